#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include <gnomon/core/exact.h>

namespace gnomon {
namespace {

__extension__ typedef __int128 Wide;

TEST(Dyadic, SumsAndProductsOfIntegersAreExact) {
  std::mt19937_64 random(1);
  for (int k = 0; k < 20000; ++k) {
    // 50-bit integers: the double is exact, their product needs 100 bits.
    const auto draw = [&] {
      return static_cast<std::int64_t>(random() >> 14) - (std::int64_t{1} << 49);
    };
    const std::int64_t a = draw(), b = draw(), c = draw(), d = draw();
    const Wide expected = static_cast<Wide>(a) * b - static_cast<Wide>(c) * d;
    const auto num = [](std::int64_t v) { return Dyadic(static_cast<double>(v)); };
    const Dyadic got = num(a) * num(b) - num(c) * num(d);
    ASSERT_EQ(got.sign(), expected > 0 ? 1 : expected < 0 ? -1 : 0);
    ASSERT_EQ((got - got).sign(), 0);
  }
}

TEST(Dyadic, KeepsTheLastBitBesideHugeNumbers) {
  const Dyadic huge(1e12), tiny(kSmallestCoordinate);
  EXPECT_EQ(((huge + tiny) - huge).sign(), 1);
  EXPECT_EQ(((huge - tiny) - huge).sign(), -1);
  EXPECT_EQ(((huge * huge + tiny * tiny) - huge * huge - tiny * tiny).sign(), 0);
}

TEST(Dyadic, HoldsTheLargestProductOfAnyPredicate) {
  // Full mantissas at both ends of the range, as in |r;e| |c;q|.
  const double big = std::nextafter(kLargestCoordinate, 0.0),
               small = std::nextafter(kSmallestCoordinate, 1.0);
  Dyadic coordinate = Dyadic(big) + Dyadic(small);
  Dyadic product(1.0);
  for (int k = 0; k < 9; ++k) product = product * coordinate;
  EXPECT_EQ((product - product).sign(), 0);
  EXPECT_EQ(product.sign(), 1);
}

TEST(Approx, BoundContainsTheExactValue) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> u(-1000, 1000);
  int decided = 0;
  for (int k = 0; k < 5000; ++k) {
    H4<Approx> a[4];
    H4<Dyadic> d[4];
    for (int i = 0; i < 4; ++i) {
      const Vec4 v(u(random), u(random), u(random), 1);
      a[i] = lift<Approx>(v);
      d[i] = lift<Dyadic>(v);
    }
    // Nearly coplanar every other time: the fourth point close to a combination of the others.
    if (k % 2 == 0) {
      const Vec4 v(a[0].x.value + a[1].x.value - a[2].x.value,
                   a[0].y.value + a[1].y.value - a[2].y.value,
                   a[0].z.value + a[1].z.value - a[2].z.value, 1);
      a[3] = lift<Approx>(v);
      d[3] = lift<Dyadic>(v);
    }
    const Approx approx = det4(a[0], a[1], a[2], a[3]);
    const Dyadic exact = det4(d[0], d[1], d[2], d[3]);
    // |approx - exact| <= error
    EXPECT_GE((Dyadic(approx.error) - (Dyadic(approx.value) - exact)).sign(), 0);
    EXPECT_GE((Dyadic(approx.error) + (Dyadic(approx.value) - exact)).sign(), 0);
    if (approx.certain()) {
      ++decided;
      EXPECT_EQ(approx.sign(), exact.sign());
    }
  }
  EXPECT_GT(decided, 2400);
}

TEST(Bound, ContainsEveryApproxOverTheSameFormula) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> u(-500, 500);
  H4<Bound> b[4];
  for (auto& p : b) p = {Bound(500.0), Bound(500.0), Bound(500.0), Bound(1.0)};
  const Bound bound = det4(b[0], b[1], b[2], b[3]);
  for (int k = 0; k < 2000; ++k) {
    H4<Approx> a[4];
    for (auto& p : a) p = lift<Approx>(Vec4(u(random), u(random), u(random), 1));
    const Approx approx = det4(a[0], a[1], a[2], a[3]);
    EXPECT_LE(approx.error, bound.error);
    EXPECT_LE(std::fabs(approx.value), bound.magnitude);
  }
}

TEST(LightSide, IsNeverZeroForATriangleWithArea) {
  ExactStats stats;
  const Vec3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
  EXPECT_NE(light_side(a, b, c, Light(1, 0, 0, 0), stats), 0);  // light in the plane
  EXPECT_NE(light_side(a, b, c, Light(0.25, 0.25, 0, 1), stats), 0);
  EXPECT_NE(light_side(a, b, c, Light(0, 0, 0, 1), stats), 0);  // light at a vertex
  EXPECT_EQ(stats.ties, 3u);
}

TEST(LightSide, OfATriangleWithoutAreaIsTheSameForEveryLight) {
  ExactStats stats;
  for (const Vec3& c : {Vec3(3, 3, 3), Vec3(1, 1, 1), Vec3(0, 0, 0)}) {
    for (const Light& l : {Light(1, 2, 0, 0), Light(5, 7, 3, 1), Light(0, 0, -1, 0)})
      EXPECT_EQ(light_side({0, 0, 0}, {1, 1, 1}, c, l, stats), -1);
  }
}

TEST(LightSide, TiesAreBrokenTheSameWayForEveryVertexOrder) {
  ExactStats stats;
  const Vec3 a(0, 0, 3), b(1, 0, 3), c(0, 1, 3);
  for (const Light& l : {Light(1, 2, 0, 0), Light(5, 7, 3, 1)}) {
    const int s = light_side(a, b, c, l, stats);
    EXPECT_EQ(light_side(b, c, a, l, stats), s);
    EXPECT_EQ(light_side(b, a, c, l, stats), -s);
  }
}

TEST(ZeroArea, IsExact) {
  EXPECT_TRUE(zero_area({0, 0, 0}, {1, 1, 1}, {3, 3, 3}));
  EXPECT_FALSE(zero_area({0, 0, 0}, {1, 1, 1}, {3, 3, std::nextafter(3.0, 4.0)}));
  EXPECT_TRUE(zero_area({0.1, 0.2, 0.3}, {0.1, 0.2, 0.3}, {5, 6, 7}));
}

}  // namespace
}  // namespace gnomon
