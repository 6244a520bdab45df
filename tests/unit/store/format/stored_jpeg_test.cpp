// SPDX-License-Identifier: Apache-2.0
#include "store/format/stored_jpeg.h"

#include "unit/store/format/pictures.h"

namespace wellspring::test {
namespace {

using namespace store;
namespace fs = std::filesystem;

constexpr int tile = 64;  // texels a side

int gradient(int x, int y, int c) { return (40 + 2 * x + y + c * 30) % 200; }

Piece decoded(const std::vector<uint8_t>& jpeg) {
  return to_piece(decode_jpeg_codes(jpeg, 1 << 20, "stored"));
}

// Counts the tiles of a level that are stored, which must show what fetch() returns.
int count_stored(const PicturePyramid& pyramid, int number) {
  const PyramidLevel& level = pyramid.levels()[size_t(number)];
  int count = 0;
  for (int row = 0; row < level.rows(); row++)
    for (int column = 0; column < level.columns(); column++) {
      const PieceKey key(1, number, uint32_t(column), uint32_t(row));
      const std::vector<uint8_t> jpeg = pyramid.stored_jpeg(key);
      if (jpeg.empty()) continue;
      count++;
      SCOPED_TRACE(std::to_string(column) + ", " + std::to_string(row));
      expect_same(decoded(jpeg), *pyramid.fetch(key).piece, 2);
    }
  return count;
}

TiffSpec jpeg_page(int photometric) {
  TiffSpec page;
  page.width = 3 * tile - 10, page.height = 2 * tile, page.tile = tile;
  page.photometric = photometric, page.compression = COMPRESSION_JPEG;
  if (photometric == PHOTOMETRIC_MINISBLACK) page.channels = 1;
  page.codes = gradient;
  return page;
}

TEST(StoredJpeg, TilesOfATiffGoOutAsTheyAre) {
  for (const int photometric : {PHOTOMETRIC_YCBCR, PHOTOMETRIC_RGB, PHOTOMETRIC_MINISBLACK}) {
    SCOPED_TRACE(photometric);
    const Folder folder;
    const auto pyramid = open_picture(write_tiff(folder, {jpeg_page(photometric)}));
    EXPECT_EQ(count_stored(*pyramid, 0), 4) << "all but those that reach over the edge";
    EXPECT_TRUE(pyramid->stored_jpeg({1, 0, 3, 0}).empty());
    EXPECT_TRUE(pyramid->stored_jpeg({1, 9, 0, 0}).empty());
    if (photometric == PHOTOMETRIC_MINISBLACK) continue;
    const std::vector<uint8_t> jpeg = pyramid->stored_jpeg({1, 0, 0, 0});
    const std::string marker(
        "\xff\xee\0\x0e"
        "Adobe\0\x64\0\0\0\0",
        15);
    EXPECT_TRUE(std::equal(marker.begin(), marker.end(), jpeg.begin() + 2,
                           [](char a, uint8_t b) { return uint8_t(a) == b; }));
    EXPECT_EQ(jpeg[17], photometric == PHOTOMETRIC_YCBCR ? 1 : 0) << "says what its colours are";
  }
}

TEST(StoredJpeg, WhatHasToBeDecodedIsNot) {
  const auto stored = [](const TiffSpec& page) {
    const Folder folder;
    return count_stored(*open_picture(write_tiff(folder, {page})), 0);
  };
  TiffSpec page = jpeg_page(PHOTOMETRIC_YCBCR);
  page.orientation = 3;
  EXPECT_EQ(stored(page), 0);
  page = jpeg_page(PHOTOMETRIC_RGB);
  page.compression = COMPRESSION_LZW;
  EXPECT_EQ(stored(page), 0);
  page = jpeg_page(PHOTOMETRIC_RGB);
  page.planar = PLANARCONFIG_SEPARATE;
  EXPECT_EQ(stored(page), 0);
  page = jpeg_page(PHOTOMETRIC_SEPARATED);
  page.channels = 4;
  EXPECT_EQ(stored(page), 0);
  page = jpeg_page(PHOTOMETRIC_RGB);
  page.channels = 4, page.extra = EXTRASAMPLE_UNASSALPHA;
  EXPECT_EQ(stored(page), 0);
  page = jpeg_page(PHOTOMETRIC_YCBCR);
  page.left_out = 1;
  EXPECT_EQ(stored(page), 3) << "a tile that is absent";
}

std::string jpeg_of(int x0, int y0, int width, int height, const std::string& segment = "") {
  Image8 image{width, height, {}};
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++)
      for (int c = 0; c < 3; c++) image.rgb.push_back(uint8_t(gradient(x0 + x, y0 + y, c)));
  std::vector<uint8_t> bytes;
  encode_jpeg(image, 95, true, bytes);
  std::string file(bytes.begin(), bytes.end());
  return file.insert(2, segment);
}

void put(const Folder& folder, const std::string& name, const std::string& bytes) {
  fs::create_directories((folder.path / name).parent_path());
  folder.write(name, bytes);
}

// An EXIF block that turns the picture by a right angle, as decode_codes() does not.
const std::string turning(
    "\xff\xe1\0\x22"
    "Exif\0\0MM\0\x2a\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\x06\0\0"
    "\0\0\0\0",
    36);

TEST(StoredJpeg, TilesOfZoomifyGoOutAsTheyAre) {
  const Folder folder;
  const std::string file = folder.write(
      "ImageProperties.xml", "<IMAGE_PROPERTIES WIDTH=\"100\" HEIGHT=\"70\" TILESIZE=\"64\"/>");
  put(folder, "TileGroup0/0-0-0.jpg", jpeg_of(0, 0, 50, 35));
  put(folder, "TileGroup0/1-0-0.jpg", jpeg_of(0, 0, 64, 64));
  put(folder, "TileGroup0/1-1-0.jpg", jpeg_of(64, 0, 36, 64, turning));
  put(folder, "TileGroup0/1-0-1.png", png_of(64, 6, gradient));
  const auto pyramid = open_picture(file);
  EXPECT_EQ(count_stored(*pyramid, 0), 2);
  EXPECT_EQ(count_stored(*pyramid, 1), 1);
  const std::string first = folder.read("TileGroup0/1-0-0.jpg");
  EXPECT_EQ(pyramid->stored_jpeg({1, 0, 0, 0}), std::vector<uint8_t>(first.begin(), first.end()));
  EXPECT_EQ(pyramid->stored_jpeg({1, 0, 1, 0}).size(), jpeg_of(64, 0, 36, 64).size())
      << "without what would turn it";
  put(folder, "TileGroup0/1-0-0.jpg", jpeg_of(0, 0, 60, 64));
  EXPECT_TRUE(pyramid->stored_jpeg({1, 0, 0, 0}).empty()) << "it has another size";
  put(folder, "TileGroup0/1-0-0.jpg", "no picture");
  EXPECT_TRUE(pyramid->stored_jpeg({1, 0, 0, 0}).empty());
}

TEST(StoredJpeg, TilesOfDeepZoomDoIfTheyDoNotOverlap) {
  for (const int overlap : {0, 1}) {
    SCOPED_TRACE(overlap);
    const Folder folder;
    const std::string file =
        folder.write("a.dzi",
                     "<Image xmlns=\"http://schemas.microsoft.com/deepzoom/2008\" TileSize=\"64\" "
                     "Overlap=\"" +
                         std::to_string(overlap) +
                         "\" Format=\"jpg\"><Size Width=\"100\" "
                         "Height=\"60\"/></Image>");
    put(folder, "a_files/7/0_0.jpg", jpeg_of(0, 0, 64 + overlap, 60));
    put(folder, "a_files/7/1_0.jpg", jpeg_of(64 - overlap, 0, 36 + overlap, 60));
    put(folder, "a_files/6/0_0.jpg", jpeg_of(0, 0, 50, 30));
    const auto pyramid = open_picture(file);
    EXPECT_EQ(count_stored(*pyramid, 0), overlap == 0 ? 2 : 0);
    EXPECT_EQ(count_stored(*pyramid, 1), 1) << "a level of one tile has none beside it";
  }
}

TEST(StoredJpeg, TilesOfIiifGoOutAsTheyAre) {
  const Folder folder;
  const std::string file = folder.write("info.json", R"({
    "@context": "http://iiif.io/api/image/3/context.json", "id": "https://example.org/a",
    "type": "ImageService3", "protocol": "http://iiif.io/api/image", "profile": "level0",
    "width": 100, "height": 60, "tiles": [{"width": 64, "scaleFactors": [1, 2]}]})");
  put(folder, "0,0,64,60/64,60/0/default.jpg", jpeg_of(0, 0, 64, 60));
  put(folder, "64,0,36,60/36,60/0/default.jpg", jpeg_of(64, 0, 36, 60));
  put(folder, "full/50,30/0/default.jpg", jpeg_of(0, 0, 50, 30));
  const auto pyramid = open_picture(file);
  EXPECT_EQ(count_stored(*pyramid, 0), 2);
  EXPECT_EQ(count_stored(*pyramid, 1), 1);
}

TEST(StoredJpeg, BrokenFilesAreNothing) {
  const std::string text = jpeg_of(0, 0, 16, 16);
  const std::vector<uint8_t> file(text.begin(), text.end());
  EXPECT_EQ(take_jpeg_file(file).bytes, file);
  for (size_t size = 0; size < file.size(); size++) {
    const StoredJpeg cut = take_jpeg_file(std::span(file).first(size));
    if (cut.bytes.empty()) continue;
    EXPECT_EQ(cut.width, 16) << "its head is there";
    EXPECT_EQ(cut.bytes.back(), 0xd9);
  }
  const std::vector<uint8_t> tables = {0xff, 0xd8, 0xff, 0xdb};
  EXPECT_TRUE(join_tiff_jpeg(tables, file, JpegColors::ycc).bytes.empty());
  EXPECT_TRUE(join_tiff_jpeg(file, file, JpegColors::ycc).bytes.empty()) << "tables hold no scan";
}

}  // namespace
}  // namespace wellspring::test
