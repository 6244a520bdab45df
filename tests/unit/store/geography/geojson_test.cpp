// SPDX-License-Identifier: Apache-2.0
// GeoJSON: all kinds of geometry are read, texts are found by language, and what is wrong or too
// much is named by its place.
#include "store/geography/geojson.h"

#include <gtest/gtest.h>

#include "base/load_error.h"
#include "unit/folder.h"

namespace wellspring::test {
namespace {

using store::GeoFeature;
using store::GeoFile;

struct GeoJsonTest : testing::Test {
  Folder folder;
  GeoFile read(const std::string& text) const {
    return store::read_geojson(folder.write("one.geojson", text));
  }
  std::string fault(const std::string& text) const {
    try {
      read(text);
    } catch (const LoadError& error) {
      return error.where + ": " + error.what_;
    }
    return "";
  }
  // Returns the fault of a geometry's coordinates.
  std::string fault_of(const std::string& type, const std::string& coordinates) const {
    return fault(R"({"type": "FeatureCollection", "features": [{"type": "Feature",
      "properties": null, "geometry": {"type": ")" +
                 type + R"(", "coordinates": )" + coordinates + "}}]}");
  }
};

TEST_F(GeoJsonTest, ReadsAllKindsOfGeometry) {
  const GeoFile file = read(R"({"type": "FeatureCollection", "bbox": [-10, 40, 0, 20, 60, 9],
    "name": "foreign members are allowed", "features": [
    {"type": "Feature", "properties": {"name": "a"}, "geometry":
      {"type": "Point", "coordinates": [1, 2, 300]}},
    {"type": "Feature", "properties": null, "geometry":
      {"type": "MultiPoint", "coordinates": [[1, 2], [3, 4]]}},
    {"type": "Feature", "properties": {}, "geometry":
      {"type": "LineString", "coordinates": [[1, 2], [3, 4]]}},
    {"type": "Feature", "geometry":
      {"type": "MultiLineString", "coordinates": [[[1, 2], [3, 4]], [[5, 6], [7, 8], [9, 10]]]}},
    {"type": "Feature", "properties": {}, "geometry": {"type": "Polygon", "coordinates":
      [[[0, 0], [9, 0], [9, 9], [0, 0]], [[4, 1], [5, 1], [5, 2], [4, 1]]]}},
    {"type": "Feature", "properties": {}, "geometry": {"type": "MultiPolygon", "coordinates":
      [[[[0, 0], [9, 0], [9, 9], [0, 0]]], [[[20, 0], [29, 0], [29, 9], [20, 0]]]]}},
    {"type": "Feature", "properties": {"name": "b"}, "geometry": {"type": "GeometryCollection",
      "geometries": [{"type": "Point", "coordinates": [1, 2]},
                     {"type": "LineString", "coordinates": [[1, 2], [3, 4]]}]}},
    {"type": "Feature", "properties": {}, "geometry": null}]})");
  ASSERT_EQ(file.features.size(), 8u);
  using enum GeoFeature::Kind;
  const GeoFeature::Kind kinds[] = {points, points, lines, lines, areas, areas, points, lines};
  const size_t parts[] = {1, 1, 1, 2, 2, 2, 1, 1};
  for (size_t i = 0; i < 8; i++) {
    EXPECT_EQ(file.features[i].kind, kinds[i]) << i;
    EXPECT_EQ(file.features[i].parts, parts[i]) << i;
  }
  const GeoFeature &hole = file.features[4], &two = file.features[5];
  EXPECT_TRUE(file.parts[hole.first_part].begins);
  EXPECT_FALSE(file.parts[hole.first_part + 1].begins);
  EXPECT_EQ(file.parts[hole.first_part].count, 3u) << "the repeated last position is left out";
  EXPECT_TRUE(file.parts[two.first_part + 1].begins);
  EXPECT_TRUE(file.features[6].is_first);
  EXPECT_FALSE(file.features[7].is_first);
  EXPECT_EQ(file.features[7].properties->at("name"), "b");
  EXPECT_EQ(file.points[0], dvec2(1, 2));
  ASSERT_TRUE(file.bbox);
  EXPECT_EQ(file.bbox->low, dvec2(-10, 40));
  EXPECT_EQ(file.bbox->high, dvec2(20, 60));
  EXPECT_EQ(file.box.high, dvec2(29, 10));
}

TEST_F(GeoJsonTest, AnEmptyCollectionHasNothing) {
  EXPECT_TRUE(read(R"({"type": "FeatureCollection", "features": []})").features.empty());
  const GeoFile file = read(R"({"type": "Feature", "properties": {},
    "geometry": {"type": "MultiPolygon", "coordinates": []}})");
  EXPECT_TRUE(file.features.empty());
  EXPECT_TRUE(file.box.empty());
}

TEST_F(GeoJsonTest, ABoxAcrossTheDateLineIsLeftToThePoints) {
  EXPECT_FALSE(read(R"({"type": "MultiPoint", "bbox": [170, -20, -170, 20],
    "coordinates": [[179, 0], [-179, 0]]})")
                   .bbox);
}

TEST_F(GeoJsonTest, NamesThePlaceOfAFault) {
  EXPECT_NE(fault("{"), "");
  EXPECT_NE(fault(R"({"type": "Topology"})").find("/type: 'Topology' is no geometry"),
            std::string::npos);
  EXPECT_NE(fault(R"({"type": "FeatureCollection"})").find("features"), std::string::npos);
  const auto names = [](const std::string& fault, const std::string& place,
                        const std::string& what) {
    EXPECT_NE(fault.find("/features/0/geometry" + place), std::string::npos) << fault;
    EXPECT_NE(fault.find(what), std::string::npos) << fault;
  };
  names(fault_of("Point", R"([1, "2"])"), "/coordinates/1: ", "no coordinate");
  names(fault_of("Point", "[1, null]"), "/coordinates/1: ", "no coordinate");
  names(fault_of("LineString", "[[1, 2], [1e9, 4]]"), "/coordinates/1/0: ", "no coordinate");
  names(fault_of("LineString", "[[1, 2], [3]]"), "/coordinates/1: ", "no position");
  names(fault_of("LineString", "[[1, 2]]"), "/coordinates: ", "two positions");
  names(fault_of("Polygon", "[[[0, 0], [1, 0], [0, 0]]]"), "/coordinates/0: ", "four positions");
  names(fault_of("Polygon", "[[[0, 0], [1, 0], [1, 1], [0, 1]]]"),
        "/coordinates/0: ", "where it begins");
  names(fault_of("MultiPolygon", "[[[[0, 0], [1, 0], [1, 1], [0, 1]]]]"),
        "/coordinates/0/0: ", "where it begins");
  names(fault_of("Polygon", "{}"), "/coordinates: ", "no list");
  EXPECT_NE(fault_of("Point", "[1e999, 2]").find("out of range"), std::string::npos);
  EXPECT_NE(fault_of("Point", "[NaN, 2]").find("not JSON"), std::string::npos);
  EXPECT_NE(fault(R"({"type": "Point", "bbox": [1, 2, 3], "coordinates": [1, 2]})").find("/bbox"),
            std::string::npos);
}

TEST_F(GeoJsonTest, BoundsNestingAndPositions) {
  std::string deep = R"({"type": "Point", "coordinates": [1, 2]})";
  for (int i = 0; i < 10; i++)
    deep = R"({"type": "GeometryCollection", "geometries": [)" + deep + "]}";
  EXPECT_NE(fault(deep).find("deep"), std::string::npos);
  EXPECT_NE(fault_of("MultiPolygon", std::string(100000, '[') + std::string(100000, ']')), "");
  std::string many = R"({"type": "MultiPoint", "coordinates": [[0,0])";
  for (size_t i = 0; i < store::most_geo_points; i++) many += ",[0,0]";
  EXPECT_NE(fault(many + "]}").find("more than 500000 positions"), std::string::npos);
}

TEST_F(GeoJsonTest, FindsTextsByLanguage) {
  const nlohmann::json properties = {
      {"name", "Wien"},      {"name:en", "Vienna"},
      {"name_sk", "Viedeň"}, {"label", {{"en", "City"}, {"de", "Stadt"}}},
      {"number", 12},        {"long", std::string(198, 'x') + "ééé"},
      {"odd", "a\nb"}};
  const std::vector<std::string> names{"name:{language}", "name_{language}", "name"};
  EXPECT_EQ(store::geo_text(&properties, names, "en"), "Vienna");
  EXPECT_EQ(store::geo_text(&properties, names, "en-GB"), "Vienna");
  EXPECT_EQ(store::geo_text(&properties, names, "sk"), "Viedeň");
  EXPECT_EQ(store::geo_text(&properties, names, "de"), "Wien");
  EXPECT_EQ(store::geo_text(&properties, {"label"}, "de-AT"), "Stadt");
  EXPECT_EQ(store::geo_text(&properties, {"label"}, "sk"), "City");
  EXPECT_EQ(store::geo_text(&properties, {"number"}, "sk"), "12");
  EXPECT_EQ(store::geo_text(&properties, {"long"}, "sk"), std::string(198, 'x') + "é");
  EXPECT_EQ(store::geo_text(&properties, {"odd"}, "sk"), "ab");
  EXPECT_EQ(store::geo_text(&properties, {"nothing"}, "sk"), "");
  EXPECT_EQ(store::geo_text(nullptr, names, "sk"), "");
}

}  // namespace
}  // namespace wellspring::test
