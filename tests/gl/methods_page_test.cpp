// docs/methods.md is what decide() says.
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include <gnomon/gl/methods_page.h>

namespace gnomon::gl {
namespace {

TEST(MethodsPage, IsWhatTheProgramPrints) {
  std::ifstream file(std::string(GNOMON_SCENES) + "/../docs/methods.md");
  ASSERT_TRUE(file);
  std::stringstream text;
  text << file.rdbuf();
  EXPECT_EQ(text.str(), methods_page()) << "Make it anew: gnomon methods > docs/methods.md";
}

}  // namespace
}  // namespace gnomon::gl
