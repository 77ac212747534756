#include <gnomon/io/write_summary_csv.h>
#include <gtest/gtest.h>
#include <io/write_test_files.h>

#include <sstream>

namespace gnomon {
namespace {

using testing::TestFolder;

constexpr std::uint32_t kHour = 3'600'000;

// Four surfaces: a house of two parts, one with an awkward name, one without; a triangle each.
struct Town {
  Scene scene;
  Receivers receivers;
  Profile profile;
};

Town town() {
  Town t;
  for (const char* object : {"house/1", "house/2", "say \"hi\", twice", "", "unseen"}) {
    Surface s;
    s.object = object;
    if (s.object.starts_with("house/")) s.whole = 5;
    t.scene.surface_of.push_back(static_cast<std::uint32_t>(t.scene.surfaces.size()));
    t.scene.surfaces.push_back(s);
  }
  View& v = t.receivers.view;
  v.eye = {0, 0, 1, 0};
  v.origin = {0, 0, 0, 1};
  v.right = {0.5, 0, 0, 0};
  v.down = {0, -0.5, 0, 0};
  v.width = 9;
  v.height = 1;
  t.receivers.triangle = {0, 0, 1, 2, 2, 3, kNoTriangle, 1, 3};
  Profile& p = t.profile;
  p.width = 9;
  p.height = 1;
  p.valid = {1, 1, 1, 1, 1, 1, 0, 1, 1};
  p.daylight_ticks = 5 * kHour / 2;
  p.shadow_ticks = {0, kHour - 1, kHour, 2 * kHour, 5 * kHour / 2, 0, 0, 3 * kHour / 2, kHour};
  return t;
}

TEST(SummaryCsv, ListsAreasPerClassForAllAndThenPerObject) {
  const TestFolder folder;
  const Town t = town();
  const auto objects = hours_by_object(t.profile, t.receivers, t.scene, kHour);
  ASSERT_TRUE(
      write_summary_csv(folder / "summary.csv", t.profile, t.receivers.view, objects, kHour));
  EXPECT_EQ(testing::content(folder / "summary.csv"),
            "object,class_from_h,class_to_h,area_m2,samples\n"
            "(all),0,1,0.75,3\n"
            "(all),1,2,0.75,3\n"
            "(all),2,2.5,0.5,2\n"
            "house,0,1,0.5,2\n"
            "house,1,2,0.5,2\n"
            "house,2,2.5,0,0\n"
            "\"say \"\"hi\"\", twice\",0,1,0,0\n"
            "\"say \"\"hi\"\", twice\",1,2,0,0\n"
            "\"say \"\"hi\"\", twice\",2,2.5,0.5,2\n"
            "(no name),0,1,0.25,1\n"
            "(no name),1,2,0.25,1\n"
            "(no name),2,2.5,0,0\n");
}

TEST(SummaryCsv, ObjectsHaveLeastMeanAndMostHours) {
  const TestFolder folder;
  Town t = town();
  const auto objects = hours_by_object(t.profile, t.receivers, t.scene, kHour);
  ASSERT_TRUE(write_objects_csv(folder / "objects.csv", t.profile, t.receivers.view, objects));
  const std::string text = testing::content(folder / "objects.csv");
  EXPECT_EQ(text.substr(0, text.find('\n')),
            "object,area_m2,samples,min_shadow_h,mean_shadow_h,max_shadow_h");
  EXPECT_NE(text.find("\n\"say \"\"hi\"\", twice\",0.5,2,2,2.25,2.5\n"), std::string::npos) << text;
  EXPECT_NE(text.find("\n(no name),0.5,2,0,0.5,1\n"), std::string::npos) << text;
}

TEST(SummaryCsv, ClassesAndObjectsAddUpToAll) {
  Town t = town();
  for (const int days : {1, 3}) {
    t.profile.days = days;
    for (const std::uint64_t step : {kHour / 4, kHour, 9 * kHour}) {
      const auto objects = hours_by_object(t.profile, t.receivers, t.scene, step);
      std::vector<std::uint64_t> sums(objects[0].classes.size(), 0);
      std::uint64_t samples = 0;
      for (std::size_t k = 1; k < objects.size(); ++k) {
        samples += objects[k].samples;
        for (std::size_t c = 0; c < sums.size(); ++c) sums[c] += objects[k].classes[c];
      }
      EXPECT_EQ(sums, objects[0].classes);
      EXPECT_EQ(samples, objects[0].samples);
      EXPECT_EQ(objects[0].samples, 8u);
    }
  }
}

TEST(SummaryCsv, OfNoSampleAtAllHasOnlyTheRowsOfAll) {
  Town t = town();
  t.profile.valid.assign(9, 0);
  const auto objects = hours_by_object(t.profile, t.receivers, t.scene, kHour);
  ASSERT_EQ(objects.size(), 1u);
  const TestFolder folder;
  ASSERT_TRUE(write_objects_csv(folder / "objects.csv", t.profile, t.receivers.view, objects));
  EXPECT_NE(testing::content(folder / "objects.csv").find("(all),0,0,,,\n"), std::string::npos);
}

TEST(SummaryCsv, FieldsAreQuotedOnlyWhereTheyMustBe) {
  EXPECT_EQ(csv_field("a b"), "a b");
  EXPECT_EQ(csv_field("a,b"), "\"a,b\"");
  EXPECT_EQ(csv_field("a\"b"), "\"a\"\"b\"");
  EXPECT_EQ(csv_field("a\nb"), "\"a\nb\"");
}

}  // namespace
}  // namespace gnomon
