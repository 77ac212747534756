#include <gnomon/core/nearest_names.h>

#include <gtest/gtest.h>

namespace gnomon {
namespace {

TEST(NearestNames, LeavesOutWhatIsFartherThanAsked) {
  const std::set<std::string_view> names{"--size", "--tz"};
  EXPECT_EQ(nearest_names("--timezone", names, 1, 3), "");
  EXPECT_EQ(nearest_names("--sise", names, 1, 2), "\"--size\"");
}

}  // namespace
}  // namespace gnomon
