#include <gnomon/trace/verification_cases.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include <gnomon/core/place.h>
#include <gnomon/trace/oracle_predicates.h>

namespace gnomon {
namespace {

// Views and lights are laid out in widths of the model, and one vertical line has none: it is given
// a thousandth of its height, thin beside it and far above the rounding of its coordinates.
constexpr double kWidthOfLine = 1e-3;

struct ModelBox {
  Vec3 lo{0.0}, hi{0.0};
  Vec3 centre() const { return (lo + hi) * 0.5; }
  // The larger side on the ground; of a model that is nothing but one vertical line, a little
  // still.
  double width() const {
    return std::max({hi.x - lo.x, hi.y - lo.y, kWidthOfLine * (hi.z - lo.z)});
  }
};

// The box of what casts and is not ground, so that views and lights stand near the model and not
// near the rim of its surroundings.
ModelBox model_box(const Scene& scene) {
  ModelBox box;
  for (const bool ground_too : {false, true}) {
    bool any = false;
    for (std::uint32_t t = 0; t < scene.mesh.triangles.size(); ++t) {
      if (!ground_too &&
          (!casts(scene, t) || scene.surfaces[scene.surface_of[t]].semantic == "Ground"))
        continue;
      for (const Vec3& p : oracle::points_of(scene.mesh, t)) {
        box.lo = any ? glm::min(box.lo, p) : p;
        box.hi = any ? glm::max(box.hi, p) : p;
        any = true;
      }
    }
    if (any) break;
  }
  return box;
}

Light sun(double azimuth_degrees, double altitude_degrees) {
  const double a = azimuth_degrees * kDegree, h = altitude_degrees * kDegree;
  return snapped(Light(std::cos(h) * std::sin(a), std::cos(h) * std::cos(a), std::sin(h), 0));
}

std::string sun_name(double azimuth, double altitude) {
  return "sun " + std::to_string(static_cast<int>(altitude)) + " high from " +
         std::to_string(static_cast<int>(azimuth));
}

// A sun exactly in the plane of some triangle: along an edge that rises, is not vertical, and whose
// difference is exact in double.
std::optional<Light> sun_in_a_plane(const Scene& scene) {
  constexpr double kLevel = 0.05;  // sine of the lowest altitude that is taken
  const std::size_t n = scene.mesh.triangles.size();
  for (std::size_t k = 0; k < n; ++k) {
    const oracle::Points t =
        oracle::points_of(scene.mesh, static_cast<std::uint32_t>((k + n / 2) % n));
    for (std::size_t c = 0; c < 3; ++c) {
      Vec3 d = t[(c + 1) % 3] - t[c];
      if (d.z < 0) d = -d;
      if (d.z < kLevel * glm::length(d) || (d.x == 0 && d.y == 0)) continue;
      ExactStats stats;
      const Light light = snapped(direction(d));
      oracle::light_side_of(t, light, stats);
      if (stats.ties > 0) return light;
    }
  }
  return {};
}

// Vertices of the upper half of the model, from the middle outwards.
std::vector<Vec3> upper_vertices(const Scene& scene, const ModelBox& box) {
  std::vector<Vec3> vertices;
  const Vec3 c = box.centre();
  for (const Vec3& p : scene.mesh.positions) {
    if (p.z > c.z && p.x >= box.lo.x && p.x <= box.hi.x && p.y >= box.lo.y && p.y <= box.hi.y)
      vertices.push_back(p);
  }
  const auto distance = [&](const Vec3& p) {
    return (p.x - c.x) * (p.x - c.x) + (p.y - c.y) * (p.y - c.y);
  };
  std::stable_sort(vertices.begin(), vertices.end(),
                   [&](const Vec3& a, const Vec3& b) { return distance(a) < distance(b); });
  if (vertices.empty() && !scene.mesh.positions.empty())
    vertices.push_back(scene.mesh.positions[0]);
  return vertices;
}

// Where the pixel's ray meets the triangle, in floating point.
Vec3 sample_point(const Scene& scene, const View& view, int column, int row, std::uint32_t t) {
  const oracle::Points r = oracle::points_of(scene.mesh, t);
  const Vec3 n = glm::cross(r[1] - r[0], r[2] - r[0]), q(pixel_point(view, column, row)),
             e(view.eye);
  return is_parallel(view) ? q - e * (glm::dot(n, q - r[0]) / glm::dot(n, e))
                           : e + q * (glm::dot(n, r[0] - e) / glm::dot(n, q));
}

struct Spot {
  double distance;  // from the middle, squared
  Vec3 at;
};

// The samples of a coarse plan that `chosen` takes, from the middle outwards.
template <class Chosen>
std::vector<Spot> spots(const Oracle& oracle, const Chosen& chosen) {
  constexpr int kCoarse = 48;
  const Scene& scene = *oracle.scene;
  const ModelBox box = model_box(scene);
  const Vec3 c = box.centre();
  Receivers r;
  r.view = whole_plan(scene, kCoarse).view;
  r.triangle = exact_receivers(oracle, r.view);
  std::vector<Spot> found;
  const std::vector<std::int32_t> counts = chosen.light
                                               ? exact_counts(oracle, r, *chosen.light)
                                               : std::vector<std::int32_t>(r.triangle.size(), 1);
  for (int row = 0; row < kCoarse; ++row) {
    for (int column = 0; column < kCoarse; ++column) {
      const auto k = static_cast<std::size_t>(row * kCoarse + column);
      if (r.triangle[k] == kNoTriangle || counts[k] == 0) continue;
      const Vec3 p = sample_point(scene, r.view, column, row, r.triangle[k]);
      if (p.z > box.lo.z + chosen.lowest_part * (box.hi.z - box.lo.z)) continue;
      found.push_back({(p.x - c.x) * (p.x - c.x) + (p.y - c.y) * (p.y - c.y), p});
    }
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Spot& a, const Spot& b) { return a.distance < b.distance; });
  return found;
}

struct Low {
  const Light* light;
  double lowest_part;  // of the model's height
};

}  // namespace

std::vector<NamedLight> choose_suns(const Scene& scene, int count) {
  std::vector<NamedLight> suns;
  const auto add = [&](double azimuth, double altitude) {
    suns.push_back({sun_name(azimuth, altitude), sun(azimuth, altitude)});
  };
  add(107, 3);
  suns.push_back({"vertical sun", Light(0, 0, 1, 0)});
  add(193, 45);
  suns.push_back({"sun along x at 45", Light(1, 0, 1, 0)});
  if (const std::optional<Light> flat = sun_in_a_plane(scene)) {
    suns.push_back({"sun in a triangle's plane", *flat});
  } else {
    suns.push_back({"sun along y at 45", Light(0, 1, 1, 0)});
  }
  add(251, 10);
  add(31, 70);
  add(319, 25);
  // Irrational steps that never repeat a place.
  constexpr double kGoldenAngle = 137.50776405003785;  // degrees
  constexpr double kSilverRatio = 0.41421356237309515;
  for (int k = 8; k < count; ++k) {
    add(std::fmod(k * kGoldenAngle, 360.0), 1 + 88 * std::fmod(k * kSilverRatio, 1.0));
  }
  suns.resize(
      static_cast<std::size_t>(std::max(0, std::min(count, static_cast<int>(suns.size())))));
  return suns;
}

std::vector<NamedLight> choose_points(const Oracle& oracle, int count) {
  const Scene& scene = *oracle.scene;
  const ModelBox box = model_box(scene);
  const double height = box.hi.z - box.lo.z;
  const auto place = [&](double x, double y, double z) {  // in parts of the box
    return Vec3(box.lo.x + x * (box.hi.x - box.lo.x), box.lo.y + y * (box.hi.y - box.lo.y),
                box.lo.z + z * height);
  };
  std::vector<NamedLight> lights;
  const auto add = [&](const char* name, const Vec3& p) {
    lights.push_back({name, snapped(point(p))});
  };
  add("point above",
      Vec3(box.centre().x, box.centre().y, box.hi.z + 0.5 * std::max(height, 0.2 * box.width())));
  const std::vector<Spot> low = spots(oracle, Low{nullptr, 0.3});
  add("point between",
      low.empty() ? place(0.37, 0.41, 0.1) : low.front().at + Vec3(0, 0, 0.15 * height));
  add("point within", place(0.61, 0.43, 0.55));
  for (const Vec3& v : upper_vertices(scene, box)) {
    if (static_cast<int>(lights.size()) >= std::max(count, 4)) break;
    add("point at a vertex", v);
  }
  lights.resize(
      static_cast<std::size_t>(std::max(0, std::min(count, static_cast<int>(lights.size())))));
  return lights;
}

NamedView whole_plan(const Scene& scene, int size) {
  const ModelBox box = model_box(scene);
  const Vec3 c = box.centre();
  // A twentieth more on each side than the model, for the shadows beside it.
  const double half = 0.55 * box.width();
  View v = plan_view({c.x - half, c.y - half, c.x + half, c.y + half}, 2 * half / size, c.z);
  v.width = v.height = size;
  return {"plan", v};
}

NamedView aerial_camera(const Scene& scene, int size) {
  const ModelBox box = model_box(scene);
  const Vec3 c = box.centre();
  const double d = std::max(box.width(), box.hi.z - box.lo.z);
  const Vec3 eye = c + Vec3(-0.7, -0.9, 0.75) * d;
  return {"camera outside", perspective_view(eye, c, Vec3(0, 0, 1), 50 * kDegree, size, size)};
}

std::int32_t casters_before_eye(const Oracle& oracle, const View& view, const Light& light,
                                ExactStats* stats) {
  ExactStats own;
  ExactStats& s = stats ? *stats : own;
  const Light from = snapped(light);
  std::int32_t n = 0;
  for (const std::uint32_t t : oracle.casters.triangles) {
    n += oracle::before_eye(view, oracle::points_of(oracle.scene->mesh, t), from, s) ? 1 : 0;
  }
  return n;
}

std::optional<NamedView> shaded_camera(const Oracle& oracle, const Light& light, int size) {
  const ModelBox box = model_box(*oracle.scene);
  const double height = box.hi.z - box.lo.z;
  constexpr std::size_t kTries = 40;
  const std::vector<Spot> dark = spots(oracle, Low{&light, 0.5});
  for (std::size_t k = 0; k < std::min(kTries, dark.size()); ++k) {
    for (const double part : {0.1, 0.02, 0.002}) {
      const Vec3 eye = dark[k].at + Vec3(0, 0, part * height);
      Vec3 target = box.centre();
      target.z = eye.z + 0.05 * height;
      if (std::hypot(target.x - eye.x, target.y - eye.y) < 0.01 * box.width())
        target.x += 0.1 * box.width();
      const View view = perspective_view(eye, target, Vec3(0, 0, 1), 75 * kDegree, size, size);
      if (casters_before_eye(oracle, view, light) > 0) return NamedView{"camera in shadow", view};
    }
  }
  return {};
}

}  // namespace gnomon
