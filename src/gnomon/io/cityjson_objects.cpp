#include <fmt/format.h>
#include <gnomon/io/cityjson_geometry.h>
#include <gnomon/io/cityjson_objects.h>
#include <gnomon/io/read_text.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <set>
#include <utility>

namespace gnomon::cityjson {
namespace {

constexpr double kUnnamedRank = 0.9;  // between the flat LoD 0 (0.0 to 0.3) and LoD 1

bool flat(const Lod& lod) { return lod.numeric && lod.rank < kUnnamedRank; }
bool same(const Lod& a, const Lod& b) {
  return a.name == b.name || (a.numeric && b.numeric && a.rank == b.rank);
}

// A geometry that has surfaces.
struct Candidate {
  const Json* geometry;
  std::size_t number;
  Lod lod;
};

struct Object {
  std::string name;                // "parent/part"
  std::vector<std::string> chain;  // ids from the outermost parent to the object
  std::string type;
  std::vector<Candidate> candidates;
  bool is_warned_of = false;  // as having something that was left out
  const Candidate* highest() const {
    const auto at = std::max_element(
        candidates.begin(), candidates.end(),
        [](const Candidate& a, const Candidate& b) { return a.lod.rank < b.lod.rank; });
    return at == candidates.end() ? nullptr : &*at;
  }
};

// The id of the object that `object` is a part of; groups are not wholes. Empty if there is none.
std::string parent_of(const Json& objects, const Json& object) {
  const Json* parents = member(&object, "parents");
  for (std::size_t k = 0; parents && parents->is_array() && k < parents->size(); ++k) {
    const std::string id = text(element(parents, k));
    const Json* parent = id.empty() ? nullptr : member(&objects, id.c_str());
    if (!id.empty() && text(member(parent, "type")) != "CityObjectGroup") return id;
  }
  return {};
}

void name_object(const Json& objects, const std::string& id, Object& object) {
  std::vector<std::string> chain{id};
  for (const Json* at = member(&objects, id.c_str()); at;) {
    const std::string parent = parent_of(objects, *at);
    if (parent.empty() || std::find(chain.begin(), chain.end(), parent) != chain.end()) break;
    chain.push_back(parent);
    at = member(&objects, parent.c_str());
  }
  std::reverse(chain.begin(), chain.end());
  object.name = fmt::format("{}", fmt::join(chain, "/"));
  object.chain = std::move(chain);
}

// False where there is no polygon in the boundaries, or none that has a ring. What is no list
// counts as one: reading it says what is wrong with it.
bool holds_polygons(const Json& boundaries, int depth) {
  if (!boundaries.is_array()) return true;
  if (depth == 0) return !boundaries.empty();
  return std::any_of(boundaries.begin(), boundaries.end(),
                     [&](const Json& b) { return holds_polygons(b, depth - 1); });
}

// Type, name and geometries with surfaces of one city object.
bool list_geometries(Reading& reading, const Json& json, Object& object) {
  const std::string where = fmt::format("object {}", in_quotes(object.name, 200));
  if (!json.is_object()) return reading.fail(where + " must be a JSON object.");
  object.type = text(member(&json, "type"));
  if (object.type.empty()) return reading.fail(where + " has no \"type\".");
  const Json* list = member(&json, "geometry");
  if (!list) return true;
  if (!list->is_array()) return reading.fail(where + ": \"geometry\" must be a list.");
  for (std::size_t k = 0; k < list->size(); ++k) {
    const Json& geometry = (*list)[k];
    std::string type = text(member(&geometry, "type"));
    const Json* source = &geometry;
    const bool instance = type == "GeometryInstance";
    if (instance) source = template_of(reading, geometry);
    if (instance && source) type = text(member(source, "type"));
    if (type == "MultiPoint" || type == "MultiLineString") {
      warn(reading.builder.model.warnings, "Points and lines cast no shadow and were left out.",
           fmt::format("{}: {}, geometry {}", reading.path, where, k));
      object.is_warned_of = true;
      continue;
    }
    if (!instance && depth_of(type) == 0) {  // reading an instance says what is wrong with it
      return reading.fail(fmt::format("{}, geometry {}: CityJSON has no geometry of type {}.",
                                      where, k, in_quotes(type)));
    }
    const Json* boundaries = member(source, "boundaries");
    if (boundaries && !holds_polygons(*boundaries, depth_of(type))) continue;
    Candidate candidate{&geometry, k, lod_of(member(source, "lod"))};
    reading.lods.insert(candidate.lod);
    object.candidates.push_back(std::move(candidate));
  }
  return true;
}

}  // namespace

bool Reading::fail(const std::string& what) {
  error =
      line ? fmt::format("{}: line {}: {}", path, line, what) : fmt::format("{}: {}", path, what);
  return false;
}

Lod lod_of(const Json* value) {
  Lod lod{kUnnamedRank, false, {}};
  if (!value) return lod;
  lod.name = value->is_number() ? fmt::format("{}", value->get<double>()) : text(value);
  const char* end = lod.name.data() + lod.name.size();
  double rank = 0;
  const auto parsed = std::from_chars(lod.name.data(), end, rank);
  if (parsed.ec == std::errc() && parsed.ptr == end && std::isfinite(rank)) {
    lod.rank = rank;
    lod.numeric = true;
  }
  return lod;
}

bool read_objects(Reading& reading, const Json& json) {
  const Json* objects = member(&json, "CityObjects");
  if (!objects) return true;
  if (!objects->is_object()) return reading.fail("\"CityObjects\" must be a JSON object.");
  const Json* vertices = member(&json, "vertices");
  if (vertices && !vertices->is_array()) return reading.fail("\"vertices\" must be a list.");
  Document document{reading, objects, vertices, nullptr, {}};
  const Json* appearance = member(&json, "appearance");
  document.materials =
      member(appearance ? appearance : member(&reading.header, "appearance"), "materials");
  document.vertex_id.assign(vertices ? vertices->size() : 0, kNotYet);

  const Json asked_json(reading.lod);
  const Lod asked = lod_of(&asked_json);
  const auto wanted = [&](const Object& object, const Candidate& c) {
    return reading.lod.empty() ? c.lod.rank == object.highest()->lod.rank : same(c.lod, asked);
  };

  // Parents and parts share a root; `served` are the roots that somewhere have what is wanted, more
  // than flat.
  std::vector<Object> list;
  std::map<std::string, bool> served;
  std::set<std::string> with_surfaces;  // ids: of objects with candidates, and of their parents
  for (const auto& [id, object_json] : objects->items()) {
    Object object;
    name_object(*objects, id, object);
    if (!list_geometries(reading, object_json, object)) return false;
    for (const Candidate& c : object.candidates) {
      if (wanted(object, c) && (!reading.lod.empty() || !flat(c.lod)))
        served[object.chain.front()] = true;
    }
    if (!object.candidates.empty()) {
      with_surfaces.insert(object.chain.begin(), object.chain.end());
    }
    list.push_back(std::move(object));
  }

  Warnings& warnings = reading.builder.model.warnings;
  for (const Object& object : list) {
    const std::string element =
        fmt::format("{}: object {}", reading.path, in_quotes(object.name, 200));
    if (object.candidates.empty()) {
      // Of groups and of wholes whose parts have them, no surfaces are asked for.
      if (!object.is_warned_of && object.type != "CityObjectGroup" &&
          !with_surfaces.contains(object.chain.back())) {
        warn(warnings, "Objects without surfaces, also in their parts, cast no shadow.", element);
      }
      continue;
    }
    const bool others_serve = served.count(object.chain.front()) > 0;
    ObjectPolygons polygons(reading.builder);
    bool any = false, any_flat = false;
    for (const Candidate& c : object.candidates) {
      if (!wanted(object, c)) continue;
      if (reading.lod.empty() && flat(c.lod) && others_serve) continue;
      any = true;
      any_flat = any_flat || flat(c.lod);
      const std::size_t whole = object.chain.size() > 1 ? object.chain.front().size() : 0;
      const GeometryOf of{object.name, whole, object.type, c.number};
      if (!read_geometry(document, of, *c.geometry, polygons)) return false;
    }
    polygons.finish();
    if (any_flat) {
      warn(warnings, "Flat geometry of LoD 0 was taken where an object has nothing higher.",
           element);
    }
    if (!any && !others_serve) {
      warn(warnings,
           fmt::format("Objects without geometry of LoD {} were left out.", in_quotes(reading.lod)),
           element);
    }
  }
  return true;
}

}  // namespace gnomon::cityjson
