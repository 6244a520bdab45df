// SPDX-License-Identifier: Apache-2.0
#include "wire/packet.h"

#include <bit>
#include <cassert>
#include <cmath>
#include <stdexcept>
#include <type_traits>

#include <zlib.h>

namespace wellspring::wire {

static constexpr Magic picture_magic{'W', 'S', 'F', '1'};
static constexpr size_t flags_at = 25;
static constexpr int deflate_level = 4;

void write_packet_header(const PacketHeader& header, std::span<uint8_t> packet) {
  assert(packet.size() >= packet_header_bytes);
  put_envelope(packet, picture_magic, packet_header_bytes);
  put(packet, 4, header.frame);
  put(packet, 8, header.seq);
  put(packet, 12, header.time_us);
  put(packet, 20, header.width);
  put(packet, 22, header.height);
  put(packet, 24, header.quality);
  put(packet, flags_at, header.flags);
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

namespace {

template <class T>
using BitsOf = std::conditional_t<sizeof(T) == 8, uint64_t, uint32_t>;

// Calls real(number) for each number of the view, in the packet's order.
void each_number(auto& keyframe, const auto& real) {
  real(keyframe.eye.x), real(keyframe.eye.y), real(keyframe.eye.z);
  for (auto* axis : {&keyframe.right, &keyframe.up, &keyframe.forward})
    real(axis->x), real(axis->y), real(axis->z);
  real(keyframe.tan_half_fov);
  real(keyframe.middle.x), real(keyframe.middle.y);
  real(keyframe.unit);
}

// Calls real(number) for each number of the sway, likewise.
void each_sway_number(auto& sway, const auto& real) {
  real(sway.unit), real(sway.time);
  for (auto& wave : sway.waves) {
    for (auto* pair : {&wave.push, &wave.wave}) real(pair->x), real(pair->y);
    real(wave.rate), real(wave.phase);
  }
}

// Returns a function that writes numbers one behind the other.
auto writer(std::span<uint8_t> packet, size_t& at) {
  return [packet, &at](auto value) {
    put(packet, at, std::bit_cast<BitsOf<decltype(value)>>(value));
    at += sizeof value;
  };
}
// Returns a function that reads them, and notes in `finite` if one is not.
auto reader(std::span<const uint8_t> bytes, size_t& at, bool& finite) {
  return [bytes, &at, &finite](auto& value) {
    using T = std::remove_reference_t<decltype(value)>;
    value = std::bit_cast<T>(get<BitsOf<T>>(bytes, at));
    at += sizeof value;
    finite &= bool(std::isfinite(value));
  };
}

}  // namespace

void write_packet_header(const PacketHeader& header, const KeyframeHeader& keyframe,
                         std::span<uint8_t> packet) {
  assert(packet.size() >= keyframe_header_bytes);
  write_packet_header(header, packet);
  put(packet, header_length_at, uint16_t(keyframe_header_bytes));
  put(packet, 28, keyframe.color_bytes);
  put(packet, 32, keyframe.cuts);
  put(packet, 36, keyframe.width);
  put(packet, 38, keyframe.height);
  size_t at = 40;
  each_number(keyframe, writer(packet, at));
}

void add_sway(SwayHeader sway, std::span<const uint8_t> codes, Packet& packet) {
  assert(codes.size() == size_t(sway.columns) * size_t(sway.rows));
  const size_t begin = get<uint16_t>(packet, header_length_at);
  packet.insert(packet.begin() + ptrdiff_t(begin), sway_header_bytes, uint8_t(0));
  const size_t codes_at = packet.size();
  uLongf bytes = compressBound(uLong(codes.size()));
  packet.resize(codes_at + bytes);
  if (compress2(&packet[codes_at], &bytes, codes.data(), uLong(codes.size()), deflate_level) !=
      Z_OK)
    throw std::runtime_error("add_sway: deflate failed");
  packet.resize(codes_at + bytes);
  put(packet, header_length_at, uint16_t(begin + sway_header_bytes));
  packet[flags_at] |= packet_sway;
  put(packet, begin, uint32_t(bytes));
  put(packet, begin + 4, sway.columns);
  put(packet, begin + 6, sway.rows);
  size_t at = begin + 8;
  each_sway_number(sway, writer(packet, at));
}

void write_packet_header(const PacketHeader& header, float zoom, std::span<uint8_t> packet) {
  assert(packet.size() >= lens_header_bytes);
  write_packet_header(header, packet);
  put(packet, header_length_at, uint16_t(lens_header_bytes));
  put(packet, packet_header_bytes, std::bit_cast<uint32_t>(zoom));
}

static bool read_zoom(std::span<const uint8_t> bytes, PacketView& view) {
  if (bytes.size() - view.payload.size() < lens_header_bytes) return false;
  view.zoom = std::bit_cast<float>(get<uint32_t>(bytes, packet_header_bytes));
  return std::isfinite(*view.zoom) && *view.zoom > 0;
}

static bool read_keyframe(std::span<const uint8_t> bytes, PacketView& view) {
  if (bytes.size() - view.payload.size() < keyframe_header_bytes) return false;
  KeyframeHeader& keyframe = view.keyframe.emplace();
  keyframe.color_bytes = get<uint32_t>(bytes, 28);
  keyframe.cuts = get<uint32_t>(bytes, 32);
  keyframe.width = get<uint16_t>(bytes, 36);
  keyframe.height = get<uint16_t>(bytes, 38);
  size_t at = 40;
  bool finite = true;
  each_number(keyframe, reader(bytes, at, finite));
  return finite && keyframe.color_bytes <= view.payload.size() && keyframe.width > 0 &&
         keyframe.height > 0 && keyframe.tan_half_fov > 0 && keyframe.unit > 0;
}

// Reads the parts' list. False: it is not complete, or parts are not within the picture.
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

static bool read_sway(std::span<const uint8_t> bytes, PacketView& view) {
  const size_t begin =
      view.keyframe ? keyframe_header_bytes : parts_header_bytes(view.parts.size());
  if (bytes.size() - view.payload.size() < begin + sway_header_bytes) return false;
  SwayHeader& sway = view.sway.emplace();
  sway.bytes = get<uint32_t>(bytes, begin);
  sway.columns = get<uint16_t>(bytes, begin + 4);
  sway.rows = get<uint16_t>(bytes, begin + 6);
  size_t at = begin + 8;
  bool finite = true;
  each_sway_number(sway, reader(bytes, at, finite));
  size_t before = view.keyframe ? view.keyframe->color_bytes : 0;
  for (const PicturePart& part : view.parts) before += part.bytes;
  return finite && sway.columns > 0 && sway.rows > 0 && sway.unit > 0 &&
         before + sway.bytes <= view.payload.size();
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
  view.header.flags = get<uint8_t>(bytes, flags_at);
  view.payload = *payload;
  const bool complete = view.header.flags & packet_complete;
  if (!complete && !read_parts(bytes, view)) return std::nullopt;
  if (complete && (view.header.flags & packet_depth) && !read_keyframe(bytes, view))
    return std::nullopt;
  const bool may_sway = !complete || view.keyframe;
  if (may_sway && (view.header.flags & packet_sway) && !read_sway(bytes, view)) return std::nullopt;
  if (complete && (view.header.flags & packet_lens) && !read_zoom(bytes, view)) return std::nullopt;
  return view;
}

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
