#include <gnomon/io/footprint_crs.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <gnomon/io/crs.h>

namespace gnomon {
namespace {

// Half of a file's footprints are smaller than this only if its unit is the degree: 0.1 m is no
// building, and 0.1 degrees of latitude is 11 km.
constexpr double kSmallestBuilding = 0.1;

// A CRS whose lengths differ from true ones by more than this is not fit for shadows. Grids that
// countries survey in stay within 0.1 %, UTM within 0.1 % of its zone; Web Mercator is off by a
// third at 48 degrees of latitude.
constexpr double kTrueScale = 0.01;
constexpr double kScaleStep = 100;  // units of the CRS over which its scale is taken

struct Box {
  Vec2 low{std::numeric_limits<double>::infinity()}, high{-low};
};

template <class Visit>
void for_each_point(FootprintFile& file, const Visit& visit) {
  for (FootprintFeature& f : file.features) {
    for (Rings& rings : f.polygons) {
      for (auto& ring : rings) {
        for (Vec2& p : ring) visit(p);
      }
    }
  }
}

bool can_be_degrees(const Box& box) {
  return box.low.x >= -360 && box.high.x <= 360 && box.low.y >= -90 && box.high.y <= 90;
}

bool looks_like_degrees(const FootprintFile& file, const Box& box) {
  if (!can_be_degrees(box)) return false;
  std::vector<double> sizes;
  for (const FootprintFeature& f : file.features) {
    for (const Rings& rings : f.polygons) {
      Box own;
      for (const Vec2& p : rings[0])
        own.low = glm::min(own.low, p), own.high = glm::max(own.high, p);
      sizes.push_back(std::max(own.high.x - own.low.x, own.high.y - own.low.y));
    }
  }
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return *middle < kSmallestBuilding;
}

// Longitudes are on a circle: what stands on both sides of the antimeridian has its middle there,
// not at longitude 0, half the Earth away.
Vec2 middle_of(FootprintFile& file, const Box& box, const std::string& crs) {
  const Vec2 middle = (box.low + box.high) / 2.0;
  if (box.high.x - box.low.x <= 180 || !is_geographic_crs(crs)) return middle;
  double low = std::numeric_limits<double>::infinity(), high = -low;  // from 0 to 360 degrees east
  for_each_point(file, [&](const Vec2& p) {
    const double x = p.x - 360 * std::floor(p.x / 360);
    low = std::min(low, x), high = std::max(high, x);
  });
  return high - low < box.high.x - box.low.x ? Vec2((low + high) / 2, middle.y) : middle;
}

// The CRS of a scene that nothing else decides: the file's own if it is fit for it, else UTM.
Result<std::string> scene_crs(const std::string& own, const Vec2& middle, const std::string& path,
                              Warnings& warnings) {
  if (is_geographic_crs(own)) return utm_crs({middle.y * kDegree, middle.x * kDegree, 0});
  const auto place = reproject(own, "OGC:CRS84", {middle});
  if (!place) return place.error();
  const Vec2 lonlat = place.value()[0];
  const std::string utm = utm_crs({lonlat.y * kDegree, lonlat.x * kDegree, 0});
  const auto there =
      reproject(own, utm, {middle, middle + Vec2(kScaleStep, 0), middle + Vec2(0, kScaleStep)});
  if (!there) return there.error();
  const auto& p = there.value();
  for (const Vec2& q : {p[1], p[2]}) {
    const double scale = glm::length(q - p[0]) / kScaleStep;
    if (std::fabs(scale - 1) <= kTrueScale) continue;
    warn(warnings, "Files whose CRS is not in metres true to scale were moved to a UTM zone.",
         fmt::format("{}: a unit of {} is {:.3f} m, moved to {}", path, own, scale, utm));
    return utm;
  }
  return own;
}

}  // namespace

Result<PlacedFootprints> place_footprints(FootprintFile& file, const std::string& path,
                                          const std::string& target_crs,
                                          const std::string& fallback_crs, Warnings& warnings) {
  const std::string target = short_crs(target_crs), fallback = short_crs(fallback_crs);
  Box box;
  for_each_point(file, [&](const Vec2& p) {
    box.low = glm::min(box.low, p);
    box.high = glm::max(box.high, p);
  });
  if (!(box.low.x <= box.high.x)) return PlacedFootprints{target, ""};  // no footprint at all

  std::string own = short_crs(file.crs);
  if (own.empty()) {
    own = fallback;
  } else if (is_geographic_crs(own) && !can_be_degrees(box)) {
    // GeoJSON in metres that lacks its "crs" member, mostly.
    if (fallback.empty() || is_geographic_crs(fallback)) {
      return Error{fmt::format(
          "{}: its coordinates, such as ({:.6g}, {:.6g}), are no longitude and latitude, but its "
          "CRS is {} (which GeoJSON always is, unless it has a \"crs\" member); name the right CRS "
          "with --crs.",
          path, box.high.x, box.high.y, own)};
    }
    warn(warnings, "Coordinates that are no degrees were taken as of the CRS given.",
         fmt::format("{}: {} instead of {}", path, fallback, own));
    own = fallback;
  }
  if (own.empty()) {
    if (looks_like_degrees(file, box)) {
      return Error{fmt::format(
          "{}: it names no CRS and its coordinates, such as ({:.6g}, {:.6g}), look like degrees; "
          "add the CRS to the file (a Shapefile's .prj) or name it with --crs EPSG:4326.",
          path, box.low.x, box.low.y)};
    }
    if (!target.empty()) {
      warn(warnings, "Files that name no CRS were taken as of the scene's.", path);
    }
    for_each_point(file, [&](Vec2& p) { p *= file.metres_per_unit; });
    return PlacedFootprints{target, ""};
  }

  std::string to = target;
  if (to.empty()) {
    auto chosen = scene_crs(own, middle_of(file, box, own), path, warnings);
    if (!chosen) return Error{path + ": " + chosen.error().message};
    to = std::move(chosen).value();
  }
  if (is_geographic_crs(to)) {
    return Error{
        fmt::format("{}: footprints cannot be placed in {}, whose coordinates are degrees; use a "
                    "CRS in metres.",
                    path, to)};
  }
  if (to == own) return PlacedFootprints{to, ""};
  std::vector<Vec2> points;
  for_each_point(file, [&](const Vec2& p) { points.push_back(p); });
  auto moved = reproject(own, to, std::move(points));
  if (!moved) return Error{path + ": " + moved.error().message};
  std::size_t next = 0;
  for_each_point(file, [&](Vec2& p) { p = moved.value()[next++]; });
  return PlacedFootprints{to, own};
}

}  // namespace gnomon
