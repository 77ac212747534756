#include <gnomon/io/footprints.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include <glm/common.hpp>

#include <gnomon/core/approx.h>
#include <gnomon/core/dyadic.h>
#include <gnomon/io/ground.h>

namespace gnomon {
namespace {

// City models store heights in whole millimetres: vertices within one of them count as equally low
// (metres).
constexpr double kLevelBottom = 1e-3;

constexpr std::string_view kTerrain[] = {"TINRelief",       "LandUse",   "Road",
                                         "Railway",         "WaterBody", "PlantCover",
                                         "TransportSquare", "Waterway"};

// City objects whose lowest vertex says nothing about the ground: what hangs on or stands in a
// building, spans the ground or runs below it.
constexpr std::string_view kAloof[] = {
    "Installation", "ConstructiveElement", "Furniture",        "Room", "Storey", "Unit", "Bridge",
    "Tunnel",       "HollowSpace",         "HeightAboveGround"};

constexpr std::string_view kCityObjects[] = {
    "Building",          "BuildingPart",    "GenericCityObject",       "CityFurniture",
    "OtherConstruction", "CityObjectGroup", "SolitaryVegetationObject"};

template <class Names>
bool contains(const Names& names, std::string_view name) {
  return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

bool is_aloof(std::string_view group) {
  return std::any_of(std::begin(kAloof), std::end(kAloof),
                     [&](std::string_view word) { return group.find(word) != group.npos; });
}

// The outermost building of a part; empty where the object is none.
std::string parent(const Surface& s) {
  return s.whole > 0 && s.whole < s.object.size() ? s.object.substr(0, s.whole) : "";
}

template <class T>
T turn_value(const Vec3& a, const Vec3& b, const Vec3& c) {
  const T ax(a.x), ay(a.y);
  return (T(b.x) - ax) * (T(c.y) - ay) - (T(b.y) - ay) * (T(c.x) - ax);
}

// One without a GroundSurface.
struct Object {
  std::vector<std::array<Vec3, 3>> triangles;
};

void add_lowest(const Object& object, Footprints& out) {
  double lowest = std::numeric_limits<double>::infinity();
  Vec3 low(lowest), high(-lowest);
  for (const auto& t : object.triangles) {
    for (const Vec3& p : t) low = glm::min(low, p), high = glm::max(high, p);
  }
  const auto is_low = [&](const Vec3& p) { return p.z <= low.z + kLevelBottom; };
  const std::size_t closed_before = out.closed.size();
  std::vector<std::array<Vec3, 2>> edges;
  for (const auto& t : object.triangles) {
    if (is_low(t[0]) && is_low(t[1]) && is_low(t[2])) {
      if (turn(t[0], t[1], t[2]) != 0) out.closed.push_back(t);
      continue;
    }
    for (int k = 0; k < 3; ++k) {
      const Vec3 &a = t[k], &b = t[(k + 1) % 3];
      if (is_low(a) && is_low(b) && (a.x != b.x || a.y != b.y)) edges.push_back({a, b});
    }
  }
  if (out.closed.size() > closed_before) return;
  if (edges.size() < 3) {
    // It touches the ground in a point or a line at most: the rectangle around it then, at that
    // height.
    const Vec3 corner[4] = {{low.x, low.y, low.z},
                            {high.x, low.y, low.z},
                            {high.x, high.y, low.z},
                            {low.x, high.y, low.z}};
    if (low.x == high.x || low.y == high.y) return;
    for (int k = 0; k < 4; ++k) edges.push_back({corner[k], corner[(k + 1) % 4]});
  }
  out.open.insert(out.open.end(), edges.begin(), edges.end());
}

}  // namespace

bool is_terrain(const Surface& surface) {
  if (surface.city) return contains(kTerrain, surface.group);
  return surface.group == "TINRelief" || is_made_ground(surface);
}

bool stands_on_ground(const Surface& surface) { return !is_aloof(surface.group); }

bool is_height_above_ground(const Surface& surface) {
  return surface.city && surface.group == "HeightAboveGround";
}

int turn(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Approx quick = turn_value<Approx>(a, b, c);
  return quick.certain() ? quick.sign() : turn_value<Dyadic>(a, b, c).sign();
}

namespace {

bool of_several_files(const Scene& scene) {
  return std::any_of(scene.surfaces.begin(), scene.surfaces.end(),
                     [&](const Surface& s) { return s.file != scene.surfaces[0].file; });
}

}  // namespace

Footprints find_footprints(const Scene& scene) {
  Footprints out;
  using Name = std::pair<std::uint32_t, std::string>;  // of an object: its file, its name there
  std::set<Name> grounded, grounded_parents;           // objects that have a GroundSurface
  std::set<std::uint32_t> cities;                      // files that name city objects
  for (const Surface& s : scene.surfaces) {
    if (!s.city) continue;
    const bool ground = s.semantic == "GroundSurface";
    if (ground || contains(kCityObjects, s.group) || is_aloof(s.group)) cities.insert(s.file);
    if (!ground) continue;
    grounded.insert({s.file, s.object});
    if (s.group.ends_with("Part")) grounded_parents.insert({s.file, parent(s)});
  }
  // Files at sites of their own have heights of their own.
  const bool placed = !scene.frame.crs.empty();
  out.one_object = cities.empty() && !(placed && of_several_files(scene));

  // Per surface: 0 nothing, 1 closes a building from below, else 2 + index of the object it belongs
  // to.
  std::map<Name, std::size_t> objects;
  std::vector<std::size_t> role(scene.surfaces.size(), 0);
  for (std::size_t k = 0; k < scene.surfaces.size(); ++k) {
    const Surface& s = scene.surfaces[k];
    const auto belongs_to = [&](const Name& name) {
      return 2 + objects.emplace(name, objects.size()).first->second;
    };
    if (out.one_object) {
      role[k] = belongs_to({0, ""});
    } else if (!cities.count(s.file)) {
      // The roof and the upper floors of a design are objects of their own, but stand on no ground.
      role[k] = belongs_to({s.file, ""});
    } else if (s.semantic == "GroundSurface") {
      // The underside of a bridge or a balcony is no ground.
      if (!is_aloof(s.group)) role[k] = 1;
    } else if (!is_aloof(s.group) && !grounded.count({s.file, s.object})) {
      // Parts without a bottom stand on their siblings, and a building on its parts, if those have
      // one.
      const bool part = s.group.ends_with("Part") && !parent(s).empty();
      const Name whole{s.file, part ? parent(s) : s.object};
      if (!grounded.count(whole) && !grounded_parents.count(whole)) role[k] = belongs_to(whole);
    }
  }

  std::vector<Object> rest(objects.size());
  for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    const std::size_t r = role[scene.surface_of[t]];
    if (r == 0) continue;
    const Triangle& v = scene.mesh.triangles[t];
    const std::array<Vec3, 3> corners = {scene.mesh.positions[v[0]], scene.mesh.positions[v[1]],
                                         scene.mesh.positions[v[2]]};
    if (r >= 2) {
      rest[r - 2].triangles.push_back(corners);
    } else if (turn(corners[0], corners[1], corners[2]) != 0) {
      out.closed.push_back(corners);
    }
  }
  for (const Object& object : rest) {
    if (!object.triangles.empty()) add_lowest(object, out);
  }
  return out;
}

}  // namespace gnomon
