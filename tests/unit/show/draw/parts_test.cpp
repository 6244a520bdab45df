// SPDX-License-Identifier: Apache-2.0
#include "show/draw/parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "frame/tiles.h"
#include "image/image.h"

namespace wellspring::test {
namespace {

constexpr int width = 328, height = 184;

// Puts packets together as a browser does.
struct Canvas {
  Image8 canvas{width, height, std::vector<uint8_t>(size_t(width* height * 3))};
  size_t bytes = 0, packets = 0;

  // False: nothing was sent.
  bool show(const Packet& packet) {
    if (packet.empty()) return false;
    const auto view = read_packet(packet);
    EXPECT_TRUE(view);
    EXPECT_FALSE(view->header.flags & packet_complete);
    size_t at = 0;
    for (const PicturePart& part : view->parts) {
      const Image8 piece = decode_jpeg(view->payload.subspan(at, part.bytes), "part");
      EXPECT_EQ(piece.width, part.width);
      EXPECT_EQ(piece.height, part.height);
      for (size_t y = 0; y < part.height; y++)
        std::copy_n(&piece.rgb[y * part.width * 3], size_t(part.width) * 3,
                    &canvas.rgb[((part.y + y) * width + part.x) * 3]);
      at += part.bytes;
    }
    EXPECT_EQ(at, view->payload.size());
    bytes += packet.size(), packets++;
    return true;
  }
  int farthest(const Image8& from) const {
    int most = 0;
    for (size_t i = 0; i < canvas.rgb.size(); i++)
      most = std::max(most, std::abs(int(canvas.rgb[i]) - int(from.rgb[i])));
    return most;
  }
};

// Soft waves, so that a JPEG of them is near to them.
Image8 waves(float phase = 0) {
  Image8 image{width, height, {}};
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++)
      for (int c = 0; c < 3; c++)
        image.rgb.push_back(uint8_t(128 + 60 * std::sin(0.05f * float(x + c * 9) + phase) *
                                              std::cos(0.04f * float(y))));
  return image;
}

void fill(Image8& image, const ImagePart& part, uint8_t value) {
  for (int y = part.y; y < part.y + part.height; y++)
    for (int x = part.x * 3; x < (part.x + part.width) * 3; x++)
      image.rgb[size_t(y * width * 3 + x)] = value;
}

struct Parts : testing::Test {
  Image8 newest = waves();
  BrowserPicture has;
  Canvas browser;
  PartsOrder order;
  PacketHeader header;
  Packet packet;

  void SetUp() override {
    header.width = width, header.height = height;
    browser.canvas = newest;
    note_complete(newest, 82, true, 0, has);
  }
  bool send(double now) {
    order.now = now;
    make_parts(newest, order, header, has, packet);
    return browser.show(packet);
  }
};

TEST_F(Parts, NothingIsSentWhereNothingHasChanged) {
  order.fine_quality = 0;
  EXPECT_FALSE(send(0.1));
  EXPECT_FALSE(send(10));
  EXPECT_FALSE(has.pending);
  order.must = true;
  EXPECT_TRUE(send(10));
  EXPECT_EQ(packet.size(), parts_header_bytes(0));
}

TEST_F(Parts, OnlyWhatHasChangedIsSent) {
  order.fine_quality = 0;
  fill(newest, {100, 60, 40, 30}, 200);
  ASSERT_TRUE(send(0.1));
  const auto view = read_packet(packet);
  for (const PicturePart& part : view->parts) {
    EXPECT_GE(part.x, 96);
    EXPECT_LE(part.x + part.width, 160);
    EXPECT_GE(part.y, 32);
    EXPECT_LE(part.y + part.height, 96);
  }
  EXPECT_LE(browser.farthest(newest), 40);
  EXPECT_FALSE(send(0.2));
}

TEST_F(Parts, WhatIsNotSeenWaitsAndAddsUp) {
  for (uint8_t& value : newest.rgb) value += 1;
  EXPECT_FALSE(send(0.1));
  EXPECT_TRUE(has.pending);
  for (uint8_t& value : newest.rgb) value += 1;
  EXPECT_TRUE(send(0.2));
}

TEST_F(Parts, WhatBecomesBetterStillIsNotMadeFineYet) {
  order.quiet = 4;
  EXPECT_FALSE(send(3.9));
  EXPECT_TRUE(send(4.1));
}

TEST_F(Parts, AfterAQuietMomentAllIsNearLosslessAndThenSilent) {
  for (uint8_t& value : newest.rgb) value += 1;
  EXPECT_FALSE(send(0.3));
  double now = 1;
  while (has.pending && browser.packets < 100) {
    send(now);
    now += 0.05;
  }
  EXPECT_LE(browser.farthest(newest), 8);
  EXPECT_EQ(std::ranges::count(has.quality, 95), std::ptrdiff_t(has.quality.size()));
  EXPECT_FALSE(send(now + 1));
}

TEST_F(Parts, ASlowLineGetsItPieceByPiece) {
  order.bytes = 3000;
  size_t most = 0;
  for (double now = 1; has.pending && browser.packets < 500; now += 0.05)
    if (send(now)) most = std::max(most, packet.size());
  EXPECT_GT(browser.packets, 4u);
  EXPECT_LE(most, 12000u);  // with the tables of each JPEG
  EXPECT_LE(browser.farthest(newest), 8);
}

TEST_F(Parts, WhatMovesDoesNotKeepTheRestFromBecomingFine) {
  order.bytes = 20000;
  size_t moving = 0;
  double now = 1;
  for (int i = 0; i < 200; i++, now += 0.04) {
    fill(newest, {64, 64, 60, 60}, uint8_t(40 + i));
    const size_t before = browser.bytes;
    send(now);
    if (i >= 100) moving += browser.bytes - before;
  }
  const TileGrid grid{width, height};
  size_t fine = 0;
  for (size_t tile = 0; tile < grid.size(); tile++) fine += has.quality[tile] == 95;
  EXPECT_GE(fine, grid.size() - 12);
  EXPECT_LT(moving / 100, 4000u);  // the moving tiles alone
}

TEST_F(Parts, AfterASmallPictureAllOfItComes) {
  note_complete(newest, 60, false, 0, has);
  order.fine_quality = 70;
  double now = 1;
  while (has.pending && browser.packets < 100) {
    send(now);
    now += 0.05;
  }
  for (uint8_t quality : has.quality) EXPECT_EQ(quality, 70);
}

}  // namespace
}  // namespace wellspring::test
