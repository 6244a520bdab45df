// SPDX-License-Identifier: Apache-2.0
#include "unit/store/format/pictures.h"

namespace wellspring::test {
namespace {

using namespace store;
namespace fs = std::filesystem;

// Writes a part of the pattern of a level as a PNG file.
void put(const Folder& folder, const std::string& name, int x0, int y0, int width, int height,
         int level) {
  fs::create_directories((folder.path / name).parent_path());
  folder.write(name, png_of(width, height, [&](int x, int y, int c) {
                 return pattern(x0 + x, y0 + y, c) ^ level;
               }));
}
Piece level_pattern(const PyramidLevel& level, int number) {
  return piece_of(int(level.width), int(level.height),
                  [&](int x, int y, int c) { return pattern(x, y, c) ^ number; });
}

std::string dzi(int width, int height, int tile, int overlap, const std::string& space,
                const std::string& format = "png") {
  return "<?xml version=\"1.0\"?><Image xmlns=\"" + space + "\" TileSize=\"" +
         std::to_string(tile) + "\" Overlap=\"" + std::to_string(overlap) + "\" Format=\"" +
         format + "\"><Size Width=\"" + std::to_string(width) + "\" Height=\"" +
         std::to_string(height) + "\"/></Image>";
}
const std::string space_2008 = "http://schemas.microsoft.com/deepzoom/2008";
const std::string space_2009 = "http://schemas.microsoft.com/deepzoom/2009";

// Writes a whole Deep Zoom pyramid, level 0 being the finest.
std::string write_deep_zoom(const Folder& folder, int width, int height, int tile, int overlap) {
  int levels = 1;
  for (int64_t w = width, h = height; w > 1 || h > 1; w = (w + 1) / 2, h = (h + 1) / 2) levels++;
  for (int i = 0; i < levels; i++) {
    for (int row = 0; row * tile < height; row++)
      for (int column = 0; column * tile < width; column++) {
        const int x = std::max(0, column * tile - overlap);
        const int y = std::max(0, row * tile - overlap);
        put(folder,
            "a_files/" + std::to_string(levels - 1 - i) + "/" + std::to_string(column) + "_" +
                std::to_string(row) + ".png",
            x, y, std::min(width, (column + 1) * tile + overlap) - x,
            std::min(height, (row + 1) * tile + overlap) - y, i);
      }
    width = (width + 1) / 2, height = (height + 1) / 2;
  }
  return folder.file("a.dzi");
}

TEST(DeepZoom, TilesWithoutTheirOverlapAreThePicture) {
  for (const int overlap : {0, 1, 5}) {
    SCOPED_TRACE(overlap);
    const Folder folder;
    const std::string file = write_deep_zoom(folder, 49, 35, 16, overlap);
    folder.write("a.dzi", dzi(49, 35, 16, overlap, overlap == 1 ? space_2009 : space_2008));
    const auto pyramid = open_picture(file);
    ASSERT_EQ(pyramid->levels().size(), 7u);
    EXPECT_EQ(pyramid->levels()[0].columns(), 4);
    for (int i = 0; i < 7; i++)
      expect_same(whole_level(*pyramid, i), level_pattern(pyramid->levels()[size_t(i)], i));
    expect_same(read_level(*pyramid, 0), level_pattern(pyramid->levels()[0], 0));
  }
}

TEST(DeepZoom, TilesThatAreMissingAreAbsentForAMinute) {
  const Folder folder;
  const std::string file = write_deep_zoom(folder, 49, 35, 16, 1);
  folder.write("a.dzi", dzi(49, 35, 16, 1, space_2008));
  fs::remove(folder.path / "a_files/6/2_1.png");
  const auto pyramid = open_picture(file);
  const Fetched absent = pyramid->fetch({1, 0, 2, 1});
  EXPECT_EQ(absent.piece, nullptr);
  EXPECT_EQ(absent.soft, 60);
  EXPECT_EQ(absent.hard, 60);
  const Piece whole = read_level(*pyramid, 0);
  EXPECT_EQ(whole.bytes[(20 * 49 + 40) * 4 + 3], 0);
  EXPECT_EQ(whole.bytes[(10 * 49 + 40) * 4 + 3], 255);
  EXPECT_EQ(pyramid->fetch({1, 0, 4, 0}).piece, nullptr);
  EXPECT_EQ(pyramid->fetch({1, 63, 0, 0}).piece, nullptr);
  EXPECT_NE(pyramid->fetch({1, 0, 3, 0}).hard, 60);
}

TEST(DeepZoom, TilesThatAreDamagedOrOfAnotherSizeAreRefusedByName) {
  const Folder folder;
  const std::string file = write_deep_zoom(folder, 49, 35, 16, 1);
  folder.write("a.dzi", dzi(49, 35, 16, 1, space_2008));
  put(folder, "a_files/6/1_0.png", 0, 0, 17, 17, 0);
  folder.write("a_files/6/1_1.png", "no picture");
  const auto pyramid = open_picture(file);
  const auto problem = [&](uint32_t column, uint32_t row) -> std::string {
    try {
      pyramid->fetch({1, 0, column, row});
    } catch (const LoadError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(problem(1, 0).find("a_files/6/1_0.png: tile of 17 x 17, expected 18 x 17"),
            std::string::npos)
      << problem(1, 0);
  EXPECT_NE(problem(1, 1).find("a_files/6/1_1.png: "), std::string::npos) << problem(1, 1);
  EXPECT_EQ(problem(0, 0), "");
}

TEST(DeepZoom, WhatMakesNoSenseIsRefusedWithItsPlace) {
  const Folder folder;
  const auto told = [&](const std::string& xml) { return refusal(folder.write("a.dzi", xml)); };
  const std::pair<std::string, std::string> wrong[] = {
      {dzi(10, 10, 16, 1, "http://example.org/other"), "Image/xmlns"},
      {dzi(10, 10, 0, 0, space_2008), "Image/TileSize"},
      {dzi(10, 10, 5000, 0, space_2008), "Image/TileSize"},
      {dzi(10, 10, 256, 300, space_2008), "Image/Overlap"},
      {dzi(0, 10, 256, 1, space_2008), "Size/Width"},
      {dzi(10, 2000000000, 256, 1, space_2008), "Size/Height"},
      {dzi(1000000000, 10, 16, 1, space_2008), "not too many"},
      {dzi(10, 10, 256, 1, space_2008, "../../etc/passwd"), "Image/Format"},
      {dzi(10, 10, 256, 1, space_2008, "exe"), "Image/Format"},
      {"<Image TileSize=\"256\" Overlap=\"1\" Format=\"jpg\"/>", "Image/Size: is missing"},
      {"<Image TileSize=\"256\"", "is no XML"},
      {"<Collection/>", "is a collection"},
      {"<svg/>", "is neither Deep Zoom"},
      {"", "is empty"}};
  for (const auto& [xml, place] : wrong)
    EXPECT_NE(told(xml).find(place), std::string::npos) << xml << "\n" << told(xml);
  const auto longest =
      open_picture(folder.write("a.dzi", dzi(1 << 30, 1 << 30, 256, 1, space_2008, "JPG")));
  EXPECT_EQ(longest->levels().size(), 31u);
}

// Writes a Zoomify pyramid; round: 1 if sizes of levels are rounded up.
void write_zoomify(const Folder& folder, int width, int height, int round) {
  constexpr int tile = 16;
  struct Level {
    int width, height;
  };
  std::vector<Level> levels = {{width, height}};
  while (std::max(levels.back().width, levels.back().height) > tile)
    levels.push_back({(levels.back().width + round) / 2, (levels.back().height + round) / 2});
  int number = 0;
  for (int i = int(levels.size()) - 1; i >= 0; i--)
    for (int y = 0; y < levels[size_t(i)].height; y += tile)
      for (int x = 0; x < levels[size_t(i)].width; x += tile)
        put(folder,
            "TileGroup" + std::to_string(number++ / 256) + "/" +
                std::to_string(int(levels.size()) - 1 - i) + "-" + std::to_string(x / tile) + "-" +
                std::to_string(y / tile) + ".png",
            x, y, std::min(tile, levels[size_t(i)].width - x),
            std::min(tile, levels[size_t(i)].height - y), i);
  folder.write("ImageProperties.xml", "<IMAGE_PROPERTIES WIDTH=\"" + std::to_string(width) +
                                          "\" HEIGHT=\"" + std::to_string(height) +
                                          "\" NUMTILES=\"" + std::to_string(number) +
                                          "\" VERSION=\"1.8\" TILESIZE=\"16\" />");
}

TEST(Zoomify, TilesOfAllGroupsAreThePictureHoweverSizesAreRounded) {
  for (const int round : {0, 1}) {
    SCOPED_TRACE(round);
    const Folder folder;
    write_zoomify(folder, 301, 259, round);
    const auto pyramid = open_picture(folder.path.string());
    ASSERT_EQ(pyramid->levels().size(), 6u);
    EXPECT_EQ(pyramid->levels()[1].width, 150 + round);
    for (int i = 0; i < 6; i++)
      expect_same(whole_level(*pyramid, i), level_pattern(pyramid->levels()[size_t(i)], i));
  }
}

TEST(Zoomify, FoldersOfNothingAreRefused) {
  const Folder folder;
  EXPECT_NE(refusal(folder.path.string()).find("neither ImageProperties.xml"), std::string::npos);
  EXPECT_NE(refusal(folder.file("none")).find("is not there"), std::string::npos);
  folder.write("ImageProperties.xml",
               "<IMAGE_PROPERTIES WIDTH=\"10\" HEIGHT=\"x\" TILESIZE=\"256\"/>");
  EXPECT_NE(refusal(folder.path.string()).find("IMAGE_PROPERTIES/HEIGHT"), std::string::npos);
}

TEST(DeepZoom, LevelsThatAreTooCoarseAreHalvedInMemory) {
  // The tile is larger than the coarsest level may be: 1200 texels.
  const Folder folder;
  put(folder, "TileGroup0/0-0-0.png", 0, 0, 1200, 3, 0);
  folder.write("ImageProperties.xml",
               "<IMAGE_PROPERTIES WIDTH=\"1200\" HEIGHT=\"3\" TILESIZE=\"2048\"/>");
  const auto pyramid = open_picture(folder.path.string());
  ASSERT_EQ(pyramid->levels().size(), 4u);
  EXPECT_EQ(pyramid->levels()[1].width, 600);
  EXPECT_EQ(pyramid->levels()[1].height, 2);
  EXPECT_EQ(whole_level(*pyramid, 1).bytes[3], 255);
  fs::remove_all(folder.path / "TileGroup0");
  const auto empty = open_picture(folder.path.string());
  EXPECT_EQ(empty->fetch({1, 1, 0, 0}).piece, nullptr);
  EXPECT_EQ(empty->fetch({1, 1, 0, 0}).hard, 60);
}

}  // namespace
}  // namespace wellspring::test
