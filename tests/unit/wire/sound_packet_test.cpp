// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "unit/wire/golden.h"
#include "unit/wire/sound_view.h"
#include "wire/packet.h"

using namespace wellspring;

using namespace wellspring::test;

static Packet golden_sound() { return test::read_golden("sound.hex"); }

static const SoundHeader golden_header{.utterance = 0x04030201,
                                       .start = 2,
                                       .time_us = 0x2827262524232221,
                                       .total = 5,
                                       .rate = 22050,
                                       .mouth = {1.5, -2, 0.25}};
static const std::vector<int16_t> golden_samples{1, -32768};

TEST(SoundPacket, is_written_as_the_golden_bytes) {
  EXPECT_EQ(make_sound_packet(golden_header, golden_samples), golden_sound());
}

TEST(SoundPacket, is_read_from_the_golden_bytes) {
  const auto view = test::read_sound_packet(golden_sound());
  ASSERT_TRUE(view);
  EXPECT_EQ(view->header.utterance, golden_header.utterance);
  EXPECT_EQ(view->header.start, 2u);
  EXPECT_EQ(view->header.time_us, golden_header.time_us);
  EXPECT_EQ(view->header.total, 5u);
  EXPECT_EQ(view->header.rate, 22050u);
  EXPECT_EQ(view->header.channels, 1);
  EXPECT_EQ(view->header.mouth, golden_header.mouth);
  EXPECT_EQ(view->samples, golden_samples);
}

TEST(SoundPacket, longer_headers_of_the_future_are_skipped) {
  Packet packet = golden_sound();
  packet.insert(packet.begin() + sound_header_bytes, {1, 2, 3, 4});
  packet[26] = 60;
  ASSERT_TRUE(test::read_sound_packet(packet));
  EXPECT_EQ(test::read_sound_packet(packet)->samples, golden_samples);
}

TEST(SoundPacket, what_is_no_sound_is_refused) {
  const Packet good = golden_sound();
  for (size_t size = 0; size < sound_header_bytes; size++)
    EXPECT_FALSE(test::read_sound_packet(std::span(good).first(size))) << size;
  EXPECT_FALSE(test::read_sound_packet(std::span(good).first(sound_header_bytes + 1)))
      << "half a sample";
  const auto with = [&](size_t at, std::vector<uint8_t> bytes) {
    Packet bad = good;
    std::copy(bytes.begin(), bytes.end(), bad.begin() + long(at));
    return test::read_sound_packet(bad).has_value();
  };
  for (size_t i = 0; i < 4; i++) EXPECT_FALSE(with(i, {uint8_t(good[i] ^ 1)})) << i;
  EXPECT_FALSE(with(26, {55, 0})) << "header too short";
  EXPECT_FALSE(with(26, {61, 0})) << "header past the end";
  EXPECT_FALSE(with(24, {0})) << "no channels";
  EXPECT_FALSE(with(24, {3})) << "a third of a sample";
  EXPECT_FALSE(with(28, {0, 0, 0, 0})) << "no rate";
  EXPECT_TRUE(with(8, {3, 0, 0, 0}));
  EXPECT_FALSE(with(8, {4, 0, 0, 0})) << "past the utterance's end";
  EXPECT_FALSE(with(8, {0xff, 0xff, 0xff, 0xff})) << "the sum must not wrap";
  EXPECT_FALSE(with(38, {0xf8, 0x7f})) << "mouth not a number";
  EXPECT_FALSE(read_packet(good)) << "nor is it a picture";
}
