#include "view_options.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <vector>

#include <fmt/format.h>
#include <gnomon/core/exact.h>
#include <gnomon/io/ground.h>
#include <unistd.h>
#include <glm/geometric.hpp>

#include "commands.h"

namespace gnomon::app {
namespace {

// Pixel sizes that people like; the first that keeps the picture within kAutoPixels is taken.
constexpr std::array kPixelSizes = {0.05, 0.1, 0.2,  0.25, 0.5,  1.0,
                                    2.0,  5.0, 10.0, 20.0, 50.0, 100.0};
constexpr double kAutoPixels = 2000;  // on the longer side
constexpr double kBytesPerSample =
    64;  // of everything that a profile keeps per sample, at its peak
constexpr double kFarthestShadow = 30;  // heights of the model
// Around the default map, where the shadows of the study leave less on a side: a street's width.
constexpr double kLeastMargin = 20;  // metres
// Beyond the tips of shadows, in heights of the model: else they would touch the border of the map.
// The ground reaches 6 heights (load_scene.h), the longest shadow that is framed 5.7.
constexpr double kBeyondShadows = 0.1;
// A model so many times as wide as it is high is a part of a city: what stands around it is
// missing, and the shadows that fall there would be as well.
constexpr double kCityHeights = 8;
constexpr double kEyeAltitude = 42 * kDegree;  // of the automatic camera above the horizon
constexpr double kEyeBesideSun =
    35 * kDegree;  // and to the right of the sun, so that shadows are seen

std::vector<double> numbers(const std::string& text, std::size_t n, const char* option,
                            const char* form) {
  std::vector<double> out;
  const char* at = text.c_str();
  while (*at != 0) {
    char* end = nullptr;
    const double v = std::strtod(at, &end);
    if (end == at || !std::isfinite(v)) break;
    out.push_back(v);
    at = end;
    if (*at == ',') ++at;
  }
  if (*at != 0 || out.size() != n) {
    throw Failure(
        fmt::format("cannot read {} '{}': give it as {}, numbers in the model's coordinates",
                    option, text, form));
  }
  return out;
}

Vec3 parse_point(const std::string& text, const char* option, const Vec3& origin) {
  const std::vector<double> v = numbers(text, 3, option, "X,Y,Z");
  return Vec3(v[0], v[1], v[2]) - origin;
}

std::array<int, 2> parse_size(const std::string& text) {
  int w = 0, h = 0;
  char extra = 0;
  if (std::sscanf(text.c_str(), "%dx%d%c", &w, &h, &extra) == 2 && std::max(w, h) > 32767)
    throw Failure(fmt::format("--size '{}' is too large: at most 32767x32767 pixels", text));
  if (std::sscanf(text.c_str(), "%dx%d%c", &w, &h, &extra) != 2 || w < 1 || h < 1) {
    throw Failure(fmt::format(
        "cannot read --size '{}': give it as WIDTHxHEIGHT in pixels, such as 1600x1000", text));
  }
  return {w, h};
}

void check_memory(double width, double height, const char* advice) {
  const double memory =
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  const double needed = width * height * kBytesPerSample;
  if (needed > memory || width * height > 2e9) {
    throw Failure(
        fmt::format("a picture of {:.6g} x {:.6g} samples needs about {:.3g} GB of memory, this "
                    "machine has {:.1f} GB: {}",
                    width, height, needed / 1e9, memory / 1e9, advice));
  }
}

// A number that CLI11 lets through may still make no view: NaN, or rays that no exact arithmetic
// takes.
View checked(const View& v, const char* options) {
  for (const Vec4* a : {&v.eye, &v.origin, &v.right, &v.down}) {
    for (int k = 0; k < 4; ++k) {
      if (!(std::fabs((*a)[k]) <= kLargestCoordinate)) {
        throw Failure(
            fmt::format("{} give a view that cannot be computed: it reaches beyond {:g} m", options,
                        kLargestCoordinate));
      }
    }
  }
  if (v.right == Vec4(0.0) || v.down == Vec4(0.0)) {
    throw Failure(
        fmt::format("{} give a view that cannot be computed: its pixels have no size", options));
  }
  return v;
}

void check_positive(double value, const char* option) {
  if (std::isnan(value) || std::isinf(value) || value < 0) {
    throw Failure(fmt::format("{} must be a positive number", option));
  }
}

}  // namespace

void add_camera_options(CLI::App& command, ViewOptions& o) {
  const char* group = "View";
  command
      .add_option("--eye", o.eye,
                  "Camera: X,Y,Z in the model's coordinates, z up (default: chosen)")
      ->group(group);
  command
      .add_option("--target", o.target,
                  "Camera: X,Y,Z that it looks at (default: the model's middle)")
      ->group(group);
  command.add_option("--fov", o.fov_deg, "Camera: vertical field of view in degrees")
      ->check(CLI::Range(1.0, 170.0))
      ->capture_default_str()
      ->group(group);
  command.add_option("--ortho", o.ortho_height, "Camera: parallel view, METRES high at the target")
      ->check(positive_number())
      ->group(group);
  command.add_option("--size", o.size, "Camera: WIDTHxHEIGHT in pixels")
      ->capture_default_str()
      ->group(group);
}

void add_view_options(CLI::App& command, ViewOptions& o) {
  const char* group = "View";
  command.add_option("--view", o.kind, "plan (default) or camera")
      ->check(CLI::IsMember({"plan", "camera"}))
      ->group(group);
  command
      .add_option("--pixel", o.pixel,
                  "Plan: size of a sample in metres (default: the finest of 0.05, 0.1, 0.2, 0.25, "
                  "0.5, 1, ... that "
                  "gives at most 2000 across)")
      ->check(positive_number())
      ->group(group);
  command
      .add_option(
          "--bounds", o.bounds,
          "Plan: x0,y0,x1,y1 in the model's coordinates (default: the model and, of few buildings, "
          "the shadows of a sun at least 10 degrees high)")
      ->group(group);
  add_camera_options(command, o);
}

// Where the model brings its own terrain, or no ground is wanted, nothing lies beyond it.
bool has_made_ground(const Scene& scene) {
  return std::any_of(scene.surface_of.begin(), scene.surface_of.end(),
                     [&](std::uint32_t s) { return is_made_ground(scene.surfaces[s]); });
}

Box model_box(const Scene& scene) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  Box box{{kInf, kInf, kInf}, {-kInf, -kInf, -kInf}};
  for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    if (is_made_ground(scene.surfaces[scene.surface_of[t]])) continue;
    for (const std::uint32_t v : scene.mesh.triangles[t]) {
      const Vec3& p = scene.mesh.positions[v];
      for (int k = 0; k < 3; ++k) {
        box.lo[k] = std::min(box.lo[k], p[k]);
        box.hi[k] = std::max(box.hi[k], p[k]);
      }
    }
  }
  return box;
}

double light_azimuth(const Scene& scene, const Light& light) {
  if (light.w == 0) return std::atan2(light.x, light.y);
  const Box box = model_box(scene);
  const Vec3 middle = (box.lo + box.hi) * 0.5;
  return std::atan2(light.x - middle.x, light.y - middle.y);
}

std::string without_sample(const Scene& scene) {
  const bool all = std::all_of(scene.surfaces.begin(), scene.surfaces.end(),
                               [](const Surface& s) { return s.receives; });
  return all ? "no surface" : "not evaluated";
}

std::optional<Bounds2> parse_bounds(const std::string& text) {
  if (text.empty()) return {};
  const std::vector<double> v = numbers(text, 4, "--bounds", "x0,y0,x1,y1");
  if (!(v[0] < v[2] && v[1] < v[3])) {
    throw Failure(
        fmt::format("--bounds '{}' is empty: x0 must be less than x1 and y0 less than y1", text));
  }
  return Bounds2{v[0], v[1], v[2], v[3]};
}

bool wants_camera(const ViewOptions& o) {
  check_positive(o.pixel, "--pixel");
  check_positive(o.fov_deg, "--fov");
  check_positive(o.ortho_height, "--ortho");
  const bool camera_options = !o.eye.empty() || !o.target.empty() || o.ortho_height > 0;
  const bool plan_options = o.pixel > 0 || !o.bounds.empty();
  if (o.kind == "plan" && camera_options)
    throw Failure("--view plan takes no --eye, --target or --ortho");
  if (o.kind == "camera" && plan_options)
    throw Failure("--view camera takes no --pixel or --bounds");
  if (o.kind.empty() && camera_options && plan_options) {
    throw Failure(
        "--pixel and --bounds are for a plan, --eye, --target and --ortho for a camera: give one "
        "kind, or --view");
  }
  return o.kind == "camera" || camera_options;
}

namespace {

// The model and room for its shadows; of the model alone where there is no ground around it.
Bounds2 default_bounds(const Scene& scene, const Box& box,
                       const std::optional<ShadowReach>& reach) {
  if (!has_made_ground(scene)) return {box.lo.x, box.lo.y, box.hi.x, box.hi.y};
  const double side = std::max(box.hi.x - box.lo.x, box.hi.y - box.lo.y);
  const double height = box.hi.z - box.lo.z;
  // Three heights: the shadows of a sun 18 degrees high.
  const double usual = 3 * height;
  if (reach && side < kCityHeights * height) {
    const double least = std::min(kLeastMargin, usual);
    const auto margin = [&](double heights) {
      return std::max(least, (heights + kBeyondShadows) * height);
    };
    return {box.lo.x - margin(reach->west), box.lo.y - margin(reach->south),
            box.hi.x + margin(reach->east), box.hi.y + margin(reach->north)};
  }
  // Of a city no more than 50 m or a twentieth of it.
  const bool few_buildings = usual >= side;
  const double most = few_buildings ? usual : std::max(50.0, 0.05 * side);
  const double margin = std::min(usual, most);
  return {box.lo.x - margin, box.lo.y - margin, box.hi.x + margin, box.hi.y + margin};
}

}  // namespace

View make_plan(const Scene& scene, const ViewOptions& o, const std::optional<ShadowReach>& reach) {
  const Box box = model_box(scene);
  const Vec3 origin = scene.frame.origin;
  Bounds2 b;
  if (const std::optional<Bounds2> given = parse_bounds(o.bounds)) {
    b = {given->x0 - origin.x, given->y0 - origin.y, given->x1 - origin.x, given->y1 - origin.y};
    // A sun 2 degrees high throws shadows 29 times as long as things are high.
    const double farthest = kFarthestShadow * (box.hi.z - box.lo.z);
    if (b.x0 > box.hi.x + farthest || b.x1 < box.lo.x - farthest || b.y0 > box.hi.y + farthest ||
        b.y1 < box.lo.y - farthest) {
      throw Failure(
          fmt::format("--bounds {} lie far from the model, which reaches from {:.2f},{:.2f} to "
                      "{:.2f},{:.2f} in its coordinates",
                      o.bounds, box.lo.x + origin.x, box.lo.y + origin.y, box.hi.x + origin.x,
                      box.hi.y + origin.y));
    }
  } else {
    b = default_bounds(scene, box, reach);
  }
  double pixel = o.pixel;
  if (!(pixel > 0)) {
    const double side = std::max(b.x1 - b.x0, b.y1 - b.y0);
    pixel = kPixelSizes.back();
    for (const double p : kPixelSizes) {
      if (side <= p * kAutoPixels) {
        pixel = p;
        break;
      }
    }
  }
  if (o.bounds.empty()) {  // whole pixels in the model's coordinates
    b.x0 = std::floor((b.x0 + origin.x) / pixel) * pixel - origin.x;
    b.y0 = std::floor((b.y0 + origin.y) / pixel) * pixel - origin.y;
    b.x1 = std::ceil((b.x1 + origin.x) / pixel) * pixel - origin.x;
    b.y1 = std::ceil((b.y1 + origin.y) / pixel) * pixel - origin.y;
  }
  check_memory((b.x1 - b.x0) / pixel, (b.y1 - b.y0) / pixel,
               "give a larger --pixel or smaller --bounds");
  return checked(plan_view(b, pixel, box.lo.z), "--pixel and --bounds");
}

View make_camera(const Scene& scene, const ViewOptions& o, double sun_azimuth, int supersample) {
  const std::array<int, 2> size = parse_size(o.size);
  const int width = size[0] * supersample, height = size[1] * supersample;
  check_memory(width, height, "give a smaller --size");
  Box box = model_box(scene);
  if (const std::optional<Bounds2> part = parse_bounds(o.bounds)) {  // of a plan: look at that part
    const Vec3& origin = scene.frame.origin;
    box.lo.x = std::max(box.lo.x, part->x0 - origin.x);
    box.lo.y = std::max(box.lo.y, part->y0 - origin.y);
    box.hi.x = std::max(box.lo.x, std::min(box.hi.x, part->x1 - origin.x));
    box.hi.y = std::max(box.lo.y, std::min(box.hi.y, part->y1 - origin.y));
  }
  const Vec3 target = o.target.empty() ? (box.lo + box.hi) * 0.5
                                       : parse_point(o.target, "--target", scene.frame.origin);
  const double fov = o.fov_deg * kDegree;
  Vec3 eye;
  if (!o.eye.empty()) {
    eye = parse_point(o.eye, "--eye", scene.frame.origin);
    if (glm::distance(eye, target) == 0) throw Failure("--eye and --target are the same point");
  } else {
    const double azimuth = sun_azimuth + kEyeBesideSun;
    const Vec3 back(std::sin(azimuth) * std::cos(kEyeAltitude),
                    std::cos(azimuth) * std::cos(kEyeAltitude), std::sin(kEyeAltitude));
    const Vec3 right = glm::normalize(glm::cross(-back, Vec3(0, 0, 1))),
               top = glm::cross(right, -back);
    const double tan_v = std::tan(fov / 2), tan_h = tan_v * width / height;
    double distance = 0;  // least at which all corners of the box are in the picture
    const auto show = [&](const Vec3& corner) {
      const Vec3 d = corner - target;
      const double beside =
          std::max(std::fabs(glm::dot(d, right)) / tan_h, std::fabs(glm::dot(d, top)) / tan_v);
      distance = std::max(distance, beside + glm::dot(d, back));
    };
    for (int k = 0; k < 8; ++k) {
      show({(k & 1) != 0 ? box.hi.x : box.lo.x, (k & 2) != 0 ? box.hi.y : box.lo.y,
            (k & 4) != 0 ? box.hi.z : box.lo.z});
    }
    // Around a lone tower some ground, on which its shadows are seen: half as far as it is high.
    if (o.bounds.empty() && has_made_ground(scene)) {
      const Vec3 middle = (box.lo + box.hi) * 0.5;
      const double far = 0.5 * (box.hi.z - box.lo.z);
      for (int k = 0; k < 4; ++k) {
        show({middle.x + ((k & 1) != 0 ? far : -far), middle.y + ((k & 2) != 0 ? far : -far),
              box.lo.z});
      }
    }
    eye = target + back * (distance * 1.02);  // a little air around it
  }
  const Vec3 forward = glm::normalize(target - eye);
  const Vec3 up = std::hypot(forward.x, forward.y) < 1e-6
                      ? Vec3(0, 1, 0)
                      : Vec3(0, 0, 1);  // straight down: north is up
  if (o.ortho_height > 0) {
    return checked(orthographic_view(eye, target, up, o.ortho_height, width, height),
                   "--eye, --target and --ortho");
  }
  return checked(perspective_view(eye, target, up, fov, width, height), "--eye and --target");
}

}  // namespace gnomon::app
