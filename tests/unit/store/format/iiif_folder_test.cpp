// SPDX-License-Identifier: Apache-2.0
#include "unit/store/format/pictures.h"

namespace wellspring::test {
namespace {

using namespace store;
namespace fs = std::filesystem;

struct IiifTree {
  Folder folder;

  // Writes a level's tiles; the canonical size is "w," or "w,h", a level of one tile is "full".
  void put_level(int width, int height, int scale, int tile, bool both,
                 const std::string& quality) {
    const int wide = (width + scale - 1) / scale, high = (height + scale - 1) / scale;
    const int reach = tile * scale;
    for (int y = 0; y < height; y += reach)
      for (int x = 0; x < width; x += reach) {
        const int w = std::min(reach, width - x), h = std::min(reach, height - y);
        const int tw = (w + scale - 1) / scale, th = (h + scale - 1) / scale;
        std::string region = std::to_string(x) + "," + std::to_string(y) + "," + std::to_string(w) +
                             "," + std::to_string(h);
        if (wide <= tile && high <= tile) region = "full";
        put(region + "/" + std::to_string(tw) + "," + (both ? std::to_string(th) : ""), quality,
            x / scale, y / scale, tw, th, scale);
      }
  }
  void put(const std::string& place, const std::string& quality, int x0, int y0, int width,
           int height, int scale) {
    fs::create_directories(folder.path / place / "0");
    folder.write(place + "/0/" + quality + ".png", png_of(width, height, [&](int x, int y, int c) {
                   return pattern(x0 + x, y0 + y, c) ^ scale;
                 }));
  }
  std::shared_ptr<const PicturePyramid> open(const std::string& info) const {
    folder.write("info.json", info);
    return open_picture(folder.path.string());
  }
  std::string told(const std::string& info) const {
    folder.write("info.json", info);
    return refusal(folder.path.string());
  }
};

void expect_levels(const PicturePyramid& pyramid, const std::vector<int>& scales) {
  ASSERT_EQ(pyramid.levels().size(), scales.size());
  for (size_t i = 0; i < scales.size(); i++) {
    SCOPED_TRACE(scales[i]);
    const PyramidLevel& level = pyramid.levels()[i];
    expect_same(whole_level(pyramid, int(i)),
                piece_of(int(level.width), int(level.height),
                         [&](int x, int y, int c) { return pattern(x, y, c) ^ scales[i]; }));
  }
}

const std::string context_2 = R"("@context": "http://iiif.io/api/image/2/context.json")";
const std::string context_3 =
    R"("@context": "http://iiif.io/api/image/3/context.json", "profile": "level0")";

TEST(Iiif, TilesOfEachVersionAreThePicture) {
  const std::string tiles = R"(, "width": 75, "height": 41,
                               "tiles": [{"width": 16, "scaleFactors": [4, 1, 2, 8]}]})";
  const std::string tiles_1 = R"(, "width": 75, "height": 41, "scale_factors": [1, 2, 4, 8],
                                 "tile_width": 16, "tile_height": 16})";
  const std::string infos[] = {
      R"({"identifier": "a")" + tiles_1,
      R"({"@context": "http://library.stanford.edu/iiif/image-api/1.1/context.json")" + tiles_1,
      "{" + context_2 + tiles, "{" + context_3 + tiles};
  for (int i = 0; i < 4; i++) {
    SCOPED_TRACE(infos[i]);
    IiifTree tree;
    for (const int scale : {1, 2, 4, 8})
      tree.put_level(75, 41, scale, 16, i == 3, i < 2 ? "native" : "default");
    expect_levels(*tree.open(infos[i]), {1, 2, 4, 8});
  }
}

TEST(Iiif, TilesOfSeveralSizesAreLevelsOfTheirOwn) {
  IiifTree tree;
  tree.put_level(75, 41, 1, 16, true, "default");
  tree.put_level(75, 41, 2, 32, true, "default");
  const auto pyramid = tree.open("{" + context_3 + R"(, "width": 75, "height": 41,
      "tiles": [{"width": 32, "scaleFactors": [2]}, {"width": 16, "scaleFactors": [1]}]})");
  expect_levels(*pyramid, {1, 2});
  EXPECT_EQ(pyramid->levels()[0].tile_width, 16);
  EXPECT_EQ(pyramid->levels()[1].tile_width, 32);
}

TEST(Iiif, LevelsOfOneTileHaveTheSizeOfTheirFile) {
  IiifTree tree;
  tree.put_level(75, 41, 1, 64, false, "default");
  tree.put("full/37,", "default", 0, 0, 37, 20, 2);  // 37.5 x 20.5 are rounded down
  const auto pyramid = tree.open("{" + context_2 + R"(, "width": 75, "height": 41,
      "tiles": [{"width": 64, "scaleFactors": [1, 2]}]})");
  EXPECT_EQ(pyramid->levels()[1].width, 37);
  EXPECT_EQ(pyramid->levels()[1].height, 20);
  expect_levels(*pyramid, {1, 2});
}

TEST(Iiif, SizesAloneAreLevels) {
  IiifTree tree;
  tree.put("full/max", "default", 0, 0, 75, 41, 1);
  tree.put("full/40,22", "default", 0, 0, 40, 22, 2);
  const auto pyramid = tree.open("{" + context_3 + R"(, "width": 75, "height": 41,
      "sizes": [{"width": 40, "height": 22}]})");
  expect_levels(*pyramid, {1, 2});
}

TEST(Iiif, TilesThatAreMissingAreAbsent) {
  const IiifTree tree;
  const auto pyramid = tree.open("{" + context_2 + R"(, "width": 6000, "height": 4000,
      "tiles": [{"width": 512, "scaleFactors": [1, 2]}]})");
  ASSERT_EQ(pyramid->levels().size(), 6u);  // four are made of nothing
  for (int level = 0; level < 6; level++) {
    const Fetched absent = pyramid->fetch({1, level, 0, 0});
    EXPECT_EQ(absent.piece, nullptr);
    EXPECT_EQ(absent.hard, 60);
  }
}

TEST(Iiif, ATileOfAnotherSizeIsRefusedByName) {
  IiifTree tree;
  tree.put("0,0,16,16/16,", "default", 0, 0, 15, 16, 1);
  EXPECT_NE(tree.told("{" + context_2 + R"(, "width": 20, "height": 20,
                      "tiles": [{"width": 16, "scaleFactors": [1]}]})")
                .find("16,/0/default.png: tile of 15 x 16, expected 16 x 16"),
            std::string::npos);
}

TEST(Iiif, InfosThatLieAreRefusedWithTheirPlace) {
  const IiifTree tree;
  const std::string size = R"(, "width": 20, "height": 20)";
  const std::pair<std::string, std::string> wrong[] = {
      {"{" + context_2 + R"(, "width": 20})", "/height: is missing"},
      {"{" + context_2 + R"(, "width": -1, "height": 20})", "/width: is no whole number"},
      {"{" + context_2 + R"(, "width": 1e9, "height": 20})", "/width: is no whole number"},
      {"{" + context_2 + R"(, "width": 18446744073709551615, "height": 2})", "/width"},
      {"{" + context_2 + size + R"(, "tiles": [{"width": 0, "scaleFactors": [1]}]})",
       "/tiles/0/width"},
      {"{" + context_2 + size + R"(, "tiles": [{"width": 9000, "scaleFactors": [1]}]})",
       "/tiles/0/width"},
      {"{" + context_2 + size + R"(, "tiles": [{"width": 16, "scaleFactors": [1, 0]}]})",
       "/tiles/0/scaleFactors/1"},
      {"{" + context_2 + size + R"(, "tiles": [{"width": 16}]})", "/tiles/0/scaleFactors"},
      {"{" + context_2 + size + R"(, "tiles": {}})", "/tiles: is no list"},
      {"{" + context_2 + size + R"(, "tiles": [7]})", "/tiles/0: is no object"},
      {"{" + context_2 + R"(, "width": 1000000000, "height": 1000000000,
        "tiles": [{"width": 16, "scaleFactors": [1]}]})",
       "not too many"},
      {R"({"width": 20, "height": 20})", "/@context"},
      {R"({"@context": "http://iiif.io/api/image/9/context.json")" + size + "}", "/@context"},
      {R"({"@context": "http://iiif.io/api/image/3/context.json")" + size + "}", "/profile"},
      {"{\"width\": ", "info.json"}};
  for (const auto& [info, place] : wrong)
    EXPECT_NE(tree.told(info).find(place), std::string::npos) << info << "\n" << tree.told(info);
}

}  // namespace
}  // namespace wellspring::test
