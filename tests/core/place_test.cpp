#include <gnomon/core/place.h>

#include <gtest/gtest.h>

namespace gnomon {
namespace {

TEST(Place, DistancesAreThoseOfASphere) {
  const Place pole{90 * kDegree, 0, 0}, equator{0, 123 * kDegree, 500};
  EXPECT_NEAR(distance_between(pole, equator), 6371008.8 * kPi / 2, 1e-3);
  EXPECT_EQ(distance_between(pole, pole), 0);
  EXPECT_NEAR(distance_between({0, -179 * kDegree, 0}, {0, 179 * kDegree, 0}),
              6371008.8 * 2 * kDegree, 1e-3);
}

}  // namespace
}  // namespace gnomon
