// The shadow polygon that pybdshadow's own test asserts, from footprints with heights. See
// docs/footprints.md, "Compared with pybdshadow".
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored \
    "-Wrestrict"  // GCC 12 warns of "text" + std::string (its bug 105651)
#endif

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <ratio>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include <gnomon/io/crs.h>
#include <gnomon/io/footprint_layer.h>
#include <gnomon/io/triangulate.h>
#include <gnomon/mesh/weld.h>
#include <gnomon/shadow/cast_shadows.h>
#include <gnomon/sun/sun.h>
#include <gnomon/view/view.h>

namespace gnomon {
namespace {

using Ring = std::vector<Vec2>;

struct Case {
  Ring building1, building2, truth;  // longitude, latitude
  double height1 = 0, height2 = 0;
};

bool read_case(Case& c) {
  std::ifstream in(GNOMON_DATA "/reference/pybdshadow/pybdshadow_sunlight.tsv");
  std::string line;
  while (std::getline(in, line)) {
    std::vector<std::string> cell;
    std::stringstream cells(line);
    for (std::string s; std::getline(cells, s, '\t');) cell.push_back(s);
    if (cell.size() != 5) continue;
    const auto point = [&] { return Vec2(std::stod(cell[3]), std::stod(cell[4])); };
    if (cell[0] == "building1") c.building1.push_back(point()), c.height1 = std::stod(cell[1]);
    if (cell[0] == "building2") c.building2.push_back(point()), c.height2 = std::stod(cell[1]);
    if (cell[0] == "truth") c.truth.push_back(point());
  }
  // Row 0 is a corner of building2 and no part of the ring, which closes from row 1 to row 13.
  if (c.truth.size() == 14 && c.truth[1] == c.truth[13]) c.truth.erase(c.truth.begin());
  return !c.building1.empty() && !c.building2.empty() && !c.truth.empty();
}

std::string feature(const std::string& id, double height, const Ring& ring) {
  std::ostringstream text;
  text.precision(17);
  text << R"({"type":"Feature","id":")" << id << R"(","properties":{"height":)" << height
       << R"(},"geometry":{"type":"Polygon","coordinates":[[)";
  for (std::size_t k = 0; k <= ring.size(); ++k) {
    const Vec2& p = ring[k % ring.size()];
    text << (k ? "," : "") << "[" << p.x << "," << p.y << "]";
  }
  text << "]]}}";
  return text.str();
}

// As load_scene does it, for one model.
Scene scene_of(const Model& m) {
  Scene scene;
  scene.frame.crs = m.report.crs;
  scene.frame.origin = {std::round(m.vertices[0].x), std::round(m.vertices[0].y), 0};
  const CrsPlace at = locate(m.report.crs, scene.frame.origin).value();
  scene.frame.place = at.place;
  scene.frame.true_north = at.true_north;
  for (const Vec3& v : m.vertices) scene.mesh.positions.push_back(v - scene.frame.origin);
  for (const ModelPolygon& p : m.polygons) {
    std::vector<std::vector<std::uint32_t>> rings;
    for (std::uint32_t r = p.first_ring; r < p.last_ring; ++r) {
      rings.emplace_back(m.corners.begin() + m.ring_begin[r],
                         m.corners.begin() + m.ring_begin[r + 1]);
    }
    for (const Triangle& t : triangulate(scene.mesh.positions, rings).triangles) {
      scene.mesh.triangles.push_back(t);
      scene.surface_of.push_back(p.surface);
    }
  }
  scene.surfaces = m.surfaces;
  weld(scene.mesh, scene.surface_of);
  return scene;
}

bool inside(const Ring& ring, const Vec2& p) {
  bool in = false;
  for (std::size_t k = 0; k + 1 < ring.size(); ++k) {
    const Vec2 &a = ring[k], &b = ring[k + 1];
    if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) {
      in = !in;
    }
  }
  return in;
}

double distance(const Ring& ring, const Vec2& p) {
  double least = INFINITY;
  for (std::size_t k = 0; k + 1 < ring.size(); ++k) {
    const Vec2 d = ring[k + 1] - ring[k];
    const double s = std::clamp(glm::dot(p - ring[k], d) / glm::dot(d, d), 0.0, 1.0);
    least = std::min(least, glm::length(p - ring[k] - s * d));
  }
  return least;
}

constexpr double kPixel = 0.05;                      // metres
constexpr double kEccentricity2 = 0.00669437999014;  // of WGS 84, squared

// From building1's corner in the north-west, where the only edge that the sun makes begins, to that
// edge's far end on building2's northern side (metres).
constexpr double kReach = 43.5;

struct Suncalc {
  double azimuth, altitude;  // radians; the azimuth from north, clockwise, in (-pi, pi]
};

// The sun of the Python package suncalc, which pybdshadow uses. Based on: Louis Strous, Astronomy
// Answers, "Position of the Sun" (aa.quae.nl), with the constants of that package.
Suncalc suncalc(Instant t, double latitude, double longitude) {
  using namespace std::chrono;
  const auto j2000 = sys_days(year(2000) / 1 / 1) + hours(12);
  const double d = duration<double, std::ratio<86400>>(t - j2000).count();
  const double m = (357.5291 + 0.98560028 * d) * kDegree;
  const double l = m + (1.9148 * std::sin(m) + 0.02 * std::sin(2 * m) + 0.0003 * std::sin(3 * m) +
                        102.9372 + 180) *
                           kDegree;
  const double tilt = 23.4397 * kDegree;
  const double declination = std::asin(std::sin(tilt) * std::sin(l));
  const double ascension = std::atan2(std::sin(l) * std::cos(tilt), std::cos(l));
  const double h = (280.16 + 360.9856235 * d) * kDegree + longitude - ascension;
  const double from_south = std::atan2(
      std::sin(h), std::cos(h) * std::sin(latitude) - std::tan(declination) * std::cos(latitude));
  return {std::remainder(from_south + kPi, 2 * kPi),
          std::asin(std::sin(latitude) * std::sin(declination) +
                    std::cos(latitude) * std::cos(declination) * std::cos(h))};
}

struct Difference {
  std::size_t samples = 0, differ = 0;
  double farthest = 0;  // of the differing samples from the polygon's boundary, metres
  double overlap = 0;   // area of both / area of either
};

// Our mask against a polygon in scene coordinates.
Difference compare(const Scene& scene, const Light& light, const View& view, const Ring& truth) {
  const ShadowMask mask = cast_shadows(scene, light, view);
  Difference d;
  std::size_t both = 0, either = 0;
  for (int j = 0; j < mask.height; ++j) {
    for (int i = 0; i < mask.width; ++i) {
      const auto state = mask.state[static_cast<std::size_t>(j * mask.width + i)];
      if (state == ShadowMask::kNoSample) continue;
      const Vec4 q = pixel_point(view, i, j);
      const bool ours = state == ShadowMask::kShadow, theirs = inside(truth, {q.x, q.y});
      ++d.samples;
      both += ours && theirs ? 1 : 0;
      either += ours || theirs ? 1 : 0;
      if (ours == theirs) continue;
      ++d.differ;
      d.farthest = std::max(d.farthest, distance(truth, {q.x, q.y}));
    }
  }
  d.overlap = static_cast<double>(both) / static_cast<double>(either);
  return d;
}

TEST(Pybdshadow, AssertedShadowOnTheLowerRoofIsOurs) {
  Case c;
  if (!read_case(c)) GTEST_SKIP() << "skipped: no reference/pybdshadow in " GNOMON_DATA;
  const auto path = std::filesystem::path(testing::TempDir()) / "gnomon_pybdshadow.geojson";
  std::ofstream(path) << R"({"type":"FeatureCollection","features":[)"
                      << feature("1", c.height1, c.building1) << ","
                      << feature("2", c.height2, c.building2) << "]}";
  auto model = read_footprints(path, {}, "", "", {});
  std::filesystem::remove(path);
  ASSERT_TRUE(model) << model.error().message;
  ASSERT_EQ(model.value().report.crs, "EPSG:32654");
  Scene scene = scene_of(model.value());
  for (Surface& s : scene.surfaces) s.receives = s.object == "2" && s.semantic == "RoofSurface";

  using namespace std::chrono;
  const Instant when = sys_days(year(2015) / 1 / 1) + hours(3) + minutes(45) + milliseconds(33960);
  const SunPosition sun = sun_position(when, *scene.frame.place);

  const auto here = [&](const Ring& ring) {
    Ring out = reproject("EPSG:4326", scene.frame.crs, ring).value();
    for (Vec2& p : out) p -= Vec2(scene.frame.origin.x, scene.frame.origin.y);
    return out;
  };
  const Ring truth = here(c.truth), roof = here(c.building2);
  Bounds2 box{INFINITY, INFINITY, -INFINITY, -INFINITY};
  for (const Vec2& p : roof) {
    box = {std::min(box.x0, p.x), std::min(box.y0, p.y), std::max(box.x1, p.x),
           std::max(box.y1, p.y)};
  }
  const View view = plan_view(box, kPixel, c.height2);

  // 1. With the sun of their formulas, turned from the sphere that their metres lie on to the
  // ellipsoid: the same polygon. What is left is the 0.003 degrees between the formulas at the
  // scene's origin and at the place (not recorded) that their test took, at most 43.5 m away.
  const double latitude = scene.frame.place->latitude;
  const Suncalc theirs = suncalc(when, latitude, scene.frame.place->longitude);
  const double m_by_n =
      (1 - kEccentricity2) / (1 - kEccentricity2 * std::pow(std::sin(latitude), 2));
  SunPosition their_sun = sun;
  their_sun.azimuth = std::atan2(std::sin(theirs.azimuth), std::cos(theirs.azimuth) * m_by_n);
  their_sun.altitude_apparent = theirs.altitude;
  const Difference same =
      compare(scene, sun_direction(their_sun, scene.frame.true_north), view, truth);
  constexpr double kSamePlace = 0.005 * kDegree;
  EXPECT_LT(same.farthest, kReach * kSamePlace);
  EXPECT_GT(same.overlap, 0.9998);

  // 2. With our sun: apart by what the two suns are apart.
  const Difference ours = compare(scene, sun_direction(sun, scene.frame.true_north), view, truth);
  const double apart = std::remainder(sun.azimuth - their_sun.azimuth, 2 * kPi);
  EXPECT_GT(ours.samples, 900000u);
  EXPECT_LT(ours.farthest, kReach * (std::fabs(apart) + kSamePlace));
  EXPECT_GT(ours.farthest, kReach * (std::fabs(apart) - kSamePlace) - 2 * kPixel);
  EXPECT_GT(ours.overlap, 0.998);
  // The formulas leave out the precession of the equinoxes since 2000, among others.
  EXPECT_NEAR(sun.azimuth, theirs.azimuth + 2 * kPi, 0.2 * kDegree);
  EXPECT_NEAR(sun.altitude_geometric, theirs.altitude, 0.02 * kDegree);

  for (const auto& [key, value] : std::initializer_list<std::pair<const char*, double>>{
           {"our azimuth", sun.azimuth / kDegree},
           {"our altitude", sun.altitude_geometric / kDegree},
           {"their azimuth", theirs.azimuth / kDegree + 360},
           {"their altitude", theirs.altitude / kDegree},
           {"azimuths apart on the ellipsoid", apart / kDegree},
           {"samples", static_cast<double>(ours.samples)},
           {"their sun: samples that differ", static_cast<double>(same.differ)},
           {"their sun: farthest", same.farthest},
           {"their sun: overlap", same.overlap},
           {"our sun: samples that differ", static_cast<double>(ours.differ)},
           {"our sun: farthest", ours.farthest},
           {"our sun: overlap", ours.overlap}}) {
    RecordProperty(key, std::to_string(value));
  }
}

}  // namespace
}  // namespace gnomon
