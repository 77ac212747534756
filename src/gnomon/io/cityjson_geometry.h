// One geometry of a city object -> polygons, with their semantic surfaces and materials.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include <gnomon/io/cityjson_objects.h>

namespace gnomon::cityjson {

inline constexpr std::uint32_t kNotYet = 0xffffffffu;

// One JSON document with vertices of its own: a file, or a line of a CityJSONSeq.
struct Document {
  Reading& reading;
  const Json* objects = nullptr;
  const Json* vertices = nullptr;
  const Json* materials = nullptr;       // appearance.materials
  std::vector<std::uint32_t> vertex_id;  // per vertex of the document: in the model, or kNotYet
};

using Rings = std::vector<std::vector<std::uint32_t>>;  // vertices of the model

// The polygons of one object at one LoD; one that is there already does not come in again.
class ObjectPolygons {
 public:
  explicit ObjectPolygons(ModelBuilder& builder) : builder_(builder) {}
  // `material`: of the looks, where the model has any.
  void add(Rings rings, std::uint32_t surface, std::uint32_t material);
  // Hands the polygons to the builder, and counts them in its report.
  void finish();

 private:
  struct Taken {
    Rings rings;
    std::uint32_t surface, number, material;
  };
  ModelBuilder& builder_;
  std::vector<Taken> taken_;
  std::unordered_map<std::uint64_t, std::size_t> by_cycle_;  // hash of the cycle -> index in taken_
  std::uint32_t next_number_ = 0;
};

// How deep the boundaries of a geometry type are nested above the polygons: 1 for MultiSurface, 2
// for Solid, 3 for MultiSolid; 0 for types that are not surfaces (or unknown).
int depth_of(const std::string& type);

struct GeometryOf {
  std::string object;       // full name
  std::size_t whole = 0;    // see Surface
  std::string object_type;  // CityJSON type
  std::size_t number = 0;   // in the object's list of geometries
};

// Adds the polygons of `geometry` (a GeometryInstance too). False: Reading::error says why.
bool read_geometry(Document& document, const GeometryOf& of, const Json& geometry,
                   ObjectPolygons& polygons);

// The template that a GeometryInstance names; nothing if there is none.
const Json* template_of(const Reading& reading, const Json& instance);

}  // namespace gnomon::cityjson
