// gnomon bench paper, as a user runs it.
#include <apps/program.h>

namespace {

class BenchCommand : public gnomon::testing::Program {
 protected:
  void SetUp() override {
    if (GNOMON_HAVE_GL == 0) GTEST_SKIP() << "built without OpenGL";
    gnomon::testing::Program::SetUp();
  }
};

TEST_F(BenchCommand, PaperWritesTheTablesOfTheScenesAskedFor) {
  const std::string file = (folder_ / "tables.md").string();
  ASSERT_EQ(run("bench paper --frames 1 --rounds 1 --size 32 --scene convex -o " + file), 0)
      << err_;
  const std::string tables = text(file);
  EXPECT_NE(tables.find("## convex"), std::string::npos);
  EXPECT_EQ(tables.find("## concave"), std::string::npos);
  EXPECT_NE(tables.find("| **32 x 32**, mean |"), std::string::npos);
  EXPECT_NE(tables.find("| alpha buffer | 1 | 4 |"), std::string::npos);
  EXPECT_NE(tables.find("| screen buffer | 2 | 3 |"), std::string::npos);
}

TEST_F(BenchCommand, PaperSaysInItsTableThatConcaveCastersTakeFloats) {
  ASSERT_EQ(run("bench paper --frames 1 --rounds 1 --size 32 --scene concave"), 0) << err_;
  EXPECT_NE(out_.find("-bit floats"), std::string::npos);
}

}  // namespace
