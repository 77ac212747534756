#include <fmt/format.h>
#include <gnomon/io/cityjson_geometry.h>
#include <gnomon/io/cityjson_looks.h>
#include <gnomon/io/read_text.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace gnomon::cityjson {
namespace {

// Where the least of the ring's rotations starts, in linear time: of two candidates, each mismatch
// throws out all starts that it passed.
std::size_t least_rotation(const std::vector<std::uint32_t>& ring) {
  const std::size_t n = ring.size();
  std::size_t a = 0, b = 1, same = 0;
  while (a < n && b < n && same < n) {
    const std::uint32_t of_a = ring[(a + same) % n], of_b = ring[(b + same) % n];
    if (of_a == of_b) {
      ++same;
      continue;
    }
    (of_a > of_b ? a : b) += same + 1;
    if (a == b) ++b;
    same = 0;
  }
  return std::min(a, b);
}

// The ring as a cycle without start and direction: the least of all its readings.
std::vector<std::uint32_t> cycle_of(std::vector<std::uint32_t> ring) {
  if (ring.size() > 1 && ring.back() == ring.front()) ring.pop_back();  // closed ones are tolerated
  if (ring.empty()) return ring;
  std::vector<std::uint32_t> turned(ring.rbegin(), ring.rend());
  for (auto* r : {&ring, &turned}) {
    std::rotate(r->begin(), r->begin() + static_cast<std::ptrdiff_t>(least_rotation(*r)), r->end());
  }
  return std::min(ring, turned);
}

// Equal for polygons that are the same up to start, direction and order of the holes.
Rings cycles_of(const Rings& rings) {
  Rings cycles;
  for (const auto& ring : rings) cycles.push_back(cycle_of(ring));
  std::sort(cycles.begin() + 1, cycles.end());
  return cycles;
}

std::uint64_t hash(const Rings& cycles) {
  std::uint64_t h = 0xcbf29ce484222325u;
  for (const auto& cycle : cycles) {
    h = (h ^ cycle.size()) * 0xff51afd7ed558ccdu;
    for (const std::uint32_t v : cycle) {
      h = (h ^ v) * 0xff51afd7ed558ccdu;
      h ^= h >> 32;
    }
  }
  return h;
}

// Where a geometry's vertex indices lead: to the document's vertices, or to a template's, placed at
// an anchor.
struct Vertices {
  Document& document;
  bool of_template = false;
  std::array<double, 16> matrix{};  // row-major, metres
  Vec3 anchor{0, 0, 0};             // units of the file

  std::size_t size() const {
    if (of_template) return document.reading.template_vertices.size();
    return document.vertices ? document.vertices->size() : 0;
  }
  // In the model. Precondition: k < size(). False: it is not three finite numbers, as the document
  // has it or where the template puts it.
  bool at(std::size_t k, std::uint32_t& id) const {
    ModelBuilder& builder = document.reading.builder;
    if (of_template) {
      const Vec3 p = document.reading.template_vertices[k];
      Vec3 placed;
      for (int r = 0; r < 3; ++r) {
        const double* row = &matrix[static_cast<std::size_t>(4 * r)];
        placed[r] = row[0] * p.x + row[1] * p.y + row[2] * p.z + row[3];
      }
      const Vec3 raw = anchor + placed / builder.model.scale;
      if (!std::isfinite(raw.x) || !std::isfinite(raw.y) || !std::isfinite(raw.z)) return false;
      id = builder.vertex(raw);
      return true;
    }
    std::uint32_t& known = document.vertex_id[k];
    if (known == kNotYet) {
      const auto raw = vec3(&(*document.vertices)[k]);
      if (!raw) return false;
      known = builder.vertex(*raw);
    }
    id = known;
    return true;
  }
};

struct Reader {
  Document& document;
  const GeometryOf& of;
  const Vertices& vertices;
  const Json* materials;  // list of the appearance
  const Json* semantics;  // list of semantic surfaces
  ObjectPolygons& polygons;

  std::string where() const {
    return fmt::format("object {}, geometry {}", in_quotes(of.object, 200), of.number);
  }
  bool fail(const std::string& what) const {
    return document.reading.fail(fmt::format("{}: {}", where(), what));
  }
  void names_do_not_fit(std::string_view kind) const {
    warn(document.reading.builder.model.warnings,
         fmt::format("{} that do not fit their geometry were ignored.", kind),
         fmt::format("{}: {}", document.reading.path, where()));
  }

  // The name that `values` (a number, or nothing) selects in `list`.
  std::string name(const Json* list, const Json* value, const char* key,
                   std::string_view kind) const {
    if (!value) return {};
    const auto k = index_below(value, list && list->is_array() ? list->size() : 0);
    if (!k) {
      names_do_not_fit(kind);
      return {};
    }
    return text(member(&(*list)[*k], key));
  }

  std::uint32_t look(const Json* value) const {
    const auto k = index_below(value, materials && materials->is_array() ? materials->size() : 0);
    if (!k || !document.reading.builder.model.looks) return kNoMaterial;
    return material_of(document.reading, (*materials)[*k]);
  }

  bool polygon(const Json& boundary, const Json* semantic, const Json* material) const {
    if (!boundary.is_array()) return fail("a polygon must be a list of rings.");
    if (boundary.empty()) {
      warn(document.reading.builder.model.warnings, "Polygons without a ring were left out.",
           fmt::format("{}: {}", document.reading.path, where()));
      return true;
    }
    Rings rings;
    for (const Json& ring : boundary) {
      if (!ring.is_array()) return fail("a ring must be a list of vertex indices.");
      auto& ids = rings.emplace_back();
      ids.reserve(ring.size());
      for (const Json& corner : ring) {
        const auto k = index_below(&corner, vertices.size());
        if (!k) {
          return fail(fmt::format(
              "vertex index {} is not a whole number below {}, the number of {}.", kind_of(&corner),
              vertices.size(), vertices.of_template ? "template vertices" : "vertices"));
        }
        std::uint32_t id = 0;
        if (!vertices.at(*k, id)) {
          if (vertices.of_template) {
            return fail(fmt::format(
                "the transformationMatrix moves template vertex {} beyond all numbers.", *k));
          }
          return fail(fmt::format("vertex {} must be three finite numbers, not {}.", *k,
                                  kind_of(&(*document.vertices)[*k])));
        }
        ids.push_back(id);
      }
    }
    const std::string material_name = name(materials, material, "name", "Materials");
    const std::string semantic_name = name(semantics, semantic, "type", "Semantic surfaces");
    polygons.add(std::move(rings),
                 document.reading.builder.surface(of.object, of.object_type, material_name,
                                                  semantic_name, of.whole),
                 look(material));
    return true;
  }

  bool surfaces(const Json& boundaries, const Json* semantic, const Json* material, int depth,
                const Json* whole_material) const {
    if (!boundaries.is_array()) {
      return fail("the boundaries are not nested as deep as the geometry's type asks for.");
    }
    const auto fits = [&](const Json* values) {
      return !values || (values->is_array() && values->size() == boundaries.size());
    };
    if (!fits(semantic)) names_do_not_fit("Semantic surfaces");
    if (!fits(material)) names_do_not_fit("Materials");
    for (std::size_t k = 0; k < boundaries.size(); ++k) {
      const Json* s = element(semantic, k);
      const Json* m = element(material, k);
      if (!(depth == 1 ? polygon(boundaries[k], s, whole_material ? whole_material : m)
                       : surfaces(boundaries[k], s, m, depth - 1, whole_material))) {
        return false;
      }
    }
    return true;
  }
};

// Boundaries with their names, from the document or from a template.
bool read_boundaries(Document& document, const GeometryOf& of, const Json& geometry,
                     const Vertices& vertices, const Json* materials, ObjectPolygons& polygons) {
  const Json* semantics = member(&geometry, "semantics");
  Reader reader{document, of, vertices, materials, member(semantics, "surfaces"), polygons};
  const std::string type = text(member(&geometry, "type"));
  const int depth = depth_of(type);
  if (depth == 0) return reader.fail(fmt::format("type {} has no surfaces.", in_quotes(type)));
  const Json* boundaries = member(&geometry, "boundaries");
  if (!boundaries) return reader.fail("has no \"boundaries\".");
  // Themes are alternative looks; the first one names the materials.
  const Json* themes = member(&geometry, "material");
  const Json* theme =
      themes && themes->is_object() && !themes->empty() ? &*themes->begin() : nullptr;
  return reader.surfaces(*boundaries, member(semantics, "values"), member(theme, "values"), depth,
                         member(theme, "value"));
}

bool read_instance(Document& document, const GeometryOf& of, const Json& instance,
                   ObjectPolygons& polygons) {
  Vertices placed{document, false, {}, {}};
  const Reader reader{document, of, placed, nullptr, nullptr, polygons};
  const Json* geometry = template_of(document.reading, instance);
  if (!geometry) {
    return reader.fail(fmt::format("template {} is not in the file's geometry-templates.",
                                   kind_of(member(&instance, "template"))));
  }
  const Json* matrix = member(&instance, "transformationMatrix");
  for (std::size_t k = 0; k < 16; ++k) {
    const auto entry = number(element(matrix, k));
    if (!entry || matrix->size() != 16) {
      return reader.fail("the transformationMatrix must be 16 finite numbers.");
    }
    placed.matrix[k] = *entry;
  }
  const auto& m = placed.matrix;
  if (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1) {
    return reader.fail("the last row of the transformationMatrix must be 0, 0, 0, 1.");
  }
  const Json* anchors = member(&instance, "boundaries");
  const auto anchor = anchors && anchors->is_array() && anchors->size() == 1
                          ? index_below(element(anchors, 0), placed.size())
                          : std::nullopt;
  const auto at = anchor ? vec3(element(document.vertices, *anchor)) : std::nullopt;
  if (!at) {
    return reader.fail("the boundaries of a GeometryInstance must be the index of one vertex.");
  }
  placed.anchor = *at;
  placed.of_template = true;
  const Json* appearance = member(&document.reading.header, "appearance");
  return read_boundaries(document, of, *geometry, placed, member(appearance, "materials"),
                         polygons);
}

}  // namespace

void ObjectPolygons::add(Rings rings, std::uint32_t surface, std::uint32_t material) {
  const std::uint32_t number = next_number_++;
  const Rings cycles = cycles_of(rings);
  std::uint64_t key = hash(cycles);
  for (auto at = by_cycle_.find(key); at != by_cycle_.end(); at = by_cycle_.find(++key)) {
    Taken& there = taken_[at->second];
    if (cycles_of(there.rings) != cycles) continue;  // another polygon with the same hash
    ++builder_.model.report.stored_twice;
    const auto& surfaces = builder_.model.surfaces;
    if (surfaces[there.surface].semantic.empty() && !surfaces[surface].semantic.empty()) {
      there = {std::move(rings), surface, number, material};
    }
    return;
  }
  by_cycle_.emplace(key, taken_.size());
  taken_.push_back({std::move(rings), surface, number, material});
}

void ObjectPolygons::finish() {
  for (const Taken& t : taken_) {
    builder_.polygon(t.surface, t.number, t.rings);
    if (builder_.model.looks) add_look(builder_.model, t.material, {}, {});
  }
  if (!taken_.empty()) ++builder_.model.report.objects;
}

int depth_of(const std::string& type) {
  if (type == "MultiSurface" || type == "CompositeSurface") return 1;
  if (type == "Solid") return 2;
  if (type == "MultiSolid" || type == "CompositeSolid") return 3;
  return 0;
}

const Json* template_of(const Reading& reading, const Json& instance) {
  const Json* templates = member(member(&reading.header, "geometry-templates"), "templates");
  if (!templates || !templates->is_array()) return nullptr;
  const auto k = index_below(member(&instance, "template"), templates->size());
  return k ? &(*templates)[*k] : nullptr;
}

bool read_geometry(Document& document, const GeometryOf& of, const Json& geometry,
                   ObjectPolygons& polygons) {
  if (text(member(&geometry, "type")) == "GeometryInstance") {
    return read_instance(document, of, geometry, polygons);
  }
  const Vertices own{document, false, {}, {}};
  return read_boundaries(document, of, geometry, own, document.materials, polygons);
}

}  // namespace gnomon::cityjson
