// SPDX-License-Identifier: Apache-2.0
#include "wire/sound_packet.h"

#include <bit>
#include <cmath>

#include "wire/little_endian.h"

namespace wellspring::wire {

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

}  // namespace wellspring::wire
