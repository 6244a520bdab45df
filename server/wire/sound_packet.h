// SPDX-License-Identifier: Apache-2.0
// A piece of an utterance's sound as a binary message, little-endian: 0 magic WSA1, 4 u32
// utterance, 8 u32 first sample of this piece within the utterance, 12 u64 server time in
// microseconds at which that sample is to sound (the clock of pictures: it goes with the picture of
// the same time), 20 u32 samples of the whole utterance, 24 u8 channels (1), 25 u8 flags (1: heard
// the same everywhere, as a narrator is), 26 u16 header length, 28 u32 samples a second, 32 3 x f64
// world position of the mouth, then 16-bit samples.
#pragma once
#include "base/vec.h"
#include "wire/packet.h"

namespace wellspring::wire {

struct SoundHeader {
  uint32_t utterance = 0, start = 0;
  uint64_t time_us = 0;
  uint32_t total = 0, rate = 22050;
  uint8_t channels = 1, flags = 0;
  dvec3 mouth{0};
};
inline constexpr size_t sound_header_bytes = 56;

Packet make_sound_packet(const SoundHeader& header, std::span<const int16_t> samples);

}  // namespace wellspring::wire
