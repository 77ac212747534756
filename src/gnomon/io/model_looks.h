// How the polygons of a Model look, and how that becomes the scene's Appearance.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <gnomon/mesh/tri_mesh.h>
#include <gnomon/scene/appearance.h>

namespace gnomon {

struct Model;
struct ModelPolygon;

// Lists end where nothing more is known: what is beyond has no material, uv 0 and no normal.
struct ModelLooks {
  std::vector<Material> materials;
  std::vector<Texture> textures;
  std::vector<std::uint32_t> material_of;  // per polygon of the model
  std::vector<glm::vec2> uv;               // per entry of Model::corners
  // Likewise; z up, directions of Model::vertices * scale, of any length.
  std::vector<glm::vec3> normals;
};

// The look of the polygon that came into the model last: its material, and per corner, ring after
// ring, uv and normals; those may be empty. Precondition: model.looks.
void add_look(Model& model, std::uint32_t material, const std::vector<glm::vec2>& uv,
              const std::vector<glm::vec3>& normals);

// Normals turn clockwise around z, as a model does that is placed. Looks may be missing.
void turn_normals(Model& model, double clockwise);

// Moves materials and textures to the end of the scene's. Returns the number of the first material.
std::uint32_t add_materials(Appearance& appearance, ModelLooks& looks);

// The look of a polygon's triangles, whose vertices count from `first_vertex`. A vertex that is a
// corner of its polygon more than once (where a slit leads to a hole) has the look of the first.
// Precondition: model.looks, with its materials added.
void add_triangle_looks(Appearance& appearance, const Model& model, const ModelPolygon& polygon,
                        const Triangle* triangles, std::size_t count, std::uint32_t first_vertex,
                        std::uint32_t first_material);

// To be called once all triangles of the scene are there: lists of nothing but nothing go.
void finish_looks(Appearance& appearance, std::size_t triangles);

}  // namespace gnomon
