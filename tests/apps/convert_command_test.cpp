// gnomon convert as a user runs it.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <apps/program.h>

namespace {

namespace fs = std::filesystem;

class ConvertCommand : public gnomon::testing::Program {
 protected:
  std::string file(const std::string& name) const { return (folder_ / name).string(); }
};

TEST_F(ConvertCommand, ObjGivesTheSameMaskAsTheModelItCameFrom) {
  ASSERT_EQ(run("convert " + vienna_ + " -o " + file("v.obj")), 0) << err_;
  EXPECT_TRUE(fs::exists(file("v.mtl")));
  const std::string as_obj = file("v.obj") + " --up z --ground none --crs EPSG:31256";
  // High and low sun, from four sides, and a lamp over the roofs.
  for (const char* light :
       {"--date 2024-09-18 --at 14:00 --tz Europe/Vienna",
        "--date 2024-06-21 --at 05:30 --tz Europe/Vienna",
        "--date 2024-12-21 --at 15:30 --tz Europe/Vienna", "--light 1249,340770,120"}) {
    for (const auto& [model, out] :
         {std::pair(vienna_, std::string("a")), std::pair(as_obj, std::string("b"))}) {
      ASSERT_EQ(run("shadow " + model + " --title t --pixel 1 " + light + " -o " + file(out)), 0)
          << err_;
    }
    EXPECT_TRUE(text(file("a/mask.tif")) == text(file("b/mask.tif"))) << light;
    const auto a = nlohmann::json::parse(text(file("a/summary.json"))),
               b = nlohmann::json::parse(text(file("b/summary.json")));
    EXPECT_EQ(a["result"], b["result"]) << light;
    EXPECT_EQ(a["view"], b["view"]) << light;
    EXPECT_EQ(a["scene"]["origin"], b["scene"]["origin"]) << light;
    EXPECT_TRUE(text(file("a/outlines.geojson")) == text(file("b/outlines.geojson"))) << light;
  }
}

TEST_F(ConvertCommand, GlbAndGltfSayOriginAndRounding) {
  for (const char* name : {"v.glb", "v.GLTF"}) {
    ASSERT_EQ(run("convert " + vienna_ + " -o " + file(name)), 0) << err_;
    EXPECT_GT(fs::file_size(file(name)), 1000000u);
    EXPECT_NE(out_.find("origin 1249, 340770, 57"), std::string::npos) << out_;
    EXPECT_NE(out_.find("single precision"), std::string::npos) << out_;
    EXPECT_NE(out_.find("read it with: --ground none --site=48.2"), std::string::npos) << out_;
    EXPECT_EQ(err_.find("millimetre"), std::string::npos) << err_;
  }
}

TEST_F(ConvertCommand, VerticesThatSinglePrecisionMovesByMoreThanAMillimetreAreAWarning) {
  {
    std::ofstream model(file("far.obj"));
    model << "v 0 0 0\nv 10 0 0\nv 0 10 0\nv 90000.002 0 0\nv 90010 0 0\nv 90000 10 0\n"
             "f 1 2 3\nf 4 5 6\n";
  }
  ASSERT_EQ(run("convert " + file("far.obj") + " --up z --ground none -o " + file("far.glb")), 0)
      << err_;
  EXPECT_NE(err_.find("more than a millimetre"), std::string::npos) << err_;
}

TEST_F(ConvertCommand, UnknownFormatsAndTheModelItselfAreRefused) {
  EXPECT_NE(run("convert " + vienna_ + " -o " + file("v.stl")), 0);
  EXPECT_NE(err_.find(".glb, .gltf or .obj"), std::string::npos);
  EXPECT_NE(run("convert " + vienna_), 0);
  EXPECT_NE(err_.find("--output"), std::string::npos) << err_;
  const std::string model = "v 0 0 0\nv 10 0 0\nv 0 10 0\nf 1 2 3\n";
  std::ofstream(file("m.obj")) << model;
  EXPECT_NE(run("convert " + file("m.obj") + " -o " + file("m.obj")), 0);
  EXPECT_NE(err_.find("overwritten"), std::string::npos);
  EXPECT_EQ(text(file("m.obj")), model);
}

}  // namespace
