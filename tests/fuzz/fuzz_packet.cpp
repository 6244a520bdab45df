// SPDX-License-Identifier: Apache-2.0
// Pictures and sound as a browser, or a program that measures, gets them.
#include "fuzz/fuzz.h"
#include "unit/wire/sound_view.h"
#include "wire/packet.h"

namespace wellspring::fuzz {

void fuzz_packet(Bytes bytes) {
  if (const auto picture = read_packet(bytes))
    require(picture->payload.size() + packet_header_bytes <= bytes.size(), "payload lies within");
  if (const auto sound = test::read_sound_packet(bytes))
    require(sound->samples.size() * 2 + sound_header_bytes <= bytes.size(), "samples lie within");
}

}  // namespace wellspring::fuzz
