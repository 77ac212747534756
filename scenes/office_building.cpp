// second_paper_scenes.h: the office building.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include <gnomon/core/place.h>
#include <scenes/body_builder.h>
#include <scenes/second_paper_scenes.h>

namespace gnomon::scenes {
namespace {

// The paper's colours for facade and concrete.
constexpr Vec3 kYellow{0.90, 0.78, 0.30}, kGreen{0.45, 0.66, 0.42}, kPaleBlue{0.66, 0.80, 0.88},
    kRed{0.78, 0.42, 0.34}, kPaving{0.80, 0.79, 0.76}, kWater{0.48, 0.60, 0.66};

constexpr int kFloors = 20, kModules = 96, kPodiumModules = 144, kPodiumFloors = 2;
constexpr double kStorey = 3.9, kPodiumStorey = 4.5, kFoot = kPodiumFloors * kPodiumStorey;
constexpr double kHeight = kFoot + kFloors * kStorey;

// A plan: an oval of half axes a and b, bent about a centre at distance `bend` to the north.
struct Plan {
  double a, b, bend;
  double twist = 0, waist = 0;  // radians, and the share it is slimmer, at kHeight
  std::vector<double> angle;    // at equal distances along the outline

  Plan(double half_length, double half_width, double radius, double turn = 0, double slim = 0)
      : a(half_length), b(half_width), bend(radius), twist(turn), waist(slim) {
    constexpr int kFine = 4096;
    std::vector<double> length{0};
    const auto fine = [](int k) { return 2 * kPi * k / kFine; };
    for (int k = 0; k < kFine; ++k)
      length.push_back(length.back() + glm::distance(bent(fine(k), 0), bent(fine(k + 1), 0)));
    constexpr int kStops = 1024;
    int k = 0;
    for (int s = 0; s <= kStops; ++s) {
      const double want = length.back() * s / kStops;
      while (k + 1 < kFine && length[static_cast<std::size_t>(k) + 1] < want) ++k;
      const double from = length[static_cast<std::size_t>(k)],
                   to = length[static_cast<std::size_t>(k) + 1];
      angle.push_back(fine(k) + (want - from) / (to - from) * (fine(1) - fine(0)));
    }
  }

  Vec2 bent(double t, double inset) const {
    const auto full = [](double c) { return std::copysign(std::pow(std::fabs(c), 0.85), c); };
    const double x = (a - inset) * full(std::cos(t)), y = (b - inset) * full(std::sin(t));
    return {(bend - y) * std::sin(x / bend), bend - (bend - y) * std::cos(x / bend)};
  }

  // Share u of the way around, `inset` metres inside the outline, at the height z.
  Vec3 at(double u, double inset, double z) const {
    const double stops = static_cast<double>(angle.size() - 1), s = (u - std::floor(u)) * stops;
    const auto k = std::min(static_cast<std::size_t>(s), angle.size() - 2);
    const double t = angle[k] + (s - static_cast<double>(k)) * (angle[k + 1] - angle[k]);
    const double up = std::max(0.0, z - kFoot) / (kHeight - kFoot);
    const double slim = 1 - waist * std::sin(0.5 * kPi * up) * up, turn = twist * up;
    const Vec2 p = bent(t, inset) * slim;
    return {p.x * std::cos(turn) - p.y * std::sin(turn),
            p.x * std::sin(turn) + p.y * std::cos(turn), z};
  }
};

struct Office {
  BodyBuilder b;
  OfficeCasters casters;
  Plan tower{34, 10.5, 37, 0.16, 0.09}, core{13, 3.6, 37}, podium{44, 18, 56};

  void concrete() { b.begin("concrete", "concrete", kGreen); }
  void facade() { b.begin("facade", "facade", kYellow); }
  void glass() { b.begin("glass", "glass", kPaleBlue, casters == OfficeCasters::all); }
  void interior() { b.begin("interior", "interior", kRed, casters == OfficeCasters::all); }

  // Between two places of a plan's outline: from `outer` to `inner` metres inside of it (less than
  // 0: outside), and at each of them from `low` to `high`.
  struct Edge {
    double inset, low, high;
  };
  void piece(const Plan& p, double u, double v, const Edge& outer, const Edge& inner) {
    const auto ring = [&](double w) {
      return std::vector<Vec3>{p.at(w, outer.inset, outer.low), p.at(w, inner.inset, inner.low),
                               p.at(w, inner.inset, inner.high), p.at(w, outer.inset, outer.high)};
    };
    b.loft({ring(u), ring(v)});
  }
  void piece(const Plan& p, double u, double v, double low, double high, double outer,
             double inner) {
    piece(p, u, v, {outer, low, high}, {inner, low, high});
  }

  // From the outline of one plan inwards to that of another.
  void ring(const Plan& outer, double out, const Plan& inner, double in, double low, double high,
            int around) {
    std::vector<std::vector<Vec3>> rings;
    for (int k = 0; k < around; ++k) {
      const double u = double(k) / around;
      rings.push_back({outer.at(u, out, low), inner.at(u, in, low), inner.at(u, in, high),
                       outer.at(u, out, high)});
    }
    b.closed_loft(rings);
  }

  static double level(int floor) { return kFoot + floor * kStorey; }

  void ground() {
    const bool casts = casters == OfficeCasters::all;
    // 21 x 21 cells, as far as the shadows of the figure's eight hours reach; a canal.
    constexpr int kAcross = 21;
    constexpr double kWest = -294, kCell = 28;
    b.begin("ground", "paving", kPaving, casts);
    b.grid({kWest, -109, 0}, kCell, 18, kAcross, 11);
    b.grid({kWest, 134, 0}, kCell, 18, kAcross, 7);
    b.begin("ground", "water", kWater, casts);
    b.grid({kWest, 89, 0}, kCell, 15, kAcross, 3);
  }

  void skeleton() {
    concrete();
    ring(core, 0, core, 0.4, -0.5, kHeight + 4.5, 64);
    for (int k = -3; k <= 3; ++k) {  // shafts of lifts
      const double x = 3.2 * k, bow = 37 - std::sqrt(37.0 * 37 - x * x);
      b.box({x - 0.12, bow - 3.4, -0.4}, {x + 0.12, bow + 3.4, kHeight + 4});
    }
    for (int f = 1; f <= kFloors; ++f)
      ring(tower, 0.45, core, 0.2, level(f) - 0.32, level(f), kModules);
    for (int f = 0; f < kFloors; ++f) {
      constexpr int kColumns = 24;
      for (int k = 0; k < kColumns; ++k) {
        const double u = (k + 0.5) / kColumns;
        b.bar(tower.at(u, 1.9, level(f) - 0.1), tower.at(u, 1.9, level(f + 1) - 0.2), 0.32, 12);
        const Vec3 from = core.at(u, 0.1, level(f + 1) - 0.5);
        b.beam(from, tower.at(u, 1.2, from.z), 0.3, 0.45, {0, 0, 1});
      }
      for (int s = 0; s < 16; ++s) {  // two flights of stairs at the ends of the core
        const double side = s < 8 ? -1 : 1, z = level(f) + kStorey / 2 * ((s % 8) / 7.0);
        const double x = side * (10.2 + 0.28 * (s % 8)), y = 1.2;
        b.box({x - 0.13, y - 0.6, z}, {x + 0.13, y + 0.6, z + 0.16});
      }
    }
    for (int f = 0; f <= kPodiumFloors; ++f) {
      const double z = f * kPodiumStorey;
      ring(podium, f == kPodiumFloors ? -0.6 : 0.5, core, 0.2, z - 0.4, z + (f == 0 ? 0.15 : 0),
           kPodiumModules);
      if (f == kPodiumFloors) break;
      for (int k = 0; k < 48; ++k) {
        const double u = (k + 0.5) / 48;
        b.bar(podium.at(u, 2.2, z - 0.2), podium.at(u, 2.2, z + kPodiumStorey - 0.1), 0.38, 12);
      }
    }
    for (int k = 0; k < 12; ++k) {  // planters on the podium's roof
      const double u = 0.54 + 0.42 * k / 12;
      piece(podium, u, u + 0.018, kFoot - 0.1, kFoot + 0.7, 2.0, 4.2);
    }
  }

  // Mullion, panel below the window, louvres where the sun comes: from the south most.
  void tower_facade() {
    constexpr double kHalf = 0.0005;  // of a mullion, as a share of the outline
    for (int f = 0; f < kFloors; ++f) {
      const double z = level(f), top = z + kStorey;
      for (int m = 0; m < kModules; ++m) {
        const double u = double(m) / kModules, v = double(m + 1) / kModules;
        facade();
        piece(tower, u - kHalf, u + kHalf, z - 0.42, top - 0.48, -0.3, 0.2);
        piece(tower, u + kHalf * 2, v - kHalf * 2, z - 0.4, z + 0.75, 0.0, 0.14);
        const Vec3 along = tower.at(v, 0, z) - tower.at(u, 0, z);
        const double south = along.x / glm::length(along);  // counterclockwise: 1 is due south
        const int louvres = south > -0.1 ? 2 : 1;
        for (int k = 0; k < louvres; ++k) {
          const double h = top - 0.6 - (louvres == 1 ? 0.2 : 1.0 * k);
          piece(tower, u + kHalf * 2, v - kHalf * 2, {-0.75, h - 0.22, h - 0.16},
                {-0.12, h - 0.06, h});
        }
        glass();
        piece(tower, u + kHalf * 1.5, v - kHalf * 1.5, z + 0.72, top - 0.38, 0.22, 0.27);
      }
    }
    facade();
    for (int m = 0; m < kModules; ++m) {  // the crown: fins that rise towards the east
      const double u = double(m) / kModules;
      piece(tower, u - kHalf, u + kHalf, {-0.3, kHeight - 0.42, crown(u)},
            {0.6, kHeight - 0.42, crown(u) - 0.5});
    }
  }
  static double crown(double u) { return kHeight + 3.5 + 3.2 * (1 + std::cos(2 * kPi * u)); }

  void podium_facade() {
    constexpr double kHalf = 0.0004;
    for (int f = 0; f < kPodiumFloors; ++f) {
      const double z = f * kPodiumStorey, top = z + kPodiumStorey;
      for (int m = 0; m < kPodiumModules; ++m) {
        const double u = double(m) / kPodiumModules, v = double(m + 1) / kPodiumModules;
        facade();
        piece(podium, u - kHalf, u + kHalf, z + 0.2, top - 0.45, -0.15, 0.25);
        if (f > 0) piece(podium, u + kHalf * 2, v - kHalf * 2, z - 0.5, z + 0.9, 0.0, 0.2);
        glass();
        piece(podium, u + kHalf * 1.5, v - kHalf * 1.5, z + (f > 0 ? 0.85 : 0.16), top - 0.42, 0.3,
              0.36);
      }
    }
    facade();
    ring(podium, -0.7, podium, -0.45, kFoot - 0.5, kFoot + 1.1, kPodiumModules);
  }

  // Rails between the crown's fins, from below and from the east on, as many as are missing.
  void crown_rails() {
    facade();
    const std::size_t used = b.triangles_of("facade") + b.triangles_of("concrete");
    std::size_t missing = kOfficeBuilding.casting - std::min(used, kOfficeBuilding.casting);
    missing = flagpoles(missing);
    constexpr double kStep = 0.6;
    for (int row = 0; missing > 0; ++row) {
      const double z = kHeight + 0.4 + kStep * row;
      for (int m = 0; m < kModules && missing > 0; ++m) {
        const double u = double(m % 2 == 0 ? m / 2 : kModules - 1 - m / 2) / kModules;
        const double v = u + 1.0 / kModules;
        if (z + 0.8 > std::min(crown(u), crown(v))) continue;
        piece(tower, u + 0.001, v - 0.001, z, z + 0.14, -0.2, 0.3);
        missing -= 12;
      }
      if (z > kHeight + 12) break;
    }
  }
  // Three-sided, 8 triangles each: until whole boxes of 12 are left.
  std::size_t flagpoles(std::size_t missing) {
    for (int k = 0; missing % 12 != 0 && missing >= 8; ++k, missing -= 8)
      b.bar({-12.0 - 4 * k, -34, -0.4}, {-12.0 - 4 * k, -34, 12}, 0.15, 3);
    return missing;
  }

  void rooms() {
    interior();
    const auto missing = [&] {
      return kOfficeBuilding.triangles - std::min(b.triangles(), kOfficeBuilding.triangles);
    };
    constexpr int kWalls = 14;
    for (int f = 0; f < kFloors; ++f) {
      for (int k = 0; k < kWalls; ++k) {
        const double u = (k + 0.25) / kWalls, z = level(f) + 1.6;
        b.beam(core.at(u, -0.1, z), tower.at(u, 2.6, z), 3.1, 0.12, {0, 0, 1});
      }
    }
    // Three-sided stands until whole boxes are left; then desks along the facade, on all floors.
    for (int k = 0; missing() % 12 != 0; ++k)
      b.bar({-1.0 + 2 * k, -6, kFoot}, {-1.0 + 2 * k, -6, kFoot + 1.8}, 0.1, 3);
    const std::size_t desks = missing() / 12;
    for (std::size_t k = 0; k < desks; ++k) {
      const int f = static_cast<int>(k % kFloors);
      const double n = static_cast<double>(k / kFloors), z = level(f) + 0.4;
      const double u = (n + 0.5) / (double(desks) / kFloors + 1);
      const Vec3 from = tower.at(u - 0.006, 3.4, z), to = tower.at(u + 0.006, 3.4, z);
      b.beam(from, to, 0.75, 0.8, {0, 0, 1});
    }
  }
};

}  // namespace

Scene office_building(OfficeCasters casters) {
  Office o;
  o.casters = casters;
  o.ground();
  o.skeleton();
  o.tower_facade();
  o.podium_facade();
  o.crown_rails();
  o.rooms();
  return o.b.finished(48.2, 16.4);
}

}  // namespace gnomon::scenes
