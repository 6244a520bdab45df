// SPDX-License-Identifier: Apache-2.0
#include "wire/packet.h"

#include <cassert>

#include "wire/little_endian.h"

namespace wellspring {

static constexpr Magic picture_magic{'W', 'S', 'F', '1'};

void write_packet_header(const PacketHeader& header, std::span<uint8_t> packet) {
  assert(packet.size() >= packet_header_bytes);
  put_envelope(packet, picture_magic, packet_header_bytes);
  put(packet, 4, header.frame);
  put(packet, 8, header.seq);
  put(packet, 12, header.time_us);
  put(packet, 20, header.width);
  put(packet, 22, header.height);
  put(packet, 24, header.quality);
  put(packet, 25, header.flags);
}

std::optional<PacketView> read_packet(std::span<const uint8_t> bytes) {
  const auto payload = get_payload(bytes, picture_magic, packet_header_bytes);
  if (!payload) return std::nullopt;
  PacketView view;
  view.header.frame = get<uint32_t>(bytes, 4);
  view.header.seq = get<uint32_t>(bytes, 8);
  view.header.time_us = get<uint64_t>(bytes, 12);
  view.header.width = get<uint16_t>(bytes, 20);
  view.header.height = get<uint16_t>(bytes, 22);
  view.header.quality = get<uint8_t>(bytes, 24);
  view.header.flags = get<uint8_t>(bytes, 25);
  view.payload = *payload;
  return view;
}

}  // namespace wellspring
