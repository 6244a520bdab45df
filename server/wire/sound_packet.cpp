// SPDX-License-Identifier: Apache-2.0
#include "wire/sound_packet.h"

#include <bit>
#include <cmath>

#include "wire/little_endian.h"

namespace wellspring {

static constexpr Magic sound_magic{'W', 'S', 'A', '1'};

Packet make_sound_packet(const SoundHeader& header, std::span<const int16_t> samples) {
  Packet packet(sound_header_bytes + 2 * samples.size());
  put_envelope(packet, sound_magic, sound_header_bytes);
  put(packet, 4, header.utterance);
  put(packet, 8, header.start);
  put(packet, 12, header.time_us);
  put(packet, 20, header.total);
  put(packet, 24, header.channels);
  put(packet, 25, header.flags);
  put(packet, 28, header.rate);
  for (int i = 0; i < 3; i++)
    put(packet, size_t(32 + 8 * i), std::bit_cast<uint64_t>(header.mouth[i]));
  for (size_t i = 0; i < samples.size(); i++)
    put(packet, sound_header_bytes + 2 * i, uint16_t(samples[i]));
  return packet;
}

std::optional<SoundView> read_sound_packet(std::span<const uint8_t> bytes) {
  const auto payload = get_payload(bytes, sound_magic, sound_header_bytes);
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

}  // namespace wellspring
