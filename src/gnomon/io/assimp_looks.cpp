#include <assimp/scene.h>
#include <fmt/format.h>
#include <gnomon/io/assimp_looks.h>
#include <gnomon/io/assimp_rig.h>
#include <gnomon/io/read_text.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace gnomon {
namespace {

TextureEdge edge_of(const aiMaterial& from, const char* key, unsigned type) {
  int mode = aiTextureMapMode_Wrap;
  from.Get(key, type, 0, mode);
  return mode == aiTextureMapMode_Mirror ? TextureEdge::mirror
         : mode == aiTextureMapMode_Wrap ? TextureEdge::repeat
                                         : TextureEdge::clamp;
}

void get_colour(const aiMaterial& from, const char* key, Vec3& to) {
  aiColor3D c;
  if (from.Get(key, 0, 0, c) != AI_SUCCESS) return;
  if (!std::isfinite(c.r) || !std::isfinite(c.g) || !std::isfinite(c.b)) return;
  to = {std::max(0.0, double(c.r)), std::max(0.0, double(c.g)), std::max(0.0, double(c.b))};
}

double get_number(const aiMaterial& from, const char* key, double otherwise) {
  float f = 0;
  return from.Get(key, 0, 0, f) == AI_SUCCESS && std::isfinite(f) ? double(f) : otherwise;
}

// Texels that Assimp has decoded itself.
Texture of_texels(const aiTexture& from, std::string name) {
  Texture out;
  out.name = std::move(name);
  out.width = static_cast<int>(from.mWidth);
  out.height = static_cast<int>(from.mHeight);
  const std::size_t n = std::size_t(from.mWidth) * from.mHeight;
  out.rgba.reserve(4 * n);
  for (std::size_t k = 0; k < n; ++k) {
    const aiTexel& t = from.pcData[k];
    out.rgba.insert(out.rgba.end(), {t.r, t.g, t.b, t.a});
  }
  return out;
}

}  // namespace

AssimpLooks::AssimpLooks(const aiScene& scene, Model& model)
    : scene_(scene), model_(model), pictures_(model), known_(scene.mNumMaterials) {
  model.looks.emplace();
}

int AssimpLooks::texture(const aiMaterial& from, int type, Known& known) {
  const auto kind = static_cast<aiTextureType>(type);
  aiString path;
  if (from.GetTexture(kind, 0, &path) != AI_SUCCESS) return -1;
  const std::string name(text_of(path));
  if (name.empty() || name[0] == '$') return -1;  // Assimp's own word for none
  int set = 0;
  from.Get(AI_MATKEY_UVWSRC(kind, 0), set);
  const auto uv_set = static_cast<unsigned>(std::clamp(set, 0, AI_MAX_NUMBER_OF_TEXTURECOORDS - 1));
  if (known.textured && uv_set != known.uv_set) {
    warn(model_.warnings,
         "Pictures that lie otherwise on the surface than the material's first were left out.",
         fmt::format("{}: {}", model_.report.path, in_quotes(name, 200)));
    return -1;
  }
  const PictureEdges edges{edge_of(from, _AI_MATKEY_MAPPINGMODE_U_BASE, kind),
                           edge_of(from, _AI_MATKEY_MAPPINGMODE_V_BASE, kind), true};
  int found = -1;
  if (const aiTexture* held = scene_.GetEmbeddedTexture(path.C_Str())) {
    const std::string key = fmt::format("{}", static_cast<const void*>(held));
    found = held->mHeight == 0
                ? pictures_.bytes({reinterpret_cast<const char*>(held->pcData), held->mWidth}, name,
                                  key, edges)
                : pictures_.texels(of_texels(*held, name), key, edges);
  } else {
    found = pictures_.file(name, edges);
  }
  if (found >= 0) known.textured = true, known.uv_set = uv_set;
  return found;
}

std::uint32_t AssimpLooks::material(const aiMesh& mesh) {
  if (mesh.mMaterialIndex >= scene_.mNumMaterials) return kNoMaterial;
  std::optional<Known>& known = known_[mesh.mMaterialIndex];
  if (known) return known->material;
  known.emplace();
  const aiMaterial& from = *scene_.mMaterials[mesh.mMaterialIndex];
  Material m;
  aiString name;
  from.Get(AI_MATKEY_NAME, name);
  m.name = text_of(name);
  get_colour(from, "$clr.diffuse", m.base_colour);
  get_colour(from, "$clr.specular", m.specular);
  get_colour(from, "$clr.emissive", m.emissive);
  m.shininess = std::max(0.0, get_number(from, "$mat.shininess", 0));
  m.specular *= std::clamp(get_number(from, "$mat.shinpercent", 1), 0.0, 1.0);
  m.opacity = std::clamp(get_number(from, "$mat.opacity", 1), 0.0, 1.0);
  m.base_texture = texture(from, aiTextureType_DIFFUSE, *known);
  m.emissive_texture = texture(from, aiTextureType_EMISSIVE, *known);
  m.normal_texture = texture(from, aiTextureType_NORMALS, *known);
  for (const aiTextureType other : {aiTextureType_SPECULAR, aiTextureType_HEIGHT,
                                    aiTextureType_OPACITY, aiTextureType_SHININESS}) {
    if (from.GetTextureCount(other) == 0) continue;
    warn(model_.warnings,
         "Maps of materials but of the base colour, the light they give and normals were left out.",
         fmt::format("{}: material {}", model_.report.path, in_quotes(m.name, 200)));
  }
  // IFC has its few materials once for each element.
  std::vector<Material>& all = model_.looks->materials;
  const auto same = std::find(all.begin(), all.end(), m);
  known->material = static_cast<std::uint32_t>(same - all.begin());
  if (same == all.end()) all.push_back(std::move(m));
  return known->material;
}

std::vector<glm::vec2> AssimpLooks::uv(const aiMesh& mesh) const {
  std::vector<glm::vec2> out;
  if (mesh.mMaterialIndex >= scene_.mNumMaterials || !known_[mesh.mMaterialIndex]) return out;
  const Known& known = *known_[mesh.mMaterialIndex];
  const aiVector3D* from = known.textured ? mesh.mTextureCoords[known.uv_set] : nullptr;
  if (!from) return out;
  for (unsigned k = 0; k < mesh.mNumVertices; ++k) {
    const glm::vec2 uv(from[k].x, 1 - from[k].y);  // Assimp counts v from the lower edge
    out.push_back(std::isfinite(uv.x) && std::isfinite(uv.y) ? uv : glm::vec2(0));
  }
  return out;
}

}  // namespace gnomon
