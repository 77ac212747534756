#include <scenes/hard_cases.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>

#include <gnomon/mesh/weld.h>

namespace gnomon::scenes {
namespace {

constexpr double kPi = std::numbers::pi;

// Rigid motion: turned by `angle` round z, then tilted by `tilt` round x, then moved.
struct Motion {
  double angle = 0, tilt = 0;  // radians
  Vec3 to{0.0};
  Vec3 operator()(const Vec3& p) const {
    const double c = std::cos(angle), s = std::sin(angle);
    const double x = c * p.x - s * p.y, y = s * p.x + c * p.y;
    const double d = std::cos(tilt), t = std::sin(tilt);
    return Vec3(x, d * y - t * p.z, t * y + d * p.z) + to;
  }
};

struct Builder {
  Scene scene;

  void begin(const std::string& name, bool casts = true, bool receives = true) {
    Surface surface;
    surface.object = surface.group = surface.material = name;
    surface.casts = casts;
    surface.receives = receives;
    scene.surfaces.push_back(surface);
  }
  std::uint32_t vertex(const Vec3& p) {
    scene.mesh.positions.push_back(p);
    return static_cast<std::uint32_t>(scene.mesh.positions.size() - 1);
  }
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    scene.mesh.triangles.push_back({a, b, c});
    scene.surface_of.push_back(static_cast<std::uint32_t>(scene.surfaces.size() - 1));
  }
  void triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
    const std::uint32_t i = vertex(a), j = vertex(b), k = vertex(c);
    triangle(i, j, k);
  }
  void quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const std::uint32_t i = vertex(a), j = vertex(b), k = vertex(c), l = vertex(d);
    triangle(i, j, k);
    triangle(i, k, l);
  }
  // Closed, wound outwards, or inwards.
  void box(const Vec3& lo, const Vec3& hi, const Motion& move = {}, bool inwards = false) {
    std::array<Vec3, 8> p;
    for (int k = 0; k < 8; ++k) {
      p[k] = move(
          Vec3((k & 1) != 0 ? hi.x : lo.x, (k & 2) != 0 ? hi.y : lo.y, (k & 4) != 0 ? hi.z : lo.z));
    }
    constexpr int kFaces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                  {1, 3, 7, 5}, {3, 2, 6, 7}, {2, 0, 4, 6}};
    for (const auto& f : kFaces) {
      if (inwards) {
        quad(p[f[3]], p[f[2]], p[f[1]], p[f[0]]);
      } else {
        quad(p[f[0]], p[f[1]], p[f[2]], p[f[3]]);
      }
    }
  }
  void sheet(double x0, double y0, double x1, double y1, double z) {
    quad({x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z});
  }
  // The surface of the filled cells of a grid: closed, wound outwards.
  void cells(const std::vector<double>& at, const std::function<bool(int, int, int)>& filled,
             const Motion& move) {
    const int n = static_cast<int>(at.size()) - 1;
    const auto full = [&](int i, int j, int k) {
      return i >= 0 && j >= 0 && k >= 0 && i < n && j < n && k < n && filled(i, j, k);
    };
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        for (int k = 0; k < n; ++k) {
          if (!full(i, j, k)) continue;
          const auto p = [&](int a, int b, int c) {
            return move(Vec3(at[i + a], at[j + b], at[k + c]));
          };
          if (!full(i - 1, j, k)) quad(p(0, 0, 0), p(0, 0, 1), p(0, 1, 1), p(0, 1, 0));
          if (!full(i + 1, j, k)) quad(p(1, 0, 0), p(1, 1, 0), p(1, 1, 1), p(1, 0, 1));
          if (!full(i, j - 1, k)) quad(p(0, 0, 0), p(1, 0, 0), p(1, 0, 1), p(0, 0, 1));
          if (!full(i, j + 1, k)) quad(p(0, 1, 0), p(0, 1, 1), p(1, 1, 1), p(1, 1, 0));
          if (!full(i, j, k - 1)) quad(p(0, 0, 0), p(0, 1, 0), p(1, 1, 0), p(1, 0, 0));
          if (!full(i, j, k + 1)) quad(p(0, 0, 1), p(1, 0, 1), p(1, 1, 1), p(0, 1, 1));
        }
      }
    }
  }
  // The twelve beams of a cube of half-width `half`, one closed surface of genus 5.
  void cage(double half, double beam, const Motion& move) {
    cells(
        {-half, -half + beam, half - beam, half},
        [](int i, int j, int k) { return (i == 1) + (j == 1) + (k == 1) <= 1; }, move);
  }
  // 2 x 2 x 2 such cubes that share their beams: genus 28.
  void lattice(double half, double beam, const Motion& move) {
    const double b = beam / 2;
    cells(
        {-half, -half + beam, -b, b, half - beam, half},
        [](int i, int j, int k) { return i % 2 + j % 2 + k % 2 <= 1; }, move);
  }
  // A tube along the (2,3) torus knot: one closed surface.
  void knot(double size, double tube, const Motion& move, int along = 72, int around = 8) {
    const auto curve = [&](double t) {
      return size * Vec3((2 + std::cos(3 * t)) * std::cos(2 * t),
                         (2 + std::cos(3 * t)) * std::sin(2 * t), 1.4 * std::sin(3 * t));
    };
    std::vector<std::uint32_t> ring;
    for (int i = 0; i < along; ++i) {
      const double t = 2 * kPi * i / along;
      const Vec3 p = curve(t);
      const Vec3 forward = glm::normalize(curve(t + 1e-3) - curve(t - 1e-3));
      // Away from the torus' core circle: turns smoothly, and is never along the curve.
      const Vec3 core = 2 * size * Vec3(std::cos(2 * t), std::sin(2 * t), 0);
      Vec3 u = p - core;
      u = glm::normalize(u - glm::dot(u, forward) * forward);
      const Vec3 v = glm::cross(forward, u);
      for (int j = 0; j < around; ++j) {
        const double a = 2 * kPi * j / around;
        ring.push_back(vertex(move(p + tube * (std::cos(a) * u + std::sin(a) * v))));
      }
    }
    for (int i = 0; i < along; ++i) {
      const int ii = (i + 1) % along;
      for (int j = 0; j < around; ++j) {
        const int jj = (j + 1) % around;
        const std::uint32_t a = ring[i * around + j], b = ring[i * around + jj],
                            c = ring[ii * around + jj], d = ring[ii * around + j];
        triangle(a, b, c);
        triangle(a, c, d);
      }
    }
  }
  // A sheet of revolution through (radius, height) points: open at both ends unless radius is 0.
  void turned(const std::vector<Vec2>& profile, const Vec3& to, int around = 20) {
    std::vector<std::uint32_t> ring;
    for (const Vec2& p : profile) {
      for (int j = 0; j < around; ++j) {
        const double a = 2 * kPi * j / around;
        ring.push_back(vertex(to + Vec3(p.x * std::cos(a), p.x * std::sin(a), p.y)));
      }
    }
    for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
      for (int j = 0; j < around; ++j) {
        const int jj = (j + 1) % around;
        const std::size_t lo = i * around, hi = (i + 1) * around;
        triangle(ring[lo + j], ring[lo + jj], ring[hi + jj]);
        triangle(ring[lo + j], ring[hi + jj], ring[hi + j]);
      }
    }
  }
  void moebius(double radius, double half_width, const Vec3& to, int around = 36) {
    std::vector<std::uint32_t> edge[2];
    for (int i = 0; i < around; ++i) {
      const double a = 2 * kPi * i / around;
      for (int side = 0; side < 2; ++side) {
        const double w = (side == 0 ? -1 : 1) * half_width;
        const double r = radius + w * std::cos(a / 2);
        edge[side].push_back(
            vertex(to + Vec3(r * std::cos(a), r * std::sin(a), w * std::sin(a / 2))));
      }
    }
    for (int i = 0; i < around; ++i) {
      const int ii = (i + 1) % around;
      const int turn = ii == 0 ? 1 : 0;
      triangle(edge[0][i], edge[1][i], edge[1 - turn][ii]);
      triangle(edge[0][i], edge[1 - turn][ii], edge[turn][ii]);
    }
  }
  // Floor and two walls, behind and to the left, as in the paper's Figure 2.
  void corner(double half = 6, double height = 5) {
    begin("floor");
    sheet(-half, -half, half, half, 0);
    begin("walls");
    quad({-half, half, 0}, {half, half, 0}, {half, half, height}, {-half, half, height});
    quad({-half, -half, 0}, {-half, half, 0}, {-half, half, height}, {-half, -half, height});
  }
  void ground(double half = 30) {
    begin("ground");
    sheet(-half, -half, half, half, 0);
  }
  Scene take() {
    weld(scene.mesh, scene.surface_of);
    return std::move(scene);
  }
};

struct Cases {
  int width, height;
  std::vector<HardCase> all{};

  HardCase& add(const std::string& name, const std::string& sentence, Builder& b,
                const Light& light, const View& view) {
    HardCase c;
    c.name = name;
    c.sentence = sentence;
    c.scene = b.take();
    c.light = light;
    c.view = view;
    all.push_back(std::move(c));
    return all.back();
  }
  View from(const Vec3& eye, const Vec3& target, double fov = 0.8) const {
    return perspective_view(eye, target, {0, 0, 1}, fov, width, height);
  }
};

Light sun(double x, double y, double z) { return {x, y, z, 0}; }
Light lamp(double x, double y, double z) { return {x, y, z, 1}; }

// --- Figure 1: near caps that no side of the volume covers ------------------------------------

void add_figure_1(Cases& c) {
  const auto things = [](Builder& b) {
    b.corner(8, 6);
    b.begin("things");
    b.box({-3, 2, 0}, {-1, 4, 3});
    b.box({2, 3, 0}, {4, 4, 1.5}, {0.4, 0, {0, 0, 0}});
  };
  {
    Builder b;
    things(b);
    b.begin("board");
    b.quad({-0.9, -7, 1.3}, {0.9, -7, 1.3}, {0.9, -7, 2.7}, {-0.9, -7, 2.7});
    c.add("figure-1-all-pixels",
          "A board behind the eye shades all that is seen: no pixel is covered by a side of its "
          "volume.",
          b, lamp(0, -8, 2), c.from({0, -6, 2}, {0, 4, 1.5}))
        .z_pass_fails = true;
  }
  {
    Builder b;
    things(b);
    b.begin("board");
    b.quad({-3, -7, -1}, {0.1, -7, -1}, {0.1, -7, 5}, {-3, -7, 5});
    c.add(
         "figure-1-some-pixels",
         "The edge of a board behind the eye shades half of the near plane; the other sides of its "
         "volume lie outside of the picture.",
         b, lamp(0.2, -8.5, 2.5), c.from({0, -6, 2}, {0, 4, 1.5}))
        .z_pass_fails = true;
  }
  {
    Builder b;
    things(b);
    b.begin("board");
    b.quad({-1.5, -7, 0.5}, {-1.5, -3.9, 0.5}, {-1.5, -3.9, 3}, {-1.5, -7, 3});
    c.add("figure-1-straddling",
          "A board beside the eye reaches from behind the near plane to in front of it; its volume "
          "runs across the picture.",
          b, lamp(-5, -5.5, 2.6), c.from({0, -6, 2}, {0, 3, 0.5}))
        .z_pass_fails = true;
  }
}

// --- Figures 2 and 3: light inside a complex object --------------------------------------------

void add_figures_2_3(Cases& c) {
  {
    Builder b;
    b.corner();
    b.begin("cage");
    b.cage(1.2, 0.22, {0.5, 0.6, {0, 1, 2}});
    c.add("light-in-cage", "A lamp inside a cage of genus 5, the eye outside (Figure 2).", b,
          lamp(0.1, 1.05, 2.1), c.from({5, -8, 4}, {-0.6, 1.2, 1.4}, 0.9));
  }
  {
    Builder b;
    b.corner();
    b.begin("knot");
    b.knot(0.55, 0.2, {0.3, 0.4, {0, 1, 2}});
    c.add("light-in-knot", "A lamp in the middle of a torus knot (Figure 2).", b,
          lamp(0.05, 1.1, 2.05), c.from({5, -8, 4}, {-0.6, 1.2, 1.4}, 0.9));
  }
  {
    Builder b;
    b.corner();
    b.begin("knot");
    b.knot(0.42, 0.16, {0.3, 0.4, {1, -2.4, 2.2}});
    c.add("light-in-knot-near-eye",
          "The knot and its lamp right before the eye, which is in some of its volumes (Figure 3).",
          b, lamp(1.05, -2.35, 2.25), c.from({2.4, -4.9, 2.9}, {-0.6, 1, 1.4}, 0.9))
        .z_pass_fails = true;
  }
  {
    Builder b;
    b.corner();
    b.begin("lattice");
    b.lattice(1.6, 0.16, {0.35, 0.3, {1, -2.5, 2}});
    c.add("eye-and-light-in-lattice",
          "Eye and lamp in two cells of one lattice of genus 28: closed, and both are inside its "
          "box.",
          b, lamp(0.3, -1.9, 2.6), c.from({1.6, -3.2, 1.7}, {-0.6, 1, 1.6}, 1.1))
        .z_pass_fails = true;
  }
  {
    Builder b;
    b.begin("room");
    b.box({-6, -6, 0}, {6, 6, 5});
    b.begin("cage");
    b.cage(0.9, 0.15, {0.5, 0.6, {0, 1, 2}});
    b.begin("things");
    b.box({-3, 3, 0}, {-2, 4, 2});
    b.box({2, -1, 0}, {3, 0, 1});
    c.add("closed-room",
          "Eye, lamp and casters are inside one closed box, which casts on no one but from its "
          "outside.",
          b, lamp(0.1, 1.05, 2.1), c.from({4.5, -5, 3.5}, {-1, 1.5, 1.4}, 1.0));
  }
  {
    Builder b;
    b.ground();
    b.begin("cell");
    b.box({-2, -2, 0.5}, {2, 2, 3});
    b.begin("things");
    b.box({5, 3, 0}, {7, 5, 3});
    c.add("light-in-closed-box", "A lamp shut in a box: everything but its inside is in shadow.", b,
          lamp(0.3, 0.2, 1.5), c.from({9, -12, 6}, {1, 1, 1}))
        .z_pass_fails = true;
  }
}

// --- Eye and near plane in volumes -------------------------------------------------------------

void add_eye_and_near_plane(Cases& c) {
  const auto towers = [](Builder& b) {
    b.ground();
    b.begin("towers");
    b.box({-2, -2, 0}, {2, 2, 12});
    b.box({-9, 4, 0}, {-6, 8, 5});
    b.box({5, 6, 0}, {8, 9, 7}, {0.2, 0, {0, 0, 0}});
    b.begin("hovering");
    b.box({-5, -7, 3}, {-3, -5, 4}, {0.3, 0.2, {0, 0, 0}});
  };
  {
    Builder b;
    towers(b);
    c.add("eye-in-volume", "The eye stands in the shadow of a tower and looks out of it.", b,
          sun(0.1, 0.8, 0.6), c.from({0.3, -9, 1.7}, {-3, 6, 2}, 1.0))
        .z_pass_fails = true;
  }
  {
    Builder b;
    b.ground();
    b.begin("shelves");
    for (int k = 0; k < 12; ++k) {
      const double s = 0.15 * k;
      b.sheet(-4 + s, -6 + 2 * s, 3 + s, -1 + s, 3 + 0.25 * k);
    }
    b.begin("posts");
    b.box({-6, 3, 0}, {-5, 4, 3});
    b.box({4, 5, 0}, {5, 6, 4});
    c.add("eye-in-many-volumes",
          "The eye is in twelve volumes at once, and leaves them one by one.", b, sun(0.3, -0.2, 1),
          c.from({-0.8, -5.2, 1.6}, {0.5, 5, 0.6}, 1.1))
        .z_pass_fails = true;
  }
  {
    Builder b;
    towers(b);
    c.add("near-plane-cuts-volumes-of-sun",
          "Edges of a tower's volume run through the near plane, whose far corner is lit.", b,
          sun(0.25, 0.8, 0.55), c.from({-0.5, -7, 1.8}, {3, 5, 1.2}, 1.0))
        .z_pass_fails = true;
  }
  {
    Builder b;
    towers(b);
    c.add("near-plane-cuts-volumes-of-lamp",
          "The same with a lamp: volumes widen, and one starts behind the near plane.", b,
          lamp(-2, -7.2, 8), c.from({-1.1, -8.5, 1.1}, {-0.5, 5, 0.8}, 1.0))
        .z_pass_fails = true;
  }
  {
    Builder b;
    towers(b);
    c.add(
        "eye-on-a-side",
        "The eye lies exactly in the plane of a volume's side, which so is a line in the picture.",
        b, sun(0, 3, 2), c.from({2, -12, 2}, {-2, 3, 2}, 0.9));
  }
  {
    Builder b;
    towers(b);
    c.add("light-behind-eye", "A lamp straight behind the eye: shadows hide behind their casters.",
          b, lamp(14, -22.5, 8), c.from({10, -16, 6}, {-2, 3.5, 0.5}));
  }
  {
    Builder b;
    towers(b);
    b.begin("fence");
    for (int k = -3; k <= 3; ++k) b.box({k - 0.12, -14.2, 0}, {k + 0.12, -14, 5});
    c.add(
         "fence-behind-eye",
         "A fence between eye and lamp, both behind the near plane: stripes that no visible caster "
         "throws.",
         b, lamp(0.3, -17, 2.2), c.from({0, -12, 2}, {-1, 4, 1.5}, 0.9))
        .z_pass_fails = true;
  }
  {
    Builder b;
    towers(b);
    c.add("light-at-eye", "The lamp is the eye: whatever is seen is lit.", b, lamp(10, -16, 6),
          c.from({10, -16, 6}, {-2, 3.5, 0.5}));
  }
  {
    Builder b;
    towers(b);
    b.begin("stick");
    b.box({-0.05, -11.4, 1.2}, {0.05, -11.3, 3});
    HardCase& h =
        c.add("light-in-near-plane",
              "The lamp lies in the near plane, so that seen from it the plane is a line.", b,
              lamp(1.5, -11, 2), c.from({0.5, -12, 2}, {0.5, 4, 2}, 0.9));
    h.near_plane = 1;
  }
  {
    Builder b;
    towers(b);
    HardCase& h =
        c.add("light-before-near-plane",
              "The lamp is between eye and near plane, within the view; casters all lie beyond.", b,
              lamp(0.6, -11.5, 2.1), c.from({0.5, -12, 2}, {-1, 4, 1}, 0.9));
    h.near_plane = 1;
  }
  {
    Builder b;
    towers(b);
    b.begin("awning", true, false);
    b.quad({-3, -13.5, 2.9}, {4, -13.5, 2.9}, {4, -9.7, 1.2}, {-3, -9.7, 1.2});
    HardCase& h = c.add("unseen-caster-cut-by-near-plane",
                        "A caster that is not drawn itself hangs before the eye and is cut by the "
                        "near plane.",
                        b, sun(-0.3, 0.1, 1), c.from({0.5, -12, 2}, {-1, 4, 0.5}, 0.9));
    h.near_plane = 1;
    h.z_pass_fails = true;
  }
}

// --- Light at infinity ------------------------------------------------------------------------

void add_suns(Cases& c) {
  const auto street = [](Builder& b) {
    b.ground(40);
    b.begin("houses");
    for (int k = 0; k < 4; ++k) {
      b.box({-9, 8.0 * k - 12, 0}, {-4, 8.0 * k - 7, 4.0 + k});
      b.box({4, 8.0 * k - 10, 0}, {9, 8.0 * k - 5, 7.0 - k});
    }
    b.begin("arch");
    b.box({-4.5, 20, 0}, {4.5, 21, 5});
    b.box({-1, 2, 3}, {1, 3, 3.6}, {0.5, 0.3, {0, 0, 0}});
  };
  {
    Builder b;
    street(b);
    c.add("sun-ahead", "The sun stands in the middle of the picture: volumes come at the eye.", b,
          sun(0.05, 1, 0.35), c.from({0, -16, 2}, {0, 5, 4}, 0.9));
  }
  {
    Builder b;
    street(b);
    c.add("sun-behind",
          "The sun is exactly behind the eye: all volumes meet in one point of the picture (Figure "
          "5).",
          b, sun(0, -4, 1), c.from({0, -16, 5}, {0, 0, 1}, 0.9));
  }
  {
    Builder b;
    street(b);
    c.add("sun-grazing", "A sun at half a degree: shadows are 100 times as long as their casters.",
          b, sun(0.6, 0.8, 0.00873), c.from({12, -20, 9}, {0, 4, 1}, 0.9));
  }
  {
    Builder b;
    street(b);
    c.add("sun-in-planes",
          "The sun lies exactly in the planes of half of all walls, whose own volumes are flat.", b,
          sun(0, 3, 4), c.from({12, -18, 9}, {0, 4, 1}, 0.9));
  }
  {
    Builder b;
    street(b);
    c.add("sun-in-ground", "The sun is in the plane of the ground: a tie for every triangle of it.",
          b, sun(0.6, 0.8, 0), c.from({12, -20, 9}, {0, 4, 1}, 0.9));
  }
  {
    Builder b;
    street(b);
    b.begin("sail");
    b.sheet(-3, -18, 7, 12, 8.5);
    c.add("sun-in-zenith",
          "The sun in the planes of all walls, and eye and street under a sheet without thickness.",
          b, sun(0, 0, 1), c.from({0.5, -16, 2}, {0, 4, 2}, 0.9))
        .z_pass_fails = true;
  }
}

// --- Light in planes and on casters ------------------------------------------------------------

void add_ties(Cases& c) {
  {
    Builder b;
    b.ground();
    b.begin("boxes");
    b.box({-5, -2, 0}, {-3, 2, 2});
    b.box({3, -2, 0}, {5, 2, 2});
    b.box({-1, 3, 0}, {1, 5, 4});
    b.begin("table");
    b.sheet(-2, -4, 2, -2, 2);
    c.add("light-in-planes",
          "A lamp exactly in the planes of a table, of roofs and of walls of boxes.", b,
          lamp(1, -1, 2), c.from({7, -13, 7}, {0, 0.5, 0.5}));
  }
  {
    Builder b;
    b.ground();
    b.begin("boxes");
    b.box({-3, 2, 0}, {-1, 4, 3});
    b.box({2, -1, 1}, {3, 0, 2});
    c.add("light-on-ground", "A lamp that lies on the ground.", b, lamp(0.25, 0.5, 0),
          c.from({6, -11, 6}, {0, 0.5, 0.5}));
  }
  {
    Builder b;
    b.ground();
    b.begin("box");
    b.box({-1, 0, 0}, {1, 2, 2});
    b.box({3, 2, 0}, {4, 3, 3});
    c.add("light-on-corner", "A lamp exactly on the corner of a box.", b, lamp(1, 0, 2),
          c.from({6, -11, 6}, {0, 0.5, 0.5}));
  }
  {
    Builder b;
    b.ground();
    b.begin("box");
    b.box({-1, 0, 0}, {1, 2, 2});
    b.box({3, 2, 0}, {4, 3, 3});
    c.add("light-on-edge", "A lamp exactly on an edge of a box.", b, lamp(0.25, 0, 2),
          c.from({6, -11, 6}, {0, 0.5, 0.5}));
  }
}

// --- Containers --------------------------------------------------------------------------------

void add_containers(Cases& c) {
  {
    Builder b;
    b.corner();
    b.begin("crate");  // walls with a thickness, open above: closed, not convex
    b.cells({-1, -0.9, 0.9, 1}, [](int i, int j, int k) { return i != 1 || j != 1 || k == 0; },
            {0.4, 0, {0, 1, 1}});
    c.add("light-in-crate", "A lamp in a crate that is open above.", b, lamp(0.1, 0.9, 1.75),
          c.from({5, -8, 5}, {-0.6, 1.2, 2.2}, 0.9));
  }
  {
    Builder b;
    b.corner();
    b.begin("cup");
    b.turned({{0.3, 0}, {1, 0.2}, {1.3, 1}, {1.2, 1.8}}, {0, 1, 0.6});
    c.add("light-in-cup",
          "A lamp in a cup without thickness, open above and at its foot: no closed caster, and "
          "directions behind it fill more than half a sphere.",
          b, lamp(0.1, 1.1, 2.1), c.from({5, -8, 5}, {-0.6, 1.2, 2.2}, 0.9));
  }
  {
    Builder b;
    b.corner();
    b.begin("cup");
    b.turned({{0.3, 0}, {1.2, 0.3}, {2, 1.4}, {2.2, 2.6}}, {0, -2.5, 0.6});
    c.add("eye-and-light-in-cup", "Eye and lamp in the same open cup; the eye looks over its rim.",
          b, lamp(0.3, -1.7, 1.6), c.from({0.6, -3.4, 3.1}, {-0.8, 3, 1.8}, 1.0));
  }
}

// --- Casters of all kinds ----------------------------------------------------------------------

void add_kinds(Cases& c) {
  const auto yard = [](Builder& b) {
    b.ground();
    b.begin("closed");
    b.box({-7, 3, 0}, {-5, 5, 3});
    b.begin("inside-out");
    b.box({-3.5, 3, 0}, {-1.5, 5, 3}, {}, true);
    b.begin("self-intersecting");  // two beams through each other, and a bow tie
    b.box({0, 3, 0.5}, {0.6, 6, 3});
    b.box({-1, 4, 1}, {2, 4.6, 2});
    b.triangle({3.4, 2, 0.5}, {5, 4, 3}, {5, 3.5, 0.5});
    b.triangle({5, 2.2, 0.2}, {3.4, 4, 0.4}, {3.2, 3.4, 3.2});
    b.begin("open");
    b.quad({-7, -2, 0}, {-5, -1, 0}, {-5, -1, 2.5}, {-7, -2, 2.5});
    b.begin("three-sheets-at-an-edge");
    const Vec3 low{-2.5, -1.5, 0}, high{-2.5, -1.5, 3};
    for (int k = 0; k < 3; ++k) {
      const double a = 0.3 + 2 * kPi * k / 3;
      const Vec3 out{1.2 * std::cos(a), 1.2 * std::sin(a), 0};
      b.quad(low, low + out, high + out, high);
    }
    b.begin("winding-at-random");
    b.quad({0, -2, 1}, {1.5, -2, 1}, {1.5, -0.5, 2.2}, {0, -0.5, 2.2});
    b.quad({1.5, -2, 1}, {1.5, -0.5, 2.2}, {2.8, -0.5, 1.5}, {2.8, -2, 0.4});
    b.begin("one-sided-strip");
    b.moebius(1.1, 0.5, {5.5, -1.5, 1.4});
    b.begin("coincident");
    b.sheet(-0.5, -5, 1.5, -4, 1);
    b.sheet(-0.5, -5, 1.5, -4, 1);
    b.begin("touching");
    b.box({-6, -6, 0}, {-5, -5, 1});
    b.box({-5, -6, 0}, {-4, -5, 2});
    b.box({-6, -6, 1}, {-5, -5, 1.6});
    b.begin("receives-only", false, true);
    b.quad({3.5, -5.5, 0.6}, {6, -5.5, 0.6}, {6, -3.6, 1.4}, {3.5, -3.6, 1.4});
  };
  {
    Builder b;
    yard(b);
    c.add("all-kinds-sun",
          "Closed, inside out, open, non-manifold, self-intersecting, one-sided, coincident and "
          "touching casters under a sun.",
          b, sun(0.5, -0.35, 0.75), c.from({4, -15, 11}, {-0.5, 0, 0.4}, 0.95));
  }
  {
    Builder b;
    yard(b);
    c.add("all-kinds-lamp", "The same around a lamp.", b, lamp(-0.2, 1.2, 3.4),
          c.from({4, -15, 11}, {-0.5, 0, 0.4}, 0.95));
  }
  {
    Builder b;
    yard(b);
    c.add("all-kinds-from-within", "The same, the eye in the volumes of several of them.", b,
          sun(0.3, 0.75, 0.6), c.from({-2.3, -3.2, 1.2}, {1.5, 4, 1.0}, 1.1))
        .z_pass_fails = true;
  }
  {
    Builder b;
    yard(b);
    c.add("parallel-view-sun", "A parallel view, whose eye is at infinity, with a sun.", b,
          sun(0.5, -0.35, 0.75),
          orthographic_view({14, -15, 12}, {0, 0, 0}, {0, 0, 1}, 14, c.width, c.height));
  }
  {
    Builder b;
    yard(b);
    c.add("parallel-view-lamp", "A parallel view with a lamp among the casters.", b,
          lamp(-0.2, 1.2, 3.4),
          orthographic_view({14, -15, 12}, {0, 0, 0}, {0, 0, 1}, 14, c.width, c.height));
  }
  {
    Builder b;
    yard(b);
    c.add("parallel-view-along-light",
          "A parallel view exactly along the sun's rays: volumes are seen as lines, and nothing "
          "that is seen is in shadow but from behind.",
          b, sun(14, -15, 12),
          orthographic_view({14, -15, 12}, {0, 0, 0}, {0, 0, 1}, 14, c.width, c.height));
  }
}

}  // namespace

std::vector<HardCase> hard_cases(int width, int height) {
  Cases c{width, height};
  add_figure_1(c);
  add_figures_2_3(c);
  add_eye_and_near_plane(c);
  add_suns(c);
  add_ties(c);
  add_containers(c);
  add_kinds(c);
  return std::move(c.all);
}

Flight flight(int width, int height) {
  // Round the lamp once, the course and the height waving; looks ahead, and now and then inwards.
  const auto at = [](double t) {
    const double r = 4.4 + 0.5 * std::cos(3 * t + 0.4);
    return Vec3(r * std::cos(t), r * std::sin(t), 2 + 0.7 * std::sin(4 * t));
  };
  Flight f;
  Builder b;
  b.ground(24);
  b.begin("pillars");  // between lamp and course
  for (int k = 0; k < 5; ++k) {
    const double a = 2 * kPi * k / 5;
    b.box({-0.4, -0.4, 0}, {0.4, 0.4, 3.0 + 0.6 * k},
          {a, 0, {2.5 * std::cos(a), 2.5 * std::sin(a), 0}});
  }
  b.begin("towers");  // around
  b.box({6, -3, 0}, {8, 2, 6}, {0.2, 0, {0, 0, 0}});
  b.box({-9, -2, 0}, {-6.5, 3, 5}, {-0.3, 0, {0, 0, 0}});
  b.box({-2, 6.5, 0}, {3, 9, 4});
  b.box({-3, -10, 0}, {2, -6.5, 3});
  b.begin("bridge");
  b.box({1.5, -0.5, 3.2}, {7, 0.5, 3.5}, {2.2, 0, {0, 0, 0}});
  b.begin("frame");  // flown through
  const double there = 11 * kPi / 8;
  b.cage(1.1, 0.18, {there + 0.2, 0, at(there)});
  b.begin("knot");
  b.knot(0.35, 0.13, {0.2, 0.5, {4.6, 5, 2.2}}, 48, 6);
  f.scene = b.take();
  f.light = lamp(0.4, 0.3, 4.4);
  for (int k = 0; k < kFlightFrames; ++k) {
    const double t = 2 * kPi * k / kFlightFrames;
    const Vec3 eye = at(t);
    const Vec3 ahead = glm::normalize(at(t + 0.05) - eye);
    const Vec3 inwards = glm::normalize(Vec3(0, 0, 1) - eye);
    const double turn = 0.5 + 0.5 * std::sin(5 * t);
    f.views.push_back(
        perspective_view(eye, eye + ahead + turn * inwards, {0, 0, 1}, 1.0, width, height));
  }
  return f;
}

}  // namespace gnomon::scenes
