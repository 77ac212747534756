#include <gnomon/core/utf8.h>
#include <gtest/gtest.h>

#include <string>

namespace gnomon {
namespace {

TEST(Utf8, CharactersOfOneToFourBytesAreRead) {
  const std::string text = "a\xC3\xBC\xE2\x82\xAC\xF0\x9F\x8F\xA0";
  std::u32string codes;
  for (std::size_t k = 0; k < text.size();) {
    const Utf8Character c = next_character(std::string_view(text).substr(k));
    EXPECT_TRUE(c.valid);
    codes += c.code;
    k += c.bytes;
  }
  EXPECT_EQ(codes, U"a\u00fc\u20ac\U0001F3E0");
}

TEST(Utf8, OverlongFormsSurrogatesAndBrokenEndsAreNot) {
  for (const std::string_view bad :
       {"\xC0\xAF", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xE2\x82", "\x80"}) {
    const Utf8Character c = next_character(bad);
    EXPECT_FALSE(c.valid);
    EXPECT_GE(c.bytes, 1u);
  }
}

}  // namespace
}  // namespace gnomon
