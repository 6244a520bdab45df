// SPDX-License-Identifier: Apache-2.0
#include "scan/splats/spz.h"

#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <glm/gtc/packing.hpp>
#include <memory>

#include "base/load_error.h"
#include "scan/format/input_file.h"
#include "scan/splats/splat_finish.h"

namespace wellspring::scan {
namespace {

constexpr uint32_t magic = 0x5053474e;  // "NGSP"
constexpr size_t old_header = 16, new_header = 32;

struct Header {
  uint32_t version = 0, splats = 0;
  int degree = 0, fraction_bits = 0;  // degree as the file says, up to 4
  uint8_t flags = 0, streams = 0;
  uint32_t table = 0;

  size_t harmonics() const { return degree == 4 ? 24 : size_t(splat_harmonics[degree]); }
  // Bytes of a splat's places, opacity, colour, scales, turn, harmonics, which lie in this order.
  std::array<size_t, 6> sizes() const {
    return {version == 1 ? size_t(6) : size_t(9),
            1,
            3,
            3,
            version < 3 ? size_t(3) : size_t(4),
            3 * harmonics()};
  }
};

bool is_gzip(std::string_view bytes) { return bytes.starts_with("\x1f\x8b"); }

// Unpacks at most so many bytes. Memory grows with what comes out, not with what is promised.
std::string unpack_gzip(std::string_view packed, uint64_t most) {
  z_stream state{};
  std::string bytes;
  if (inflateInit2(&state, 31) != Z_OK) return bytes;
  const std::unique_ptr<z_stream, int (*)(z_stream*)> end(&state, inflateEnd);
  state.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  std::array<char, 65536> piece;
  for (size_t fed = 0; bytes.size() < most;) {
    if (state.avail_in == 0) {
      state.avail_in = uInt(std::min<size_t>(packed.size() - fed, 1 << 30));
      fed += state.avail_in;
    }
    state.next_out = reinterpret_cast<Bytef*>(piece.data());
    state.avail_out = uInt(std::min<uint64_t>(piece.size(), most - bytes.size()));
    const uInt room = state.avail_out;
    const int result = inflate(&state, Z_NO_FLUSH);
    bytes.append(piece.data(), room - state.avail_out);
    if (result != Z_OK || (state.avail_in == 0 && fed == packed.size() && room == state.avail_out))
      break;
  }
  return bytes;
}

std::string unpack_zstd(std::string_view packed, uint64_t most) {
  const std::unique_ptr<ZSTD_DStream, size_t (*)(ZSTD_DStream*)> state(ZSTD_createDStream(),
                                                                       ZSTD_freeDStream);
  ZSTD_inBuffer in{packed.data(), packed.size(), 0};
  std::array<char, 65536> piece;
  std::string bytes;
  while (bytes.size() < most) {
    ZSTD_outBuffer out{piece.data(), piece.size(), 0};
    const size_t result = ZSTD_decompressStream(state.get(), &out, &in);
    if (ZSTD_isError(result)) break;
    bytes.append(piece.data(), out.pos);
    if (result == 0 || (in.pos == in.size && out.pos == 0)) break;
  }
  return bytes;
}

quat unpack_first_three(const uint8_t* from) {
  const vec3 xyz = vec3(from[0], from[1], from[2]) / 127.5f - 1.0f;
  return {std::sqrt(std::max(0.0f, 1 - glm::dot(xyz, xyz))), xyz.x, xyz.y, xyz.z};
}

// Two bits say which of x, y, z, w is the largest; the others have a sign and 9 bits each, the last
// in the lowest bits.
quat unpack_smallest_three(uint32_t bits) {
  std::array<float, 4> xyzw{};
  const int largest = int(bits >> 30);
  float rest = 1;
  for (int i = 3; i >= 0; i--) {
    if (i == largest) continue;
    const float size = float(bits & 511) / 511 * 0.70710678f;
    xyzw[size_t(i)] = bits & 512 ? -size : size;
    rest -= size * size;
    bits >>= 10;
  }
  xyzw[size_t(largest)] = std::sqrt(std::max(0.0f, rest));
  return {xyzw[3], xyzw[0], xyzw[1], xyzw[2]};
}

vec3 unpack_place(const Header& header, const char* from) {
  vec3 place;
  for (int i = 0; i < 3; i++) {
    if (header.version == 1) {
      place[i] = glm::unpackHalf1x16(number_at<uint16_t>(from + 2 * i));
      continue;
    }
    const auto* bytes = reinterpret_cast<const uint8_t*>(from + 3 * i);
    const uint32_t bits =
        uint32_t(bytes[0]) << 8 | uint32_t(bytes[1]) << 16 | uint32_t(bytes[2]) << 24;
    place[i] = std::ldexp(float(int32_t(bits) >> 8), -header.fraction_bits);
  }
  return place;
}

SplatSet unpack(const Header& header, const std::array<const char*, 6>& columns) {
  SplatSet set;
  set.format = fmt::format("SPZ, version {}", header.version);
  set.degree = std::min(header.degree, 3);
  if (header.degree > 3) set.notices.push_back("harmonics of degree 4 are not read");
  if (header.flags & 2) set.notices.push_back("extensions of makers are not read");
  resize_splats(set, header.splats);
  const std::array<size_t, 6> sizes = header.sizes();
  const size_t all = size_t(splat_harmonics[set.degree]);
  for (size_t i = 0; i < set.size(); i++) {
    const auto at = [&](size_t column) {
      return reinterpret_cast<const uint8_t*>(columns[column] + i * sizes[column]);
    };
    set.place[i] = unpack_place(header, columns[0] + i * sizes[0]);
    set.opacity[i] = float(*at(1)) / 255;
    const uint8_t *color = at(2), *scale = at(3), *harmonics = at(5);
    // Colours have room beyond 0 to 1: their scale is 0.15, not that of the constant harmonic.
    set.color[i] = color_of_harmonic((vec3(color[0], color[1], color[2]) / 255.0f - 0.5f) / 0.15f);
    set.scale[i] = glm::exp(vec3(scale[0], scale[1], scale[2]) / 16.0f - 10.0f);
    set.turn[i] = header.version < 3
                      ? unpack_first_three(at(4))
                      : unpack_smallest_three(number_at<uint32_t>(columns[4] + i * sizes[4]));
    for (size_t h = 0; h < all; h++, harmonics += 3)
      set.harmonics[i * all + h] =
          (vec3(harmonics[0], harmonics[1], harmonics[2]) - 128.0f) / 128.0f;
  }
  return set;
}

}  // namespace

bool is_spz(std::string_view bytes) {
  return is_gzip(bytes) ? unpack_gzip(bytes, 4) == "NGSP" : bytes.starts_with("NGSP");
}

SplatSet read_spz(const std::string& file, const std::string& where, std::string_view bytes) {
  const auto fail = [&](const std::string& what) { throw LoadError(file, where, what); };
  std::string unpacked;
  const std::string_view packed = bytes;
  if (is_gzip(packed)) bytes = unpacked = unpack_gzip(packed, old_header);
  if (bytes.size() < old_header || number_at<uint32_t>(bytes.data()) != magic)
    fail("does not begin as SPZ does");
  Header header;
  header.version = number_at<uint32_t>(bytes.data() + 4);
  header.splats = number_at<uint32_t>(bytes.data() + 8);
  header.degree = uint8_t(bytes[12]), header.fraction_bits = uint8_t(bytes[13]);
  header.flags = uint8_t(bytes[14]);
  if (header.version < 1 || header.version > 4)
    fail(fmt::format("has version {}, which is not read", header.version));
  if (header.degree > 4) fail(fmt::format("has harmonics of degree {}", header.degree));
  if (header.fraction_bits > 24) fail(fmt::format("has {} bits of fraction", header.fraction_bits));
  const std::array<size_t, 6> sizes = header.sizes();
  std::array<const char*, 6> columns{};
  std::array<std::string, 6> streams;
  if (header.version < 4) {
    uint64_t size = old_header;
    for (const size_t one : sizes) size += uint64_t(one) * header.splats;
    if (is_gzip(packed)) bytes = unpacked = unpack_gzip(packed, size);
    if (bytes.size() < size)
      fail(fmt::format("is cut off or damaged: it has {} bytes unpacked, not {}", bytes.size(),
                       size));
    const char* from = bytes.data() + old_header;
    for (size_t i = 0; i < 6; from += sizes[i] * header.splats, i++) columns[i] = from;
    return unpack(header, columns);
  }
  if (bytes.size() < new_header) fail("is cut off");
  const size_t count = uint8_t(bytes[15]);
  const uint64_t table = number_at<uint32_t>(bytes.data() + 16);
  if (table < new_header || table > bytes.size() || count * 16 > bytes.size() - table)
    fail("its table of streams lies beyond its end");
  size_t wanted = 0;
  for (const size_t size : sizes) wanted += size * header.splats > 0;
  if (count != wanted) fail(fmt::format("has {} streams, not {}", count, wanted));
  uint64_t at = table + count * 16;
  for (size_t i = 0, k = 0; i < 6; i++) {
    const uint64_t size = uint64_t(sizes[i]) * header.splats;
    if (size == 0) continue;
    const char* row = bytes.data() + table + 16 * k++;
    const uint64_t length = number_at<uint64_t>(row);
    if (length > bytes.size() - at || number_at<uint64_t>(row + 8) != size)
      fail(fmt::format("stream {} is cut off, or not of {} bytes", i, size));
    streams[i] = unpack_zstd(bytes.substr(at, length), size);
    if (streams[i].size() != size)
      fail(fmt::format("stream {} is damaged: it has {} bytes unpacked, not {}", i,
                       streams[i].size(), size));
    columns[i] = streams[i].data();
    at += length;
  }
  return unpack(header, columns);
}

}  // namespace wellspring::scan
