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

void write_packet_header(const PacketHeader& header, std::span<const PicturePart> parts,
                         std::span<uint8_t> packet) {
  assert(packet.size() >= parts_header_bytes(parts.size()));
  write_packet_header(header, packet);
  put(packet, header_length_at, uint16_t(parts_header_bytes(parts.size())));
  put(packet, packet_header_bytes, uint16_t(parts.size()));
  for (size_t i = 0; i < parts.size(); i++) {
    const size_t at = parts_header_bytes(i);
    put(packet, at, parts[i].x);
    put(packet, at + 2, parts[i].y);
    put(packet, at + 4, parts[i].width);
    put(packet, at + 6, parts[i].height);
    put(packet, at + 8, parts[i].bytes);
  }
}

// False: they are not all there, or not within the picture.
static bool read_parts(std::span<const uint8_t> bytes, PacketView& view) {
  const size_t header_bytes = bytes.size() - view.payload.size();
  if (header_bytes < parts_header_bytes(0)) return false;
  const size_t count = get<uint16_t>(bytes, packet_header_bytes);
  if (header_bytes < parts_header_bytes(count)) return false;
  size_t sum = 0;
  for (size_t i = 0; i < count; i++) {
    const size_t at = parts_header_bytes(i);
    PicturePart part{get<uint16_t>(bytes, at), get<uint16_t>(bytes, at + 2),
                     get<uint16_t>(bytes, at + 4), get<uint16_t>(bytes, at + 6),
                     get<uint32_t>(bytes, at + 8)};
    if (part.width == 0 || part.height == 0 || part.x + part.width > view.header.width ||
        part.y + part.height > view.header.height)
      return false;
    sum += part.bytes;
    view.parts.push_back(part);
  }
  return sum <= view.payload.size();
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
  if (!(view.header.flags & packet_complete) && !read_parts(bytes, view)) return std::nullopt;
  return view;
}

}  // namespace wellspring
