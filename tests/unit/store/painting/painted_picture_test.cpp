// SPDX-License-Identifier: Apache-2.0
// Paintings: any window of a level has the same texels, coarse levels look like the mean of fine
// ones, and hostile descriptions end in a LoadError or in time.
#include "store/painting/painted_picture.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "base/load_error.h"
#include "unit/folder.h"

namespace wellspring::test {
namespace {

using store::open_painting;
using store::PaintedPicture;
using store::Piece;
using store::PieceKey;

// Holds one of everything that a painting can have.
const char* const whole_painting = R"({"width": 16384, "height": 8192, "metres": 1, "seed": 7,
"gradients": {"sky": {"from": [0, 0], "to": [0, 0.5],
    "stops": [{"at": 0, "color": "#4060a0"}, {"at": 1, "color": "#e0d0a0"}]},
  "soft": {"from": [0, 0], "radius": 1,
    "stops": [{"at": 0, "color": "#ffffffc0"}, {"at": 1, "color": "#ffffff00"}]}},
"brushes": {"sky": {"width": 0.002, "length": 0.012, "turn": 40, "tone": 0.06, "warmth": 0.03,
    "impasto": 0.1, "smear": 0.0008, "octaves": 3},
  "fine": {"width": 0.0006, "length": 0.002, "angle": 60, "tone": 0.1, "impasto": 0.1}},
"symbols": [
  {"name": "leaf", "items": [{"path": "M-0.5 0R0 -0.3 0.5 0 0 0.3Z", "fill": "#40702a"}]},
  {"name": "cloud", "items": [{"ellipse": [0, 0, 1, 1], "fill": "@soft"}]},
  {"name": "tree", "items": [{"box": [-0.05, -0.4, 0.05, 0], "fill": "#503018", "brush": "fine"},
    {"repeat": "leaf", "within": "M-0.4 -0.3L0.4 -0.3L0.3 -1L-0.3 -1Z", "cell": 0.08,
     "scale": [0.08, 0.14], "turn": [-180, 180], "shade": 0.2}]}],
"layers": [
  {"name": "paint", "ground": "#808060",
   "material": {"cracks": {"cell": 0.004, "width": 0.0001, "depth": 0.4},
     "weave": {"period": 0.0006, "depth": 0.03}, "grain": {"period": 0.0005, "depth": 0.03, "octaves": 3}},
   "items": [{"box": [0, 0, 1, 0.5], "fill": "@sky", "brush": "sky"},
    {"include": "cloud", "move": [0.4, 0.1], "scale": [0.2, 0.05]},
    {"repeat": "tree", "within": "M0 0.3L1 0.25L1 0.5L0 0.5Z", "cell": 0.03, "scale": [0.03, 0.05]},
    {"hatch": "M0.2 0.1L0.5 0.1L0.5 0.3Z", "spacing": 0.004, "angle": 30, "stroke": "#302010",
     "width": 0.001},
    {"group": [{"path": "M0 0L1 0L0.5 -1Z", "fill": "#a04030", "stroke": "#201008", "width": 0.02}],
     "move": [0.6, 0.4], "scale": 0.1, "turn": 12, "clip": "M0 0L1 0L1 -0.8L0 -0.8Z"},
    {"text": {"en": "Well", "de": "Brunnen"}, "at": [0.1, 0.2], "size": 0.05, "fill": "#200000"},
    {"metres": [0, 0, 100, 50], "frame": [0, 0, 1, 0.5],
     "styles": {"river": {"stroke": "#3060a0", "width": 0.004, "casing": "#102040",
         "casing_width": 0.006, "smooth": true, "wobble": 0.001},
       "wood": {"fill": "#508040", "symbol": "tree", "cell": 0.02, "scale": 0.03,
         "hachures": {"length": 0.01, "spacing": 0.004, "width": 0.001, "fill": "#000000"}}},
     "features": {"type": "FeatureCollection", "features": [
       {"type": "Feature", "properties": {"kind": "river"},
        "geometry": {"type": "LineString", "coordinates": [[0, 10], [40, 14], [100, 4]]}},
       {"type": "Feature", "properties": {"kind": "wood"}, "geometry": {"type": "Polygon",
        "coordinates": [[[60, 30], [80, 30], [80, 45], [60, 45], [60, 30]]]}}]}}]},
  {"name": "xray", "gray": true, "items": [{"box": [0, 0, 1, 0.5], "fill": "#c02020"}]}]})";

struct PaintedPictureTest : testing::Test {
  Folder folder;
  std::shared_ptr<const PaintedPicture> open(const std::string& text, const std::string& layer = "",
                                             const std::string& language = "en") const {
    return open_painting(folder.write("one.painting.json", text), layer, language);
  }
  std::string fault(const std::string& text) const {
    try {
      open(text);
    } catch (const LoadError& error) {
      return error.where + ": " + error.what_;
    }
    return "";
  }
};

std::string painting_of(const std::string& items, const std::string& more = "") {
  return R"({"width": 4096, "height": 4096, "metres": 1, )" + more +
         R"("layers": [{"name": "paint", "items": [)" + items + "]}]}";
}

TEST_F(PaintedPictureTest, HasLevelsAndTiles) {
  const auto picture = open(whole_painting);
  ASSERT_EQ(picture->levels().size(), 7u);
  EXPECT_EQ(picture->levels()[0].columns(), 64);
  EXPECT_LE(picture->levels().back().width, store::coarsest_side);
  const auto fetched = picture->fetch(PieceKey(1, 4, 3, 1));
  ASSERT_TRUE(fetched.piece);
  EXPECT_EQ(fetched.piece->width, 256);
  EXPECT_EQ(fetched.piece->bytes.size(), 4u * 256 * 256);
  EXPECT_FALSE(picture->fetch(PieceKey(1, 4, 4, 0)).piece);
  EXPECT_FALSE(picture->fetch(PieceKey(1, 9, 0, 0)).piece);
}

TEST_F(PaintedPictureTest, HasNoSeams) {
  const auto picture = open(whole_painting);
  for (int level = 0; level < 5; level++) {
    const auto& size = picture->levels()[size_t(level)];
    const int column = size.columns() / 2 - 1, row = size.rows() / 2 - 1;
    const Piece both = picture->paint(level, int64_t(column) * 256, int64_t(row) * 256, 512, 512);
    for (int k = 0; k < 4; k++) {
      const int right = k % 2, below = k / 2;
      const auto tile =
          picture->fetch(PieceKey(1, level, uint32_t(column + right), uint32_t(row + below))).piece;
      int most = 0, differ = 0;
      for (int y = 0; y < 256; y++)
        for (int x = 0; x < 4 * 256; x++) {
          const int whole = both.bytes[size_t(4 * 512 * (256 * below + y) + 4 * 256 * right + x)];
          const int off = std::abs(whole - int(tile->bytes[size_t(4 * 256 * y + x)]));
          most = std::max(most, off), differ += off > 1;
        }
      // Cairo cuts long lines at the window's border, which moves their edges by a trifle.
      EXPECT_LE(differ, 400) << "level " << level << ", tile " << k;
      EXPECT_LE(most, 16) << "level " << level << ", tile " << k;
    }
  }
}

TEST_F(PaintedPictureTest, CoarseLevelsAreTheMeanOfFineOnes) {
  const auto picture = open(whole_painting);
  const auto mean = [](const Piece& piece) {
    vec3 sum(0);
    for (size_t i = 0; i < piece.bytes.size(); i += 4)
      sum += vec3(piece.bytes[i], piece.bytes[i + 1], piece.bytes[i + 2]);
    return sum * (4.f / float(piece.bytes.size()));
  };
  for (int level = 1; level < 5; level++)
    for (int row = 0; row < picture->levels()[size_t(level)].rows(); row++) {
      const uint32_t column = uint32_t(7 * row % picture->levels()[size_t(level)].columns());
      const vec3 coarse = mean(*picture->fetch(PieceKey(1, level, column, uint32_t(row))).piece);
      vec3 fine(0);
      for (uint32_t k = 0; k < 4; k++)
        fine +=
            0.25f *
            mean(*picture
                      ->fetch(PieceKey(1, level - 1, 2 * column + k % 2, 2 * uint32_t(row) + k / 2))
                      .piece);
      for (int i = 0; i < 3; i++) EXPECT_NEAR(coarse[i], fine[i], 6) << level << ", " << row;
    }
}

TEST_F(PaintedPictureTest, HasLayersAndLanguages) {
  const Piece seen = open(whole_painting, "xray")->paint(4, 100, 100, 8, 8);
  EXPECT_EQ(seen.bytes[0], seen.bytes[1]);
  EXPECT_EQ(seen.bytes[1], seen.bytes[2]);
  EXPECT_THROW(open(whole_painting, "ultraviolet"), LoadError);
  const Piece english = open(whole_painting)->paint(4, 80, 120, 300, 200),
              german = open(whole_painting, "", "de")->paint(4, 80, 120, 300, 200),
              other = open(whole_painting, "", "sk")->paint(4, 80, 120, 300, 200);
  EXPECT_NE(english.bytes, german.bytes);
  EXPECT_EQ(english.bytes, other.bytes);
}

TEST_F(PaintedPictureTest, NamesThePlaceOfAFault) {
  EXPECT_NE(fault("{"), "");
  EXPECT_NE(fault(R"({"width": 9, "height": 64, "metres": 1, "layers": []})").find("width"),
            std::string::npos);
  EXPECT_NE(fault(painting_of(R"({"path": "M0 0L1", "fill": "#000000"})")).find("/items/0/path"),
            std::string::npos);
  EXPECT_NE(fault(painting_of(R"({"path": "M0 0L1 1", "fill": "red"})")).find("fill"),
            std::string::npos);
  EXPECT_NE(fault(painting_of(R"({"include": "tree"})")).find("include"), std::string::npos);
  EXPECT_NE(fault(painting_of(R"({"box": [0, 0, 1, 1], "fill": "@sky"})")).find("gradient"),
            std::string::npos);
  EXPECT_NE(fault(painting_of(R"({"box": [0, 0, 1, 1], "colour": "#000000"})")).find("colour"),
            std::string::npos);
}

TEST_F(PaintedPictureTest, HostilePaintingsEnd) {
  // Each symbol has the one before it many times: 20 levels of it are more than can be drawn.
  std::string symbols = R"({"name": "s0", "items": [{"box": [0, 0, 1, 1], "fill": "#000000"}]})";
  for (int i = 1; i < 20; i++) {
    symbols += R"(,{"name": "s)" + std::to_string(i) + R"(", "items": [)";
    for (int k = 0; k < 8; k++)
      symbols += (k ? "," : "") + (R"({"include": "s)" + std::to_string(i - 1) + R"("})");
    symbols += "]}";
  }
  const std::string bomb =
      painting_of(R"({"include": "s19"})", R"("symbols": [)" + symbols + "], ");
  const std::string crowd = painting_of(
      R"({"repeat": "s", "within": "M0 0L1 0L1 1L0 1Z", "cell": 0.000001, "scale": [1000, 1000]},
         {"repeat": "s", "within": "M0 0L1 0L1 1L0 1Z", "cell": 0.0008, "scale": [900, 1000]},
         {"hatch": "M0 0L1 0L1 1L0 1Z", "spacing": 0.000001, "stroke": "#000000", "width": 1})",
      R"("symbols": [{"name": "s", "items": [{"box": [-1, -1, 1, 1], "fill": "#10203040"}]}], )");
  for (const std::string& text : {bomb, crowd}) {
    const auto picture = open(text);
    for (int level = 0; level < 3; level++) {
      try {
        EXPECT_EQ(picture->fetch(PieceKey(1, level, 1, 1)).piece->width, 256);
      } catch (const LoadError& error) {
        EXPECT_NE(error.what_.find("more is drawn there"), std::string::npos) << error.what();
      }
    }
  }
  std::string many;
  for (int i = 0; i < 2500; i++) many += (i ? "," : "") + std::string(R"({"group": []})");
  EXPECT_NE(fault(painting_of(many)).find("too many groups"), std::string::npos);
}

}  // namespace
}  // namespace wellspring::test
