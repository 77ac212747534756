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

TEST(ZonePlace, DistancesAreThoseOfASphere) {
  const Place pole{90 * kDegree, 0, 0}, equator{0, 123 * kDegree, 500};
  EXPECT_NEAR(surface_distance(pole, equator), 6371e3 * kPi / 2, 1e-3);
  EXPECT_EQ(surface_distance(pole, pole), 0);
  EXPECT_NEAR(surface_distance({0, -179 * kDegree, 0}, {0, 179 * kDegree, 0}), 6371e3 * 2 * kDegree,
              1e-3);
}

}  // namespace
}  // namespace gnomon
