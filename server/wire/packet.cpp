// SPDX-License-Identifier: Apache-2.0
#include "wire/packet.h"

#include <cassert>
#include <cstring>

#include "wire/little_endian.h"

namespace wellspring {

static constexpr uint8_t picture_magic[4] = {'W', 'S', 'F', '1'};

void write_packet_header(const PacketHeader& header, std::span<uint8_t> packet) {
  assert(packet.size() >= packet_header_bytes);
  std::memcpy(packet.data(), picture_magic, sizeof(picture_magic));
  put(packet, 4, header.frame);
  put(packet, 8, header.seq);
  put(packet, 12, header.time_us);
  put(packet, 20, header.width);
  put(packet, 22, header.height);
  put(packet, 24, header.quality);
  put(packet, 25, header.flags);
  put(packet, 26, uint16_t(packet_header_bytes));
}

std::optional<PacketView> read_packet(std::span<const uint8_t> bytes) {
  if (bytes.size() < packet_header_bytes) return std::nullopt;
  if (std::memcmp(bytes.data(), picture_magic, sizeof(picture_magic)) != 0) return std::nullopt;
  const auto header_bytes = get<uint16_t>(bytes, 26);
  if (header_bytes < packet_header_bytes || header_bytes > bytes.size()) return std::nullopt;
  PacketView view;
  view.header.frame = get<uint32_t>(bytes, 4);
  view.header.seq = get<uint32_t>(bytes, 8);
  view.header.time_us = get<uint64_t>(bytes, 12);
  view.header.width = get<uint16_t>(bytes, 20);
  view.header.height = get<uint16_t>(bytes, 22);
  view.header.quality = get<uint8_t>(bytes, 24);
  view.header.flags = get<uint8_t>(bytes, 25);
  view.payload = bytes.subspan(header_bytes);
  return view;
}

}  // namespace wellspring
