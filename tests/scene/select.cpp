#include <gnomon/scene/select.h>
#include <gtest/gtest.h>

namespace gnomon {
namespace {

Surface named(std::string object, std::string group, std::string material, std::string semantic) {
  Surface s;
  s.object = std::move(object);
  s.group = std::move(group);
  s.material = std::move(material);
  s.semantic = std::move(semantic);
  return s;
}

// A house with roof and wall, and a ground; surface 3 has no triangles.
Scene house() {
  Scene scene;
  scene.mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  scene.mesh.triangles = {{0, 1, 2}, {0, 1, 2}, {0, 1, 2}};
  scene.surface_of = {0, 1, 2};
  scene.surfaces = {named("House", "Building", "tile", "RoofSurface"),
                    named("House", "Building", "concrete", "WallSurface"),
                    named("Ground", "Ground", "", "Ground"), named("Ghost", "Phantom", "", "")};
  return scene;
}

TEST(Glob, StarIsAnyTextAndQuestionMarkAnyByte) {
  EXPECT_TRUE(glob_matches("*", "anything"));
  EXPECT_TRUE(glob_matches("*", ""));
  EXPECT_TRUE(glob_matches("Roof*", "RoofSurface"));
  EXPECT_TRUE(glob_matches("*Surface", "RoofSurface"));
  EXPECT_TRUE(glob_matches("R*f*e", "RoofSurface"));
  EXPECT_TRUE(glob_matches("a*b*c", "a-b-b-c-c"));
  EXPECT_TRUE(glob_matches("h?us?", "house"));
  EXPECT_TRUE(glob_matches("", ""));
  EXPECT_FALSE(glob_matches("h?use", "huse"));
  EXPECT_FALSE(glob_matches("Roof", "RoofSurface"));
  EXPECT_FALSE(glob_matches("a*b", "a-b-c"));
  EXPECT_FALSE(glob_matches("", "x"));
}

TEST(Glob, CaseMattersAndBracketsAreText) {
  EXPECT_FALSE(glob_matches("roof*", "RoofSurface"));
  EXPECT_TRUE(glob_matches("[a].{b}", "[a].{b}"));
  EXPECT_FALSE(glob_matches("[a]", "a"));
}

TEST(Glob, ManyStarsOnLongTextStayFast) {
  std::string glob, text(100000, 'a');
  for (int k = 0; k < 50; ++k) glob += "a*";
  EXPECT_FALSE(glob_matches(glob + "b", text));
}

TEST(Glob, AnyOfTheFourNamesOfASurfaceCounts) {
  const Surface s = named("House", "Building", "tile", "RoofSurface");
  for (const char* glob : {"House", "Building", "tile", "RoofSurface"}) {
    EXPECT_TRUE(glob_matches(glob, s)) << glob;
  }
  EXPECT_FALSE(glob_matches("wood", s));
  EXPECT_FALSE(glob_matches("*", Surface{}));
}

TEST(Select, EverythingCastsAndReceivesByDefault) {
  Scene scene = house();
  EXPECT_FALSE(select(scene, {}));
  for (const Surface& s : scene.surfaces) EXPECT_TRUE(s.casts && s.receives);
}

TEST(Select, OnlyWhatCastNamesCastsTheGroundToo) {
  Scene scene = house();
  EXPECT_FALSE(select(scene, {.cast = {"concrete", "tile"}, .no_cast = {}, .receive = {}}));
  EXPECT_TRUE(scene.surfaces[0].casts);
  EXPECT_TRUE(scene.surfaces[1].casts);
  EXPECT_FALSE(scene.surfaces[2].casts);
  EXPECT_TRUE(scene.surfaces[2].receives);
}

TEST(Select, NoCastIsStrongerThanCast) {
  Scene scene = house();
  EXPECT_FALSE(select(scene, {.cast = {"Building"}, .no_cast = {"Wall*"}, .receive = {"Ground"}}));
  EXPECT_TRUE(scene.surfaces[0].casts);
  EXPECT_FALSE(scene.surfaces[1].casts);
  EXPECT_FALSE(scene.surfaces[0].receives);
  EXPECT_TRUE(scene.surfaces[2].receives);
}

TEST(Select, AGlobThatMatchesNothingNamesTheNearestNames) {
  Scene scene = house();
  const auto error = select(scene, {.cast = {}, .no_cast = {"rofsurface"}, .receive = {}});
  ASSERT_TRUE(error);
  EXPECT_NE(error->message.find("--no-cast \"rofsurface\" matches no"), std::string::npos);
  EXPECT_NE(error->message.find("nearest names are \"RoofSurface\""), std::string::npos)
      << error->message;
}

TEST(Select, NamesWithoutTrianglesDoNotCountAsMatched) {
  Scene scene = house();
  const auto error = select(scene, {.cast = {"Ghost"}, .no_cast = {}, .receive = {}});
  ASSERT_TRUE(error);
  EXPECT_EQ(error->message.find("\"Ghost\","), std::string::npos);
}

TEST(Select, NothingLeftToCastIsAnError) {
  Scene scene = house();
  const auto error = select(scene, {.cast = {"tile"}, .no_cast = {"tile"}, .receive = {}});
  ASSERT_TRUE(error);
  EXPECT_NE(error->message.find("casts a shadow"), std::string::npos);
}

}  // namespace
}  // namespace gnomon
