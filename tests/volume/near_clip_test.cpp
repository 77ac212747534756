#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include <glm/geometric.hpp>

#include "soup.h"

#include <gnomon/core/exact.h>
#include <gnomon/volume/near_clip.h>

namespace gnomon {
namespace {

using Rectangle = std::array<Vec3, 4>;
constexpr double kFar = 1e4;  // where the slow form ends a directional light's prism

// The rectangle z = 0, |x| <= 2, |y| <= 1.
const Rectangle kFlat = {Vec3(-2, -1, 0), Vec3(2, -1, 0), Vec3(2, 1, 0), Vec3(-2, 1, 0)};

bool box_may(const Rectangle& r, const Light& light, const Vec3& lo, const Vec3& hi) {
  return may_shade_near(near_clip_volume(r, light), lo, hi);
}

// Slow and clear: the faces of the volume clipped by the box, and the box's centre in the volume.
bool meets_by_clipping(const Rectangle& r, const Light& light, const Vec3& lo, const Vec3& hi) {
  std::vector<std::vector<Vec3>> faces = {{r[0], r[1], r[2], r[3]}};
  const Vec3 l(light.x, light.y, light.z);
  std::array<Vec3, 4> end;
  for (std::size_t k = 0; k < 4; ++k) end[k] = light.w == 0 ? r[k] + kFar * glm::normalize(l) : l;
  Vec3 middle(0.0);
  for (std::size_t k = 0; k < 4; ++k) {
    middle += (r[k] + end[k]) / 8.0;
    faces.push_back({r[k], r[(k + 1) % 4], end[(k + 1) % 4], end[k]});
  }
  if (light.w == 0) faces.push_back({end[0], end[1], end[2], end[3]});
  const Vec3 centre = (lo + hi) / 2.0;
  bool inside = true;
  for (std::vector<Vec3> f : faces) {
    const Vec3 n = glm::cross(f[1] - f[0], f[2] - f[0]);
    if (glm::dot(n, centre - f[0]) * glm::dot(n, middle - f[0]) < 0) inside = false;
    for (int axis = 0; axis < 3; ++axis) {
      for (const double sign : {1.0, -1.0}) {
        std::vector<Vec3> kept;
        const auto f_of = [&](const Vec3& p) {
          return sign * (p[axis] - (sign > 0 ? lo[axis] : hi[axis]));
        };
        for (std::size_t k = 0; k < f.size(); ++k) {
          const Vec3 &p = f[k], &q = f[(k + 1) % f.size()];
          const double fp = f_of(p), fq = f_of(q);
          if (fp >= 0) kept.push_back(p);
          if (fp * fq < 0) kept.push_back(p + (q - p) * (fp / (fp - fq)));
        }
        f = kept;
      }
    }
    if (!f.empty()) return true;
  }
  return inside;
}

Rectangle random_rectangle(std::mt19937& random) {
  std::uniform_real_distribution<double> u(-1, 1);
  const auto vec = [&] { return Vec3(u(random), u(random), u(random)); };
  const Vec3 forward = glm::normalize(vec()), right = glm::normalize(glm::cross(forward, vec())),
             up = glm::cross(right, forward);
  const Vec3 c = 3.0 * vec();
  const double w = 0.1 + std::fabs(u(random)), h = 0.1 + std::fabs(u(random));
  return {c - w * right - h * up, c + w * right - h * up, c + w * right + h * up,
          c - w * right + h * up};
}

TEST(NearClip, HoldsWhatStandsBetweenTheNearRectangleAndALamp) {
  const Light lamp(0, 0, 10, 1);
  EXPECT_TRUE(box_may(kFlat, lamp, {-0.1, -0.1, 5}, {0.1, 0.1, 5.1}));
  EXPECT_TRUE(box_may(kFlat, lamp, {-50, -50, 5}, {50, 50, 6}));           // much larger
  EXPECT_FALSE(box_may(kFlat, lamp, {-0.1, -0.1, -1}, {0.1, 0.1, -0.1}));  // behind the rectangle
  EXPECT_FALSE(box_may(kFlat, lamp, {-0.1, -0.1, 10.1}, {0.1, 0.1, 11}));  // behind the lamp
  EXPECT_FALSE(box_may(kFlat, lamp, {1.1, -1, 5}, {2, 1, 6}));             // beside the pyramid
  EXPECT_TRUE(box_may(kFlat, lamp, {0.9, -1, 5}, {2, 1, 6}));
}

TEST(NearClip, OfASunIsAPrismWithoutEnd) {
  const Light sun(0.3, 0, 1, 0);
  EXPECT_TRUE(box_may(kFlat, sun, {299, -1, 1000}, {301, 1, 1001}));
  EXPECT_FALSE(box_may(kFlat, sun, {303, -1, 1000}, {305, 1, 1001}));
  EXPECT_FALSE(box_may(kFlat, sun, {-301, -1, -1001}, {-299, 1, -1000}));  // away from the sun
}

TEST(NearClip, TouchingIsNotProvedApartAndOneUnitInTheLastPlaceIsForLevelSides) {
  const Light lamp(0, 0, 10, 1), sun(0, 0, 1, 0);
  EXPECT_TRUE(box_may(kFlat, lamp, {-1, -1, -1}, {1, 1, 0}));
  EXPECT_FALSE(box_may(kFlat, lamp, {-1, -1, -1}, {1, 1, -0x1p-60}));
  EXPECT_TRUE(box_may(kFlat, sun, {2, -1, 5}, {3, 1, 6}));
  EXPECT_FALSE(box_may(kFlat, sun, {std::nextafter(2.0, 3.0), -1, 5}, {3, 1, 6}));
}

TEST(NearClip, KeepsThePlanesThatHoldASunsDirectionExactly) {
  // A square turned by 45 degrees: only its own sides rule out what stands beside a corner.
  const Rectangle turned = {Vec3(2, 0, 0), Vec3(0, 2, 0), Vec3(-2, 0, 0), Vec3(0, -2, 0)};
  const Light zenith(0, 0, 1, 0);
  EXPECT_EQ(near_clip_volume(turned, zenith).size, 4 + 1 + 4 + 2 * 2 + 2 * 3);
  EXPECT_FALSE(box_may(turned, zenith, {1.25, 1.25, 3}, {1.5, 1.5, 4}));
  EXPECT_TRUE(box_may(turned, zenith, {0.75, 0.75, 3}, {1.5, 1.5, 4}));
}

TEST(NearClip, OfALightInTheNearPlaneIsFlatAndStaysProvable) {
  for (const Light& light : {Light(7, 0.25, 0, 1), Light(1, 0.5, 0, 0)}) {
    EXPECT_TRUE(box_may(kFlat, light, {3, -0.5, -1}, {3.5, 2, 1}));        // cut by the plane
    EXPECT_FALSE(box_may(kFlat, light, {3, -0.5, 0x1p-40}, {3.5, 2, 1}));  // just in front of it
    EXPECT_FALSE(box_may(kFlat, light, {3, -0.5, -1}, {3.5, 2, -0x1p-40}));
    EXPECT_FALSE(box_may(kFlat, light, {3, -9, -1}, {3.5, -8, 1}));  // beside it
  }
}

TEST(NearClip, OfALightOnTheRectangleIsTheRectangle) {
  for (const Light& light : {Light(0, 0, 0, 1), Light(2, 1, 0, 1)}) {
    EXPECT_TRUE(box_may(kFlat, light, {-1, -1, -1}, {1, 1, 1}));
    EXPECT_FALSE(box_may(kFlat, light, {-1, -1, 0x1p-40}, {1, 1, 1}));
    EXPECT_FALSE(box_may(kFlat, light, {2.5, -1, -1}, {3, 1, 1}));
  }
}

TEST(NearClip, HomogeneousLightsMeanTheSamePoint) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> u(-4, 4);
  for (int k = 0; k < 500; ++k) {
    const Rectangle r = random_rectangle(random);
    const Vec3 l(u(random), u(random), u(random)), c(u(random), u(random), u(random));
    EXPECT_EQ(box_may(r, Light(l, 1), c - 0.5, c + 0.5),
              box_may(r, Light(4.0 * l, 4), c - 0.5, c + 0.5));
  }
}

TEST(NearClip, AnswersForBoxesEqualClippingTheVolumeByTheBox) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u(-5, 5);
  int may = 0, never = 0;
  for (int k = 0; k < 20000; ++k) {
    const Rectangle r = random_rectangle(random);
    const Light light(u(random), u(random), u(random), k % 2);
    const Vec3 c(u(random), u(random), u(random));
    const Vec3 half(0.02 + std::fabs(u(random)) / (1 + k % 7), 0.02 + std::fabs(u(random)) / 5,
                    0.02 + std::fabs(u(random)) / (1 + k % 3));
    const bool meets = meets_by_clipping(r, light, c - half, c + half);
    EXPECT_EQ(box_may(r, light, c - half, c + half), meets) << k;
    ++(meets ? may : never);
  }
  EXPECT_GT(may, 1000);
  EXPECT_GT(never, 3000);
}

int sign4(const Vec4& a, const Vec4& b, const Vec4& c, const Vec4& d) {
  ExactStats ignored;
  return tie_sign({}, ignored, [&]<class T>(int, int, int) {
    return det4<T>(lift<T>(a), lift<T>(b), lift<T>(c), lift<T>(d));
  });
}

// Exactly: the triangle and the closed segment from x to the light have a point in common (general
// position).
bool crosses(const Vec3& a, const Vec3& b, const Vec3& c, const Vec4& x, const Light& light) {
  const Vec4 p = point(a), q = point(b), r = point(c);
  const int f = sign4(p, q, r, x);
  if (f * sign4(p, q, r, light) > 0) return false;
  return f * sign4(light, x, p, q) >= 0 && f * sign4(light, x, q, r) >= 0 &&
         f * sign4(light, x, r, p) >= 0;
}

TEST(NearClip, NoTriangleThatIsRuledOutCrossesASegmentFromTheRectangleToTheLight) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> u(-4, 4), unit(0, 1);
  int ruled_out = 0, hits = 0;
  for (int k = 0; k < 6000; ++k) {
    const Rectangle r = random_rectangle(random);
    const Light light(u(random), u(random), u(random), k % 2);
    const Vec3 c(u(random), u(random), u(random));
    const auto corner = [&] { return c + Vec3(u(random), u(random), u(random)) / 3.0; };
    const std::array<Vec3, 3> t = {corner(), corner(), corner()};
    TriMesh mesh;
    mesh.positions.assign(t.begin(), t.end());
    mesh.triangles = {{0, 1, 2}};
    const NearClip near = near_clip_volume(r, light);
    const std::uint32_t only[] = {0};
    const bool may = may_shade_near(near, t);
    EXPECT_EQ(may, may_shade_near(near, mesh, only));
    const bool may_alone = may_any_shade_near(near, mesh, only);
    EXPECT_TRUE(may || !may_alone);
    ruled_out += !may;
    for (int j = 0; j < 30; ++j) {
      const double a = unit(random), b = unit(random);
      const Vec3 x = r[0] + a * (r[1] - r[0]) + b * (r[3] - r[0]);
      const bool crossed = crosses(t[0], t[1], t[2], point(x), light);
      hits += crossed;
      EXPECT_FALSE(crossed && !may_alone) << k;
    }
  }
  EXPECT_GT(ruled_out, 1000);
  EXPECT_GT(hits, 500);
}

// Slow and clear: the triangle clipped by the planes of the volume.
bool triangle_meets_by_clipping(const Rectangle& r, const Light& light,
                                const std::array<Vec3, 3>& t) {
  const Vec3 l(light);
  std::array<Vec3, 4> end;
  for (std::size_t k = 0; k < 4; ++k) end[k] = light.w == 0 ? r[k] + kFar * glm::normalize(l) : l;
  Vec3 middle(0.0);
  for (std::size_t k = 0; k < 4; ++k) middle += (r[k] + end[k]) / 8.0;
  std::vector<std::array<Vec3, 3>> planes = {{r[0], r[1], r[2]}};
  if (light.w == 0) planes.push_back({end[0], end[1], end[2]});
  for (std::size_t k = 0; k < 4; ++k) planes.push_back({r[k], r[(k + 1) % 4], end[k]});
  std::vector<Vec3> f(t.begin(), t.end());
  for (const auto& p : planes) {
    Vec3 n = glm::normalize(glm::cross(p[1] - p[0], p[2] - p[0]));
    if (glm::dot(n, middle - p[0]) < 0) n = -n;
    std::vector<Vec3> kept;
    for (std::size_t k = 0; k < f.size(); ++k) {
      const Vec3 &a = f[k], &b = f[(k + 1) % f.size()];
      const double fa = glm::dot(n, a - p[0]), fb = glm::dot(n, b - p[0]);
      if (fa >= 0) kept.push_back(a);
      if (fa * fb < 0) kept.push_back(a + (b - a) * (fa / (fa - fb)));
    }
    f = kept;
  }
  return !f.empty();
}

TEST(NearClip, AnswersForTrianglesEqualClippingThemByTheVolume) {
  std::mt19937 random(13);
  std::uniform_real_distribution<double> u(-5, 5);
  int may = 0, never = 0;
  for (int k = 0; k < 20000; ++k) {
    const Rectangle r = random_rectangle(random);
    const Light light(u(random), u(random), u(random), k % 2);
    TriMesh m;
    const Vec3 c(u(random), u(random), u(random));
    for (int j = 0; j < 3; ++j) {
      m.positions.push_back(c + Vec3(u(random), u(random), u(random)) / (1.0 + k % 5));
    }
    m.triangles = {{0, 1, 2}};
    const std::uint32_t only[] = {0};
    const bool meets =
        triangle_meets_by_clipping(r, light, {m.positions[0], m.positions[1], m.positions[2]});
    EXPECT_EQ(may_any_shade_near(near_clip_volume(r, light), m, only), meets) << k;
    ++(meets ? may : never);
  }
  EXPECT_GT(may, 500);
  EXPECT_GT(never, 3000);
}

TEST(NearClip, AValleysFloorAndSlopesDoNotShadeAViewThatTheirHullHolds) {
  // A camera above the floor of a valley, a sun above: no slope is between them.
  TriMesh m;
  test::add_quad(m, {-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0});
  test::add_quad(m, {9, -9, 0}, {30, -9, 9}, {30, 9, 9}, {9, 9, 0});
  test::add_quad(m, {-30, -9, 9}, {-9, -9, 0}, {-9, 9, 0}, {-30, 9, 9});
  std::vector<std::uint32_t> all(m.triangles.size());
  for (std::uint32_t t = 0; t < all.size(); ++t) all[t] = t;
  const Rectangle r = {Vec3(0, -0.1, 1.6), Vec3(0, 0.1, 1.6), Vec3(0, 0.1, 1.8),
                       Vec3(0, -0.1, 1.8)};
  const NearClip high = near_clip_volume(r, Light(1, 0, 1, 0)),
                 low = near_clip_volume(r, Light(1, 0, 0.1, 0));
  EXPECT_TRUE(may_shade_near(high, m, all));
  EXPECT_FALSE(may_any_shade_near(high, m, all));
  EXPECT_TRUE(may_any_shade_near(low, m, all));  // now the eastern slope is
  EXPECT_FALSE(may_any_shade_near(low, m, {}));
}

TEST(NearClip, TinyNearRectanglesFarFromTheOriginAreStillJudgedSafely) {
  // 2 mm wide, 5 km out: the sides' normals are mostly rounding. Triangles are thrown across
  // segments from the rectangle, so that each must be kept.
  std::mt19937 random(4);
  std::uniform_real_distribution<double> u(-1, 1), unit(0, 1);
  int crossed = 0;
  for (int k = 0; k < 4000; ++k) {
    Rectangle r = random_rectangle(random);
    const Vec3 away(5000 * u(random), 5000 * u(random), 5000 * u(random));
    for (Vec3& p : r) p = away + p * 1e-3;
    const Light light = k % 2 == 0 ? Light(u(random), u(random), u(random), 0)
                                   : Light(away + Vec3(u(random), u(random), u(random)) * 100.0, 1);
    const double a = unit(random), b = unit(random);
    const Vec3 x = r[0] + a * (r[1] - r[0]) + b * (r[3] - r[0]);
    const Vec3 on = x + (Vec3(light) - light.w * x) * (0.9 * unit(random));
    const auto corner = [&] { return on + Vec3(u(random), u(random), u(random)) * 1e-6; };
    const std::array<Vec3, 3> t = {corner(), corner(), corner()};
    if (crosses(t[0], t[1], t[2], point(x), light)) {
      TriMesh m;
      m.positions.assign(t.begin(), t.end());
      m.triangles = {{0, 1, 2}};
      const std::uint32_t only[] = {0};
      EXPECT_TRUE(may_shade_near(near_clip_volume(r, light), t)) << k;
      EXPECT_TRUE(may_any_shade_near(near_clip_volume(r, light), m, only)) << k;
      ++crossed;
    }
  }
  EXPECT_GT(crossed, 500);
}

TEST(NearClip, LeavesNoHalfSpaceOutInGeneralPosition) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> u(-4, 4);
  for (int k = 0; k < 200; ++k) {
    const Rectangle r = random_rectangle(random);
    const Vec3 l(u(random), u(random), u(random));
    EXPECT_EQ(near_clip_volume(r, Light(l, 1)).size, NearClip::kMaxHalfSpaces);
    // Towards a sun one side of the near plane and one of each plane along the rectangle's edges
    // and an axis have no end; three planes hold the light's direction and an axis, both ways.
    EXPECT_EQ(near_clip_volume(r, Light(l, 0)).size, 4 + 1 + 6 + 6);
  }
}

}  // namespace
}  // namespace gnomon
