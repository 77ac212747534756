#include <gnomon/io/footprint_file.h>

#include <gdal.h>
#include <ogr_api.h>
#include <ogr_srs_api.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <cmath>

#include <gnomon/io/crs.h>
#include <gnomon/io/geojson_fault.h>

#include "io/footprint_test_files.h"

namespace gnomon {
namespace {

const std::string kDegrees =
    R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{"height":9},)"
    R"("geometry":{"type":"Polygon","coordinates":[[[16.37,48.2],[16.371,48.2],[16.371,48.201],)"
    R"([16.37,48.201],[16.37,48.2]]]}}]})";

TEST_F(FootprintLayer, GeoJsonWithoutCrsIsLongitudeAndLatitudeAndGoesToItsUtmZone) {
  const Model m = model(kDegrees);
  EXPECT_EQ(m.report.crs, "EPSG:32633");
  EXPECT_EQ(m.report.placed, "moved from EPSG:4326 to EPSG:32633");
  const Vec2 corner = reproject("EPSG:4326", "EPSG:32633", {{16.37, 48.2}}).value()[0];
  EXPECT_EQ(m.vertices[0].x, corner.x);
  EXPECT_EQ(m.vertices[0].y, corner.y);
  EXPECT_NEAR(volume(m), 74.3 * 111.2 * 9, 0.01 * 74.3 * 111.2 * 9);
}

TEST_F(FootprintLayer, BothSidesOfTheAntimeridianHaveTheirMiddleThere) {
  const auto at = [](double x) {
    const std::string w = std::to_string(x), e = std::to_string(x + 0.001);
    return feature(R"("height":9)", polygon("[[" + w + ",-17],[" + e + ",-17],[" + e +
                                            ",-16.999],[" + w + ",-16.999]]"));
  };
  const Model m =
      model(R"({"type":"FeatureCollection","features":[)" + at(179.99) + "," + at(-179.98) + "]}");
  EXPECT_EQ(m.report.crs, "EPSG:32701");
  double low = INFINITY, high = -INFINITY;
  for (const Vec3& v : m.vertices) low = std::min(low, v.x), high = std::max(high, v.x);
  EXPECT_NEAR(high - low, 0.031 * 111320 * std::cos(17 * kDegree), 10);
}

TEST_F(FootprintLayer, CoordinatesGoToTheScenesCrsAndTheGroundIsAskedThere) {
  const Vec2 corner = reproject("EPSG:4326", "EPSG:31256", {{16.37, 48.2}}).value()[0];
  double asked = INFINITY;
  const GroundAt ground = [&](double x, double) {
    asked = std::min(asked, std::fabs(x - corner.x));
    return std::optional(1.0);
  };
  const auto m = read_footprints(write("a.geojson", kDegrees), {}, "EPSG:31256", "", ground);
  ASSERT_TRUE(m) << m.error().message;
  EXPECT_EQ(m.value().report.crs, "EPSG:31256");
  EXPECT_EQ(m.value().vertices[0].x, corner.x);
  EXPECT_EQ(asked, 0);
}

TEST_F(FootprintLayer, MetresWithoutTheirCrsMemberTakeTheCrsGivenOrAreRefused) {
  std::string text = collection({house(R"("height":3)")});
  text.erase(text.find(kMetres), kMetres.size());
  EXPECT_TRUE(has(refusal(text), "no longitude and latitude")) << refusal(text);
  const auto m = read_footprints(write("a.geojson", text), {}, "", "EPSG:31256", {});
  ASSERT_TRUE(m) << m.error().message;
  EXPECT_EQ(m.value().report.crs, "EPSG:31256");
  EXPECT_EQ(m.value().vertices[0].x, 1000);
  EXPECT_EQ(warning(m.value(), "no degrees").count, 1u);
}

TEST_F(FootprintLayer, WebMercatorIsNotTrueToScaleSoUtmIsTaken) {
  std::string text = kDegrees;
  const auto p = reproject("EPSG:4326", "EPSG:3857",
                           {{16.37, 48.2}, {16.371, 48.2}, {16.371, 48.201}, {16.37, 48.201}})
                     .value();
  std::string r;
  for (const Vec2& q : p) {
    r += (r.empty() ? "[" : ",[") + std::to_string(q.x) + "," + std::to_string(q.y) + "]";
  }
  const Model m = model(R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":)"
                        R"("urn:ogc:def:crs:EPSG::3857"}},"features":[)" +
                        feature(R"("height":9)", polygon("[" + r + "]")) + "]}");
  EXPECT_EQ(m.report.crs, "EPSG:32633");
  EXPECT_NEAR(volume(m), volume(model(text)), 0.1);
  EXPECT_EQ(warning(m, "true to scale").count, 1u);
}

struct Made {
  std::string layer;
  int epsg;  // 0: none
  std::string wkt;
};

// A file of OGR's making with one feature of height 6 in each layer.
void make(const std::filesystem::path& path, const std::string& driver,
          const std::vector<Made>& layers) {
  RegisterOGRShape();
  RegisterOGRGeoPackage();
  RegisterOGRFlatGeobuf();
  RegisterOGRGML();
  RegisterOGRLIBKML();
  const GDALDatasetH dataset =
      GDALCreate(GDALGetDriverByName(driver.c_str()), path.c_str(), 0, 0, 0, GDT_Unknown, nullptr);
  ASSERT_NE(dataset, nullptr);
  for (const Made& made : layers) {
    OGRSpatialReferenceH srs = nullptr;
    if (made.epsg) {
      srs = OSRNewSpatialReference(nullptr);
      OSRImportFromEPSG(srs, made.epsg);
      OSRSetAxisMappingStrategy(srs, OAMS_TRADITIONAL_GIS_ORDER);
    }
    OGRGeometryH geometry = nullptr;
    std::string wkt = made.wkt;
    char* text = wkt.data();
    ASSERT_EQ(OGR_G_CreateFromWkt(&text, srs, &geometry), OGRERR_NONE);
    const OGRLayerH layer = GDALDatasetCreateLayer(dataset, made.layer.c_str(), srs,
                                                   OGR_G_GetGeometryType(geometry), nullptr);
    ASSERT_NE(layer, nullptr);
    const OGRFieldDefnH field = OGR_Fld_Create("height", OFTReal);
    OGR_L_CreateField(layer, field, 1);
    OGR_Fld_Destroy(field);
    const OGRFeatureH f = OGR_F_Create(OGR_L_GetLayerDefn(layer));
    OGR_F_SetFieldDouble(f, OGR_F_GetFieldIndex(f, "height"), 6);
    OGR_F_SetGeometryDirectly(f, geometry);
    ASSERT_EQ(OGR_L_CreateFeature(layer, f), OGRERR_NONE);
    OGR_F_Destroy(f);
    if (srs) OSRRelease(srs);
  }
  GDALClose(dataset);
}

const std::string kHouse =
    "POLYGON ((1000 340000,1010 340000,1010 340010,1000 340010,1000 340000))";

std::string first_bytes(const std::filesystem::path& path) {
  return gnomon::testing::content(path).substr(0, 4096);
}

TEST_F(FootprintLayer, EveryFormatGivesTheSameSolid) {
  const struct {
    const char *name, *driver, *format;
  } cases[] = {{"a.gpkg", "GPKG", "GeoPackage footprints"},
               {"a.shp", "ESRI Shapefile", "Shapefile footprints"},
               {"a.fgb", "FlatGeobuf", "FlatGeobuf footprints"},
               {"a.gml", "GML", "GML footprints"}};
  for (const auto& c : cases) {
    make(folder_ / c.name, c.driver, {{"a", 31256, kHouse}});
    EXPECT_TRUE(is_footprint_file(folder_ / c.name, first_bytes(folder_ / c.name))) << c.name;
    const auto m = read_footprints(folder_ / c.name, {}, "", "", {});
    ASSERT_TRUE(m) << m.error().message;
    EXPECT_EQ(m.value().report.format, c.format);
    EXPECT_EQ(m.value().report.crs, "EPSG:31256") << c.name;
    EXPECT_NEAR(volume(m.value()), 600, 1e-6) << c.name;
    EXPECT_EQ(m.value().vertices[0].x, 1000) << c.name << ": the axes are east, north";
  }
}

TEST_F(FootprintLayer, KmlIsReadToo) {
  make(folder_ / "a.kml", "LIBKML",
       {{"a", 4326, "POLYGON ((16.37 48.2,16.371 48.2,16.371 48.201,16.37 48.201,16.37 48.2))"}});
  EXPECT_TRUE(is_footprint_file(folder_ / "a.kml", first_bytes(folder_ / "a.kml")));
  const auto m = read_footprints(folder_ / "a.kml", {}, "", "", {});
  ASSERT_TRUE(m) << m.error().message;
  EXPECT_EQ(m.value().report.crs, "EPSG:32633");
  EXPECT_EQ(m.value().report.format, "KML footprints");
}

TEST_F(FootprintLayer, ReadingLeavesTheFolderAsItWas) {
  for (const auto& [name, driver] :
       {std::pair("a.gml", "GML"), {"a.gpkg", "GPKG"}, {"a.shp", "ESRI Shapefile"}}) {
    make(folder_ / name, driver, {{"a", 31256, kHouse}});
  }
  std::filesystem::remove(folder_ / "a.xsd");  // without it GDAL would like to write a .gfs
  auto before = folder_.names();
  for (const char* name : {"a.gml", "a.gpkg", "a.shp"}) {
    EXPECT_TRUE(read_footprints(folder_ / name, {}, "", "", {})) << name;
  }
  auto after = folder_.names();
  std::sort(before.begin(), before.end());
  std::sort(after.begin(), after.end());
  EXPECT_EQ(before, after);
}

TEST_F(FootprintLayer, CurvedPolygonsBecomeStraightOnes) {
  make(folder_ / "a.gpkg", "GPKG",
       {{"a", 31256,
         "CURVEPOLYGON (CIRCULARSTRING (1000 340000,1010 340010,1020 340000,1010 339990,1000 "
         "340000))"}});
  const auto m = read_footprints(folder_ / "a.gpkg", {}, "", "", {});
  ASSERT_TRUE(m) << m.error().message;
  EXPECT_TRUE(watertight(m.value()));
  // A regular polygon of 90 sides (4 degrees each) in a circle of 10 m.
  EXPECT_NEAR(volume(m.value()), 6 * 0.5 * 90 * 100 * std::sin(4 * kDegree), 0.01);
}

TEST_F(FootprintLayer, TheCrsThatAFileNamesIsToldWithoutReadingIt) {
  EXPECT_EQ(crs_of_footprint_file(write("m.geojson", collection({house("")})), "").value(),
            "EPSG:31256");
  EXPECT_EQ(crs_of_footprint_file(write("d.geojson", kDegrees), "").value(), "EPSG:4326");
  make(folder_ / "n.shp", "ESRI Shapefile", {{"n", 0, kHouse}});
  EXPECT_EQ(crs_of_footprint_file(folder_ / "n.shp", "").value(), "");
  make(folder_ / "a.gpkg", "GPKG", {{"houses", 31256, kHouse}, {"lots", 25832, kHouse}});
  EXPECT_EQ(crs_of_footprint_file(folder_ / "a.gpkg", "lots").value(), "EPSG:25832");
  EXPECT_FALSE(crs_of_footprint_file(folder_ / "a.gpkg", ""));
  EXPECT_FALSE(crs_of_footprint_file(folder_ / "none.gpkg", ""));
}

TEST_F(FootprintLayer, SeveralPolygonLayersAreListedAndOneIsChosenByName) {
  make(folder_ / "a.gpkg", "GPKG",
       {{"houses", 31256, kHouse},
        {"lots", 31256, kHouse},
        {"roads", 31256, "LINESTRING (0 0,1 1)"}});
  const auto m = read_footprints(folder_ / "a.gpkg", {}, "", "", {});
  ASSERT_FALSE(m);
  EXPECT_TRUE(has(m.error().message, "houses, lots; name")) << m.error().message;
  FootprintOptions options;
  options.layer = "houses";
  EXPECT_TRUE(read_footprints(folder_ / "a.gpkg", options, "", "", {}));
  options.layer = "barns";
  const auto wrong = read_footprints(folder_ / "a.gpkg", options, "", "", {});
  ASSERT_FALSE(wrong);
  EXPECT_TRUE(has(wrong.error().message, "no layer \"barns\"; it has houses, lots, roads"))
      << wrong.error().message;
  make(folder_ / "b.gpkg", "GPKG", {{"roads", 31256, "LINESTRING (0 0,1 1)"}});
  const auto lines = read_footprints(folder_ / "b.gpkg", {}, "", "", {});
  ASSERT_FALSE(lines);
  EXPECT_TRUE(has(lines.error().message, "no layer with polygons (its layers: roads)"))
      << lines.error().message;
}

TEST_F(FootprintLayer, ShapefilesWithoutPrjAreLocalMetresUnlessTheyLookLikeDegrees) {
  make(folder_ / "m.shp", "ESRI Shapefile", {{"m", 0, "POLYGON ((0 0,0 9,9 9,9 0,0 0))"}});
  const auto local = read_footprints(folder_ / "m.shp", {}, "", "", {});
  ASSERT_TRUE(local) << local.error().message;
  EXPECT_EQ(local.value().report.crs, "");
  EXPECT_NEAR(volume(local.value()), 9 * 9 * 6, 1e-9);
  make(folder_ / "d.shp", "ESRI Shapefile",
       {{"d", 0, "POLYGON ((16.37 48.2,16.37 48.201,16.371 48.2,16.37 48.2))"}});
  const auto degrees = read_footprints(folder_ / "d.shp", {}, "", "", {});
  ASSERT_FALSE(degrees);
  EXPECT_TRUE(has(degrees.error().message, "look like degrees")) << degrees.error().message;
  const auto told = read_footprints(folder_ / "d.shp", {}, "", "EPSG:4326", {});
  ASSERT_TRUE(told) << told.error().message;
  EXPECT_EQ(told.value().report.crs, "EPSG:32633");
}

TEST_F(FootprintLayer, DamagedFilesAreRefusedByNameAndNothingIsPrinted) {
  ::testing::internal::CaptureStderr();
  const auto expect = [&](const std::string& name, const std::string& part) {
    const auto m = read_footprints(folder_ / name, {}, "", "", {});
    ASSERT_FALSE(m) << name;
    EXPECT_TRUE(has(m.error().message, name) && has(m.error().message, part)) << m.error().message;
  };
  expect("missing.geojson", "no such file");
  write("bad.geojson", R"({"type":"FeatureCollection","features":[{"type":"Feature")");
  expect("bad.geojson", "check that the file is whole");
  write("second.geojson", collection({house(R"("height":3)"),
                                      feature(R"("height":3)", polygon(R"([["east",0],[1,1]])"))}));
  expect("second.geojson", "feature 2 cannot be read");
  write("lines.geojsonl",
        house(R"("height":3)") + "\n" + feature(R"("height":3)", polygon(R"([["east",0],[1,1]])")));
  expect("lines.geojsonl", "line 2 cannot be read");
  write("noise.gpkg", "this is no database");
  expect("noise.gpkg", "check that the file is whole");
  write("empty.geojson", R"({"type":"FeatureCollection","features":[]})");
  expect("empty.geojson", "no features");

  make(folder_ / "a.shp", "ESRI Shapefile", {{"a", 31256, kHouse}});
  std::filesystem::remove(folder_ / "a.shx");
  expect("a.shp", ".shx");

  make(folder_ / "b.gpkg", "GPKG", {{"b", 31256, kHouse}});
  std::filesystem::resize_file(folder_ / "b.gpkg", 60000);
  expect("b.gpkg", "check that the file is whole");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST_F(FootprintLayer, NamesThatMeanAddressesToGdalAreNotOpened) {
  for (const char* name : {"/vsicurl/http://127.0.0.1:9/a.geojson", "http://127.0.0.1:9/a.geojson",
                           "WFS:http://127.0.0.1:9/"}) {
    const auto m = read_footprints(name, {}, "", "", {});
    ASSERT_FALSE(m);
    EXPECT_TRUE(has(m.error().message, "no such file")) << m.error().message;
  }
  write("a.vrt", R"(<OGRVRTDataSource><OGRVRTLayer name="a"><SrcDataSource>/vsicurl/http://)"
                 R"(127.0.0.1:9/a.geojson</SrcDataSource></OGRVRTLayer></OGRVRTDataSource>)");
  const auto m = read_footprints(folder_ / "a.vrt", {}, "", "", {});
  ASSERT_FALSE(m);
  EXPECT_TRUE(has(m.error().message, "cannot be read as GeoJSON")) << m.error().message;
}

TEST(GeoJsonFault, TheFirstFeatureWhoseCoordinatesAreNoneIsNamed) {
  const auto found = [](const std::string& geometries) {
    return first_bad_feature(R"({"features":[{"geometry":{"coordinates":[[[1,2.5],[3,4]]]}},)"
                             R"({"id":"way/7","geometry":)" +
                             geometries + "}]}");
  };
  EXPECT_EQ(found(R"({"coordinates":[[[1,2],[3,"x"]]]})"), "feature 2 (id way/7)");
  EXPECT_EQ(found(R"({"coordinates":[[[1,null]]]})"), "feature 2 (id way/7)");
  EXPECT_EQ(found(R"({"coordinates":7})"), "feature 2 (id way/7)");
  EXPECT_EQ(found(R"({"coordinates":[[[[[1]]]]]})"), "feature 2 (id way/7)");
  EXPECT_EQ(found(R"({"geometries":[{"coordinates":[1,{}]}]})"), "feature 2 (id way/7)");
  EXPECT_EQ(found(R"({"coordinates":[[[[1,2]]]]})"), "");
  EXPECT_EQ(found("null"), "");
}

TEST(GeoJsonFault, OfATextSequenceTheLineIsNamed) {
  const std::string good = R"({"geometry":{"coordinates":[1,2]}})",
                    bad = R"({"id":7,"geometry":{"coordinates":["a",2]}})";
  EXPECT_EQ(first_bad_feature(good + "\n\n" + bad + "\n"), "line 3 (id 7)");
  EXPECT_EQ(first_bad_feature(good + "\n" + good), "");
  EXPECT_EQ(first_bad_feature(good + "\n{"), "line 2");
  EXPECT_EQ(first_bad_feature("\x1e{\n\"a\":\n1}\n\x1e\n" + bad), "line 5 (id 7)");
  EXPECT_EQ(first_bad_feature(bad), "feature 1 (id 7)");
}

TEST(FootprintFormat, FilesAreKnownByTheirContent) {
  EXPECT_TRUE(is_footprint_file("a.json", R"({ "type" : "FeatureCollection", "features": [)"));
  EXPECT_TRUE(is_footprint_file("a.json", R"({"features":[{"type":"Feature","geometry":)"));
  EXPECT_TRUE(is_footprint_file("a.json", R"({"type":"Polygon","coordinates":[)"));
  EXPECT_TRUE(is_footprint_file("a.geojson", ""));
  EXPECT_TRUE(is_footprint_file("A.GPKG", ""));
  EXPECT_TRUE(is_footprint_file("a.kmz", "PK\x03\x04"));
  EXPECT_FALSE(is_footprint_file("a.json", R"({"type":"CityJSON","version":"2.0"})"));
  EXPECT_FALSE(is_footprint_file("a.geojson", R"({"type":"CityJSON","version":"2.0"})"));
  EXPECT_FALSE(is_footprint_file("a.jsonl", "{\"type\":\"CityJSONFeature\",\"id\":\"a\"}\n"));
  EXPECT_FALSE(is_footprint_file("a.obj", "v 0 0 0\n"));
  EXPECT_FALSE(is_footprint_file("a.gml",
                                 "<core:CityModel xmlns:core=\"http://www.opengis.net/citygml/2.0\""
                                 " xmlns:gml=\"http://www.opengis.net/gml\">"));
  EXPECT_FALSE(is_footprint_file("a.dae", "<?xml version=\"1.0\"?><COLLADA>"));
}

}  // namespace
}  // namespace gnomon
