#include <gnomon/sun/zone_place.h>

#include <gtest/gtest.h>

namespace gnomon {
namespace {

TEST(ZonePlace, OfViennaIsVienna) {
  const auto vienna = zone_reference("Europe/Vienna");
  if (!vienna) GTEST_SKIP() << "no zone.tab on this machine";
  EXPECT_NEAR(vienna->latitude / kDegree, 48 + 13.0 / 60, 1e-9);
  EXPECT_NEAR(vienna->longitude / kDegree, 16 + 20.0 / 60, 1e-9);
}

TEST(ZonePlace, HasSignsAndSeconds) {
  const auto new_york = zone_reference("America/New_York");
  if (!new_york) GTEST_SKIP() << "no zone.tab on this machine";
  EXPECT_NEAR(new_york->latitude / kDegree, 40 + 42.0 / 60 + 51.0 / 3600, 1e-9);
  EXPECT_NEAR(new_york->longitude / kDegree, -(74 + 0.0 / 60 + 23.0 / 3600), 1e-9);
}

TEST(ZonePlace, IsNoneOfClocksWithoutAHome) {
  for (const char* zone : {"UTC", "solar", "", "Europe/Atlantis"})
    EXPECT_FALSE(zone_reference(zone)) << zone;
}

}  // namespace
}  // namespace gnomon
