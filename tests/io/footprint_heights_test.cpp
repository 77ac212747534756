#include <gnomon/io/footprint_layer.h>
#include <gnomon/io/osm_tags.h>

#include "io/footprint_test_files.h"

namespace gnomon {
namespace {

TEST(OsmTags, LengthsAreReadWithTheirUnits) {
  EXPECT_EQ(parse_metres("12"), 12);
  EXPECT_EQ(parse_metres(" 12 m "), 12);
  EXPECT_EQ(parse_metres("12.5m"), 12.5);
  EXPECT_EQ(parse_metres("12,5"), 12.5);
  EXPECT_EQ(parse_metres("+3 metres"), 3);
  EXPECT_DOUBLE_EQ(*parse_metres("40 ft"), 40 * 0.3048);
  EXPECT_DOUBLE_EQ(*parse_metres("40'"), 40 * 0.3048);
  EXPECT_DOUBLE_EQ(*parse_metres("12'6\""), 12.5 * 0.3048);
  EXPECT_DOUBLE_EQ(*parse_metres("12 ft 6 in"), 12.5 * 0.3048);
  EXPECT_EQ(parse_number("1e-3"), 1e-3);
  for (const char* bad : {"", "tall", "~12", "10-12", "12;15", "1,200", "12 km", "nan", "inf", "m",
                          "12 m x", "1e999", "--3", "12'6"}) {
    EXPECT_FALSE(parse_metres(bad)) << bad;
  }
}

TEST(OsmTags, PackedTagsAreTakenApart) {
  const auto hstore = parse_tags(R"("height"=>"12 m", "name"=>"The \"Inn\"","x"=>NULL)");
  ASSERT_TRUE(hstore);
  EXPECT_EQ(*hstore, (Tags{{"height", "12 m"}, {"name", "The \"Inn\""}}));
  const auto json = parse_tags(R"({"height":12.5,"levels":"3","x":null})");
  ASSERT_TRUE(json);
  EXPECT_EQ(*json, (Tags{{"height", "12.5"}, {"levels", "3"}}));
  EXPECT_FALSE(parse_tags("a,b"));
  EXPECT_FALSE(parse_tags(R"("height"=>"12)"));
  EXPECT_FALSE(parse_tags(R"({"height":)"));
}

TEST_F(FootprintLayer, HeightsComeFromTheUsualAttributesInAnyCase) {
  const std::pair<const char*, double> cases[] = {
      {R"("height":"12 m")", 12},
      {R"("HEIGHT":12.25)", 12.25},
      {R"("building:height":"40'")", 40 * 0.3048},
      {R"("measuredHeight":7)", 7},
      {R"("bouwhoogte":8)", 8},
      {R"("building:levels":"4")", 12},
      {R"("num_floors":4)", 12},
      {R"("height":null,"building:levels":2)", 6},
      {R"("height":20,"building:levels":2)", 20},
      {R"("building:levels":2,"roof:levels":1)", 9},
      {R"("building:levels":2,"roof:levels":1,"roof:height":"2.5")", 8.5},
      {R"("tags":{"height":"9"})", 9},
      {R"("other_tags":"\"building\"=>\"yes\",\"height\"=>\"9.5\"")", 9.5}};
  for (const auto& [properties, expected] : cases) {
    EXPECT_DOUBLE_EQ(top(model(collection({house(properties)}))), expected) << properties;
  }
}

TEST_F(FootprintLayer, NamedAttributesAreTakenInsteadOfTheUsualOnes) {
  FootprintOptions options;
  options.height = "Eaves";
  options.floors = "n";
  options.floor_height = 4;
  EXPECT_EQ(top(model(collection({house(R"("height":99,"eaves":5,"n":1)")}), options)), 5);
  EXPECT_EQ(top(model(collection({house(R"("height":99,"eaves":null,"n":2)")}), options)), 8);
  const std::string why = refusal(collection({house(R"("height":99,"n":1)")}), options);
  EXPECT_TRUE(has(why, "no attribute \"Eaves\"; it has height, n")) << why;
  options = {};
  options.floor_height = 0;
  EXPECT_TRUE(has(refusal(collection({house(R"("height":9)")}), options), "storey"));
}

TEST_F(FootprintLayer, MinHeightRaisesTheFloor) {
  const Model m =
      model(collection({house(R"("height":10,"min_height":4)", 0, "a"),
                        house(R"("building:levels":5,"building:min_level":2)", 20, "b")}));
  auto h = heights(m);
  EXPECT_EQ(h["a"].low, 4);
  EXPECT_EQ(h["a"].high, 10);
  EXPECT_EQ(h["b"].low, 6);
  EXPECT_EQ(h["b"].high, 15);
  EXPECT_TRUE(watertight(m));
  // The made ground must not rise to them.
  EXPECT_EQ(count(m, "GroundSurface"), 0u);
  EXPECT_EQ(count(m, "OuterCeilingSurface"), 2u);
  EXPECT_EQ(m.surfaces[0].group, "BuildingInstallation");
}

TEST_F(FootprintLayer, UnusableHeightsAreLeftOutAndTheFirstIsNamed) {
  const Model m = model(
      collection({house(R"("height":"3")"), house(R"("height":"0")", 20, "way/7"),
                  house(R"("height":"-4")", 40), house(R"("height":"tall")", 60),
                  house(R"("height":"NaN")", 80), house(R"("height":"4","min_height":"4")", 100),
                  house(R"("height":"4","min_height":"?")", 120)}));
  EXPECT_EQ(m.report.objects, 1u);
  const Warning w = warning(m, "cannot be used");
  EXPECT_EQ(w.count, 6u);
  EXPECT_TRUE(has(w.first, "town.geojson: feature 2 (id way/7): height is \"0\"")) << w.first;
  const std::string why = refusal(collection({house(R"("height":"tall")")}));
  EXPECT_TRUE(has(why, "height is \"tall\"")) << why;
}

TEST_F(FootprintLayer, BooleansAreNoHeights) {
  // GDAL alone makes 1 of true in a column of numbers, and of a column of booleans.
  const Model m = model(collection({house(R"("height":12.25)"), house("\"HEIGHT\" :\ttrue", 20),
                                    house(R"("height": false)", 40, "f"),
                                    house(R"("height":7,"note":"\"height\": true")", 60)}));
  EXPECT_EQ(m.report.objects, 2u);
  EXPECT_EQ(heights(m)["feature 1"].high, 12.25);
  const Warning w = warning(m, "cannot be used");
  EXPECT_EQ(w.count, 2u);
  EXPECT_TRUE(has(w.first, "town.geojson: feature 2: height is \"true\"")) << w.first;
  const std::string why = refusal(collection({house(R"("height":true)")}));
  EXPECT_TRUE(has(why, "height is \"true\"")) << why;
}

TEST_F(FootprintLayer, AListOrAnObjectLeavesTheHeightsOfTheOtherFeatures) {
  // GDAL alone makes lists of all of them.
  const Model m = model(
      collection({house("\"height\":[5,\n\"6:\\\"]\"],\"levels\":3"), house(R"("height":4)", 20),
                  house(R"("height":{"m":[9]})", 40), house(R"("height":2.25)", 60)}));
  EXPECT_EQ(heights(m)["feature 2"].high, 4);
  EXPECT_EQ(heights(m)["feature 4"].high, 2.25);
  const Warning w = warning(m, "cannot be used");
  EXPECT_EQ(w.count, 2u);
  EXPECT_TRUE(has(w.first, R"(feature 1: height is "[5, "6:\"]"]")")) << w.first;
  FootprintOptions options;
  options.height = "geometry";  // GeoJSON's own member
  EXPECT_TRUE(has(refusal(collection({house(R"("height":4)")}), options), "no attribute"));
}

TEST_F(FootprintLayer, ReasonsOfARefusalAreNoWarnings) {
  const auto expect = [&](const std::string& text, const std::string& part) {
    const std::string why = refusal(text);
    EXPECT_TRUE(why.ends_with("town.geojson: " + part)) << why;
  };
  const std::string nowhere = feature(R"("height":5)", "null");
  expect(collection({nowhere}), "its only feature has no geometry.");
  expect(collection({nowhere, nowhere}), "none of its 2 features has a geometry.");
  expect(collection({house(R"("height":true)")}),
         "its only feature has no height that can be used (feature 1: height is \"true\").");
  expect(collection({house(R"("building":"no")"), nowhere}),
         "none of its 2 features is the footprint of a building (1 x Features with building=no "
         "were left out; 1 x Features without a geometry were left out).");
}

TEST_F(FootprintLayer, ListsAndObjectsInPackedTagsAreNoHeights) {
  const Model m = model(collection({house(R"("tags":{"height":"9","colour":["red"]})"),
                                    house(R"("tags":{"height":[9]})", 20),
                                    house(R"("tags":{"height":{"m":9}})", 40)}));
  EXPECT_EQ(m.report.objects, 1u);
  const Warning w = warning(m, "cannot be used");
  EXPECT_EQ(w.count, 2u);
  EXPECT_TRUE(has(w.first, "feature 2: height is \"[9]\"")) << w.first;
}

TEST_F(FootprintLayer, WhereNoAttributeHasANameOfHeightsTheFilesOwnAreTold) {
  const Model m = model(collection({house(R"("levels":3,"hohe":9)"), house(R"("hohe":9)", 20)}));
  const Warning w = warning(m, "without a height");
  EXPECT_EQ(w.count, 1u);
  EXPECT_TRUE(has(w.what, "attributes of the file: levels, hohe")) << w.what;
}

TEST_F(FootprintLayer, FeaturesWithoutHeightAreCountedAndAFileOfThemIsRefused) {
  const Model m =
      model(collection({house(R"("height":3)"), house(R"("use":"x")", 20, "q"), house("", 40)}));
  const Warning w = warning(m, "without a height");
  EXPECT_EQ(w.count, 2u);
  EXPECT_TRUE(has(w.first, "feature 2 (id q)")) << w.first;
  EXPECT_TRUE(has(w.what, "height, building:height") && has(w.what, "building:levels") &&
              w.what.size() < 250)
      << w.what;
  const std::string why = refusal(collection({house(R"("use":"x","stock":2)")}));
  EXPECT_TRUE(has(why, "its only footprint has no height (looked")) << why;
  EXPECT_TRUE(has(why, "its attributes: use, stock")) << why;
}

}  // namespace
}  // namespace gnomon
