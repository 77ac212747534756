#include <scenes/paper_scenes.h>

#include <cmath>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>

#include <gnomon/mesh/weld.h>
#include <scenes/generated_sphere.h>
#include <scenes/random.h>

namespace gnomon::scenes {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kFloorHalf = 30;  // metres
constexpr double kPitch = 3;       // from one body to the next
constexpr int kAcross = 8;         // and as many deep

// Whole multiples of 2^-10 m: floats hold them exactly, so that faces that are level, upright or
// parallelograms stay plane.
double snapped(double x) { return std::round(x * 1024) / 1024; }
Vec3 snapped(const Vec3& p) { return {snapped(p.x), snapped(p.y), snapped(p.z)}; }

struct Builder {
  Scene scene;
  std::uint32_t surface = 0;

  void begin(const std::string& name, bool casts = true) {
    surface = static_cast<std::uint32_t>(scene.surfaces.size());
    Surface s;
    s.object = s.group = name;
    s.casts = casts;
    scene.surfaces.push_back(std::move(s));
  }
  std::uint32_t vertex(const Vec3& p) {
    scene.mesh.positions.push_back(p);
    return static_cast<std::uint32_t>(scene.mesh.positions.size() - 1);
  }
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    scene.mesh.triangles.push_back({a, b, c});
    scene.surface_of.push_back(surface);
  }
  void quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    triangle(a, b, c);
    triangle(a, c, d);
  }
  // Corners counterclockwise as seen from where it is visible.
  void rectangle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const std::uint32_t k = vertex(a);
    vertex(b);
    vertex(c);
    vertex(d);
    quad(k, k + 1, k + 2, k + 3);
  }
  // Precondition: w is on the side of cross(u, v).
  void parallelepiped(const Vec3& at, const Vec3& u, const Vec3& v, const Vec3& w) {
    const std::uint32_t k = vertex(at);
    for (const Vec3& p : {u, u + v, v, w, u + w, u + v + w, v + w}) vertex(at + p);
    quad(k + 3, k + 2, k + 1, k);
    quad(k + 4, k + 5, k + 6, k + 7);
    quad(k, k + 1, k + 5, k + 4);
    quad(k + 1, k + 2, k + 6, k + 5);
    quad(k + 2, k + 3, k + 7, k + 6);
    quad(k + 3, k, k + 4, k + 7);
  }
  // Turned about the vertical through `at`. The outline, (radius, height), runs from the bottom
  // outwards and up; it begins and ends on the axis, or is closed (a ring).
  void turned(const Vec3& at, const std::vector<Vec2>& outline, int around, bool ring = false) {
    const auto n = static_cast<std::uint32_t>(outline.size());
    const auto segments = static_cast<std::uint32_t>(around);
    std::vector<std::vector<std::uint32_t>> id(n);
    for (std::uint32_t i = 0; i < n; ++i) {
      const bool pole = outline[i].x == 0;
      for (std::uint32_t k = 0; k < (pole ? 1 : segments); ++k) {
        const double angle = kTurn * k / around;
        id[i].push_back(vertex(at + snapped(Vec3(outline[i].x * std::cos(angle),
                                                 outline[i].x * std::sin(angle), outline[i].y))));
      }
    }
    const auto of = [&](std::uint32_t i, std::uint32_t k) {
      return id[i].size() == 1 ? id[i][0] : id[i][k % segments];
    };
    for (std::uint32_t i = 0; i + (ring ? 0 : 1) < n; ++i) {
      const std::uint32_t j = (i + 1) % n;
      for (std::uint32_t k = 0; k < segments; ++k) {
        if (id[i].size() > 1) triangle(of(i, k), of(i, k + 1), of(j, k));
        if (id[j].size() > 1) triangle(of(i, k + 1), of(j, k + 1), of(j, k));
      }
    }
  }
  // A prism over a counterclockwise outline in the plane of u and v that `centre` sees all of.
  // Precondition: w is on the side of cross(u, v).
  void prism(const Vec3& at, const std::vector<Vec2>& outline, const Vec2& centre, const Vec3& u,
             const Vec3& v, const Vec3& w) {
    const auto n = static_cast<std::uint32_t>(outline.size());
    // Products of few bits are exact: the ends are plane, and lit or dark as a whole.
    const auto few_bits = [](double x) { return std::round(x * 64) / 64; };
    const auto few = [&](const Vec3& p) {
      return Vec3(few_bits(p.x), few_bits(p.y), few_bits(p.z));
    };
    const auto place = [&](const Vec2& p) {
      return at + few(u) * few_bits(p.x) + few(v) * few_bits(p.y);
    };
    const std::uint32_t low = vertex(place(centre)), high = vertex(place(centre) + w);
    const std::uint32_t k = high + 1;
    for (const Vec2& p : outline) {
      vertex(place(p));
      vertex(place(p) + w);
    }
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t j = (i + 1) % n;
      triangle(low, k + 2 * j, k + 2 * i);
      triangle(high, k + 2 * i + 1, k + 2 * j + 1);
      quad(k + 2 * i, k + 2 * j, k + 2 * j + 1, k + 2 * i + 1);
    }
  }
  void add(const Scene& other) {
    const auto k = static_cast<std::uint32_t>(scene.mesh.positions.size());
    for (const Vec3& p : other.mesh.positions) vertex(p);
    for (const Triangle& t : other.mesh.triangles) triangle(t[0] + k, t[1] + k, t[2] + k);
  }
  void floor() {
    begin("floor", false);
    rectangle({-kFloorHalf, -kFloorHalf, 0}, {kFloorHalf, -kFloorHalf, 0},
              {kFloorHalf, kFloorHalf, 0}, {-kFloorHalf, kFloorHalf, 0});
  }
  Scene finished() {
    weld(scene.mesh, scene.surface_of);
    return std::move(scene);
  }
};

std::vector<Vec2> circle(const Vec2& middle, double radius, int n) {
  std::vector<Vec2> out;
  for (int i = 0; i < n; ++i) {
    const double a = kTurn * i / n;
    out.push_back(middle + radius * Vec2(std::cos(a), std::sin(a)));
  }
  return out;
}

// Where body k of the grid stands, and at half of the places how high above the floor.
Vec3 place_of(int k, Random& random) {
  const double x = (k % kAcross - (kAcross - 1) / 2.0) * kPitch + random.between(-0.8, 0.8);
  const double y = (k / kAcross - (kAcross - 1) / 2.0) * kPitch + random.between(-0.8, 0.8);
  const double z = random.between(0.5, 5);
  return snapped(Vec3(x, y, random.between(0, 1) < 0.5 ? 0.0 : z));
}

PaperScene with_the_papers_camera(std::string name, std::string what, Scene scene) {
  return {std::move(name), std::move(what), std::move(scene), {1, -16, 4}, {0, -1, 1.5}, 0.75};
}

}  // namespace

View view_of(const PaperScene& s, int width, int height) {
  return perspective_view(s.eye, s.target, {0, 0, 1}, s.fov, width, height);
}

PaperScene convex_bodies() {
  Builder b;
  b.floor();
  Random random{2002};
  for (int k = 0; k < kAcross * kAcross; ++k) {
    const Vec3 at = place_of(k, random);
    const double size = random.between(0.6, 1.1), height = random.between(1.2, 2.8);
    switch ((k + k / kAcross) % 4) {
      case 0:
        b.begin("cylinder_" + std::to_string(k));
        b.turned(at, {{0, 0}, {size, 0}, {size, height}, {0, height}}, 32);
        break;
      case 1: {
        b.begin("plate_" + std::to_string(k));
        const double turn = random.between(0, kTurn), tilt = random.between(0.2, 1.2);
        const Vec3 u = Vec3(std::cos(turn), std::sin(turn), 0);
        const Vec3 v =
            Vec3(-std::sin(turn) * std::cos(tilt), std::cos(turn) * std::cos(tilt), std::sin(tilt));
        b.parallelepiped(at + Vec3(0, 0, 0.5), snapped(u * size * 1.6), snapped(v * size * 2.2),
                         snapped(glm::cross(u, v) * 0.12));
        break;
      }
      case 2:
        b.begin("sphere_" + std::to_string(k));
        b.add(generated_sphere(2, size, at + Vec3(0, 0, 1.2)));
        break;
      default:
        b.begin("cone_" + std::to_string(k));
        b.turned(at, {{0, 0}, {size, 0}, {0, height}}, 32);
    }
  }
  return with_the_papers_camera("convex", "64 small convex bodies over a floor", b.finished());
}

PaperScene concave_bodies() {
  Builder b;
  b.floor();
  Random random{2003};
  for (int k = 0; k < kAcross * kAcross; ++k) {
    const Vec3 at = place_of(k, random);
    const double size = random.between(0.8, 1.2), turn = random.between(0, kTurn);
    const Vec3 u(std::cos(turn), std::sin(turn), 0), v(-u.y, u.x, 0), up(0, 0, 1);
    switch ((k + k / kAcross) % 4) {
      case 0:
        b.begin("ring_" + std::to_string(k));
        b.turned(at, circle({size, 0.6}, 0.3, 8), 24, true);
        break;
      case 1: {  // standing: its axis is level
        b.begin("gear_" + std::to_string(k));
        std::vector<Vec2> outline;
        for (int i = 0; i < 32; ++i) {
          const double a = kTurn * (i + 0.5) / 32, r = size * (i % 4 < 2 ? 1.2 : 0.85);
          outline.emplace_back(r * std::cos(a), 1.5 + r * std::sin(a));
        }
        b.prism(at, outline, {0, 1.5}, u, up, snapped(-0.5 * v));
        break;
      }
      case 2: {
        b.begin("stairs_" + std::to_string(k));
        constexpr int kSteps = 8;
        std::vector<Vec2> outline{{0, 0}, {2.0, 0}};
        for (int i = kSteps; i > 0; --i) {
          outline.emplace_back(2.0 * i / kSteps, size * 1.8 * i / kSteps);
          outline.emplace_back(2.0 * (i - 1) / kSteps, size * 1.8 * i / kSteps);
        }
        b.prism(at, outline, {1.9375, 0.0625}, u, up, snapped(-1.5 * v));
        break;
      }
      default: {
        b.begin("house_" + std::to_string(k));
        const std::vector<Vec2> outline{{0, 0}, {2, 0}, {2, 0.8}, {0.8, 0.8}, {0.8, 2}, {0, 2}};
        b.prism(at, outline, {0.5, 0.5}, u * size, v * size, {0, 0, 2});
      }
    }
  }
  return with_the_papers_camera("concave", "64 rings, gears, stairs and L-shaped houses",
                                b.finished());
}

PaperScene figures_in_a_room() {
  Builder b;
  b.begin("floor", false);
  b.rectangle({-8, -8, 0}, {8, -8, 0}, {8, 8, 0}, {-8, 8, 0});
  b.begin("walls", false);
  b.rectangle({-8, 8, 0}, {8, 8, 0}, {8, 8, 5}, {-8, 8, 5});
  b.rectangle({-8, -8, 0}, {-8, 8, 0}, {-8, 8, 5}, {-8, -8, 5});
  const std::vector<Vec2> outline{{0, 0},      {0.45, 0},   {0.5, 0.1},  {0.3, 0.25}, {0.22, 0.7},
                                  {0.28, 1.1}, {0.42, 1.3}, {0.4, 1.42}, {0.12, 1.5}, {0.14, 1.55},
                                  {0.25, 1.7}, {0.22, 1.9}, {0, 2}};
  Random random{2004};
  for (int k = 0; k < 6; ++k) {
    // In this order: compilers differ in which of two arguments they evaluate first.
    const double y = (k / 3) * 3 - 1 + random.between(-0.5, 0.5);
    const double x = (k % 3 - 1) * 3 + random.between(-0.5, 0.5);
    const Vec3 at = snapped(Vec3(x, y, 0));
    b.begin("figure_" + std::to_string(k));
    b.turned(at, outline, 20);
    const double turn = random.between(0, kTurn);
    const Vec3 u(std::cos(turn), std::sin(turn), 0), v(-u.y, u.x, 0);
    for (const double side : {-1.0, 1.0}) {
      b.begin("arm_" + std::to_string(k) + (side < 0 ? "_left" : "_right"));
      // Held forward and a little up.
      b.prism(at + snapped(side * 0.5 * u + Vec3(0, 0, 1.3)), circle({0, 0}, 0.09, 10), {0, 0}, u,
              {0, 0, 1}, snapped(-0.8 * v + Vec3(0, 0, 0.2)));
    }
  }
  for (const double x : {-6.0, 0.0, 6.0}) {
    b.begin("pillar");
    b.parallelepiped({x - 0.4, 6.4, 0}, {0.8, 0, 0}, {0, 0.8, 0}, {0, 0, 5});
  }
  return {"figures", "six figures between pillars", b.finished(), {4, -9, 3.5}, {0, 1, 1}, 0.8};
}

Lamp lamp_on_its_round(double phase) {
  const double a = kTurn * phase;
  return {{14 * std::sin(a), -14 * std::cos(a), 5.25 + 3.25 * std::cos(a)}, {0.8, 0.8, 0.8}};
}

std::vector<Lamp> lamps_of_the_room(int count, double phase) {
  const auto round = [&](double at) {
    const double a = kTurn * (phase + at);
    return Vec3(4.5 * std::sin(a), 1 - 4.5 * std::cos(a), 3.5 + 0.5 * std::cos(2 * a));
  };
  if (count == 1) return {{round(0), {0.8, 0.8, 0.8}}};
  if (count == 3) {
    return {{round(0), {0.5, 0.1, 0.1}},
            {round(1.0 / 3), {0.1, 0.5, 0.1}},
            {round(2.0 / 3), {0.1, 0.1, 0.5}}};
  }
  std::vector<Lamp> out;
  for (const Vec3& p : generated_sphere(0, 0.25).mesh.positions)  // an icosahedron's 12 corners
    out.push_back({round(0) + p, Vec3(0.8 / count)});
  return out;
}

}  // namespace gnomon::scenes
