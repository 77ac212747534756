#include <gnomon/io/pbr_looks.h>

#include <cmath>

#include "looks_files.h"

namespace gnomon {
namespace {

using namespace testing_files;

// A quad of two triangles in glTF's xy plane; `material` and `more` are members of the file. The
// buffer: 4 positions, 4 texture coordinates, 4 normals, 6 indices.
std::string quad(const std::string& material, const std::string& more) {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1,"NORMAL":2},"indices":3,"material":0}]}],
"materials":[)" +
         material + R"(],"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},
{"bufferView":1,"componentType":5126,"count":4,"type":"VEC2"},
{"bufferView":2,"componentType":5126,"count":4,"type":"VEC3"},
{"bufferView":3,"componentType":5123,"count":6,"type":"SCALAR"}],
"bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":32},
{"buffer":0,"byteOffset":80,"byteLength":48},{"buffer":0,"byteOffset":128,"byteLength":12}],
"buffers":[{"byteLength":140,"uri":"quad.bin"}])" +
         more + "}";
}

std::string bytes_of_quad() {
  const float f[] = {0, 0, 0, 4, 0, 0, 4, 3, 0, 0, 3, 0,  // positions
                     0, 1, 1, 1, 1, 0, 0, 0,              // the picture upright
                     0, 0, 2, 0, 0, 2, 0, 0, 2, 0, 0, 2};
  const std::uint16_t i[] = {0, 1, 2, 0, 2, 3};
  return std::string(reinterpret_cast<const char*>(f), sizeof f) +
         std::string(reinterpret_cast<const char*>(i), sizeof i);
}

struct GltfLooksTest : testing::Test {
  Files files;
  Scene read(const std::string& material, const std::string& more = "") {
    files("quad.bin", bytes_of_quad());
    files("four.png", png(four_colours()));
    return load({files("t.gltf", quad(material, more))}, with_looks()).scene;
  }
};

const std::string kPicture =
    R"(,"images":[{"uri":"four.png"}],"textures":[{"source":0,"sampler":0}],)"
    R"("samplers":[{"wrapS":33071,"wrapT":33648,"magFilter":9728}])";

TEST_F(GltfLooksTest, ColoursAreEncodedAndRoughnessBecomesAnExponent) {
  const Scene s = read(R"({"name":"m","pbrMetallicRoughness":{"baseColorFactor":[0.5,0.2,0,0.25],)"
                       R"("metallicFactor":0,"roughnessFactor":0.5},"emissiveFactor":[0.25,0,1]})");
  const Material& m = material_of(s, 0);
  EXPECT_NEAR(m.base_colour.x, 0.735357, 1e-6);  // sRGB of 0.5
  EXPECT_NEAR(m.base_colour.y, 0.484529, 1e-6);  // of 0.2
  EXPECT_NEAR(m.emissive.x, 0.537099, 1e-6);     // of 0.25
  EXPECT_NEAR(m.emissive.z, 1, 1e-12);
  EXPECT_EQ(m.shininess, 30);  // 2 / 0.0625 - 2
  EXPECT_NEAR(m.specular.x, srgb_encoded(0.04 * 38 / 8), 1e-12);
  EXPECT_EQ(m.opacity, 1);  // alphaMode is OPAQUE
  EXPECT_FALSE(m.double_sided);
  EXPECT_TRUE(s.appearance.uv.empty());
}

TEST_F(GltfLooksTest, MetalReflectsItsOwnColour) {
  const Scene s =
      read(R"({"pbrMetallicRoughness":{"baseColorFactor":[0.6,0.3,0.1,1],"roughnessFactor":1}})");
  const Material& m = material_of(s, 0);
  EXPECT_EQ(m.shininess, 0);
  EXPECT_NEAR(srgb_decoded(m.specular.x), 0.6, 1e-12);
  EXPECT_NEAR(srgb_decoded(m.base_colour.x), 0.3, 1e-12);
  EXPECT_NEAR(srgb_decoded(m.specular.z), 0.1, 1e-12);
}

TEST_F(GltfLooksTest, PicturesLieOnTheSurfaceUpright) {
  const Scene s = read(R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0}},)"
                       R"("alphaMode":"MASK","alphaCutoff":0.3,"doubleSided":true})",
                       kPicture);
  const Material& m = material_of(s, 0);
  EXPECT_EQ(m.alpha, TextureAlpha::cut);
  EXPECT_EQ(m.alpha_cutoff, 0.3);
  EXPECT_TRUE(m.double_sided);
  const Texture& t = s.appearance.textures.at(std::size_t(m.base_texture));
  EXPECT_EQ(t.edge_u, TextureEdge::clamp);
  EXPECT_EQ(t.edge_v, TextureEdge::mirror);
  EXPECT_FALSE(t.smooth);
  ASSERT_EQ(s.appearance.uv.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3 p = corner(s, k, c) + s.frame.origin;
      EXPECT_FLOAT_EQ(s.appearance.uv[k][c].x, float(p.x / 4));
      EXPECT_FLOAT_EQ(s.appearance.uv[k][c].y, float(1 - p.z / 3));
      EXPECT_EQ(s.appearance.normals[k][c], glm::vec3(0, -1, 0));  // glTF's z
    }
  }
}

TEST_F(GltfLooksTest, PicturesInTheFileAreRead) {
  const std::string picture = png({1, 1, {{1, 2, 3}}});
  files("quad.bin", bytes_of_quad() + picture);
  std::string text = quad(
      R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0}},)"
      R"("normalTexture":{"index":1,"scale":0.5}})",
      R"(,"images":[{"bufferView":4,"mimeType":"image/png"},{"uri":"data:image/png;base64,)"
      R"(iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGNoaPgPAAODAgAApfuJAAAAAElFTkSuQmCC"}],)"
      R"("textures":[{"source":0},{"source":1}])");
  const auto put = [&](const std::string& a, const std::string& b) {
    text.replace(text.find(a), a.size(), b);
  };
  put(R"({"buffer":0,"byteOffset":128,"byteLength":12}])",
      R"({"buffer":0,"byteOffset":128,"byteLength":12},{"buffer":0,"byteOffset":140,"byteLength":)" +
          std::to_string(picture.size()) + "}]");
  put(R"("byteLength":140)", R"("byteLength":)" + std::to_string(140 + picture.size()));
  const Scene s = load({files("t.gltf", text)}, with_looks()).scene;
  const Material& m = material_of(s, 0);
  ASSERT_GE(m.base_texture, 0);
  EXPECT_EQ(s.appearance.textures[std::size_t(m.base_texture)].rgba,
            (std::vector<std::uint8_t>{1, 2, 3, 255}));
  ASSERT_GE(m.normal_texture, 0);
  EXPECT_EQ(m.normal_scale, 0.5);
  EXPECT_EQ(s.appearance.textures[std::size_t(m.normal_texture)].rgba,
            (std::vector<std::uint8_t>{128, 128, 255, 255}));
}

TEST_F(GltfLooksTest, CoordinatesAreMovedTurnedAndScaled) {
  const Scene s = read(R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"extensions":)"
                       R"({"KHR_texture_transform":{"offset":[0.5,0.25],"scale":[2,3],)"
                       R"("rotation":1.5707963267948966}}}}})",
                       kPicture);
  for (std::size_t c = 0; c < 3; ++c) {
    const Vec3 p = corner(s, 0, c) + s.frame.origin;
    const double u = p.x / 4, v = 1 - p.z / 3;
    EXPECT_NEAR(double(s.appearance.uv[0][c].x), 3 * v + 0.5, 1e-6);
    EXPECT_NEAR(double(s.appearance.uv[0][c].y), -2 * u + 0.25, 1e-6);
  }
}

TEST_F(GltfLooksTest, WhatIsLeftOutIsCounted) {
  const Scene s = read(R"({"name":"m","pbrMetallicRoughness":{"baseColorTexture":{"index":0},)"
                       R"("metallicRoughnessTexture":{"index":0}},"occlusionTexture":{"index":0},)"
                       R"("normalTexture":{"index":0,"texCoord":1},"emissiveTexture":{"index":7},)"
                       R"("emissiveFactor":[1,1,1],"extensions":{"KHR_materials_clearcoat":{}}})",
                       kPicture);
  EXPECT_TRUE(warns(s, "Maps of metal and roughness were replaced by their mean", 1));
  EXPECT_TRUE(warns(s, "Maps of occlusion were left out", 1));
  EXPECT_TRUE(warns(s, "lie otherwise on the surface", 1));
  EXPECT_TRUE(warns(s, "Extensions of materials that are not read", 1));
  EXPECT_TRUE(warns(s, "Pictures on surfaces were left out", 1));
  const Material& m = material_of(s, 0);
  EXPECT_EQ(m.emissive, Vec3(0));  // its map, which is not there, says where it glows
  // Red, green, blue, white: half of the texels are metal, half are rough.
  EXPECT_NEAR(m.shininess, 30, 1e-9);
}

TEST_F(GltfLooksTest, PicturesOutsideTheFolderOrMissingAreCounted) {
  const std::string textured = R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}})";
  for (const char* uri :
       {"../secret.png", "gone.png", "/etc/passwd", "http://a.b/c.png", "quad.bin"}) {
    const Scene s = read(
        textured, std::string(R"(,"images":[{"uri":")") + uri + R"("}],"textures":[{"source":0}])");
    EXPECT_TRUE(warns(s, "Pictures on surfaces were left out", 1)) << uri;
    EXPECT_EQ(material_of(s, 0).base_texture, -1);
  }
  const Scene s = read(textured, R"(,"images":[{"uri":"fou%72.png"}],"textures":[{"source":0}])");
  EXPECT_GE(material_of(s, 0).base_texture, 0);
}

}  // namespace
}  // namespace gnomon
