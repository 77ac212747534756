#include "ifc_test_file.h"

#include <assimp/scene.h>
#include <gnomon/io/crs.h>
#include <gnomon/io/ifc_check.h>
#include <gnomon/io/ifc_map.h>
#include <gnomon/io/ifc_place.h>
#include <gnomon/io/ifc_units.h>
#include <gnomon/io/read_text.h>
#include <gtest/gtest.h>

#include <assimp/Importer.hpp>
#include <cmath>
#include <filesystem>
#include <limits>

namespace gnomon {
namespace {

IfcPlace read(const IfcTestFile& file) {
  auto place = read_ifc_place(file.text(), "t.ifc");
  if (!place) {
    ADD_FAILURE() << place.error().message;
    return {};
  }
  return std::move(place).value();
}

void expect_warning(const Warnings& warnings, const std::string& part) {
  std::string all;
  for (const Warning& w : warnings) {
    all += w.what + " [" + w.first + "]\n";
  }
  EXPECT_NE(all.find(part), std::string::npos) << "warnings:\n" << all;
}

// The house's site, in EPSG:25832, with the local x axis turned 30 degrees to the north.
std::string map_conversion(const std::string& name = "EPSG:25832", const std::string& unit = "$",
                           const std::string& scale = "$") {
  return "#90=IFCPROJECTEDCRS('" + name + "',$,'ETRS89',$,'UTM','32N'," + unit +
         ");\n#91=IFCMAPCONVERSION(#33,#90,458900.,5438785.,113.5,0.8660254037844386,0.5," + scale +
         ");\n";
}

std::string property(int id, const std::string& name, const std::string& value) {
  return "#" + std::to_string(id) + "=IFCPROPERTYSINGLEVALUE('" + name + "',$," + value + ",$);\n";
}

std::string property_sets(const std::string& eastings = "IFCLENGTHMEASURE(458900.)",
                          const std::string& northings = "IFCREAL(5438785.)",
                          const std::string& map_unit = "'METRE'") {
  return property(100, "Eastings", eastings) + property(101, "Northings", northings) +
         property(102, "OrthogonalHeight", "IFCLENGTHMEASURE(113.5)") +
         property(103, "XAxisAbscissa", "IFCREAL(0.8660254037844386)") +
         property(104, "XAxisOrdinate", "IFCREAL(0.5)") +
         property(105, "Name", "IFCLABEL('EPSG:25832')") +
         (map_unit.empty() ? "" : property(106, "MapUnit", "IFCIDENTIFIER(" + map_unit + ")")) +
         "#110=IFCPROPERTYSET('0000000000000000000010',#5,'ePset_MapConversion',$,(#100,#101,#102,"
         "#103,#104));\n"
         "#111=IFCPROPERTYSET('0000000000000000000011',#5,'ePSet_ProjectedCRS',$,(#105" +
         std::string(map_unit.empty() ? "" : ",#106") +
         "));\n"
         "#112=IFCRELDEFINESBYPROPERTIES('0000000000000000000012',#5,$,$,(#60),#110);\n"
         "#113=IFCRELDEFINESBYPROPERTIES('0000000000000000000013',#5,$,$,(#60),#111);\n";
}

IfcTestFile on_its_site() {
  IfcTestFile file;
  file.latitude = "(49,6,1,900000)";
  file.longitude = "(8,26,10)";
  file.elevation = "110.";
  return file;
}

struct Box {
  Vec3 low{std::numeric_limits<double>::infinity()}, high{-low};
  void add(const Vec3& p) {
    for (int k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], p[k]);
      high[k] = std::max(high[k], p[k]);
    }
  }
};

// What Assimp makes of the file, as it is: y up.
Box assimp_box(const std::string& text) {
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFileFromMemory(text.data(), text.size(), 0, "ifc");
  Box box;
  if (!scene) {
    ADD_FAILURE() << importer.GetErrorString();
    return box;
  }
  const auto walk = [&](const auto& self, const aiNode& node, const aiMatrix4x4& above) -> void {
    const aiMatrix4x4 here = above * node.mTransformation;
    for (unsigned m = 0; m < node.mNumMeshes; ++m) {
      const aiMesh& mesh = *scene->mMeshes[node.mMeshes[m]];
      for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
        const aiVector3D p = here * mesh.mVertices[v];
        box.add({p.x, p.y, p.z});
      }
    }
    for (unsigned c = 0; c < node.mNumChildren; ++c) self(self, *node.mChildren[c], here);
  };
  walk(walk, *scene->mRootNode, aiMatrix4x4());
  return box;
}

void expect_box(const Box& box, const Vec3& low, const Vec3& high) {
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(box.low[k], low[k], 1e-4) << "low " << k;
    EXPECT_NEAR(box.high[k], high[k], 1e-4) << "high " << k;
  }
}

// A model as a reader of local metres gives it: the four lower corners of the test file's box.
Model local_model() {
  Model model;
  model.vertices = {{1, 2, 0}, {11, 2, 0}, {11, 7, 0}, {1, 7, 3}};
  return model;
}

Vec3 placed(const Model& model, std::size_t k) {
  return model.vertices[k] * model.scale + model.translate;
}

TEST(IfcByAssimp, YIsUpAndMillimetresComeAsMetres) {
  expect_box(assimp_box(IfcTestFile().text()), {1, 0, -7}, {11, 3, -2});
  IfcTestFile file;
  file.unit = kIfcMillimetres;
  expect_box(assimp_box(file.text()), {0.001, 0, -0.007}, {0.011, 0.003, -0.002});
  EXPECT_EQ(read(file).metres_per_unit, 0.001);
  EXPECT_EQ(read(file).assimp_metres_per_unit, 1);
}

TEST(IfcByAssimp, FeetComeAsIfTheyWereMetres) {
  IfcTestFile file;
  file.unit = kIfcFeet;
  expect_box(assimp_box(file.text()), {1, 0, -7}, {11, 3, -2});
  EXPECT_NEAR(read(file).metres_per_unit, 0.3048, 1e-15);
  EXPECT_NEAR(read(file).assimp_metres_per_unit, 0.3048, 1e-15);
  Model model = local_model();
  place_ifc(model, read(file));
  EXPECT_NEAR(placed(model, 1).x, 11 * 0.3048, 1e-12);
}

TEST(IfcByAssimp, TrueNorthSiteAndMapConversionChangeNothing) {
  IfcTestFile file = on_its_site();
  file.north = "#32";
  file.more = property_sets() + map_conversion();
  expect_box(assimp_box(file.text()), {1, 0, -7}, {11, 3, -2});
}

TEST(IfcByAssimp, WorldCoordinateSystemIsApplied) {
  IfcTestFile file;
  file.world =
      "#28=IFCCARTESIANPOINT((100.,200.,7.));\n#29=IFCDIRECTION((0.,0.,1.));\n"
      "#30=IFCDIRECTION((0.,1.,0.));\n#31=IFCAXIS2PLACEMENT3D(#28,#29,#30);";
  // x becomes y, y becomes -x: 100 - 7 .. 100 - 2, 200 + 1 .. 200 + 11.
  expect_box(assimp_box(file.text()), {93, 7, -211}, {98, 10, -201});
}

TEST(IfcPlace, TrueNorthIsClockwiseFromY) {
  IfcTestFile file;
  EXPECT_FALSE(read(file).true_north);
  file.north = "#32";
  const IfcPlace place = read(file);
  EXPECT_NEAR(*place.true_north, 30 * kDegree, 1e-12);
  EXPECT_TRUE(place.warnings.empty());
  EXPECT_EQ(place.schema, "IFC2X3");
  EXPECT_EQ(place.metres_per_unit, 1);

  Model model = local_model();
  place_ifc(model, place);
  EXPECT_NEAR(*model.north, 30 * kDegree, 1e-12);
  EXPECT_FALSE(model.site);
  EXPECT_EQ(placed(model, 1), Vec3(11, 2, 0));  // turning the sun is enough
}

TEST(IfcPlace, TrueNorthTurnsWithTheWorldCoordinateSystem) {
  IfcTestFile file;
  file.north = "#32";
  file.world =
      "#29=IFCDIRECTION((0.,0.,1.));\n#30=IFCDIRECTION((0.,1.,0.));\n"
      "#31=IFCAXIS2PLACEMENT3D(#50,#29,#30);";
  const IfcPlace place = read(file);
  EXPECT_NEAR(*place.true_north, -60 * kDegree, 1e-12);
  expect_warning(place.warnings, "WorldCoordinateSystem is not the origin");
}

TEST(IfcPlace, TrueNorthWithoutDirectionIsAWarning) {
  IfcTestFile file;
  file.north = "#73";  // straight up
  const IfcPlace place = read(file);
  EXPECT_FALSE(place.true_north);
  expect_warning(place.warnings, "TrueNorth is no direction");
}

TEST(IfcPlace, TheSitesAnglesAreAddedUp) {
  const IfcPlace place = read(on_its_site());
  ASSERT_TRUE(place.site);
  EXPECT_NEAR(place.site->latitude / kDegree, 49 + 6 / 60.0 + 1.9 / 3600, 1e-12);
  EXPECT_NEAR(place.site->longitude / kDegree, 8 + 26 / 60.0 + 10 / 3600.0, 1e-12);
  EXPECT_EQ(place.site->height, 110);
  Model model = local_model();
  place_ifc(model, place);
  EXPECT_EQ(model.site->latitude, place.site->latitude);
  EXPECT_TRUE(model.report.crs.empty());
}

TEST(IfcPlace, ElevationIsInTheProjectsUnit) {
  IfcTestFile file = on_its_site();
  file.unit = kIfcFeet;
  EXPECT_NEAR(read(file).site->height, 110 * 0.3048, 1e-12);
}

TEST(IfcPlace, SouthAndWestAreNegativeInEveryPart) {
  IfcTestFile file;
  file.latitude = "(-33,-51,-35)";
  file.longitude = "(0,-7,-30,-500000)";
  const IfcPlace place = read(file);
  EXPECT_NEAR(place.site->latitude / kDegree, -(33 + 51 / 60.0 + 35 / 3600.0), 1e-12);
  EXPECT_NEAR(place.site->longitude / kDegree, -(7 / 60.0 + 30.5 / 3600.0), 1e-12);
  EXPECT_TRUE(place.warnings.empty());
  file.latitude = "(-33,51,35)";
  EXPECT_NEAR(read(file).site->latitude, place.site->latitude, 1e-15);
  expect_warning(read(file).warnings, "different signs");
}

TEST(IfcPlace, AnglesOutOfRangeAreAWarningAndNoPlace) {
  for (const std::string bad : {"(91,0,0)", "(49,60,0)", "(49,6,1,1000000)", "(49,6)", "(49.5,0,0)",
                                "()", "'49'", "(90,0,1)", "(1,2,3,4,5)"}) {
    IfcTestFile file = on_its_site();
    file.latitude = bad;
    const IfcPlace place = read(file);
    EXPECT_FALSE(place.site) << bad;
    expect_warning(place.warnings, "latitude and longitude cannot be read");
  }
  IfcTestFile file;
  file.latitude = file.longitude = "(0,0,0)";
  EXPECT_FALSE(read(file).site);
  expect_warning(read(file).warnings, "taken as not given");
}

// Local (11, 2, 0) turned by 30 degrees counter-clockwise and moved.
const Vec3 kCorner(458900 + 11 * std::sqrt(0.75) - 2 * 0.5,
                   5438785 + 11 * 0.5 + 2 * std::sqrt(0.75), 113.5);

void expect_corner(const IfcPlace& place, double tolerance = 1e-8) {
  Model model = local_model();
  place_ifc(model, place);
  const Vec3 p = placed(model, 1);
  EXPECT_NEAR(p.x, kCorner.x, tolerance);
  EXPECT_NEAR(p.y, kCorner.y, tolerance);
  EXPECT_NEAR(p.z, kCorner.z, tolerance);
  EXPECT_EQ(model.report.crs, "EPSG:25832");
  EXPECT_FALSE(model.site);
  EXPECT_FALSE(model.north);
}

TEST(IfcPlace, PropertySetsOfIfc2x3PlaceTheModelInItsCrs) {
  IfcTestFile file;
  file.more = property_sets();
  const IfcPlace place = read(file);
  ASSERT_TRUE(place.conversion);
  EXPECT_EQ(place.conversion->crs, "EPSG:25832");
  EXPECT_TRUE(place.warnings.empty());
  expect_corner(place);
}

TEST(IfcPlace, MapConversionOfIfc4PlacesTheModelInItsCrs) {
  IfcTestFile file;
  file.schema = "IFC4";
  file.more = map_conversion();
  const IfcPlace place = read(file);
  EXPECT_EQ(place.schema, "IFC4");
  expect_warning(place.warnings, "not IFC2x3");
  expect_corner(place);
}

TEST(IfcPlace, WithBothTheConversionTurnsTheModelOnce) {
  IfcTestFile file = on_its_site();
  file.more = property_sets();
  file.north = "#32";  // the same 30 degrees, as programs write it that mean grid north
  IfcPlace place = read(file);
  EXPECT_TRUE(place.true_north);
  EXPECT_TRUE(place.warnings.empty());
  expect_corner(place);

  file.north = "$";
  EXPECT_TRUE(read(file).warnings.empty());  // not given: nothing that could disagree
  file.north = "#35";
  file.more += "#35=IFCDIRECTION((0.,1.));\n";
  place = read(file);
  expect_warning(place.warnings, "TrueNorth do not agree");
  expect_corner(place);
}

TEST(IfcPlace, ASiteFarFromTheMapIsAWarning) {
  IfcTestFile file;
  file.latitude = "(52,31,0)";  // what ArchiCAD writes where nobody said
  file.longitude = "(13,24,0)";
  file.more = property_sets();
  const IfcPlace place = read(file);
  expect_warning(place.warnings, "latitude and longitude do not agree");
  expect_corner(place);
}

TEST(IfcPlace, TheMapsUnitAndTheScaleGoTogether) {
  IfcTestFile file;
  file.unit = kIfcMillimetres;
  file.more =
      map_conversion("EPSG:25832", "#95", "0.001") + "#95=IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.);\n";
  IfcPlace place = read(file);
  EXPECT_EQ(place.conversion->scale, 1);
  EXPECT_TRUE(place.warnings.empty());
  expect_corner(place);

  // In millimetres throughout, as IFC has it where no map unit is given.
  file.more = property_sets("IFCLENGTHMEASURE(458900000.)", "IFCREAL(5438785000.)", "");
  file.more.replace(file.more.find("(113.5)"), 7, "(113500.)");
  place = read(file);
  EXPECT_TRUE(place.warnings.empty());
  expect_corner(place);
}

TEST(IfcPlace, AScaleWithoutTheUnitsIsTakenForTheMapsAlone) {
  IfcTestFile file;
  file.unit = kIfcMillimetres;
  file.more =
      map_conversion("EPSG:25832", "#95", "0.9996") + "#95=IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.);\n";
  const IfcPlace place = read(file);
  EXPECT_EQ(place.conversion->scale, 0.9996);
  expect_warning(place.warnings, "does not turn the project's length unit");
  Model model = local_model();
  place_ifc(model, place);
  const Vec3 along = placed(model, 1) - placed(model, 0);
  EXPECT_NEAR(std::hypot(along.x, along.y), 10 * 0.9996, 1e-8);
}

TEST(IfcPlace, AScaleThatChangesTheModelsSizeIsNotUsed) {
  IfcTestFile file;
  file.more = map_conversion("EPSG:25832", "$", "0.001");
  const IfcPlace place = read(file);
  EXPECT_EQ(place.conversion->scale, 1);
  expect_warning(place.warnings, "would change the model's size");
  expect_corner(place);
}

TEST(IfcPlace, MetresInAFileOfMillimetresAreFoundOut) {
  IfcTestFile file;
  file.unit = kIfcMillimetres;
  file.more = property_sets("IFCLENGTHMEASURE(458900.)", "IFCREAL(5438785.)", "");
  const IfcPlace place = read(file);
  expect_warning(place.warnings, "another unit was taken");
  expect_corner(place);
}

TEST(IfcPlace, AnUnknownCrsLeavesTheMapsCoordinatesAndTheSite) {
  IfcTestFile file = on_its_site();
  file.north = "#32";
  file.more = property_sets();
  file.more.replace(file.more.find("EPSG:25832"), 10, "our own");
  const IfcPlace place = read(file);
  expect_warning(place.warnings, "not known to PROJ");
  Model model = local_model();
  place_ifc(model, place);
  EXPECT_NEAR(placed(model, 1).x, kCorner.x, 1e-8);
  EXPECT_TRUE(model.report.crs.empty());
  EXPECT_TRUE(model.site);
  EXPECT_NEAR(*model.north, 0, 1e-12);  // 30 degrees of TrueNorth, which the vertices now have
}

TEST(IfcPlace, AConversionThatCannotBeReadIsAWarning) {
  IfcTestFile file = on_its_site();
  file.more = property_sets("IFCLABEL('far')");
  const IfcPlace place = read(file);
  EXPECT_FALSE(place.conversion);
  EXPECT_TRUE(place.site);
  expect_warning(place.warnings, "number of the map conversion cannot be read");
  expect_warning(place.warnings, "no eastings or northings");
}

TEST(IfcPlace, NamesOfCrsAreReadAsProgramsWriteThem) {
  for (const std::string name : {"EPSG:25832", "epsg:25832", "EPSG 25832", "25832", "EPSG_25832",
                                 "urn:ogc:def:crs:EPSG::25832"}) {
    EXPECT_EQ(ifc_crs(name), "EPSG:25832") << name;
  }
  EXPECT_EQ(ifc_crs("ETRS89 / UTM zone 32N"), "ETRS89 / UTM zone 32N");
  IfcTestFile file;
  file.more = map_conversion("ETRS89 / UTM zone 32N");
  EXPECT_TRUE(read(file).warnings.empty());
}

TEST(IfcPlace, NamesOfUnitsAreReadAsProgramsWriteThem) {
  for (const std::string name : {"METRE", "meter", "Metres", "m"}) {
    EXPECT_EQ(ifc_length_unit_named(name), 1.0) << name;
  }
  EXPECT_EQ(ifc_length_unit_named("MILLIMETRE"), 0.001);
  EXPECT_EQ(ifc_length_unit_named("foot"), 0.3048);
  EXPECT_NEAR(*ifc_length_unit_named("US survey foot"), 0.3048006096, 1e-10);
  EXPECT_FALSE(ifc_length_unit_named("cubit"));
  EXPECT_FALSE(ifc_length_unit_named("KILOGRAM"));
}

TEST(IfcPlace, AProjectWithoutLengthUnitIsAWarning) {
  IfcTestFile file;
  file.unit = "#20=IFCSIUNIT(*,.AREAUNIT.,$,.SQUARE_METRE.);";
  expect_warning(read(file).warnings, "no length unit");
  file.unit =  // a unit of itself would be a circle, which check_ifc refuses
      "#18=IFCMEASUREWITHUNIT(IFCLENGTHMEASURE(0.),#19);\n"
      "#19=IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.);\n"
      "#20=IFCCONVERSIONBASEDUNIT($,.LENGTHUNIT.,'NOTHING',#18);";
  expect_warning(read(file).warnings, "no length unit");
}

void expect_error(const std::string& text, const std::string& part) {
  const auto place = read_ifc_place(text, "t.ifc");
  ASSERT_FALSE(place);
  EXPECT_NE(place.error().message.find(part), std::string::npos) << place.error().message;
}

TEST(IfcCheck, WhatAssimpWouldCrashOnIsAnError) {
  IfcTestFile file;
  file.body = "#76=IFCEXTRUDEDAREASOLID(#999,#75,#73,3.);";
  expect_error(file.text(), "t.ifc: line 36: #76 (IFCEXTRUDEDAREASOLID) refers to #999");
  file = {};
  file.placement = "#52=IFCLOCALPLACEMENT(#52,#51);";
  expect_error(file.text(), "#52 (IFCLOCALPLACEMENT) contains itself");
  file = {};
  file.more = "#99=IFCRELAGGREGATES('0000000000000000000099',#5,$,$,#62,(#60));\n";
  expect_error(file.text(), "contains itself");
}

TEST(IfcCheck, BodiesOfIfc4AreAnErrorThatSaysWhatToDo) {
  IfcTestFile file;
  file.schema = "IFC4";
  file.body =
      "#75001=IFCCARTESIANPOINTLIST3D(((0.,0.,0.),(1.,0.,0.),(0.,1.,0.)));\n"
      "#76=IFCTRIANGULATEDFACESET(#75001,$,.T.,((1,2,3)),$);";
  expect_error(file.text(),
               "#76 is \"IFCTRIANGULATEDFACESET\", which IFC2x3 does not have (the "
               "file's schema is \"IFC4\"); IFC2x3 is read, so export");
}

TEST(IfcCheck, OtherSchemasAreErrors) {
  IfcTestFile file;
  file.schema = "AUTOMOTIVE_DESIGN";
  expect_error(file.text(), "t.ifc: is a STEP file of the schema \"AUTOMOTIVE_DESIGN\", not IFC.");
  file.schema = "IFC2X2_FINAL";
  expect_error(file.text(), "its schema is \"IFC2X2_FINAL\"");
}

TEST(IfcCheck, FilesThatWereCutOffAreErrors) {
  const std::string text = IfcTestFile().text();
  for (std::size_t size = 0; size + 2 < text.size(); size += 7) {
    EXPECT_FALSE(read_ifc_place(text.substr(0, size), "t.ifc")) << size;
  }
}

TEST(IfcPlace, ChangedBytesNeverCrash) {
  IfcTestFile file = on_its_site();
  file.north = "#32";
  file.more = property_sets() + map_conversion();
  const std::string text = file.text();
  std::size_t read = 0;
  for (std::size_t at = 0; at < text.size(); at += 61) {  // PROJ takes 10 ms each
    for (const char c : std::string("$1(#-", 5)) {
      std::string changed = text;
      changed[at] = c;
      const auto place = read_ifc_place(changed, "t.ifc");
      if (!place) continue;
      ++read;
      Model model = local_model();
      place_ifc(model, place.value());
      EXPECT_TRUE(std::isfinite(placed(model, 1).x));
    }
  }
  EXPECT_GT(read, 0u);
}

TEST(IfcPlace, TheFzkHouseSaysBerlinAndNorth) {
  const std::filesystem::path path =
      std::filesystem::path(GNOMON_DATA) / "ifc" / "AC14-FZK-Haus.ifc";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "skipped: " << path << " is missing";
  const auto text = read_text(path);
  ASSERT_TRUE(text);
  const auto place = read_ifc_place(text.value(), path.string());
  ASSERT_TRUE(place) << place.error().message;
  EXPECT_EQ(place.value().metres_per_unit, 1);
  EXPECT_NEAR(*place.value().true_north, 0, 1e-15);
  EXPECT_NEAR(place.value().site->latitude / kDegree, 52 + 31 / 60.0, 1e-12);
  EXPECT_NEAR(place.value().site->longitude / kDegree, 13.4, 1e-12);
  EXPECT_TRUE(place.value().warnings.empty());
}

}  // namespace
}  // namespace gnomon
