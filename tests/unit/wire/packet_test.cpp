// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "unit/wire/golden.h"
#include "wire/packet.h"

using namespace wellspring;

using namespace wellspring::test;

static Packet golden_picture() { return test::read_golden("picture.hex"); }

static constexpr PacketHeader golden_header{.frame = 0x04030201,
                                            .seq = 0x14131211,
                                            .time_us = 0x2827262524232221,
                                            .width = 1280,
                                            .height = 720,
                                            .quality = 85,
                                            .flags = packet_still | packet_complete};

TEST(Packet, is_written_as_the_golden_bytes) {
  Packet packet = golden_picture();
  std::fill_n(packet.begin(), packet_header_bytes, uint8_t(0xee));
  write_packet_header(golden_header, packet);
  EXPECT_EQ(packet, golden_picture());
}

TEST(Packet, is_read_from_the_golden_bytes) {
  const Packet packet = golden_picture();
  const auto view = read_packet(packet);
  ASSERT_TRUE(view);
  EXPECT_EQ(view->header.frame, golden_header.frame);
  EXPECT_EQ(view->header.seq, golden_header.seq);
  EXPECT_EQ(view->header.time_us, golden_header.time_us);
  EXPECT_EQ(view->header.width, 1280);
  EXPECT_EQ(view->header.height, 720);
  EXPECT_EQ(view->header.quality, 85);
  EXPECT_EQ(view->header.flags, 3);
  EXPECT_EQ(std::vector(view->payload.begin(), view->payload.end()),
            (std::vector<uint8_t>{0xff, 0xd8, 0xff, 0xd9}));
}

TEST(Packet, longer_headers_of_the_future_are_skipped) {
  Packet packet = golden_picture();
  packet.insert(packet.begin() + packet_header_bytes, {1, 2, 3, 4});
  packet[26] = 32;
  const auto view = read_packet(packet);
  ASSERT_TRUE(view);
  EXPECT_EQ(view->payload.size(), 4u);
  EXPECT_EQ(view->payload[0], 0xff);
}

TEST(Packet, an_empty_payload_is_a_picture_message) {
  Packet packet = golden_picture();
  packet.resize(packet_header_bytes);
  ASSERT_TRUE(read_packet(packet));
  EXPECT_TRUE(read_packet(packet)->payload.empty());
}

TEST(Packet, what_is_no_picture_is_refused) {
  const Packet good = golden_picture();
  for (size_t size = 0; size < packet_header_bytes; size++)
    EXPECT_FALSE(read_packet(std::span(good).first(size))) << size;
  for (size_t i = 0; i < 4; i++) {
    Packet bad = good;
    bad[i] ^= 1;
    EXPECT_FALSE(read_packet(bad)) << i;
  }
  Packet bad = good;
  bad[26] = 27;  // header too short
  EXPECT_FALSE(read_packet(bad));
  bad[26] = uint8_t(good.size() + 1);  // header past the end
  EXPECT_FALSE(read_packet(bad));
  bad[26] = uint8_t(good.size());
  EXPECT_TRUE(read_packet(bad));
  bad[27] = 0xff;
  EXPECT_FALSE(read_packet(bad));
}

struct Change {
  size_t at;
  std::vector<uint8_t> bytes;
};
// Checks that with any one of the changes the bytes are no picture message.
static void expect_refused(const Packet& golden, const std::vector<Change>& changes) {
  for (const Change& change : changes) {
    Packet packet = golden;
    std::copy(change.bytes.begin(), change.bytes.end(), packet.begin() + ptrdiff_t(change.at));
    EXPECT_FALSE(read_packet(packet)) << change.at;
  }
}

TEST(Packet, parts_are_written_and_read_as_the_golden_bytes) {
  const PacketHeader header{.frame = 5,
                            .seq = 6,
                            .time_us = 7,
                            .width = 640,
                            .height = 360,
                            .quality = 90,
                            .flags = packet_still};
  const std::vector<PicturePart> parts = {{32, 64, 96, 32, 4}, {0, 320, 640, 40, 5}};
  const Packet golden = test::read_golden("picture_parts.hex");
  Packet packet = golden;
  std::fill_n(packet.begin(), parts_header_bytes(2), uint8_t(0xee));
  write_packet_header(header, parts, packet);
  EXPECT_EQ(packet, golden);
  const auto view = read_packet(golden);
  ASSERT_TRUE(view);
  EXPECT_EQ(view->parts, parts);
  EXPECT_EQ(view->payload.size(), 9u);
}

TEST(Packet, parts_that_cannot_be_are_refused) {
  const Packet golden = test::read_golden("picture_parts.hex");
  for (size_t size = 0; size < golden.size(); size++)
    EXPECT_FALSE(read_packet({golden.data(), size})) << size;
  expect_refused(golden, {{28, {3}},
                          {29, {1}},
                          {31, {3}},
                          {34, {0}},
                          {35, {3}},
                          {38, {0xff}},
                          {41, {0xff}},
                          {43, {2}}});
}

static constexpr KeyframeHeader golden_keyframe{.color_bytes = 4,
                                                .cuts = 3,
                                                .width = 8,
                                                .height = 4,
                                                .eye = {1.5, -2.25, 1024.5},
                                                .right = {1, 0, 0},
                                                .up = {0, 1, 0},
                                                .forward = {0, 0, -1},
                                                .tan_half_fov = 0.5f,
                                                .middle = {0.25f, -0.125f},
                                                .unit = 0.5f};

TEST(Packet, keyframes_are_written_and_read_as_the_golden_bytes) {
  const PacketHeader header{.frame = 9,
                            .seq = 10,
                            .time_us = 11,
                            .width = 16,
                            .height = 8,
                            .quality = 85,
                            .flags = packet_complete | packet_depth};
  const Packet golden = test::read_golden("keyframe.hex");
  Packet packet = golden;
  std::fill_n(packet.begin(), keyframe_header_bytes, uint8_t(0xee));
  write_packet_header(header, golden_keyframe, packet);
  EXPECT_EQ(packet, golden);
  const auto view = read_packet(golden);
  ASSERT_TRUE(view);
  EXPECT_EQ(view->keyframe, golden_keyframe);
  EXPECT_EQ(view->payload[0], 0xff);
}

static constexpr SwayHeader golden_sway{
    .columns = 2,
    .rows = 1,
    .unit = 1,
    .time = 12.5,
    .waves = {{{{0.5f, -0.25f}, {1, 2}, 1.5f, 0.75f}, {{0, 1}, {0, 0}, 2, -1}, {}, {}}}};

TEST(Packet, sway_goes_behind_the_header_and_the_depth) {
  const Packet keyframe = test::read_golden("keyframe.hex");
  Packet packet = keyframe;
  add_sway(golden_sway, std::vector<uint8_t>{0, 7}, packet);
  EXPECT_EQ(packet, test::read_golden("keyframe_sway.hex"));
  const auto view = read_packet(packet);
  ASSERT_TRUE(view);
  EXPECT_EQ(view->keyframe, golden_keyframe);
  ASSERT_TRUE(view->sway);
  SwayHeader expected = golden_sway;
  expected.bytes = view->sway->bytes;
  EXPECT_EQ(view->sway, expected);
  EXPECT_EQ(view->payload.size(), read_packet(keyframe)->payload.size() + view->sway->bytes);
}

TEST(Packet, parts_may_sway_too) {
  Packet packet = test::read_golden("picture_parts.hex");
  const auto parts = read_packet(packet)->parts;
  add_sway(golden_sway, std::vector<uint8_t>{0, 7}, packet);
  const auto view = read_packet(packet);
  ASSERT_TRUE(view);
  EXPECT_EQ(view->parts, parts);
  ASSERT_TRUE(view->sway);
  EXPECT_EQ(view->sway->time, 12.5);
  EXPECT_EQ(view->payload.size(), 9u + view->sway->bytes);
}

TEST(Packet, sway_that_cannot_be_is_refused) {
  const Packet golden = test::read_golden("keyframe_sway.hex");
  const size_t at = keyframe_header_bytes;
  for (size_t size = 0; size < at + sway_header_bytes; size++)
    EXPECT_FALSE(read_packet({golden.data(), size})) << size;
  expect_refused(golden, {{26, {uint8_t(at + sway_header_bytes - 1)}},
                          {at + 1, {1}},            // more codes than there are
                          {at + 4, {0}},            // no columns
                          {at + 6, {0}},            // no rows
                          {at + 10, {0, 0}},        // no unit
                          {at + 18, {0xff, 0x7f}},  // a time that is no finite number
                          {at + 22, {0x80, 0x7f}},  // a push, a phase
                          {at + 42, {0x80, 0x7f}}});
}

TEST(Packet, what_a_glass_shows_is_written_and_read_as_the_golden_bytes) {
  const PacketHeader header{.frame = 9,
                            .seq = 10,
                            .time_us = 11,
                            .width = 48,
                            .height = 48,
                            .quality = 85,
                            .flags = packet_complete | packet_lens};
  const Packet golden = test::read_golden("lens.hex");
  Packet packet = golden;
  std::fill_n(packet.begin(), lens_header_bytes, uint8_t(0xee));
  write_packet_header(header, 2, packet);
  EXPECT_EQ(packet, golden);
  ASSERT_TRUE(read_packet(golden));
  EXPECT_EQ(read_packet(golden)->zoom, 2);
  EXPECT_EQ(read_packet(golden)->payload.size(), 4u);
  for (size_t size = 0; size < lens_header_bytes; size++)
    EXPECT_FALSE(read_packet({golden.data(), size})) << size;
  expect_refused(golden, {{26, {28}}, {31, {0xc0}}, {30, {0x80, 0x7f}}, {31, {0}}});
}

TEST(Packet, keyframes_that_cannot_be_are_refused) {
  const Packet golden = test::read_golden("keyframe.hex");
  for (size_t size = 0; size < keyframe_header_bytes + golden_keyframe.color_bytes; size++)
    EXPECT_FALSE(read_packet({golden.data(), size})) << size;
  expect_refused(golden, {{26, {115}},
                          {31, {1}},
                          {36, {0}},
                          {38, {0}},
                          {46, {0xff, 0x7f}},  // not a finite number
                          {66, {0xff, 0x7f}},
                          {103, {0xbf}},
                          {102, {0xff, 0x7f}},
                          {106, {0xff, 0x7f}},
                          {114, {0, 0}}});
}
