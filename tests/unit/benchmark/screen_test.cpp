// SPDX-License-Identifier: Apache-2.0
// A page shows the pictures that it is sent.
#include "benchmark/screen.h"

#include <gtest/gtest.h>

#include "image/image.h"
#include "wire/packet.h"

namespace wellspring::test {
namespace {

Image8 plain(int width, int height, uint8_t value) {
  return {width, height, std::vector<uint8_t>(3 * size_t(width) * size_t(height), value)};
}

Packet complete(const Image8& image) {
  Packet packet(packet_header_bytes);
  PacketHeader header{.width = uint16_t(image.width), .height = uint16_t(image.height)};
  write_packet_header(header, packet);
  encode_jpeg(image, 95, true, packet, packet_header_bytes);
  return packet;
}

int red(const Image8& image, int x, int y) { return image.rgb[size_t(3 * (y * image.width + x))]; }

TEST(Screen, IsBlackUntilAPictureComes) {
  Screen screen(32, 16);
  EXPECT_EQ(screen.picture().rgb, plain(32, 16, 0).rgb);
  EXPECT_FALSE(screen.receive(std::vector<uint8_t>{1, 2, 3}));
}

TEST(Screen, ShowsASmallerPictureAsLarge) {
  Screen screen(32, 16);
  EXPECT_TRUE(screen.receive(complete(plain(16, 8, 200))));
  const Image8 shown = screen.picture();
  ASSERT_EQ(shown.width, 32);
  ASSERT_EQ(shown.height, 16);
  EXPECT_NEAR(red(shown, 31, 15), 200, 2);
}

TEST(Screen, PutsPartsWhereTheyBelong) {
  Screen screen(32, 32);
  screen.receive(complete(plain(32, 32, 50)));
  std::vector<uint8_t> jpeg;
  encode_jpeg(plain(16, 16, 220), 95, true, jpeg);
  PacketHeader header{.width = 32, .height = 32, .flags = 0};
  const PicturePart part{16, 0, 16, 16, uint32_t(jpeg.size())};
  Packet packet(parts_header_bytes(1));
  write_packet_header(header, std::span(&part, 1), packet);
  packet.insert(packet.end(), jpeg.begin(), jpeg.end());
  EXPECT_TRUE(screen.receive(packet));
  const Image8 shown = screen.picture();
  EXPECT_NEAR(red(shown, 20, 4), 220, 2);
  EXPECT_NEAR(red(shown, 31, 15), 220, 2);
  EXPECT_NEAR(red(shown, 15, 4), 50, 2);
  EXPECT_NEAR(red(shown, 20, 16), 50, 2);
}

TEST(ScalePicture, MixesBetweenTheMiddlesOfPixels) {
  Image8 two{2, 1, {0, 0, 0, 100, 100, 100}};
  const Image8 four = scale_picture(two, 4, 1);
  EXPECT_EQ(red(four, 0, 0), 0);
  EXPECT_EQ(red(four, 1, 0), 25);
  EXPECT_EQ(red(four, 2, 0), 75);
  EXPECT_EQ(red(four, 3, 0), 100);
}

}  // namespace
}  // namespace wellspring::test
