#include <gnomon/io/crs.h>

#include <proj.h>

#include <cmath>

#include <gtest/gtest.h>

namespace gnomon {
namespace {

// Meridian convergence of a transverse Mercator, series to the fifth power of the longitude
// difference (Hofmann-Wellenhof, Lichtenegger, Collins; also Snyder 1987, chapter 8). Angles in
// radians, e2 the ellipsoid's squared eccentricity. Under three degrees from the central meridian
// it is good to 1e-9 rad.
double tm_convergence(double latitude, double from_meridian, double e2) {
  const double c = std::cos(latitude), t2 = std::pow(std::tan(latitude), 2);
  const double eta2 = e2 / (1 - e2) * c * c, l = from_meridian;
  return std::sin(latitude) * (l + std::pow(l, 3) * c * c / 3 * (1 + 3 * eta2 + 2 * eta2 * eta2) +
                               std::pow(l, 5) * std::pow(c, 4) / 15 * (2 - t2));
}

constexpr double kWgs84E2 = 0.0066943799901413165;

CrsPlace at(const std::string& crs, double x, double y, double z = 0) {
  Result<CrsPlace> r = locate(crs, {x, y, z});
  EXPECT_TRUE(r) << crs << ": " << (r ? "" : r.error().message);
  return r ? r.value() : CrsPlace{};
}

std::string refusal(const std::string& crs, double x, double y) {
  Result<CrsPlace> r = locate(crs, {x, y, 0});
  EXPECT_FALSE(r) << crs;
  return r ? "" : r.error().message;
}

// A GeoJSON (EPSG:4326) and a --site (CRS84) meet in one scene.
TEST(Crs, BothNamesOfWgs84GiveTheSamePoint) {
  const Vec2 lonlat(16.3525, 48.2047);
  const Vec2 a = reproject("EPSG:4326", "EPSG:31256", {lonlat}).value()[0];
  const Vec2 b = reproject("OGC:CRS84", "EPSG:31256", {lonlat}).value()[0];
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.y, b.y);
  const CrsPlace back = locate("EPSG:31256", {a.x, a.y, 0}).value();
  EXPECT_NEAR(back.place.longitude / kDegree, lonlat.x, 2e-8);  // 2 mm, there and back
  EXPECT_NEAR(back.place.latitude / kDegree, lonlat.y, 2e-8);
}

TEST(Crs, PlacesTheViennaDistrictInVienna) {
  // The middle of the demo's model: between the Danube canal and the Prater.
  const CrsPlace p = at("EPSG:31256", 1246.8, 340741.2, 30);
  EXPECT_NEAR(p.place.latitude / kDegree, 48.2, 0.03);
  EXPECT_NEAR(p.place.longitude / kDegree, 16.35, 0.03);
  EXPECT_EQ(p.place.height, 30);
  EXPECT_EQ(p.metres_per_unit, 1);
  EXPECT_EQ(p.name, "MGI / Austria GK East");
}

TEST(Crs, PutsTheTowerOfAmersfoortAtItsPublishedCoordinates) {
  // Origin of the Dutch grid, tower of Our Lady: x 155000, y 463000; ETRS89 52 09 18.62 N 5
  // 23 13.93 E (RDNAP), known to a metre here.
  const CrsPlace p = at("EPSG:28992", 155000, 463000);
  EXPECT_NEAR(p.place.latitude / kDegree, 52 + 9 / 60.0 + 18.62 / 3600, 1e-4 / 6);
  EXPECT_NEAR(p.place.longitude / kDegree, 5 + 23 / 60.0 + 13.93 / 3600, 1e-4 / 6);
}

TEST(Crs, PutsTheOldObservatoryOfBernAtItsPublishedCoordinates) {
  // Origin of the Swiss grid: E 2600000, N 1200000; 46 57 03.898 N 7 26 19.077 E (swisstopo,
  // CHTRS95).
  const CrsPlace p = at("EPSG:2056", 2600000, 1200000);
  EXPECT_NEAR(p.place.latitude / kDegree, 46 + 57 / 60.0 + 3.898 / 3600, 1e-5);
  EXPECT_NEAR(p.place.longitude / kDegree, 7 + 26 / 60.0 + 19.077 / 3600, 1e-5);
}

TEST(Crs, TakesTheHorizontalPartOfACompoundCrs) {
  const CrsPlace compound = at("EPSG:7415", 84900, 447600, 3);
  const CrsPlace flat = at("EPSG:28992", 84900, 447600, 3);
  EXPECT_EQ(compound.place.latitude, flat.place.latitude);
  EXPECT_EQ(compound.place.longitude, flat.place.longitude);
  EXPECT_EQ(compound.true_north, flat.true_north);
  EXPECT_NEAR(flat.place.latitude / kDegree, 52.01, 0.01);  // Delft
  EXPECT_NEAR(flat.place.longitude / kDegree, 4.36, 0.01);
}

TEST(Crs, ConvergenceOfUtmAgreesWithTheSeries) {
  // UTM 33N on WGS 84: no datum shift, so the closed formula must be met exactly.
  for (const double y : {1e6, 3e6, 5.34e6, 6.5e6}) {
    for (const double x : {300000.0, 420000.0, 500000.0, 601771.0, 690000.0}) {
      const CrsPlace p = at("EPSG:32633", x, y);
      const double expected =
          tm_convergence(p.place.latitude, p.place.longitude - 15 * kDegree, kWgs84E2);
      EXPECT_NEAR(p.true_north, -expected, 2e-9) << x << ' ' << y;
    }
  }
}

TEST(Crs, ConvergenceInViennaDiffersFromTheSeriesByTheDatumsTurnOnly) {
  // True north is that of WGS 84; the Austrian datum is turned against it. EPSG:1618 turns
  // by 5.137, 1.474, 5.297 arcseconds about x, y, z; about the local vertical that is their
  // component along the plumb line.
  const CrsPlace p = at("EPSG:31256", 1246.8, 340741.2);
  const double phi = p.place.latitude, lambda = p.place.longitude;
  const double e2 = 0.006674372230614;  // Bessel 1841
  const double series = tm_convergence(phi, lambda - (16 + 20 / 60.0) * kDegree, e2);
  const double turn = (5.137 * std::cos(phi) * std::cos(lambda) +
                       1.474 * std::cos(phi) * std::sin(lambda) + 5.297 * std::sin(phi)) *
                      kDegree / 3600;
  EXPECT_NEAR(p.true_north, -series, 6e-5);
  EXPECT_NEAR(std::abs(p.true_north + series), turn, 2e-5);
}

TEST(Crs, ConvergenceAgreesWithProjsOwnFactors) {
  // The Dutch, the Swiss and a conic projection, put on WGS 84 so that no datum shift comes
  // between.
  const std::string projections[] = {
      "+proj=sterea +lat_0=52.1561605555556 +lon_0=5.38763888888889 +k=0.9999079 +x_0=155000 "
      "+y_0=463000",
      "+proj=somerc +lat_0=46.9524055555556 +lon_0=7.43958333333333 +k_0=1 +x_0=155000 +y_0=463000",
      "+proj=lcc +lat_1=49 +lat_2=44 +lat_0=46.5 +lon_0=3 +x_0=155000 +y_0=463000"};
  for (const std::string& projection : projections) {
    const std::string crs = projection + " +datum=WGS84";
    for (const double x : {30000.0, 155000.0, 290000.0}) {
      const CrsPlace p = at(crs, x, 480000);
      PJ* pj = proj_create(PJ_DEFAULT_CTX, (projection + " +ellps=WGS84").c_str());
      ASSERT_NE(pj, nullptr);
      const PJ_FACTORS factors =
          proj_factors(pj, proj_coord(p.place.longitude, p.place.latitude, 0, 0));
      EXPECT_NEAR(std::abs(p.true_north), std::abs(factors.meridian_convergence), 1e-7) << crs;
      proj_destroy(pj);
    }
  }
}

TEST(Crs, GridNorthLiesEastOfTrueNorthEastOfTheCentralMeridian) {
  EXPECT_LT(at("EPSG:32633", 600000, 5340000).true_north, -0.01);
  EXPECT_GT(at("EPSG:32633", 400000, 5340000).true_north, 0.01);
  EXPECT_NEAR(at("EPSG:32633", 500000, 5340000).true_north, 0, 1e-12);
  // South of the equator it is the other way round.
  EXPECT_GT(at("EPSG:32733", 600000, 6500000).true_north, 0.009);
}

TEST(Crs, ReadsNorthingFirstSystemsAsEastThenNorth) {
  // EPSG:31466 defines its first axis as north; files hold easting first.
  const CrsPlace p = at("EPSG:31466", 2567000, 5660000);
  EXPECT_NEAR(p.place.latitude / kDegree, 51.07, 0.05);
  EXPECT_NEAR(p.place.longitude / kDegree, 6.95, 0.05);
  EXPECT_LT(p.true_north, 0);
}

TEST(Crs, SaysTheLengthOfItsUnit) {
  // New York Long Island in US survey feet; about City Hall.
  const CrsPlace p = at("EPSG:2263", 981900, 198900);
  EXPECT_DOUBLE_EQ(p.metres_per_unit, 1200.0 / 3937.0);
  EXPECT_NEAR(p.place.latitude / kDegree, 40.7128, 0.001);
  EXPECT_NEAR(p.place.longitude / kDegree, -74.006, 0.003);
}

TEST(Crs, ShortensUrlsAndUrns) {
  EXPECT_EQ(short_crs("https://www.opengis.net/def/crs/EPSG/0/7415"), "EPSG:7415");
  EXPECT_EQ(short_crs("http://www.opengis.net/def/crs/EPSG/0/2056/"), "EPSG:2056");
  EXPECT_EQ(short_crs("urn:ogc:def:crs:EPSG::7415"), "EPSG:7415");
  EXPECT_EQ(short_crs("urn:ogc:def:crs:EPSG:9.9.1:7415"), "EPSG:7415");
  EXPECT_EQ(short_crs("epsg:7415"), "EPSG:7415");
  EXPECT_EQ(short_crs("EPSG:7415"), "EPSG:7415");
  EXPECT_EQ(short_crs("ESRI:102100"), "ESRI:102100");
  EXPECT_EQ(short_crs(""), "");
}

TEST(Crs, ReadsUrlsAndProjStrings) {
  const CrsPlace a = at("https://www.opengis.net/def/crs/EPSG/0/32633", 600000, 5340000);
  const CrsPlace b = at("+proj=utm +zone=33 +datum=WGS84", 600000, 5340000);
  EXPECT_NEAR(a.place.latitude, b.place.latitude, 1e-12);
  EXPECT_NEAR(a.true_north, b.true_north, 1e-12);
}

TEST(Crs, RefusesDegreesAndSaysWhatToDo) {
  const std::string why = refusal("EPSG:4326", 16.37, 48.2);
  EXPECT_NE(why.find("geographic"), std::string::npos) << why;
  EXPECT_NE(why.find("reproject"), std::string::npos) << why;
  EXPECT_NE(refusal("EPSG:4979", 16.37, 48.2).find("geographic"), std::string::npos);
}

TEST(Crs, RefusesNonsense) {
  for (const char* crs : {"", "EPSG:999999", "Atlantis", "EPSG:7004", "{}"}) {
    EXPECT_NE(refusal(crs, 0, 0).find("unknown CRS"), std::string::npos) << crs;
  }
  EXPECT_NE(refusal("EPSG:4978", 4e6, 1e6).find("not a projected CRS"), std::string::npos);
}

TEST(Crs, RefusesPointsFarOutsideAndNamesWhereTheyWouldLie) {
  const std::string why = refusal("EPSG:28992", 2680000, 1245000);  // Zurich in the Dutch grid
  EXPECT_NE(why.find("does not fit"), std::string::npos) << why;
  EXPECT_NE(why.find("--crs"), std::string::npos) << why;
  refusal("EPSG:32633", 1e12, 1e12);
  refusal("EPSG:32633", std::nan(""), 0);
}

TEST(Crs, HasANameForPeople) {
  EXPECT_EQ(crs_in_words("urn:ogc:def:crs:EPSG::7415"), "EPSG:7415");
  EXPECT_EQ(crs_in_words(R"(PROJCRS["Site grid",BASEGEOGCRS["x"]])"), "\"Site grid\"");
  EXPECT_EQ(crs_in_words("+proj=utm +zone=33"), "+proj=utm +zone=33");
  EXPECT_EQ(crs_in_words("PROJCRS["), "PROJCRS[");
}

}  // namespace
}  // namespace gnomon
