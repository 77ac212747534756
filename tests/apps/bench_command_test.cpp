// gnomon bench paper, as a user runs it.
#include <apps/program.h>

namespace {

class BenchFrames : public gnomon::testing::Program {
 protected:
  void SetUp() override {
    if (GNOMON_HAVE_GL == 0) GTEST_SKIP() << "built without OpenGL";
    gnomon::testing::Program::SetUp();
  }
};

TEST_F(BenchFrames, PaperWritesTheTablesOfTheScenesAskedFor) {
  const std::string file = (folder_ / "tables.md").string();
  ASSERT_EQ(run("bench paper --frames 1 --rounds 1 --size 32 --scene convex -o " + file), 0)
      << err_;
  const std::string tables = text(file);
  EXPECT_NE(tables.find("## convex"), std::string::npos);
  EXPECT_EQ(tables.find("## concave"), std::string::npos);
  EXPECT_EQ(tables.find("## Silhouettes"), std::string::npos);
  EXPECT_NE(tables.find("| **32 x 32**, mean |"), std::string::npos);
  EXPECT_NE(tables.find("| alpha buffer | 1 | 4 |"), std::string::npos);
  EXPECT_NE(tables.find("| screen buffer | 2 | 3 |"), std::string::npos);
}

TEST_F(BenchFrames, PaperSaysInItsTableThatConcaveCastersTakeFloats) {
  ASSERT_EQ(run("bench paper --frames 1 --rounds 1 --size 32 --scene concave"), 0) << err_;
  EXPECT_NE(out_.find("-bit floats"), std::string::npos);
}

class BenchSilhouettes : public gnomon::testing::Program {};

TEST_F(BenchSilhouettes, PaperHasTheTrianglesAndTheTimesOfThePaperBesideOurs) {
  ASSERT_EQ(run("bench paper --rounds 1 --scene tower --alone"), 0) << err_;
  EXPECT_EQ(out_.find("Whole frames"), std::string::npos) << "needs no OpenGL";
  EXPECT_NE(out_.find("`lattice_tower`) | 11353 (11155) | "), std::string::npos) << out_;
  EXPECT_NE(out_.find(" | 4.584 | 4.236 | 0.92 |\n"), std::string::npos) << out_;
  EXPECT_NE(out_.find("| 48.8 N, 10:00-14:00 Europe/Paris, 240 suns |"), std::string::npos) << out_;
  EXPECT_EQ(out_.find("Industry"), std::string::npos);
}

TEST_F(BenchSilhouettes, AModelHasARowWithoutThePapersTimesAndNoGround) {
  const std::string model = house().substr(0, house().find(' ')),
                    frames = GNOMON_HAVE_GL ? "--frames 4 " : "";
  ASSERT_EQ(run("bench paper --rounds 1 " + frames + "--scene industry --model " + model), 0)
      << err_;
  EXPECT_NE(out_.find(" | 7.299 | 5.799 | 0.79 |\n"), std::string::npos) << out_;
  EXPECT_NE(out_.find("| house | 12 (12) | "), std::string::npos) << out_;
  EXPECT_NE(out_.find(" |  |  |  |\n"), std::string::npos) << out_;
  if (!GNOMON_HAVE_GL) return;
  // Whole frames, of four suns.
  EXPECT_NE(out_.find("`industry_area`) | 13615 (13585) | 4 | "), std::string::npos) << out_;
  EXPECT_NE(out_.find("| house | 12 (12) | 4 | "), std::string::npos) << out_;
}

TEST_F(BenchSilhouettes, AModelThatCannotBeReadIsAnErrorAtOnce) {
  EXPECT_EQ(run("bench paper --model " + (folder_ / "none.obj").string()), 1);
  EXPECT_NE(err_.find("none.obj"), std::string::npos) << err_;
  EXPECT_EQ(out_, "");
}

TEST_F(BenchSilhouettes, ViennaIsAskedForWhereItsFileIs) {
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder_);
  const int code = run("bench paper --scene vienna");
  std::filesystem::current_path(before);
  EXPECT_EQ(code, 1);
  EXPECT_NE(err_.find("vienna.city.jsonl"), std::string::npos) << err_;
  EXPECT_NE(err_.find("--model"), std::string::npos) << err_;
}

}  // namespace
