// second_paper_scenes.h: the tower of lattice.
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include <gnomon/core/place.h>
#include <scenes/body_builder.h>
#include <scenes/second_paper_scenes.h>

namespace gnomon::scenes {
namespace {

constexpr Vec3 kIron{0.46, 0.35, 0.26}, kDarkIron{0.36, 0.27, 0.21}, kStone{0.78, 0.74, 0.66},
    kLawn{0.55, 0.64, 0.42}, kPaving{0.80, 0.77, 0.70};

// Heights, metres, of Eiffel's tower.
constexpr double kMasonryTop = 4.5, kFirst = 57.6, kSecond = 115.7, kJoin = 188, kThird = 276,
                 kTop = 300;

// Half of the tower's outer width, and the width of a leg, at the height z.
struct Width {
  double z, half, leg;
};
constexpr std::array<Width, 5> kWidths = {{{0, 61.5, 25.0},
                                           {kFirst, 34.0, 16.0},
                                           {kSecond, 18.9, 10.4},
                                           {kJoin, 9.3, 8.6},
                                           {kThird, 4.6, 4.6}}};

// Through the table, smooth and without overshoot (Fritsch and Carlson's harmonic slopes).
double interpolated(double z, double Width::*what) {
  std::array<double, kWidths.size()> slope{};
  const auto rise = [&](std::size_t k) {
    return (kWidths[k + 1].*what - kWidths[k].*what) / (kWidths[k + 1].z - kWidths[k].z);
  };
  slope.front() = rise(0);
  slope.back() = rise(kWidths.size() - 2);
  for (std::size_t k = 1; k + 1 < kWidths.size(); ++k)
    slope[k] = 2 * rise(k - 1) * rise(k) / (rise(k - 1) + rise(k));
  std::size_t k = 0;
  while (k + 2 < kWidths.size() && z > kWidths[k + 1].z) ++k;
  const double h = kWidths[k + 1].z - kWidths[k].z, t = (z - kWidths[k].z) / h, u = 1 - t;
  return kWidths[k].*what * u * u * (1 + 2 * t) + slope[k] * h * t * u * u +
         kWidths[k + 1].*what * t * t * (3 - 2 * t) - slope[k + 1] * h * t * t * u;
}
double half_at(double z) { return interpolated(z, &Width::half); }
double leg_at(double z) { return interpolated(z, &Width::leg); }

// Where panels of lattice begin and end: each about as high as the lattice is wide.
std::vector<double> panels(double low, double high, int count, double ratio) {
  std::vector<double> z{low};
  double step = 1, sum = 0;
  for (int k = 0; k < count; ++k, step *= ratio) sum += step;
  step = (high - low) / sum;
  for (int k = 0; k < count; ++k, step *= ratio) z.push_back(z.back() + step);
  z.back() = high;
  return z;
}

struct Tower {
  BodyBuilder b;
  // Corners that gussets may take: a node, and along which two ways they reach.
  struct Node {
    Vec3 at, u, v;
  };
  std::vector<Node> nodes;

  void node(const Vec3& at, const Vec3& beside, const Vec3& above) {
    nodes.push_back({at, glm::normalize(beside - at), glm::normalize(above - at)});
  }

  // Corner c of leg (sx, sy) at z: 0 outer, 1 inner in x, 2 inner in both, 3 inner in y.
  static Vec3 leg_corner(double sx, double sy, int c, double z) {
    const double out = half_at(z), in = out - leg_at(z);
    return {sx * (c == 1 || c == 2 ? in : out), sy * (c == 2 || c == 3 ? in : out), z};
  }
  static Vec3 shaft_corner(int c, double z) {
    const double w = half_at(z);
    return {c == 0 || c == 3 ? w : -w, c < 2 ? w : -w, z};
  }

  // Four chords, and in each panel of each face a level bar and two diagonals.
  template <typename Corner>
  void lattice(const std::vector<double>& z, const Corner& corner, double chord, double bar) {
    for (int c = 0; c < 4; ++c) {
      std::vector<std::vector<Vec3>> rings;
      for (std::size_t k = 0; k < z.size(); ++k) {
        const Vec3 p = corner(c, z[k]);
        const double w = chord / 2 * (1 - 0.35 * double(k) / double(z.size()));
        rings.push_back(
            {p + Vec3(w, w, 0), p + Vec3(-w, w, 0), p + Vec3(-w, -w, 0), p + Vec3(w, -w, 0)});
      }
      b.loft(rings);
    }
    for (std::size_t k = 0; k + 1 < z.size(); ++k) {
      for (int c = 0; c < 4; ++c) {
        const int d = (c + 1) % 4;
        const Vec3 p = corner(c, z[k]), q = corner(d, z[k]);
        const Vec3 r = corner(c, z[k + 1]), s = corner(d, z[k + 1]);
        b.bar(p, s, bar, 3);
        b.bar(q, r, bar, 3);
        b.beam(r, s, 2.2 * bar, 1.6 * bar, {0, 0, 1});
      }
    }
  }

  void ground() {
    // South-east of the middle less, north-west more: there the shadows of the figure's four hours
    // fall. The lawn is the strip across, as the Champ de Mars.
    constexpr double kCell = 100;
    b.begin("ground", "paving", kPaving, false);
    b.grid({-700, -300, 0}, kCell, kCell, 11, 2);
    b.grid({-700, 100, 0}, kCell, kCell, 11, 5);
    b.begin("ground", "lawn", kLawn, false);
    b.grid({-700, -100, 0}, kCell, kCell, 11, 2);
  }

  void masonry() {
    b.begin("masonry", "stone", kStone);
    for (const double sx : {-1.0, 1.0}) {
      for (const double sy : {-1.0, 1.0}) {
        for (int c = 0; c < 4; ++c) {
          const Vec3 low = leg_corner(sx, sy, c, 0), high = leg_corner(sx, sy, c, kMasonryTop);
          const auto square = [](const Vec3& p, double w) {
            return std::vector<Vec3>{p + Vec3(-w, -w, 0), p + Vec3(w, -w, 0), p + Vec3(w, w, 0),
                                     p + Vec3(-w, w, 0)};
          };
          b.loft({square(low - Vec3(0, 0, 1), 4.2), square(high, 2.6)});
        }
      }
    }
  }

  void legs() {
    int number = 0;
    for (const double sx : {-1.0, 1.0}) {
      for (const double sy : {-1.0, 1.0}) {
        b.begin("leg_" + std::to_string(++number), "iron", kIron);
        const auto corner = [&](int c, double z) { return leg_corner(sx, sy, c, z); };
        const std::vector<double> lower = panels(kMasonryTop - 1, kFirst - 2, 4, 0.9),
                                  middle = panels(kFirst + 1, kSecond - 2, 5, 0.92);
        lattice(lower, corner, 2.0, 0.55);
        lattice(middle, corner, 1.6, 0.42);
        lattice(panels(kSecond + 1, kJoin, 4, 0.95), corner, 1.3, 0.34);
        for (const auto& z : {lower, middle}) {
          for (std::size_t k = 1; k + 1 < z.size(); ++k) {
            for (const int d : {1, 3})  // the outer faces
              node(corner(0, z[k]), corner(d, z[k]), corner(0, z[k + 1]));
          }
        }
      }
    }
  }

  void shaft() {
    b.begin("shaft", "iron", kIron);
    const std::vector<double> z = panels(kJoin - 2, kThird - 1, 9, 0.95);
    lattice(z, shaft_corner, 1.1, 0.3);
    b.beam({0, 0, kSecond}, {0, 0, kThird - 2}, 1.8, 1.8, {1, 0, 0});  // the lift's
    for (std::size_t k = 1; k + 1 < z.size(); ++k) {
      for (int c = 0; c < 4; ++c)
        node(shaft_corner(c, z[k]), shaft_corner((c + 1) % 4, z[k]), shaft_corner(c, z[k + 1]));
    }
  }

  // Two ribs and bars between them, in the plane of each side's outer faces.
  void arches() {
    b.begin("arches", "dark iron", kDarkIron);
    constexpr int kParts = 10;
    constexpr double kRadius = 36.5, kDepth = 4.0, kSpring = 13;
    for (int side = 0; side < 4; ++side) {
      const auto point = [&](double radius, int k) {
        const double a = kPi * (0.06 + 0.88 * k / kParts);
        const double x = radius * std::cos(a), z = kSpring + radius * std::sin(a);
        const double y = half_at(z) - 0.4;
        const std::array<Vec2, 4> turned = {Vec2(x, y), Vec2(-y, x), Vec2(-x, -y), Vec2(y, -x)};
        return Vec3(turned[static_cast<std::size_t>(side)], z);
      };
      for (const double radius : {kRadius, kRadius + kDepth}) {
        std::vector<std::vector<Vec3>> rings;
        for (int k = 0; k <= kParts; ++k) {
          const Vec3 p = point(radius, k), r = 0.5 * (point(radius + 1, k) - p);
          const Vec3 along = side % 2 == 0 ? Vec3(0, 0.7, 0) : Vec3(0.7, 0, 0);
          rings.push_back({p - r - along, p - r + along, p + r + along, p + r - along});
        }
        b.loft(rings);
      }
      for (int k = 0; k < kParts; ++k) {
        const bool up = k % 2 == 0;
        b.bar(point(kRadius + (up ? 0 : kDepth), k), point(kRadius + (up ? kDepth : 0), k + 1), 0.3,
              3);
      }
    }
  }

  // A square ring of slab from `in` to `out`, half widths.
  void ring_slab(double in, double out, double low, double high) {
    std::vector<std::vector<Vec3>> rings;
    for (const Vec2 c : {Vec2(1, 1), Vec2(-1, 1), Vec2(-1, -1), Vec2(1, -1)}) {
      rings.push_back(
          {Vec3(c * in, low), Vec3(c * out, low), Vec3(c * out, high), Vec3(c * in, high)});
    }
    b.closed_loft(rings);
  }
  // Posts along the square of half width w, `count` on each side.
  void posts(double w, double low, double high, int count, double thick) {
    for (int k = 0; k < count; ++k) {
      const double t = -w + 2 * w * k / count;
      for (const Vec2 p : {Vec2(t, -w), Vec2(w, t), Vec2(-t, w), Vec2(-w, -t)})
        b.beam(Vec3(p, low), Vec3(p, high), thick, thick, {1, 0, 0});
    }
  }

  void platforms() {
    b.begin("platform_1", "dark iron", kDarkIron);
    const double first = half_at(kFirst);
    ring_slab(first - 20, first + 1.8, kFirst - 4, kFirst - 0.6);  // the frieze
    ring_slab(first - 19, first + 3.0, kFirst - 0.5, kFirst + 0.5);
    posts(first + 2.3, kFirst + 0.4, kFirst + 5.2, 5, 0.5);
    ring_slab(first - 1.5, first + 3.2, kFirst + 5, kFirst + 5.8);
    for (const double s : {-1.0, 1.0}) {  // restaurants
      b.box({-13, s * (first - 9) - 4.5, kFirst + 0.4}, {13, s * (first - 9) + 4.5, kFirst + 7});
      b.box({s * (first - 9) - 4.5, -13, kFirst + 0.4}, {s * (first - 9) + 4.5, 13, kFirst + 7});
    }
    b.begin("platform_2", "dark iron", kDarkIron);
    const double second = half_at(kSecond);
    ring_slab(second - 12, second + 1.2, kSecond - 3, kSecond - 0.5);
    ring_slab(second - 11.5, second + 2.2, kSecond - 0.4, kSecond + 0.4);
    posts(second + 1.8, kSecond + 0.3, kSecond + 4, 4, 0.4);
    ring_slab(second - 1.5, second + 2.3, kSecond + 3.8, kSecond + 4.4);
    b.box({-8, -8, kSecond + 0.2}, {8, 8, kSecond + 6});
    b.begin("platform_3", "dark iron", kDarkIron);
    const auto square = [](double w, double z) {
      return std::vector<Vec3>{{-w, -w, z}, {w, -w, z}, {w, w, z}, {-w, w, z}};
    };
    b.loft({square(4.8, kThird - 5), square(8.2, kThird), square(8.2, kThird + 1.2)});
    b.box({-7.0, -7.0, kThird + 1}, {7.0, 7.0, kThird + 4.6});
    b.box({-7.8, -7.8, kThird + 4.4}, {7.8, 7.8, kThird + 5.2});
    b.box({-4.6, -4.6, kThird + 5}, {4.6, 4.6, kThird + 9.5});
  }

  void mast() {
    b.begin("mast", "dark iron", kDarkIron);
    b.turned({0, 0, kThird + 9}, {{0, 0}, {4.2, 0}, {3.7, 2.2}, {2.2, 3.8}, {0, 4.4}}, 12);
    const double foot = kThird + 13;
    b.turned({0, 0, foot},
             {{0, 0}, {1.1, 0}, {0.8, 4}, {0.5, 4.2}, {0.4, kTop - foot - 0.6}, {0, kTop - foot}},
             8);
    b.box({-1.6, -1.6, foot + 1.5}, {1.6, 1.6, foot + 2});
  }

  // Triangular plates in the corners of chord and bar, as many as are missing.
  void gussets() {
    b.begin("gussets", "iron", kIron);
    const std::size_t missing =
        kLatticeTower.casting - std::min(b.casting(), kLatticeTower.casting);
    assert(missing <= 2 * nodes.size());
    for (std::size_t k = 0; k < missing; ++k) {
      const Node& n = nodes[k % nodes.size()];
      const bool below = k >= nodes.size();
      const Vec3 v = below ? -n.v : n.v;
      const double size = 0.09 * leg_at(n.at.z);
      b.plate(n.at, n.at + 2 * size * n.u, n.at + 2 * size * v);
    }
  }
};

}  // namespace

Scene lattice_tower() {
  Tower t;
  t.ground();
  t.masonry();
  t.legs();
  t.shaft();
  t.arches();
  t.platforms();
  t.mast();
  t.gussets();
  return t.b.finished(48.8, 2.3);
}

}  // namespace gnomon::scenes
