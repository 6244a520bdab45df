// SPDX-License-Identifier: Apache-2.0
// Maps of GeoJSON: outlines lie on the right texels, tiles meet, levels agree, names are in the
// language that was asked for, and much data is drawn quickly.
#include <cairo.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "base/clock.h"
#include "base/load_error.h"
#include "store/open/open_picture.h"
#include "store/painting/draw_geo.h"
#include "store/painting/geo_drawing.h"
#include "store/painting/painted_picture.h"
#include "unit/folder.h"

namespace wellspring::test {
namespace {

using store::open_geojson;
using store::open_painting;
using store::PaintedPicture;
using store::Piece;
using store::PieceKey;

using Picture = std::shared_ptr<const PaintedPicture>;

std::string feature(const std::string& type, const std::string& coordinates,
                    const std::string& properties = "{}") {
  return R"({"type": "Feature", "properties": )" + properties + R"(, "geometry": {"type": ")" +
         type + R"(", "coordinates": )" + coordinates + "}}";
}

std::string collection(const std::string& features, const std::string& more = "") {
  return R"({"type": "FeatureCollection", )" + more + R"("features": [)" + features + "]}";
}

struct GeoPictureTest : testing::Test {
  Folder folder;
  Picture open(const std::string& text, const std::string& language = "en") const {
    return open_geojson(folder.write("one.geojson", text), language);
  }
  // Opens a painting of 4096 x 4096 texels, a metre wide, that shows the file.
  Picture paint(const std::string& text, const std::string& item,
                const std::string& language = "en") const {
    folder.write("one.geojson", text);
    return open_painting(
        folder.write("one.painting.json",
                     R"({"width": 4096, "height": 4096, "metres": 1, "layers": [{"name": "map",
        "ground": "#ffffff", "items": [{"geojson": "one.geojson", )" +
                         item + "}]}]}"),
        "", language);
  }
  std::string fault(const std::string& text, const std::string& item) const {
    try {
      paint(text, item);
    } catch (const LoadError& error) {
      return error.file + ": " + error.where + ": " + error.what_;
    }
    return "";
  }
};

// Returns the red code of a texel of level 0.
int red_at(const Picture& picture, int64_t x, int64_t y) {
  return picture->paint(0, x, y, 1, 1).bytes[0];
}

double mean_of(const Piece& piece) {
  double sum = 0;
  for (size_t i = 0; i < piece.bytes.size(); i += 4) sum += piece.bytes[i];
  return sum / double(piece.bytes.size() / 4);
}

const char* const black = R"("bounds": [0, 0, 4096, 4096], "frame": [0, 0, 1, 1],
  "style": {"fill": "#000000", "stroke": "#000000", "width_mm": 0})";

TEST_F(GeoPictureTest, AnAreaCoversTheTexelsOfItsPlaces) {
  // A coordinate is a texel here, north is up: y of texels is 4096 - y.
  const Picture picture =
      paint(collection(feature("Polygon",
                               "[[[1000, 3096], [2000, 3096], [2000, 2096], [1000, 2096], "
                               "[1000, 3096]], [[1400, 2696], [1500, 2696], [1500, 2596], "
                               "[1400, 2596], [1400, 2696]]]")),
            black);
  const Piece part = picture->paint(0, 900, 900, 1200, 1200);
  int wrong = 0;
  for (int y = 0; y < 1200; y++)
    for (int x = 0; x < 1200; x++) {
      const int u = x + 900, v = y + 900;
      const bool within = u >= 1000 && u < 2000 && v >= 1000 && v < 2000;
      const bool hole = u >= 1400 && u < 1500 && v >= 1400 && v < 1500;
      const int code = part.bytes[size_t(4 * (1200 * y + x))];
      wrong += code != (within && !hole ? 0 : 255);
    }
  EXPECT_EQ(wrong, 0);
}

TEST_F(GeoPictureTest, PolygonsOfOneFeatureDoNotCutHolesIntoEachOther) {
  const Picture picture =
      paint(collection(feature("MultiPolygon",
                               "[[[[1000, 3096], [2000, 3096], [2000, 2096], [1000, "
                               "2096], [1000, 3096]]], [[[1500, 3096], [2500, 3096], "
                               "[2500, 2096], [1500, 2096], [1500, 3096]]]]")),
            black);
  for (int64_t x : {1200, 1800, 2300}) EXPECT_EQ(red_at(picture, x, 1500), 0) << x;
  EXPECT_EQ(red_at(picture, 2600, 1500), 255);
}

TEST_F(GeoPictureTest, LinesAndPointsHaveTheirWidthInMillimetres) {
  // A texel is 1/4.096 mm: a line of 5 mm is 20.5 texels wide.
  const Picture picture = paint(collection(feature("LineString", "[[0, 2048], [4096, 2048]]") +
                                           "," + feature("Point", "[1000, 1000]")),
                                R"("bounds": [0, 0, 4096, 4096], "frame": [0, 0, 1, 1],
      "style": {"fill": "#000000", "stroke": "#000000", "width_mm": 5, "radius_mm": 10})");
  for (int off : {-9, 0, 9}) EXPECT_EQ(red_at(picture, 3000, 2048 + off), 0) << off;
  for (int off : {-12, 12}) EXPECT_EQ(red_at(picture, 3000, 2048 + off), 255) << off;
  // The disc's radius is 41 texels, and its ring 20.5 more.
  for (int off : {0, 59}) EXPECT_EQ(red_at(picture, 1000 + off, 3096), 0) << off;
  EXPECT_EQ(red_at(picture, 1000 + 64, 3096), 255);
}

TEST_F(GeoPictureTest, AreasCloseAsTheyAreOnTheGround) {
  // A degree of longitude is half as long at 60 degrees north: 2 by 1 degrees are a square.
  const std::string square =
      feature("Polygon", "[[[10, 59.5], [12, 59.5], [12, 60.5], [10, 60.5], [10, 59.5]]]");
  const Picture picture = open(collection(square, R"("bbox": [10, 59.5, 12, 60.5], )"));
  const auto& level = picture->levels()[0];
  EXPECT_EQ(level.width, 32768);
  EXPECT_NEAR(double(level.height), 32768, 2);
  // A file without a bbox has a border.
  const Picture bare = open(collection(square));
  EXPECT_EQ(bare->paint(5, 2, 2, 1, 1).bytes[0], 255);
  EXPECT_LT(bare->paint(5, 512, 512, 1, 1).bytes[0], 250);
  // In a painting the map keeps its shape in the middle of the frame.
  const Picture wide = paint(collection(square), R"("style": {"fill": "#000000"},
    "frame": [0, 0, 1, 0.5])");
  EXPECT_EQ(red_at(wide, 2048, 1024), 0);
  EXPECT_EQ(red_at(wide, 1100, 1024), 0);
  EXPECT_EQ(red_at(wide, 1000, 1024), 255);
}

// Returns a rough ring of many corners, as JSON.
std::string rough_ring(int count, double x, double y, double radius) {
  std::string ring = "[", first;
  for (int i = 0; i < count; i++) {
    const double turn = 2 * double(pi) * i / count;
    const double far = radius * (1 + 0.2 * std::sin(9 * turn) + 0.03 * std::sin(377 * turn));
    char place[80];
    std::snprintf(place, sizeof place, "[%.6f, %.6f]", x + far * std::cos(turn),
                  y + far * std::sin(turn));
    if (i == 0) first = place;
    ring += std::string(place) + ", ";
  }
  return ring + first + "]";
}

std::string valley() {
  return collection(
      feature("Polygon",
              "[" + rough_ring(4000, 20, 48, 3) + ", " + rough_ring(800, 20, 48, 1) + "]",
              R"({"name": "Valley", "name_de": "Tal", "fill": "#3080c0"})") +
      "," +
      feature("LineString", "[[14, 45], [26, 51.37], [15, 50], [15.01, 44]]",
              R"({"name": "The long river", "stroke": "#c02020", "stroke-width": 4})") +
      "," + feature("Point", "[21, 49]", R"({"name": "Town"})"));
}

TEST_F(GeoPictureTest, TilesMeetAsOneDrawing) {
  const Picture picture = open(valley());
  for (int level = 0; level < int(picture->levels().size()) - 1; level++) {
    const auto& size = picture->levels()[size_t(level)];
    const int column = size.columns() * 5 / 12, row = size.rows() * 5 / 12;
    if (column + 2 > size.columns() || row + 2 > size.rows()) continue;
    const int width = 256 + size.width_at(column + 1), height = 256 + size.height_at(row + 1);
    const Piece both =
        picture->paint(level, int64_t(column) * 256, int64_t(row) * 256, width, height);
    int most = 0, differ = 0;
    for (int k = 0; k < 4; k++) {
      const int right = k % 2, below = k / 2;
      const auto tile =
          picture->fetch(PieceKey(1, level, uint32_t(column + right), uint32_t(row + below))).piece;
      for (int y = 0; y < tile->height; y++)
        for (int x = 0; x < 4 * tile->width; x++) {
          const int whole = both.bytes[size_t(4 * width * (256 * below + y) + 4 * 256 * right + x)];
          const int off = std::abs(whole - int(tile->bytes[size_t(4 * tile->width * y + x)]));
          most = std::max(most, off), differ += off > 1;
        }
    }
    // The corners are the same numbers. Cairo measures a row of texels by 15 samples, or exactly if
    // no edge ends in it, even far away: borders of ink differ by up to a fifteenth.
    EXPECT_LE(most, 17) << "level " << level;
    EXPECT_LE(differ, 2000) << "of a million codes, level " << level;
  }
}

TEST_F(GeoPictureTest, CoarseLevelsAreTheMeanOfFineOnes) {
  const Picture picture = open(valley());
  double most = 0;
  for (int level = 1; level < int(picture->levels().size()); level++) {
    const auto& size = picture->levels()[size_t(level)];
    const int64_t left = size.width / 3, top = size.height / 3;
    const int side = int(std::min<int64_t>(size.width / 3, 512));
    const Piece coarse = picture->paint(level, left, top, side, side),
                fine = picture->paint(level - 1, 2 * left, 2 * top, 2 * side, 2 * side);
    double squares = 0;
    for (int y = 0; y < side; y++)
      for (int x = 0; x < side; x++)
        for (int i = 0; i < 3; i++) {
          int sum = 0;
          for (int k = 0; k < 4; k++)
            sum += fine.bytes[size_t(4 * (2 * side * (2 * y + k / 2) + 2 * x + k % 2) + i)];
          const double off = coarse.bytes[size_t(4 * (side * y + x) + i)] - 0.25 * sum;
          squares += off * off;
        }
    const double off = std::sqrt(squares / (3.0 * side * side));
    most = std::max(most, off);
    EXPECT_NEAR(mean_of(coarse), mean_of(fine), 1.5) << "level " << level;
  }
  EXPECT_LT(most, 5) << "codes";
}

TEST_F(GeoPictureTest, NamesAreWholeAcrossTilesAndInTheLanguageAskedFor) {
  const std::string text =
      collection(feature("Point", "[2048, 2148]", R"({"name": "Nothing", "name:en": "Falconwell",
        "name_de": "Falkenbrunn"})"));
  const char* const item = R"("bounds": [0, 0, 4096, 4096], "frame": [0, 0, 1, 1],
    "style": {"label": {"size_mm": 40, "fill": "#000000"}})";
  // Letters of 164 texels begin left of texel 2048 and end right of it, on both rows of tiles.
  const auto ink = [&](const std::string& language, int64_t left) {
    double sum = 0;
    for (int64_t top : {1792, 2048}) {
      const Picture picture = paint(text, item, language);
      for (int64_t x = left; x < left + 1024; x += 256)
        sum +=
            255 -
            mean_of(*picture->fetch(PieceKey(1, 0, uint32_t(x / 256), uint32_t(top / 256))).piece);
    }
    return sum;
  };
  const Picture english = paint(text, item, "en"), british = paint(text, item, "en-GB"),
                german = paint(text, item, "de"), slovak = paint(text, item, "sk");
  const auto seen = [](const Picture& picture) {
    return picture->paint(0, 1024, 1792, 2048, 512).bytes;
  };
  EXPECT_EQ(seen(english), seen(british));
  EXPECT_NE(seen(english), seen(german));
  EXPECT_NE(seen(english), seen(slovak));
  // Both halves have ink, and about as much.
  const double left = ink("en", 1024), right = ink("en", 2048);
  EXPECT_GT(left, 20);
  EXPECT_GT(right, 20);
  EXPECT_NEAR(left / right, 1, 0.4);
  EXPECT_LT(ink("sk", 1024), ink("de", 1024)) << "Nothing is shorter than Falkenbrunn";
}

TEST_F(GeoPictureTest, NamesStandWhereTheyAreRead) {
  const store::GeoFile file = store::read_geojson(folder.write(
      "one.geojson",
      collection(
          // The letter U: the middle of its box is outside.
          feature("Polygon",
                  "[[[0, 0], [90, 0], [90, 80], [70, 80], [70, 10], [20, 10], [20, 80], "
                  "[0, 80], [0, 0]]]",
                  R"({"name": "U"})") +
          "," +
          feature("LineString", "[[0, -10], [10, -20], [60, -70], [61, -80]]",
                  R"({"name": "slope"})") +
          "," + feature("Point", "[-50, -50]", R"({"name": "one"})") + "," +
          feature("Point", "[-50, -50.5]", R"({"name": "two"})"))));
  store::GeoFrame frame;
  frame.bounds = {{-100, -100}, {100, 100}}, frame.frame = {{0, 0}, {1, 1}};
  store::GeoStyles styles;
  styles.styles[0].label.size = 0.02;
  const store::GeoDrawing drawing = make_geo_drawing(file, frame, styles, "en");
  ASSERT_EQ(drawing.names.size(), 3u) << "the second point's name would lie over the first's";
  const auto middle = [&](size_t i) {
    return 0.5 * (drawing.names[i].box.low + drawing.names[i].box.high) * 200.0 - 100.0;
  };
  const dvec2 u = middle(0);
  const bool in_leg = u.x > 0 && u.x<20, in_base = -u.y> 0 && -u.y < 10;
  EXPECT_TRUE(in_leg || (u.x > 70 && u.x < 90) || in_base) << u.x << " " << u.y;
  const auto& slope = drawing.names[1].corners;
  const dvec2 along = slope[1] - slope[0];
  EXPECT_NEAR(std::atan2(along.y, along.x), double(pi) / 4, 0.1) << "down to the right";
  styles.styles[0].label.overlaps = true;
  EXPECT_EQ(make_geo_drawing(file, frame, styles, "en").names.size(), 4u);
}

TEST_F(GeoPictureTest, KindsHaveStylesOfTheirOwn) {
  const std::string text =
      collection(feature("Point", "[1000, 3096]", R"({"class": "red"})") + "," +
                 feature("Point", "[2000, 3096]", R"({"class": "other"})"));
  const Picture picture = paint(text, R"("bounds": [0, 0, 4096, 4096], "frame": [0, 0, 1, 1],
    "style_by": "class", "style": {"fill": "#0000ff", "radius_mm": 10},
    "styles": {"red": {"fill": "#ff0000"}})");
  EXPECT_EQ(red_at(picture, 1000, 1000), 255);
  EXPECT_EQ(red_at(picture, 2000, 1000), 0);
}

TEST_F(GeoPictureTest, DashesGoOnFromTileToTile) {
  const Picture picture = paint(collection(feature("LineString", "[[0, 2148], [4096, 2148]]")),
                                R"("bounds": [0, 0, 4096, 4096], "frame": [0, 0, 1, 1],
    "style": {"stroke": "#000000", "width_mm": 4, "dash_mm": [20, 10]})");
  // A period is 122.9 texels, of which the first 81.9 are ink.
  for (int64_t x = 5; x < 4090; x += 7) {
    const double at = std::fmod(double(x) + 0.5, 122.88);
    if (std::abs(at - 81.92) < 2 || at < 2 || at > 121) continue;
    EXPECT_EQ(red_at(picture, x, 1948), at < 81.92 ? 0 : 255) << x;
  }
  const double mean = mean_of(picture->paint(4, 0, 120, 256, 4)),
               whole = mean_of(picture->paint(0, 0, 1920, 4096, 64));
  EXPECT_NEAR(mean, whole, 2);
}

TEST_F(GeoPictureTest, AnEmptyCollectionIsWhitePaper) {
  const Picture picture = open(collection(""));
  EXPECT_EQ(picture->levels()[0].width, 32768);
  EXPECT_EQ(mean_of(*picture->fetch(PieceKey(1, 3, 2, 1)).piece), 255);
  EXPECT_EQ(red_at(paint(collection(""), R"("style": {})"), 100, 100), 255);
}

TEST_F(GeoPictureTest, PlacesThatAreNoDegreesWantBounds) {
  const std::string metres = collection(feature("LineString", "[[4e6, 5e6], [4.1e6, 5.2e6]]"));
  EXPECT_THROW(open(metres), LoadError);
  EXPECT_NE(fault(metres, R"("style": {})").find("bounds"), std::string::npos);
  EXPECT_EQ(fault(metres, R"("bounds": [4e6, 5e6, 4.1e6, 5.2e6])"), "");
  // The date line, the poles and a single point are drawn somehow.
  EXPECT_TRUE(open(collection(feature("LineString", "[[179, 0], [-179, 0]]"))));
  EXPECT_TRUE(open(collection(feature("LineString", "[[0, 90], [10, 90]]"))));
  EXPECT_TRUE(open(collection(feature("Point", "[10, 50]")))->fetch(PieceKey(1, 0, 1, 1)).piece);
}

TEST_F(GeoPictureTest, BoundsMayBeAsSmallAsAHouse) {
  const std::string house = collection(feature(
      "Polygon", "[[[13.21, 49.04], [13.2102, 49.04], [13.2102, 49.0402], [13.21, 49.04]]]"));
  const Picture picture = paint(house, R"("bounds": [13.21, 49.04, 13.2104, 49.0404],
    "frame": [0, 0, 1, 1], "style": {"fill": "#000000"})");
  EXPECT_EQ(red_at(picture, 1500, 3500), 0);
  EXPECT_EQ(red_at(picture, 500, 2500), 255);
}

TEST_F(GeoPictureTest, NamesTheFileAndPlaceOfAFault) {
  const std::string line = collection(feature("LineString", "[[0, 0], [1, 1]]"));
  EXPECT_NE(fault(collection(feature("LineString", "[[0, 0], [1]]")), R"("style": {})")
                .find("one.geojson: line 1, /features/0/geometry/coordinates/1: "),
            std::string::npos);
  EXPECT_NE(fault(line, R"("styel": {})").find("/layers/0/items/0/styel"), std::string::npos);
  EXPECT_NE(fault(line, R"("bounds": [1, 0, 0, 1])").find("/items/0/bounds"), std::string::npos);
  EXPECT_NE(fault(line, R"("style": {"dash_mm": [0, 1]})").find("style/dash_mm"),
            std::string::npos);
  EXPECT_NE(fault(line, R"("style": {"width_mm": -1})").find("style/width_mm"), std::string::npos);
  folder.write("a.painting.json", R"({"width": 64, "height": 64, "metres": 1, "layers":
    [{"name": "a", "items": [{"geojson": "../a.geojson"}]}]})");
  EXPECT_THROW(open_painting(folder.file("a.painting.json")), LoadError);
  folder.write("a.painting.json", R"({"width": 64, "height": 64, "metres": 1, "layers":
    [{"name": "a", "items": [{"geojson": "/etc/passwd"}]}]})");
  EXPECT_THROW(open_painting(folder.file("a.painting.json")), LoadError);
  EXPECT_THROW(store::open_picture(folder.file("none.geojson")), LoadError);
}

TEST_F(GeoPictureTest, ATileOfMuchDataTouchesLittleOfIt) {
  // 100,000 corners of 50 rings around one another.
  std::string features;
  for (int i = 0; i < 50; i++)
    features += (i ? "," : "") + feature("LineString", rough_ring(2000, 20, 48, 0.1 + 0.06 * i));
  folder.write("one.geojson", collection(features));
  const double began = seconds_now();
  const store::GeoFile file = store::read_geojson(folder.file("one.geojson"));
  ASSERT_GE(file.points.size(), 100000u);
  const double read = seconds_now();
  const Picture picture = open_geojson(folder.file("one.geojson"));
  const double opened = seconds_now();
  const auto& level = picture->levels()[1];
  for (int i = 0; i < 32; i++)
    picture->fetch(PieceKey(1, 1, uint32_t(level.columns() * i / 32), uint32_t(level.rows() / 2)));
  const double fine = seconds_now();
  picture->fetch(PieceKey(1, int(picture->levels().size()) - 1, 0, 0));
  const double coarse = seconds_now();
  RecordProperty("read_ms", int(1e3 * (read - began)));
  RecordProperty("open_ms", int(1e3 * (opened - read)));
  RecordProperty("fine_tile_us", int(1e6 / 32 * (fine - opened)));
  RecordProperty("coarse_tile_ms", int(1e3 * (coarse - fine)));
  // Work counts shapes and corners that were drawn, whatever the machine's pace.
  store::GeoFrame frame;
  frame.bounds = store::geo_bounds(file);
  store::GeoStyles styles;
  styles.styles[0].stroke = {0, 0, 0, 1}, styles.styles[0].width = 0.0005;
  const store::GeoDrawing drawing = make_geo_drawing(file, frame, styles, "en");
  cairo_surface_t* surface = cairo_image_surface_create(CAIRO_FORMAT_ARGB32, 260, 260);
  cairo_t* cairo = cairo_create(surface);
  store::PaintPlacement placement{{32768, 0}, {0, 32768}, {-16384 - 9000, -16384}};
  double work = 1e6;
  draw_geo(drawing, {cairo, placement, {9000 + 16384, 16384}, 260, 260}, work);
  const double spent = 1e6 - work;
  cairo_destroy(cairo);
  cairo_surface_destroy(surface);
  EXPECT_LT(spent, 60) << "of about 6300 for all corners";
}

}  // namespace
}  // namespace wellspring::test
