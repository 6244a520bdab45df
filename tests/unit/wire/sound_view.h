// SPDX-License-Identifier: Apache-2.0
// A message of sound as a browser reads it.
#pragma once
#include <bit>
#include <cmath>
#include <optional>

#include "wire/packet.h"

namespace wellspring::test {

struct SoundView {
  SoundHeader header;
  std::vector<int16_t> samples;  // all channels, interleaved
};
// Empty when the bytes are no sound message: short, other magic, header length < 56 or past the
// end, no channels or no rate, half a sample, more samples than the utterance has, a mouth that is
// nowhere.
inline std::optional<SoundView> read_sound_packet(std::span<const uint8_t> bytes) {
  const auto payload = get_payload(bytes, Magic{'W', 'S', 'A', '1'}, sound_header_bytes);
  if (!payload) return std::nullopt;
  SoundView view;
  SoundHeader& header = view.header;
  header.utterance = get<uint32_t>(bytes, 4);
  header.start = get<uint32_t>(bytes, 8);
  header.time_us = get<uint64_t>(bytes, 12);
  header.total = get<uint32_t>(bytes, 20);
  header.channels = get<uint8_t>(bytes, 24);
  header.flags = get<uint8_t>(bytes, 25);
  header.rate = get<uint32_t>(bytes, 28);
  for (int i = 0; i < 3; i++)
    header.mouth[i] = std::bit_cast<double>(get<uint64_t>(bytes, size_t(32 + 8 * i)));
  if (header.channels == 0 || header.rate == 0) return std::nullopt;
  if (payload->size() % (2u * header.channels) != 0) return std::nullopt;
  if (uint64_t(header.start) + payload->size() / 2 / header.channels > header.total)
    return std::nullopt;
  for (int i = 0; i < 3; i++)
    if (!std::isfinite(header.mouth[i])) return std::nullopt;
  view.samples.resize(payload->size() / 2);
  for (size_t i = 0; i < view.samples.size(); i++)
    view.samples[i] = int16_t(get<uint16_t>(*payload, 2 * i));
  return view;
}

}  // namespace wellspring::test
