#include "looks_files.h"

namespace gnomon {
namespace {

using namespace testing_files;

// Two triangles of one object, the first of material 1, the second of none.
std::string city(const std::string& materials) {
  return R"({"type":"CityJSON","version":"2.0","transform":{"scale":[1,1,1],"translate":[0,0,0]},)"
         R"("appearance":{"materials":)" +
         materials +
         R"(},"CityObjects":{"A":{"type":"Building","geometry":[{"type":"MultiSurface","lod":"2",)"
         R"("boundaries":[[[0,1,2]],[[0,1,3]]],"material":{"day":{"values":[1,null]}}}]}},)"
         R"("vertices":[[0,0,0],[5,0,0],[0,5,0],[0,0,5]]})";
}

TEST(CityJsonLooks, MaterialsComeWithTheirSurfaces) {
  const Files files;
  const Scene scene =
      load({files("a.city.json",
                  city(R"([{"name":"roof"},{"name":"glass","diffuseColor":[0.1,0.2,0.3],)"
                       R"("emissiveColor":[0,0,0.5],"specularColor":[0.9,0.8,0.7],)"
                       R"("shininess":0.25,"transparency":0.75}])"))},
           with_looks())
          .scene;
  ASSERT_EQ(scene.appearance.materials.size(), 1u);
  const Material& glass = material_of(scene, 0);
  EXPECT_EQ(glass.name, "glass");
  EXPECT_EQ(glass.base_colour, Vec3(0.1, 0.2, 0.3));
  EXPECT_EQ(glass.emissive, Vec3(0, 0, 0.5));
  EXPECT_EQ(glass.specular, Vec3(0.9, 0.8, 0.7));
  EXPECT_EQ(glass.shininess, 32);
  EXPECT_EQ(glass.opacity, 0.25);
  EXPECT_EQ(scene.appearance.material_of[1], kNoMaterial);
  EXPECT_TRUE(scene.appearance.uv.empty() && scene.appearance.normals.empty());
}

TEST(CityJsonLooks, ValuesOutOfRangeAreCounted) {
  const Files files;
  const Scene scene =
      load({files("a.city.json",
                  city(R"([{},{"name":"m","diffuseColor":[2,0,0],"transparency":"none"}])"))},
           with_looks())
          .scene;
  EXPECT_TRUE(warns(scene, "no numbers from 0 to 1", 2));
  EXPECT_EQ(material_of(scene, 0).opacity, 1);
  EXPECT_EQ(material_of(scene, 0).base_colour, Material{}.base_colour);
}

}  // namespace
}  // namespace gnomon
