// The scene as OBJ and glTF: read back, nothing is lost.
#include <gnomon/io/load_scene.h>
#include <gnomon/io/obj.h>
#include <gnomon/io/scene_parts.h>
#include <gnomon/io/write_gltf.h>
#include <gnomon/io/write_obj.h>
#include <gtest/gtest.h>
#include <io/write_test_files.h>

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/Importer.hpp>

#include <array>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <set>

namespace gnomon {
namespace {

using testing::content;
using testing::TestFolder;

LoadedScene vienna() {
  LoadOptions options;
  options.crs = "EPSG:31256";
  auto loaded = load_scene({GNOMON_SCENES "/vienna/vienna.city.jsonl"}, options);
  EXPECT_TRUE(loaded) << loaded.error().message;
  return std::move(loaded).value();
}

// Two triangles of two objects, one of them without names, with coordinates that floats cannot
// hold.
Scene small_scene() {
  Scene s;
  s.mesh.positions = {{0.1, 0.2, 0.3}, {10.7, 0, 0}, {0, 10, 1.0 / 3}, {5, 5, 9}};
  s.mesh.triangles = {{0, 1, 2}, {1, 2, 3}};
  s.surface_of = {0, 1};
  Surface roof;
  roof.object = "Haus\\1\n ";
  roof.group = "Building";
  roof.semantic = "RoofSurface";
  Surface bare;
  bare.receives = false;
  s.surfaces = {roof, bare};
  s.frame.origin = {1000, 340000, 30};
  return s;
}

TEST(SceneParts, HoldEveryTriangleOnceAndTheNamelessObjectFirst) {
  const LoadedScene loaded = vienna();
  const SceneParts parts = scene_parts(loaded.scene);
  std::vector<int> seen(loaded.scene.mesh.triangles.size(), 0);
  std::set<std::string> names;
  for (const SceneObject& object : parts.objects) {
    EXPECT_TRUE(names.insert(object.name).second) << object.name;
    for (const ScenePart& part : object.parts) {
      EXPECT_FALSE(part.triangles.empty());
      for (const std::uint32_t t : part.triangles) {
        ++seen[t];
        EXPECT_EQ(loaded.scene.surface_of[t], part.surface);
      }
    }
  }
  EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<std::ptrdiff_t>(seen.size()));
  EXPECT_EQ(scene_parts(small_scene()).objects[0].name, "");
}

TEST(WriteObj, ReadsBackTheSameTrianglesBitForBit) {
  const TestFolder folder;
  const Scene scene = vienna().scene;
  const auto written = write_obj(folder / "v.obj", scene, "gnomon test");
  ASSERT_TRUE(written) << written.error().message;
  // The ground has vertices closer to each other than coordinates of the CRS can tell.
  std::size_t merged = 0;
  for (const Warning& w : written.value().warnings) merged += w.count;
  EXPECT_LT(written.value().largest_rounding, 3e-11) << "half a last digit of 340000 m";
  const auto model = read_obj(content(folder / "v.obj"), "v.obj", 'z', 1);
  ASSERT_TRUE(model) << model.error().message;
  const Model& m = model.value();
  ASSERT_EQ(m.polygons.size(), scene.mesh.triangles.size());
  EXPECT_EQ(m.vertices.size() + merged, scene.mesh.positions.size());
  std::size_t polygon = 0;
  for (const SceneObject& object : scene_parts(scene).objects) {
    for (const ScenePart& part : object.parts) {
      for (const std::uint32_t t : part.triangles) {
        const ModelPolygon& p = m.polygons[polygon++];
        const std::uint32_t begin = m.ring_begin[p.first_ring];
        ASSERT_EQ(m.ring_begin[p.first_ring + 1] - begin, 3u);
        for (std::uint32_t k = 0; k < 3; ++k) {
          const Vec3 want = scene.mesh.positions[scene.mesh.triangles[t][k]] + scene.frame.origin;
          ASSERT_EQ(m.vertices[m.corners[begin + k]], want) << "triangle " << t;
        }
        const Surface &a = m.surfaces[p.surface], &b = scene.surfaces[part.surface];
        ASSERT_EQ(a.object, b.object);
        ASSERT_EQ(a.group, b.group);
        ASSERT_EQ(a.material, b.semantic) << "OBJ has no word for semantic surfaces";
      }
    }
  }
}

TEST(WriteObj, NamesThatBreakLinesAreChangedWithAWarning) {
  const TestFolder folder;
  const auto written = write_obj(folder / "s.obj", small_scene(), "gnomon");
  ASSERT_TRUE(written) << written.error().message;
  ASSERT_EQ(written.value().warnings.size(), 1u);
  const auto model = read_obj(content(folder / "s.obj"), "s.obj", 'z', 1);
  ASSERT_TRUE(model) << model.error().message;
  ASSERT_EQ(model.value().polygons.size(), 2u);
  EXPECT_EQ(model.value().surfaces[0].object, "");
  EXPECT_EQ(model.value().surfaces[1].object, "Haus_1_");
  EXPECT_NE(content(folder / "s.mtl").find("newmtl RoofSurface"), std::string::npos);
}

TEST(WriteObj, VerticesThatRoundingMakesOneAreCounted) {
  const TestFolder folder;
  Scene s = small_scene();
  s.surfaces[0].object = "house";
  s.mesh.positions[3] = s.mesh.positions[0] + Vec3(0, 1e-13, 0);
  const auto written = write_obj(folder / "s.obj", s, "gnomon");
  ASSERT_TRUE(written);
  ASSERT_EQ(written.value().warnings.size(), 1u);
  EXPECT_EQ(written.value().warnings[0].count, 1u);
  EXPECT_GT(written.value().largest_rounding, 1e-12);
}

TEST(WriteObj, ForeignMaterialsAreNotOverwritten) {
  const TestFolder folder;
  ASSERT_TRUE(write_text_file(folder / "s.mtl", "newmtl mine\n"));
  const auto refused = write_obj(folder / "s.obj", small_scene(), "gnomon");
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("s.mtl"), std::string::npos);
  EXPECT_EQ(content(folder / "s.mtl"), "newmtl mine\n");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"s.mtl"});
  ASSERT_TRUE(write_obj(folder / "t.obj", small_scene(), "gnomon"));
  EXPECT_TRUE(write_obj(folder / "t.obj", small_scene(), "gnomon")) << "its own are";
}

std::uint32_t word(const std::string& bytes, std::size_t at) {
  std::uint32_t w = 0;
  std::memcpy(&w, bytes.data() + at, 4);
  return w;
}

struct Glb {
  nlohmann::json json;
  std::string bytes;
};

Glb parse_glb(const std::string& file) {
  EXPECT_EQ(word(file, 0), 0x46546C67u);
  EXPECT_EQ(word(file, 4), 2u);
  EXPECT_EQ(word(file, 8), file.size());
  const std::size_t size = word(file, 12);
  EXPECT_EQ(word(file, 16), 0x4E4F534Au);
  EXPECT_EQ(size % 4, 0u);
  EXPECT_EQ(word(file, 20 + size), file.size() - 28 - size);
  EXPECT_EQ(word(file, 24 + size), 0x004E4942u);
  return {nlohmann::json::parse(file.substr(20, size)), file.substr(28 + size)};
}

TEST(WriteGltf, ChunksAccessorsAndBoundsAreWhatTheSpecificationAsks) {
  const TestFolder folder;
  const Scene scene = vienna().scene;
  const auto written = write_gltf(folder / "v.glb", scene, GltfForm::binary, "gnomon test");
  ASSERT_TRUE(written) << written.error().message;
  const Glb glb = parse_glb(content(folder / "v.glb"));
  const auto& j = glb.json;
  EXPECT_EQ(j["asset"]["version"], "2.0");
  EXPECT_EQ(j["asset"]["extras"]["crs"], "EPSG:31256");
  EXPECT_EQ(j["asset"]["extras"]["origin"][1], scene.frame.origin.y);
  ASSERT_EQ(j["buffers"][0]["byteLength"], glb.bytes.size());
  std::size_t covered = 0, triangles = 0;
  for (const auto& view : j["bufferViews"]) {
    EXPECT_EQ(view["byteOffset"], covered) << "one after the other, without gaps";
    EXPECT_EQ(view["byteOffset"].get<std::size_t>() % 4, 0u);
    covered += view["byteLength"].get<std::size_t>();
  }
  EXPECT_EQ(covered, glb.bytes.size());
  for (const auto& mesh : j["meshes"]) {
    for (const auto& primitive : mesh["primitives"]) {
      const auto& positions =
          j["accessors"][primitive["attributes"]["POSITION"].get<std::size_t>()];
      const auto& indices = j["accessors"][primitive["indices"].get<std::size_t>()];
      const auto count = indices["count"].get<std::size_t>();
      ASSERT_EQ(count % 3, 0u);
      triangles += count / 3;
      const auto& view = j["bufferViews"][indices["bufferView"].get<std::size_t>()];
      ASSERT_EQ(view["byteLength"], 4 * count);
      for (std::size_t k = 0; k < count; ++k) {
        ASSERT_LT(word(glb.bytes, view["byteOffset"].get<std::size_t>() + 4 * k),
                  positions["count"].get<std::uint32_t>());
      }
      ASSERT_LT(primitive["material"].get<std::size_t>(), j["materials"].size());
    }
  }
  EXPECT_EQ(triangles, scene.mesh.triangles.size());
  for (const auto& accessor : j["accessors"]) {
    if (accessor["type"] != "VEC3") continue;
    const auto& view = j["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    const auto begin = view["byteOffset"].get<std::size_t>();
    std::array<float, 3> low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};
    for (std::size_t k = 0; k < 3 * accessor["count"].get<std::size_t>(); ++k) {
      float f = 0;
      std::memcpy(&f, glb.bytes.data() + begin + 4 * k, 4);
      low[k % 3] = std::min(low[k % 3], f);
      high[k % 3] = std::max(high[k % 3], f);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      ASSERT_EQ(accessor["min"][k].get<float>(), low[k]);
      ASSERT_EQ(accessor["max"][k].get<float>(), high[k]);
    }
  }
  EXPECT_EQ(j["nodes"].size(), written.value().objects);
  EXPECT_EQ(j["nodes"].back()["name"], "Ground");
}

// Corners as floats, y up, of every triangle: what a file must hold.
std::multiset<std::array<float, 9>> corners_of(const Scene& scene) {
  std::multiset<std::array<float, 9>> out;
  for (const Triangle& t : scene.mesh.triangles) {
    std::array<float, 9> c;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& p = scene.mesh.positions[t[k]];
      c[3 * k] = static_cast<float>(p.x);
      c[3 * k + 1] = static_cast<float>(p.z);
      c[3 * k + 2] = static_cast<float>(0.0 - p.y);
    }
    out.insert(c);
  }
  return out;
}

void collect(const aiScene& scene, const aiNode& node, std::multiset<std::array<float, 9>>& out) {
  EXPECT_TRUE(node.mTransformation.IsIdentity());
  for (unsigned m = 0; m < node.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[node.mMeshes[m]];
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      ASSERT_EQ(mesh.mFaces[f].mNumIndices, 3u);
      std::array<float, 9> c;
      for (std::size_t k = 0; k < 3; ++k) {
        const aiVector3D& p = mesh.mVertices[mesh.mFaces[f].mIndices[k]];
        c[3 * k] = p.x;
        c[3 * k + 1] = p.y;
        c[3 * k + 2] = p.z;
      }
      out.insert(c);
    }
  }
  for (unsigned k = 0; k < node.mNumChildren; ++k) collect(scene, *node.mChildren[k], out);
}

TEST(WriteGltf, AssimpReadsTheSameTrianglesFromBothForms) {
  const TestFolder folder;
  const Scene scene = vienna().scene;
  ASSERT_TRUE(write_gltf(folder / "v.glb", scene, GltfForm::binary, "gnomon"));
  ASSERT_TRUE(write_gltf(folder / "v.gltf", scene, GltfForm::embedded, "gnomon"));
  const auto want = corners_of(scene);
  for (const char* name : {"v.glb", "v.gltf"}) {
    Assimp::Importer importer;
    const aiScene* read = importer.ReadFile((folder / name).string(), 0);
    ASSERT_NE(read, nullptr) << name << ": " << importer.GetErrorString();
    std::multiset<std::array<float, 9>> found;
    collect(*read, *read->mRootNode, found);
    EXPECT_TRUE(found == want) << name;
  }
}

TEST(WriteGltf, SaysHowFarSinglePrecisionMovesVertices) {
  const TestFolder folder;
  Scene s = small_scene();
  const auto near = write_gltf(folder / "s.glb", s, GltfForm::binary, "gnomon");
  ASSERT_TRUE(near);
  EXPECT_LT(near.value().largest_rounding, 1e-6);
  s.mesh.positions[3] = {100000.003, 5, 9};
  const auto far = write_gltf(folder / "s.glb", s, GltfForm::binary, "gnomon");
  ASSERT_TRUE(far);
  EXPECT_EQ(far.value().largest_rounding, std::fabs(100000.003 - double(100000.003F)));
  const Glb glb = parse_glb(content(folder / "s.glb"));
  EXPECT_FALSE(glb.json["nodes"][0].contains("name"));
  EXPECT_EQ(glb.json["nodes"][0]["extras"]["receives"], false);
  EXPECT_EQ(glb.json["nodes"][1]["name"], "Haus\\1\n ");
}

}  // namespace
}  // namespace gnomon
