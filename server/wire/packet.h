// SPDX-License-Identifier: Apache-2.0
// Writes and reads binary messages to the browser, little-endian: pictures (magic WSF1);
// packet.h has sound (WSA1). Picture: 0 magic, 4 u32 frame number, 8 u32 last input/camera
// seq this picture shows, 12 u64 server time in microseconds, 20 u16 width, 22 u16 height, 24 u8
// quality, 25 u8 flags, 26 u16 header length, payload: a JPEG. A complete picture may be smaller
// than was asked for: it is shown as large all the same. Without the flag `complete` it holds parts
// of a picture of that width and height, for clients whose hello says that they take them; the rest
// is the picture before, which is first scaled to that size if it had another. Its header goes on:
// 28 u16 number of parts, then for each from 30 on: u16 x, u16 y, u16 width, u16 height, u32 bytes;
// the payload is their JPEGs one after the other. No parts: nothing is new but seq.
//
// With the flag `depth` a complete picture is a keyframe, for displays that reproject it (hello
// {display: "local"}). Its header goes on: 28 u32 bytes of the JPEG, 32 u32 camera cuts so far, 36
// u16 width, 38 u16 height of the depth, 40 f64 x, y, z of the eye, 64 f32 x, y, z of each of the
// axes to the right, up and forward, 100 f32 half of the picture's height at a depth of 1, 104 f32
// x, y of its middle there, 112 f32 unit. Behind the JPEG follow disparities in that unit, as
// frame/disparity_code.h has them. With the flag `around`, too, it is a wide view in few pixels,
// for places that keyframes do not show. With the flag `layer` it is a dynamic layer, to be laid
// over keyframes with the flag `still` until the next one: pixels with a disparity of 0 are empty.
//
// With the flag `sway` a keyframe, or parts of one, show what wind moves. The header goes on behind
// that: u32 bytes of codes, u16 columns, u16 rows, f32 pixels a code, f64 seconds of the wind's
// clock, then four waves of the wind: f32 x, z of what it pushes, x, z of its radians a metre, its
// radians a second, its radians at the eye at that time. At (x, z) from the eye and t later a push
// is the sum of push * sin(dot(wave, (x, z)) + phase - rate * t). The payload ends with the codes,
// a zlib stream of u8, row after row: as far is what their part of the picture shows moved by a
// push of 1 that is seen from the side.
//
// With the flag `lens` a complete picture is what a visitor's glass shows: a square of three times
// its radius, around its middle at the time of the message `lens` that seq names. Its header goes
// on: 28 f32 how many times larger things are in it than beside it.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/vec.h"

namespace wellspring::wire {

// Writes and reads whole numbers in binary messages, byte by byte, so that the layout is
// little-endian on every machine and no pointer need be aligned; and the common part of every
// binary message: four bytes that name its kind, and the length of its header.

template <class T>
void put(std::span<uint8_t> bytes, size_t at, T value) {
  for (size_t i = 0; i < sizeof(T); i++) bytes[at + i] = uint8_t(uint64_t(value) >> (8 * i));
}

template <class T>
T get(std::span<const uint8_t> bytes, size_t at) {
  uint64_t value = 0;
  for (size_t i = 0; i < sizeof(T); i++) value |= uint64_t(bytes[at + i]) << (8 * i);
  return T(value);
}

using Magic = std::array<uint8_t, 4>;
inline constexpr size_t header_length_at = 26;  // u16

inline void put_envelope(std::span<uint8_t> bytes, const Magic& magic, size_t header_bytes) {
  std::copy(magic.begin(), magic.end(), bytes.begin());
  put(bytes, header_length_at, uint16_t(header_bytes));
}

// Returns the bytes behind the header of a message of that kind, whose header is at least as long
// as `least` (longer: a later version's, whose additions are skipped); none: it is no such message.
inline std::optional<std::span<const uint8_t>> get_payload(std::span<const uint8_t> bytes,
                                                           const Magic& magic, size_t least) {
  if (bytes.size() < least || !std::equal(magic.begin(), magic.end(), bytes.begin()))
    return std::nullopt;
  const size_t header_bytes = get<uint16_t>(bytes, header_length_at);
  if (header_bytes < least || header_bytes > bytes.size()) return std::nullopt;
  return bytes.subspan(header_bytes);
}

inline constexpr uint8_t packet_still =
    1;  // the visitor stands still, and this is the refined picture
inline constexpr uint8_t packet_complete = 2;  // complete picture, not a part
inline constexpr uint8_t packet_depth = 4;     // complete, and with the depth of its pixels
inline constexpr uint8_t packet_around = 8;    // with depth: the surroundings, in fewer pixels
inline constexpr uint8_t packet_layer = 16;  // with depth: what moves, laid over what stands still
inline constexpr uint8_t packet_lens = 32;   // complete: what the visitor's glass shows
inline constexpr uint8_t packet_sway = 64;   // with depth, or parts: wind moves some of it

struct PacketHeader {
  uint32_t frame = 0, seq = 0;
  uint64_t time_us = 0;
  uint16_t width = 0, height = 0;
  uint8_t quality = 0, flags = packet_complete;
};
inline constexpr size_t packet_header_bytes = 28;

struct PicturePart {
  uint16_t x = 0, y = 0, width = 0, height = 0;  // pixels from the upper left
  uint32_t bytes = 0;                            // length of its JPEG
  bool operator==(const PicturePart&) const = default;
};
// Holds the view for which a keyframe was drawn, in metres of the exhibit, and how its depth is
// stored.
struct KeyframeHeader {
  uint32_t color_bytes = 0, cuts = 0;
  uint16_t width = 0, height = 0;
  dvec3 eye{0};
  vec3 right{0}, up{0}, forward{0};
  float tan_half_fov = 0;
  vec2 middle{0};
  float unit = 0;
  bool operator==(const KeyframeHeader&) const = default;
};
inline constexpr size_t keyframe_header_bytes = 116;

// One of the wind's waves, as seen from the eye of a keyframe at its time.
struct SwayWave {
  vec2 push{0}, wave{0};  // x and z
  float rate = 0, phase = 0;
  bool operator==(const SwayWave&) const = default;
};
struct SwayHeader {
  uint32_t bytes = 0;
  uint16_t columns = 0, rows = 0;
  float unit = 0;
  double time = 0;
  std::array<SwayWave, 4> waves;
  bool operator==(const SwayHeader&) const = default;
};
inline constexpr size_t sway_header_bytes = 20 + 4 * 24;

inline constexpr size_t max_parts = 16;  // most parts of a picture
inline constexpr size_t parts_header_bytes(size_t parts) {
  return packet_header_bytes + 2 + 12 * parts;
}

// A packet is a whole binary message, ready to be sent; shared, never changed after it is made.
using Packet = std::vector<uint8_t>;

// Writes the header over the first 28 bytes of `packet` (which must be at least that long).
void write_packet_header(const PacketHeader& header, std::span<uint8_t> packet);
// Writes both headers over the first parts_header_bytes() of `packet`.
void write_packet_header(const PacketHeader& header, std::span<const PicturePart> parts,
                         std::span<uint8_t> packet);
// Writes both headers over the first keyframe_header_bytes of `packet`.
void write_packet_header(const PacketHeader& header, const KeyframeHeader& keyframe,
                         std::span<uint8_t> packet);
// Writes the header of what a glass shows over the first lens_header_bytes of `packet`.
inline constexpr size_t lens_header_bytes = packet_header_bytes + 4;
void write_packet_header(const PacketHeader& header, float zoom, std::span<uint8_t> packet);
// Adds to a whole packet, a keyframe's or one of parts, how wind moves what it shows: a header
// behind its own, whose `bytes` it sets, and the codes at its end, one for each column of each row.
void add_sway(SwayHeader sway, std::span<const uint8_t> codes, Packet& packet);
// Holds a packet as read; read_packet() returns none if the bytes are no picture message (short,
// other magic, header length < 28 or past the end; parts that are past the end, or not within the
// picture; a keyframe of no size, or whose view or unit is no finite number; a zoom that is no
// positive number; a sway of no size, whose numbers are not finite, or whose codes are not there).
struct PacketView {
  PacketHeader header;
  std::vector<PicturePart> parts;          // parts of a picture that is not complete
  std::optional<KeyframeHeader> keyframe;  // for a picture with depth
  std::optional<SwayHeader> sway;          // likewise, or for parts; its codes end the payload
  std::optional<float> zoom;               // for what a glass shows
  std::span<const uint8_t> payload;
};
std::optional<PacketView> read_packet(std::span<const uint8_t> bytes);

// Makes binary messages with a piece of an utterance's sound, little-endian: 0 magic WSA1, 4 u32
// utterance, 8 u32 first sample of this piece within the utterance, 12 u64 server time in
// microseconds at which that sample is to sound (the clock of pictures: it goes with the picture of
// the same time), 20 u32 samples of the whole utterance, 24 u8 channels (1), 25 u8 flags (1: heard
// the same everywhere, as a narrator is), 26 u16 header length, 28 u32 samples a second, 32 3 x f64
// world position of the mouth, then 16-bit samples.

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
