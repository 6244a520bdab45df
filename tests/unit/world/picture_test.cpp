// SPDX-License-Identifier: Apache-2.0
// Pictures on surfaces from files that are right, cut off, or made to break a reader.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "world/texture.h"

namespace wellspring::test {
namespace {

std::vector<uint8_t> read_seed(const char* name) {
  const auto folder = std::filesystem::path(WELLSPRING_SOURCE) / "tests/fuzz/corpus/picture";
  std::ifstream in(folder / name, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string decode(const std::vector<uint8_t>& bytes, Image& image, int64_t texels_left = 1 << 20) {
  return decode_image(bytes, true, image, texels_left);
}

TEST(Picture, FilesBecomeTexels) {
  Image png, jpeg;
  ASSERT_EQ(decode(read_seed("small.jpg"), jpeg), "");
  EXPECT_EQ(jpeg.width, 6);
  EXPECT_EQ(jpeg.height, 4);
  EXPECT_TRUE(jpeg.srgb);
  ASSERT_EQ(jpeg.texels8.size(), 6u * 4 * 4);
  for (size_t i = 3; i < jpeg.texels8.size(); i += 4) EXPECT_EQ(jpeg.texels8[i], 255);
  ASSERT_EQ(decode(read_seed("small.png"), png), "");
  EXPECT_GT(png.width * png.height, 0);
}

TEST(Picture, CutOffFilesAreRefused) {
  for (const char* name : {"small.jpg", "small.png"}) {
    std::vector<uint8_t> bytes = read_seed(name);
    ASSERT_GT(bytes.size(), 60u);
    bytes.resize(bytes.size() - 20);
    Image image;
    EXPECT_NE(decode(bytes, image), "") << name;
  }
}

TEST(Picture, AChunkThatClaimsMoreThanThereIsIsRefused) {
  Image image;
  std::vector<uint8_t> bytes = read_seed("small.png");
  const std::string kind = "IDAT";
  const auto chunk = std::search(bytes.begin(), bytes.end(), kind.begin(), kind.end()) - 4;
  ASSERT_LT(chunk, bytes.end() - 4);
  *chunk = 0x70;
  EXPECT_EQ(decode(bytes, image), "picture cannot be decoded: the file is cut off");
}

// A Huffman table of more codes than there are bytes, which some readers write beyond theirs by.
TEST(Picture, TablesThatAreTooLongAreRefused) {
  std::vector<uint8_t> bytes{0xff, 0xd8, 0xff, 0xc4, 0x01, 0x23, 0x00};
  for (int i = 0; i < 16; i++) bytes.push_back(17);
  bytes.insert(bytes.end(), 272, 1);
  bytes.insert(bytes.end(), {0xff, 0xd9});
  Image image;
  EXPECT_NE(decode(bytes, image), "");
  // The picture is right otherwise.
  std::vector<uint8_t> whole = read_seed("small.jpg");
  for (size_t i = 0; i + 20 < whole.size(); i++)
    if (whole[i] == 0xff && whole[i + 1] == 0xc4) std::fill_n(&whole[i + 5], 16, uint8_t(17));
  EXPECT_NE(decode(whole, image), "");
}

TEST(Picture, NoMoreTexelsThanAreLeft) {
  Image image;
  EXPECT_NE(decode(read_seed("small.jpg"), image, 23), "");
  EXPECT_EQ(decode(read_seed("small.jpg"), image, 24), "");
}

}  // namespace
}  // namespace wellspring::test
