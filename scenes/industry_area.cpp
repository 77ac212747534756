// second_paper_scenes.h: the industry area.
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

constexpr Vec3 kAsphalt{0.66, 0.66, 0.65}, kBrick{0.68, 0.45, 0.36}, kMetal{0.80, 0.82, 0.84},
    kGlazing{0.55, 0.68, 0.76}, kConcrete{0.76, 0.75, 0.72}, kSteel{0.42, 0.47, 0.52},
    kRed{0.75, 0.26, 0.20}, kWhite{0.93, 0.93, 0.90}, kBlue{0.25, 0.42, 0.62},
    kYellow{0.86, 0.70, 0.22}, kRoofing{0.50, 0.52, 0.55}, kWood{0.72, 0.58, 0.40};

const Vec3 kUp{0, 0, 1};

struct Area {
  BodyBuilder b;

  void ground() {
    b.begin("ground", "asphalt", kAsphalt, false);
    b.grid({-200, -140, 0}, 80, 100, 5, 3);
  }

  // Saw teeth that look north: upright glazing, slopes that fall to the south; the ridges run along
  // x. Eaves at `eaves`, ridges `rise` above.
  void hall(int number, const Vec2& at, double length, int teeth, double tooth, double eaves,
            double rise) {
    const std::string name = "hall_" + std::to_string(number);
    b.begin(name, "brick", kBrick);
    const double depth = teeth * tooth;
    std::vector<Vec3> outline{{at.x, at.y, -0.5}, {at.x, at.y + depth, -0.5}};
    for (int k = teeth; k > 0; --k) {
      outline.push_back({at.x, at.y + k * tooth - (k == teeth ? 0 : 0.4), eaves + rise});
      outline.push_back({at.x, at.y + (k - 1) * tooth, eaves});
    }
    b.concave_prism(outline, {length, 0, 0}, 0);
    b.begin(name, "glazing", kGlazing);  // a band below each ridge, and its bars
    for (int k = 1; k <= teeth; ++k) {
      const double y = at.y + k * tooth - (k == teeth ? 0.0 : 0.35);
      b.box({at.x + 1, y - 0.2, eaves + 0.8}, {at.x + length - 1, y + 0.2, eaves + rise - 0.4});
    }
    b.begin(name, "steel", kSteel);
    for (int k = 1; k <= teeth; ++k) {
      const double y = at.y + k * tooth - (k == teeth ? 0.0 : 0.35);
      for (int i = 1; i < 4; ++i) {
        const double x = at.x + length * i / 4;
        b.box({x - 0.12, y - 0.1, eaves + 0.5}, {x + 0.12, y + 0.32, eaves + rise - 0.2});
      }
    }
    b.begin(name, "roofing", kRoofing);
    for (int k = 0; k < teeth; ++k) {
      const double run = tooth - (k + 1 == teeth ? 0.0 : 0.4) - 0.5;
      const Vec3 up = glm::normalize(Vec3(0, -rise, run + 0.5));
      b.parallelepiped({at.x - 0.3, at.y + k * tooth + 0.3, eaves + 0.3 * rise / tooth - 0.06},
                       {length + 0.6, 0, 0}, {0, run, run * rise / (run + 0.5)}, 0.3 * up);
    }
    b.begin(name, "brick", kBrick);
    const int bays = static_cast<int>(length / 7.5);
    for (int i = 0; i <= bays; ++i) {  // pilasters
      const double x = at.x + 0.6 + (length - 1.2) * i / bays;
      b.box({x - 0.4, at.y - 0.4, -0.4}, {x + 0.4, at.y + 0.2, eaves - 0.3});
    }
    b.begin(name, "gates", kSteel);
    for (int i = 1; i < bays; i += 3) {
      const double x = at.x + 0.6 + (length - 1.2) * (i + 0.5) / bays;
      b.box({x - 2, at.y - 0.25, -0.3}, {x + 2, at.y + 0.3, 4.2});
    }
    b.begin(name, "metal", kMetal);
    for (int k = 0; k < teeth; ++k) {  // ventilators on the slopes
      for (const double part : {0.3, 0.7}) {
        const double z = eaves + 0.45 * rise;
        b.turned({at.x + length * part, at.y + (k + 0.45) * tooth, z - 0.6},
                 {{0, 0}, {0.8, 0}, {0.8, 1.6}, {0, 2.3}}, 6);
      }
    }
  }

  void silos() {
    for (int k = 0; k < 8; ++k) {
      const Vec3 at(40 + 11.5 * (k % 4), 62 + 11.5 * (k / 4), 0);
      b.begin("silos", "metal", kMetal);
      b.turned(at, {{0, 3}, {5, 6}, {5, 27}, {0, 29.5}}, 16);
      b.begin("silos", "steel", kSteel);
      b.turned(at, {{4.85, 16}, {5.2, 16}, {5.2, 16.6}, {4.85, 16.6}}, 16);
      for (int leg = 0; leg < 4; ++leg) {
        const double a = kPi * (leg + 0.5) / 2;
        const Vec3 foot = at + 4.4 * Vec3(std::cos(a), std::sin(a), 0);
        b.beam(foot - 0.5 * kUp, foot + 7.0 * kUp, 0.5, 0.5, {1, 0, 0});
      }
    }
    b.begin("silos", "steel", kSteel);  // the gallery over their tops
    for (int row = 0; row < 2; ++row) {
      const double y = 62 + 11.5 * row;
      b.box({37, y - 1.4, 29.3}, {78, y + 1.4, 32});
    }
    b.box({73, 60, 0.2}, {81, 76, 1});
  }

  void tanks() {
    for (int k = 0; k < 4; ++k) {
      const Vec3 at(-165 + 27 * (k % 2), 52 + 27 * (k / 2), 0);
      b.begin("tanks", "white", kWhite);
      b.turned(at, {{0, -0.3}, {10.5, -0.3}, {10.5, 11}, {7, 12.4}, {0, 13}}, 24);
      b.begin("tanks", "steel", kSteel);
      for (int step = 0; step < 12; ++step) {  // stairs around it
        const double a = 0.2 + 0.1 * step + k, z = 0.6 + 0.9 * step;
        const Vec3 out(std::cos(a), std::sin(a), 0), along(-out.y, out.x, 0);
        b.beam(at + 10.4 * out + z * kUp, at + 11.6 * out + z * kUp, 1.1, 0.12, along);
      }
    }
    b.begin("tanks", "concrete", kConcrete);  // the wall of their basin
    const std::array<Vec2, 4> corner = {Vec2(-182, 35), Vec2(-121, 35), Vec2(-121, 96),
                                        Vec2(-182, 96)};
    const Vec2 middle(-151.5, 65.5);
    std::vector<std::vector<Vec3>> rings;
    for (const Vec2& c : corner) {
      const Vec2 in = middle + (c - middle) * 0.985;
      rings.push_back({Vec3(in, -0.4), Vec3(c, -0.4), Vec3(c, 1.6), Vec3(in, 1.6)});
    }
    b.closed_loft(rings);
  }

  void gas_holder() {
    const Vec3 at(-92, 66, 0);
    b.begin("gas_holder", "white", kWhite);
    std::vector<Vec2> outline;
    for (int k = 0; k <= 10; ++k) {
      const double a = kPi * (k / 10.0 - 0.5);
      outline.emplace_back(k == 0 || k == 10 ? 0 : 9 * std::cos(a), 13 + 9 * std::sin(a));
    }
    b.turned(at, outline, 20);
    b.begin("gas_holder", "steel", kSteel);
    for (int k = 0; k < 10; ++k) {
      const double a = kPi * k / 5, next = kPi * (k + 1) / 5;
      const Vec3 p = at + 8.7 * Vec3(std::cos(a), std::sin(a), 0);
      const Vec3 q = at + 8.7 * Vec3(std::cos(next), std::sin(next), 0);
      b.bar(p - 0.4 * kUp, p + 13.0 * kUp, 0.35, 6);
      b.bar(p + 1.0 * kUp, q + 9.5 * kUp, 0.12, 3);
      b.bar(q + 1.0 * kUp, p + 9.5 * kUp, 0.12, 3);
    }
  }

  void chimney(const Vec2& at, double height, double radius) {
    const Vec3 foot(at, 0);
    b.begin("chimneys", "brick", kBrick);
    const double top = 0.6 * radius;
    b.turned(foot,
             {{radius - 0.6, -0.5},
              {radius, -0.5},
              {0.5 * (radius + top) + 0.05, height / 2},
              {top, height},
              {top - 0.5, height}},
             16);
    b.begin("chimneys", "red", kRed);
    for (int k = 0; k < 2; ++k) {  // marks for pilots
      const double z = height * (0.97 - 0.09 * k), w = 0.03 * height;
      const auto r = [&](double h) { return radius + (top - radius) * h / height + 0.08; };
      b.turned(foot, {{r(z) - 0.35, z - w}, {r(z - w), z - w}, {r(z), z}, {r(z) - 0.35, z}}, 16);
    }
    b.begin("chimneys", "steel", kSteel);
    b.bar(foot + Vec3(radius + 0.3, 0, 0), foot + Vec3(top + 0.4, 0, height + 1), 0.1, 4);
    b.bar(foot + Vec3(radius + 0.3, 0.6, 0), foot + Vec3(top + 0.4, 0.6, height + 1), 0.1, 4);
  }

  void cooling_tower() {
    const Vec3 at(138, 92, 0);
    constexpr int kAround = 28, kLevels = 7;
    constexpr double kHeight = 52, kLift = 4;
    const auto radius = [](double z) {  // a hyperbola, narrowest at three quarters
      const double t = (z - 0.75 * kHeight) / (0.75 * kHeight);
      return 13.5 * std::sqrt(1 + 1.25 * t * t);
    };
    b.begin("cooling_tower", "concrete", kConcrete);
    std::vector<Vec2> outline;
    for (int k = 0; k <= kLevels; ++k) {
      const double z = kLift + (kHeight - kLift) * k / kLevels;
      outline.emplace_back(radius(z), z);
    }
    for (int k = kLevels; k >= 0; --k) {
      const double z = kLift + (kHeight - kLift) * k / kLevels;
      outline.emplace_back(radius(z) - 0.5, z);
    }
    b.turned(at, outline, kAround);
    for (int k = 0; k < kAround / 2; ++k) {  // slanting props
      const double a = 4 * kPi * k / kAround, turn = kPi / kAround * 2;
      const auto p = [&](double angle, double r, double z) {
        return at + Vec3(r * std::cos(angle), r * std::sin(angle), z);
      };
      const double low = radius(0) + 0.3, high = radius(kLift) - 0.25;
      b.bar(p(a, low, -0.4), p(a + turn, high, kLift + 0.5), 0.3, 4);
      b.bar(p(a + 0.02, low, -0.4), p(a - turn, high, kLift + 0.5), 0.3, 4);
    }
    b.turned(at,
             {{radius(0) + 1.5, -0.4},
              {radius(0) + 2.0, -0.4},
              {radius(0) + 2.0, 1.2},
              {radius(0) + 1.5, 1.2}},
             kAround);
  }

  // Pipes on portals from a to b, level.
  void pipe_bridge(const Vec2& from, const Vec2& to, double height, int spans) {
    const Vec3 a(from, height), e(to, height);
    const Vec3 along = glm::normalize(e - a), across(-along.y, along.x, 0);
    b.begin("pipe_bridges", "steel", kSteel);
    for (int k = 0; k <= spans; ++k) {
      const Vec3 p = a + (e - a) * (0.02 + 0.96 * k / spans);
      for (const double s : {-1.0, 1.0}) {
        const Vec3 foot = p + s * 2.2 * across;
        b.beam(Vec3(foot.x, foot.y, -0.4), foot + 1.2 * kUp, 0.4, 0.4, along);
      }
      b.beam(p - 2.8 * across - 0.3 * kUp, p + 2.8 * across - 0.3 * kUp, 0.35, 0.5, along);
      b.beam(p - 2.8 * across + 0.9 * kUp, p + 2.8 * across + 0.9 * kUp, 0.3, 0.4, along);
    }
    for (const double s : {-2.5, 2.5})
      b.beam(a + s * across - 0.8 * kUp, e + s * across - 0.8 * kUp, 0.25, 0.5, across);
    struct Pipe {
      double across, above, radius;
    };
    for (const Pipe& p : {Pipe{-1.6, 0.32, 0.35},
                          {-0.7, 0.27, 0.3},
                          {0.3, 0.42, 0.45},
                          {1.4, 0.22, 0.25},
                          {-0.9, 1.55, 0.4},
                          {0.6, 1.6, 0.45}}) {
      b.begin("pipe_bridges", p.above > 1 ? "yellow" : "metal", p.above > 1 ? kYellow : kMetal);
      const Vec3 shift = p.across * across + p.above * kUp;
      b.bar(a + shift - along, e + shift + along, p.radius, 8);
    }
  }

  // A closed gallery that climbs on trestles.
  void conveyor() {
    const Vec3 low(-20, 103, 6), high(40.5, 74, 33.5);
    const Vec3 along = glm::normalize(high - low);
    const Vec3 across = glm::normalize(glm::cross(kUp, along));
    b.begin("conveyor", "blue", kBlue);
    b.beam(low, high, 3.0, 2.8, across);
    b.box({38.5, 58, 29}, {46, 79, 38.5});  // where it hands over
    b.box({-28, 97, -0.4}, {-17, 109, 9.5});
    b.begin("conveyor", "steel", kSteel);
    for (int k = 1; k < 5; ++k) {
      const Vec3 top = low + (high - low) * (0.05 + k * 0.2) - 1.3 * kUp;
      for (const double s : {-1.0, 1.0}) {
        const Vec3 head = top + s * 1.3 * across,
                   foot(head.x + s * 1.8 * across.x, head.y + s * 1.8 * across.y, -0.4);
        b.beam(foot, head, 0.4, 0.4, across);
      }
      const int fields = std::max(1, static_cast<int>(top.z / 6));
      const auto at = [&](double s, double part) {
        const double spread = 1.3 + 1.8 * (1 - part);
        const Vec3 p = top + s * spread * across;
        return Vec3(p.x, p.y, top.z * part);
      };
      for (int f = 0; f < fields; ++f) {
        const double from = double(f) / fields + 0.02, to = (f + 1.0) / fields - 0.02;
        b.bar(at(-1, from), at(1, to), 0.14, 3);
        b.bar(at(1, from), at(-1, to), 0.14, 3);
      }
    }
  }

  void buildings() {
    for (int k = 0; k < 6; ++k) {
      const double x = -176 + 17.5 * k, y = -18, w = 12.5, d = 20, eaves = 4.5 + 0.3 * (k % 3);
      b.begin("sheds", k % 2 == 0 ? "metal" : "red", k % 2 == 0 ? kMetal : kRed);
      b.concave_prism({{x, y, -0.3},
                       {x + w, y, -0.3},
                       {x + w, y, eaves},
                       {x + w / 2, y, eaves + 2.6},
                       {x, y, eaves}},
                      {0, d, 0}, 1);
      b.begin("sheds", "gates", kSteel);
      b.box({x + 3.5, y - 0.2, -0.2}, {x + 9, y + 0.3, 3.8});
      b.box({x + 0.8, y - 0.15, 1.2}, {x + 2.4, y + 0.2, 2.6});
      b.box({x + 10.1, y - 0.15, 1.2}, {x + 11.7, y + 0.2, 2.6});
    }
    b.begin("pump_houses", "brick", kBrick);  // where the pipes go
    for (const double x : {-127.0, 116.0}) b.box({x, 17, -0.4}, {x + 11, 31, 12.5});
    b.begin("office", "white", kWhite);
    b.box({120, -80, -0.4}, {165, -66, 14});
    b.box({130, -70, 13.5}, {140, -67, 17});
    for (int floor = 0; floor < 4; ++floor) {
      b.begin("office", "glazing", kGlazing);
      for (int i = 0; i < 4; ++i) {
        const double x = 121.4 + 10.8 * i, z = 1.2 + 3.3 * floor;
        b.box({x, -80.15, z}, {x + 9.4, -79.7, z + 1.8});
        b.box({x, -66.3, z}, {x + 9.4, -65.85, z + 1.8});
      }
    }
  }

  void yard() {
    for (int k = 0; k < 14; ++k) {  // containers
      const double x = 45 + 7.2 * (k % 7), y = 6 + 3.4 * (k % 2);
      const double z = k < 7 ? 0.05 : 2.75;
      const bool blue = k % 3 == 0;
      b.begin("containers", blue ? "blue" : "red", blue ? kBlue : kRed);
      if (k >= 7 && k % 4 == 0) continue;
      b.box({x, y, z}, {x + 6.1, y + 2.44, z + 2.6});
    }
    for (int k = 0; k < 7; ++k) {  // wagons on the siding south of the halls
      const double x = -150 + 16.5 * k, y = -128;
      b.begin("wagons", k % 2 == 0 ? "blue" : "metal", k % 2 == 0 ? kBlue : kMetal);
      b.bar({x + 0.5, y, 2.9}, {x + 14.5, y, 2.9}, 1.45, 12);
      b.begin("wagons", "steel", kSteel);
      b.box({x, y - 1.3, 0.95}, {x + 15, y + 1.3, 1.35});
      for (const double bogie : {1.5, 10.5})
        b.box({x + bogie, y - 0.95, 0.2}, {x + bogie + 3, y + 0.95, 1.0});
    }
    b.begin("rails", "steel", kSteel);
    for (const double s : {-0.72, 0.72})
      b.box({-195, -128 + s - 0.04, -0.2}, {195, -128 + s + 0.04, 0.16});
    for (int k = 0; k < 12; ++k) {  // lamps along the road between halls and sheds
      const double x = -180 + 32 * k;
      b.begin("lamps", "steel", kSteel);
      b.bar({x, -32, -0.4}, {x, -32, 11}, 0.14, 6);
      b.box({x - 0.2, -32.2, 10.8}, {x + 0.2, -29.8, 11.1});
    }
  }

  // Open: a sheet casts the same shadow as a thin board.
  void sheets() {
    b.begin("canopies", "metal", kMetal);
    for (int k = 0; k < 6; ++k) {
      const double x = 121.5 + 7.3 * k;
      b.sheet({x, -83, 3.6}, {x + 5, -83, 3.6}, {x + 5, -79.9, 4.0}, {x, -79.9, 4.0});
    }
    b.begin("lamps", "steel", kSteel);  // two posts carry the sign
    for (const double x : {-58.0, -46.0}) b.box({x, -137.8, -0.4}, {x + 0.4, -137.4, 7});
    b.begin("signs", "yellow", kYellow);
    b.sheet({-60, -138, 2.5}, {-44, -138, 2.5}, {-44, -138, 7.5}, {-60, -138, 7.5});
    b.plate({-43.5, -138, 2.5}, {-38, -138, 5}, {-43.5, -138, 7.5});  // an arrow to the gate
  }

  // Crates on the yard, as many as are missing; then signs, for what is less than a crate.
  void stock() {
    const std::size_t missing =
        kIndustryArea.casting - std::min(b.casting(), kIndustryArea.casting);
    constexpr std::size_t kBox = 12;
    const std::size_t crates = missing / kBox, rest = missing % kBox;
    b.begin("stock", "wood", kWood);
    for (std::size_t k = 0; k < crates; ++k) {
      const double x = -58 + 3.2 * double(k % 15), y = -6 + 3.4 * double(k / 15);
      const double high = 1.2 + 0.35 * double((k * 7) % 5);
      b.box({x, y, 0.1}, {x + 2.4, y + 2.2, high});
    }
    b.begin("signs", "yellow", kYellow);
    for (std::size_t k = 0; k + 1 < rest; k += 2) {
      const double x = -30 + 6.0 * double(k);
      b.sheet({x, -138, -0.2}, {x + 4, -138, -0.2}, {x + 4, -138, 2.5}, {x, -138, 2.5});
    }
  }
};

}  // namespace

Scene industry_area() {
  Area a;
  a.ground();
  a.hall(1, {-180, -112}, 105, 7, 10, 9, 5);
  a.hall(2, {-62, -112}, 75, 6, 10, 8, 4.5);
  a.hall(3, {30, -112}, 75, 5, 12, 10, 5.5);
  a.silos();
  a.tanks();
  a.gas_holder();
  a.chimney({-30, 60}, 88, 4.2);
  a.chimney({-8, 52}, 70, 3.4);
  a.cooling_tower();
  a.pipe_bridge({-118, 24}, {118, 24}, 8, 11);
  a.pipe_bridge({-60, 28.5}, {-60, 62}, 8.8, 2);
  a.pipe_bridge({98, 30}, {98, 92}, 8.8, 3);
  a.conveyor();
  a.buildings();
  a.yard();
  a.sheets();
  a.stock();
  return a.b.finished(45.2, 9.2);
}

}  // namespace gnomon::scenes
