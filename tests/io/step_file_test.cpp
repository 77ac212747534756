#include <gnomon/io/step_file.h>
#include <gnomon/io/step_string.h>
#include <gtest/gtest.h>

namespace gnomon {
namespace {

using Kind = StepValue::Kind;

std::string step(const std::string& data) {
  return "ISO-10303-21;\nHEADER;\nFILE_SCHEMA(('IFC2X3'));\nENDSEC;\nDATA;\n" + data +
         "\nENDSEC;\nEND-ISO-10303-21;\n";
}

std::vector<StepValue> arguments(const std::string& list) {
  const std::string text = step("#1=A" + list + ";");
  const auto file = read_step(text, "t.ifc");
  if (!file) {
    ADD_FAILURE() << file.error().message;
    return {};
  }
  return arguments_of(*find(file.value(), 1));
}

void expect_failure(const std::string& text, const std::string& line, const std::string& part) {
  const auto file = read_step(text, "t.ifc");
  ASSERT_FALSE(file) << text;
  const std::string& message = file.error().message;
  EXPECT_TRUE(message.starts_with("t.ifc: line " + line + ": ")) << message;
  EXPECT_NE(message.find(part), std::string::npos) << message;
}

TEST(StepFile, EveryKindOfValueIsRead) {
  const auto a = arguments("($,*,-12,1.E-3,'x',.T.,\"0F\",#77,(1,(2.)),IFCLABEL('y'),())");
  ASSERT_EQ(a.size(), 11u);
  EXPECT_EQ(a[0].kind, Kind::kNull);
  EXPECT_EQ(a[1].kind, Kind::kDerived);
  EXPECT_EQ(a[2].number, -12);
  EXPECT_EQ(a[3].number, 0.001);
  EXPECT_EQ(a[4].text, "x");
  EXPECT_EQ(a[5].kind, Kind::kEnumeration);
  EXPECT_EQ(a[5].text, "T");
  EXPECT_EQ(a[6].text, "0F");
  EXPECT_EQ(a[7].reference, 77u);
  EXPECT_EQ(a[8].items[1].items[0].number, 2);
  EXPECT_EQ(a[9].kind, Kind::kTyped);
  EXPECT_EQ(a[9].text, "IFCLABEL");
  EXPECT_EQ(a[9].items[0].text, "y");
  EXPECT_EQ(a[10].kind, Kind::kList);
  EXPECT_TRUE(a[10].items.empty());
}

TEST(StepFile, CommentsSpacesAndLineBreaksMayStandAnywhere) {
  const std::string text =
      "\n/* first */ISO-10303-21 ;HEADER;FILE_SCHEMA ( ( 'IFC4' , 'X' ) ) ;ENDSEC;DATA;"
      "/* #1=B(); */#1 =\r\n A ( /* ' */ 1 , '/* no comment */' ) ; ENDSEC ; END-ISO-10303-21;";
  const auto file = read_step(text, "t.ifc");
  ASSERT_TRUE(file) << file.error().message;
  EXPECT_EQ(file.value().schemas, (std::vector<std::string>{"IFC4", "X"}));
  ASSERT_EQ(file.value().instances.size(), 1u);
  EXPECT_EQ(file.value().instances[0].keyword, "A");
  EXPECT_EQ(arguments_of(file.value().instances[0])[1].text, "/* no comment */");
  EXPECT_EQ(where(file.value(), file.value().instances[0]), "t.ifc: line 3: ");
}

TEST(StepFile, InstancesAreFoundByTheirNumbersInAnyOrder) {
  const std::string text = step("#9=A(#3,(#3,#18446744073709551615));\n#3=B();\n#4=(C(1)D(#9));");
  const auto file = read_step(text, "t.ifc");
  ASSERT_TRUE(file) << file.error().message;
  EXPECT_EQ(find(file.value(), 3)->keyword, "B");
  EXPECT_EQ(find(file.value(), 5), nullptr);
  std::vector<std::uint64_t> ids;
  for (const StepInstance& i : file.value().instances) references_of(i, ids);
  EXPECT_EQ(ids, (std::vector<std::uint64_t>{3, 3, 18446744073709551615u, 9}));
  const auto complex = arguments_of(*find(file.value(), 4));
  ASSERT_EQ(complex.size(), 2u);
  EXPECT_EQ(complex[1].text, "D");
}

TEST(StepFile, StringsBecomeUtf8) {
  EXPECT_EQ(decode_step_string("It''s"), "It's");
  EXPECT_EQ(decode_step_string("Gel\\S\\dnde"), "Gelände");
  EXPECT_EQ(decode_step_string("\\X\\E4"), "ä");
  EXPECT_EQ(decode_step_string("T\\X2\\00FC0072\\X0\\!"), "Tür!");
  EXPECT_EQ(decode_step_string("\\X2\\D83CDFE0\\X0\\"), "🏠");
  EXPECT_EQ(decode_step_string("\\X4\\0001F3E0\\X0\\"), "🏠");
  EXPECT_EQ(decode_step_string("S:\\\\a"), "S:\\a");
  EXPECT_EQ(decode_step_string("schön"), "schön");
  EXPECT_EQ(decode_step_string("sch\xF6n"), "schön");
  EXPECT_EQ(decode_step_string("a\r\nb"), "ab");
  EXPECT_EQ(decode_step_string("\\PB\\\\S\\d"), "\uFFFD");
}

TEST(StepFile, BrokenEscapesStayAsTheyAre) {
  for (const std::string text : {"C:\\temp", "\\X2\\00F", "\\X2\\00FG\\X0\\", "\\X\\Z", "\\S\\",
                                 "\\", "\\X4\\0001\\X0\\", "\\P"}) {
    EXPECT_EQ(decode_step_string(text), text);
  }
  EXPECT_EQ(decode_step_string("\\X2\\D83C\\X0\\"), "\uFFFD");  // half a letter
}

TEST(StepFile, WhatIsNoStepFileIsAnError) {
  expect_failure("solid x", "1", "not a STEP file");
  expect_failure("ISO-10303-21;\nDATA;\n", "2", "HEADER should follow");
  expect_failure(
      "ISO-10303-21;\nHEADER;\nENDSEC;\nANCHOR;\nENDSEC;\nDATA;\nENDSEC;\nEND-ISO-10303-21;", "4",
      "\"ANCHOR;\" stands where DATA");
  expect_failure("ISO-10303-21;\nHEADER;\nENDSEC;\nEND-ISO-10303-21;", "4", "no DATA section");
}

TEST(StepFile, ErrorsNameTheLine) {
  expect_failure(step("#1=A(1);\n#1=B();"), "7", "#1 is given twice");
  expect_failure(step("#1=A(1;"), "6", "comma or a parenthesis");
  expect_failure(step("#1=A(1 2);"), "6", "\"2);\" stands where");
  expect_failure(step("#1=A(1,);"), "6", "\");\" is not a value");
  expect_failure(step("\n#1=A(#x);"), "7", "not the number of an entity");
  expect_failure(step("#99999999999999999999=A();"), "6", "not the number of an entity");
  expect_failure(step("#1=A(1.#QNAN);"), "6", "not a number");
  expect_failure(step("#1=A(-inf);"), "6", "not a finite number");
  expect_failure(step("#1=A(1.E999);"), "6", "not a finite number");
  expect_failure(step("#1=A(nan);"), "6", "parenthesis should follow \"nan\"");
  expect_failure(step("#1=A(.T);"), "6", "\".T);\" is not a value");
  expect_failure(step("#1=A(?);"), "6", "is not a value");
  expect_failure(step("#1 A();"), "6", "= should follow");
  expect_failure(step("A();"), "6", "is not an entity");
  expect_failure(step("#1=A()\n#2=B();"), "7", "; should follow the entity");
  expect_failure(step("#1=A('x);\n#2=B();"), "6", "string does not end");
  expect_failure(step("/* #1=A();"), "6", "comment does not end");
  expect_failure(step("#1=(A(1)2);"), "6", "not a part of an entity");
}

TEST(StepFile, DeepListsAreAnErrorAndNoCrash) {
  EXPECT_EQ(arguments("(" + std::string(90, '(') + std::string(90, ')') + ")").size(), 1u);
  expect_failure(step("#1=A" + std::string(1000000, '(')), "6", "nested deeper than 100");
  std::string typed;
  for (int k = 0; k < 100000; ++k) typed += "A(";
  expect_failure(step("#1=" + typed), "6", "nested deeper than 100");
}

TEST(StepFile, EveryTruncationIsAnErrorThatNamesTheLine) {
  std::string text = step("#1=A($,*,-12,1.E-3,'x''y',.T.,\"0F\",#77,(1,(2.)),B('y')); /* c */");
  text.pop_back();  // the last line's end
  ASSERT_TRUE(read_step(text, "t.ifc"));
  for (std::size_t size = 0; size < text.size(); ++size) {
    const auto file = read_step(std::string_view(text).substr(0, size), "t.ifc");
    ASSERT_FALSE(file) << size;
    EXPECT_TRUE(file.error().message.starts_with("t.ifc: line ")) << file.error().message;
  }
}

TEST(StepFile, ChangedBytesNeverCrash) {
  const std::string text = step("#1=A($,*,-12,1.E-3,'\\X2\\00FC\\X0\\',.T.,\"0F\",#77,(1,(2.)));");
  std::size_t read = 0;
  for (std::size_t at = 0; at < text.size(); ++at) {
    for (const char c : std::string("\0'(),.;#*\\/\"A1-\xE4", 16)) {
      std::string changed = text;
      changed[at] = c;
      const auto file = read_step(changed, "t.ifc");
      if (!file) continue;
      ++read;
      for (const StepInstance& i : file.value().instances) arguments_of(i);
    }
  }
  EXPECT_GT(read, 0u);
}

}  // namespace
}  // namespace gnomon
