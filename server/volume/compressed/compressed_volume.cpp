// SPDX-License-Identifier: Apache-2.0
#include "volume/compressed/compressed_volume.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fmt/format.h>

#include "base/load_error.h"
#include "volume/compressed/rgb_word.h"

namespace wellspring::volume {

static_assert(std::endian::native == std::endian::little);

namespace {

constexpr char file_magic[] = "WSRVQ\r\n\x1a";
constexpr int most_side = 1 << 20;
constexpr uint64_t most_voxels = uint64_t(1) << 42;

template <class T>
T take(const std::byte*& from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  from += sizeof value;
  return value;
}

template <class T>
void put(std::byte*& to, T value) {
  std::memcpy(to, &value, sizeof value);
  to += sizeof value;
}

uint64_t product(glm::ivec3 v) { return uint64_t(v.x) * uint64_t(v.y) * uint64_t(v.z); }

uint64_t codevector_bytes(const CompressedVolume& volume) {
  return block_voxels * (volume.channels == 3 ? 4 : 2);
}

void read_header(CompressedVolume& volume, const std::byte* from, const std::string& name) {
  const auto check = [&](bool good, const std::string& what) {
    if (!good) throw LoadError(name, "header", what);
  };
  check(std::memcmp(from, file_magic, 8) == 0, "this is no compressed volume");
  from += 8;
  const auto version = take<uint32_t>(from);
  check(version == 1, fmt::format("version {} is unknown, this program reads 1", version));
  const auto channels = take<uint32_t>(from), kind = take<uint32_t>(from);
  check(channels == 1 || channels == 3, fmt::format("{} channels, not 1 or 3", channels));
  check(kind <= 2 && (kind == 0 || channels == 1), fmt::format("kind {} of samples", kind));
  volume.channels = int(channels);
  volume.kind = kind == 0 ? SampleKind::u8 : kind == 1 ? SampleKind::u16 : SampleKind::i16;
  for (int i = 0; i < 3; i++) volume.size[i] = take<int32_t>(from);
  for (int i = 0; i < 3; i++)
    check(volume.size[i] >= 1 && volume.size[i] <= most_side,
          fmt::format("a side of {} voxels", volume.size[i]));
  check(product(volume.size) <= most_voxels, "too many voxels");
  const auto levels = take<uint32_t>(from), codevectors = take<uint32_t>(from);
  check(levels >= 1 && levels <= most_code_levels, fmt::format("{} levels", levels));
  check(codevectors >= 1 && codevectors <= most_codevectors,
        fmt::format("{} codevectors a level", codevectors));
  volume.levels = int(levels), volume.codevectors = int(codevectors);
  check(volume.levels * index_bits(volume.codevectors) <= most_code_bits, "codes are too long");
  volume.slope = take<double>(from), volume.intercept = take<double>(from);
  check(std::isfinite(volume.slope) && std::isfinite(volume.intercept),
        "slope or intercept is not finite");
  for (int i = 0; i < 16; i++) volume.to_metres[i / 4][i % 4] = take<double>(from);
  const double determinant = glm::determinant(volume.to_metres);
  check(std::isfinite(determinant) && determinant != 0, "to_metres is singular");
  for (int level = 0; level < most_code_levels; level++) {
    const int fraction = take<int32_t>(from), offset = take<int32_t>(from);
    check(std::abs(double(fraction)) <= 16 && std::abs(double(offset)) < 1 << 24,
          fmt::format("level {} has fraction {} and offset {}", level, fraction, offset));
    volume.fraction[size_t(level)] = fraction, volume.offset[size_t(level)] = offset;
  }
}

// Adds a block's codevector at 2:1 and 4:1: the means of its voxels, `value(voxel, channel)`.
template <class Value>
void add_means(CompressedVolume& volume, size_t entry, const Value& value) {
  const int channels = volume.channels, apart = channels == 3 ? 4 : 1;
  float* half = &volume.halves[entry * size_t(8 * channels)];
  float* quarter = &volume.quarters[entry * size_t(apart)];
  for (int channel = 0; channel < channels; channel++) {
    double sums[8] = {}, all = 0;
    for (int voxel = 0; voxel < block_voxels; voxel++) {
      const int x = voxel & 3, y = voxel >> 2 & 3, z = voxel >> 4;
      sums[x / 2 + y / 2 * 2 + z / 2 * 4] += double(value(voxel, channel));
    }
    for (int i = 0; i < 8; i++) half[8 * channel + i] = float(sums[i] / 8), all += sums[i];
    quarter[channel] = float(all / block_voxels);
  }
}

void make_tables(CompressedVolume& volume, const std::byte* codebooks) {
  const size_t entries = size_t(volume.entries()), all = entries * size_t(volume.levels);
  const bool colored = volume.channels == 3;
  (colored ? volume.words.resize(all * block_voxels) : volume.values.resize(all * block_voxels));
  volume.halves.resize(all * 8 * size_t(volume.channels));
  volume.quarters.resize(all * (colored ? 4 : 1));
  const std::byte* from = codebooks;
  for (size_t level = 0; level < size_t(volume.levels); level++) {
    const float step = std::ldexp(1.f, -volume.fraction[level]);
    for (size_t entry = level * entries; entry < level * entries + entries; entry++) {
      const bool given = entry - level * entries < size_t(volume.codevectors);
      if (colored) {
        uint32_t* words = &volume.words[entry * block_voxels];
        if (given) std::memcpy(words, from, block_voxels * 4);
        add_means(volume, entry,
                  [&](int voxel, int channel) { return from_rgb_word(words[voxel])[channel]; });
        if (level == 0)
          for (int i = 0; i < block_voxels; i++) words[i] += rgb_bias;
      } else {
        float* values = &volume.values[entry * block_voxels];
        for (int i = 0; given && i < block_voxels; i++) {
          int16_t stored;
          std::memcpy(&stored, from + 2 * i, sizeof stored);
          values[i] = float(stored + volume.offset[level]) * step;
        }
        add_means(volume, entry, [&](int voxel, int) { return values[voxel]; });
      }
      if (given) from += codevector_bytes(volume);
    }
  }
}

}  // namespace

int index_bits(int codevectors) { return std::bit_width(unsigned(codevectors) - 1); }

glm::ivec3 blocks_of(glm::ivec3 size) { return (size + (block_side - 1)) / block_side; }

glm::ivec3 bricks_of(glm::ivec3 size) { return (size + (brick_side - 1)) / brick_side; }

uint64_t code_bytes(glm::ivec3 size, int levels, int codevectors) {
  return (product(blocks_of(size)) * uint64_t(levels * index_bits(codevectors)) + 7) / 8;
}

uint64_t CompressedVolume::code(size_t block) const {
  const int bits = levels * index_bits(codevectors);
  const uint64_t at = block * uint64_t(bits);
  uint64_t word;  // codebooks follow the codes, so that there are eight bytes
  std::memcpy(&word, codes + at / 8, sizeof word);
  return word >> (at & 7) & ((uint64_t(1) << bits) - 1);
}

glm::ivec3 size_at(const CompressedVolume& volume, int detail) {
  const int step = 1 << detail;
  return (volume.size + (step - 1)) / step;
}

CompressedLayout layout_of(const CompressedVolume& volume) {
  CompressedLayout layout;
  layout.codes = compressed_header_bytes;
  layout.codebooks = layout.codes + code_bytes(volume.size, volume.levels, volume.codevectors);
  layout.ranges = layout.codebooks +
                  uint64_t(volume.levels) * uint64_t(volume.codevectors) * codevector_bytes(volume);
  layout.end = layout.ranges + product(bricks_of(volume.size)) * 2 * uint64_t(volume.channels) *
                                   uint64_t(bytes_of(volume.kind));
  return layout;
}

void write_header(std::byte* to, const CompressedVolume& volume) {
  std::memcpy(to, file_magic, 8);
  to += 8;
  put(to, uint32_t(1));
  put(to, uint32_t(volume.channels));
  put(to, uint32_t(volume.kind == SampleKind::u8 ? 0 : volume.kind == SampleKind::u16 ? 1 : 2));
  for (int i = 0; i < 3; i++) put(to, int32_t(volume.size[i]));
  put(to, uint32_t(volume.levels));
  put(to, uint32_t(volume.codevectors));
  put(to, volume.slope);
  put(to, volume.intercept);
  for (int i = 0; i < 16; i++) put(to, volume.to_metres[i / 4][i % 4]);
  for (size_t level = 0; level < most_code_levels; level++) {
    put(to, int32_t(volume.fraction[level]));
    put(to, int32_t(volume.offset[level]));
  }
}

CompressedVolume open_compressed(std::shared_ptr<const std::byte> bytes, uint64_t count,
                                 const std::string& name) {
  if (count < compressed_header_bytes)
    throw LoadError(name, "header", fmt::format("{} bytes are no compressed volume", count));
  CompressedVolume volume;
  read_header(volume, bytes.get(), name);
  const CompressedLayout layout = layout_of(volume);
  if (layout.end != count)
    throw LoadError(name, "",
                    fmt::format("has {} bytes, its header leads to {}", count, layout.end));
  volume.codes = bytes.get() + layout.codes;
  volume.ranges = bytes.get() + layout.ranges;
  make_tables(volume, bytes.get() + layout.codebooks);
  volume.file = std::move(bytes), volume.file_bytes = count;
  return volume;
}

SampleRange brick_range(const CompressedVolume& volume, glm::ivec3 brick) {
  const glm::ivec3 bricks = bricks_of(volume.size);
  const int channels = volume.channels, step = bytes_of(volume.kind);
  const size_t index =
      (size_t(brick.z) * size_t(bricks.y) + size_t(brick.y)) * size_t(bricks.x) + size_t(brick.x);
  const std::byte* from = volume.ranges + index * size_t(2 * channels * step);
  const auto read = [&](int i) {
    const std::byte* at = from + i * step;
    if (volume.kind == SampleKind::u8) return int(take<uint8_t>(at));
    return volume.kind == SampleKind::u16 ? int(take<uint16_t>(at)) : int(take<int16_t>(at));
  };
  SampleRange range;
  for (int i = 0; i < channels; i++)
    range.least[i] = read(i), range.greatest[i] = read(channels + i);
  return range;
}

}  // namespace wellspring::volume
