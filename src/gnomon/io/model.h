// A model as a reader hands it over: polygons with holes over vertices, before it is placed,
// triangulated and welded.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <gnomon/core/place.h>
#include <gnomon/core/vec.h>
#include <gnomon/core/warnings.h>
#include <gnomon/io/file_report.h>
#include <gnomon/io/model_looks.h>
#include <gnomon/scene/scene.h>

namespace gnomon {

struct ModelPolygon {
  std::uint32_t surface = 0;  // index into Model::surfaces
  std::uint32_t first_ring =
      0;  // rings first_ring .. last_ring - 1; the first one is the outer ring
  std::uint32_t last_ring = 0;
  std::uint32_t number =
      0;  // what a message calls it: the line (OBJ), or the running number in the object from 0
};

struct Model {
  FileReport report;
  std::vector<Vec3>
      vertices;  // as in the file, z up; vertices * scale + translate are metres in the CRS
  Vec3 scale{1, 1, 1};
  Vec3 translate{0, 0, 0};
  std::vector<std::uint32_t> corners;  // indices into vertices, ring after ring
  std::vector<std::uint32_t> ring_begin{
      0};  // ring r is corners[ring_begin[r] .. ring_begin[r + 1])
  std::vector<ModelPolygon> polygons;
  std::vector<Surface> surfaces;
  std::optional<ModelLooks> looks;  // where they were asked for
  std::size_t animations = 0;       // that the file has
  // Where the origin of local coordinates stands and which way their +y looks (radians clockwise
  // from +y to true north), where the file says so (IFC); not used where report.crs is set.
  std::optional<Place> site;
  std::optional<double> north;
  Warnings warnings;
};

// Height of the ground below a point, metres, in the scene's CRS (east, north); nothing where there
// is none. For readers of what stands on the ground: footprints, heights above ground.
using GroundAt = std::function<std::optional<double>(double x, double y)>;

// A Model under construction: equal vertices become one, surfaces with the same names too.
class ModelBuilder {
 public:
  Model model;

  // Index of the vertex in model.vertices.
  std::uint32_t vertex(const Vec3& raw);
  // Index of the surface with these names in model.surfaces. `whole`: see Surface.
  std::uint32_t surface(std::string_view object, std::string_view group, std::string_view material,
                        std::string_view semantic, std::size_t whole = 0);
  void polygon(std::uint32_t surface, std::uint32_t number,
               const std::vector<std::vector<std::uint32_t>>& rings);

 private:
  struct HashVertex {
    std::size_t operator()(const Vec3& p) const;
  };
  std::unordered_map<Vec3, std::uint32_t, HashVertex> vertices_;
  std::unordered_map<std::string, std::uint32_t> surfaces_;
};

// "vienna.jsonl: object "UUID_1/UUID_1_2", polygon 3" or "house.obj: line 17".
std::string name_of(const Model& model, const ModelPolygon& polygon);

}  // namespace gnomon
