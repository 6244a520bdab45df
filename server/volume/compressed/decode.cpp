// SPDX-License-Identifier: Apache-2.0
#include "volume/compressed/decode.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <type_traits>

#include "base/simd.h"
#include "volume/compressed/rgb_word.h"

namespace wellspring::volume {

namespace {

using ShortLanes = uint16_t __attribute__((vector_size(32)));
using ByteLanes = uint8_t __attribute__((vector_size(32)));

// A block's codevectors, as indices into the tables.
struct BlockEntries {
  size_t entry[most_code_levels];
  int levels;
};

inline BlockEntries entries_of(const CompressedVolume& volume, size_t block) {
  BlockEntries found;
  found.levels = volume.levels;
  uint64_t code = volume.code(block);
  const int bits = index_bits(volume.codevectors);
  const uint64_t mask = (uint64_t(1) << bits) - 1;
  for (int level = 0; level < volume.levels; level++, code >>= bits)
    found.entry[level] = (size_t(level) << bits) + size_t(code & mask);
  return found;
}

// Cuts sixteen sums, which count from -rgb_below, to 0 to 255.
inline ShortLanes cut_shorts(ShortLanes sums) {
  constexpr uint16_t least = rgb_below, most = rgb_below + 255;
  sums = sums > least ? sums : ShortLanes{} + least;
  sums = sums < most ? sums : ShortLanes{} + most;
  return sums - least;
}

// Returns two rows of four colours, each in the first 12 bytes of a half.
inline ByteLanes rows_of_colors(LaneBits sums) {
  const LaneBits red_green = (sums >> 5 & 0x07ff0000u) | (sums >> 10 & 0x7ffu);
  const ShortLanes red_green_cut = cut_shorts(lanes_as<ShortLanes>(red_green) >> 2);
  const ShortLanes blue = cut_shorts(lanes_as<ShortLanes>(sums & 1023u) >> 1);
  const ByteLanes bytes = lanes_as<ByteLanes>(red_green_cut | blue << 8);
  return __builtin_shufflevector(bytes, bytes, 2, 0, 1, 6, 4, 5, 10, 8, 9, 14, 12, 13, 3, 3, 3, 3,
                                 18, 16, 17, 22, 20, 21, 26, 24, 25, 30, 28, 29, 19, 19, 19, 19);
}

// Writes a block of colours of 1:1. `line` and `slice` lead to the next y and z, in samples.
template <int known_levels>
inline void write_colors(uint8_t* to, const CompressedVolume& volume, const BlockEntries& entries,
                         size_t line, size_t slice) {
  const uint32_t* words = volume.words.data();
  const uint32_t* from[most_code_levels];
  const int levels = known_levels > 0 ? known_levels : entries.levels;
  for (int level = 0; level < levels; level++)
    from[level] = words + entries.entry[level] * block_voxels;
  for (int i = 0; i < block_voxels; i += lane_count) {
    LaneBits sums = load_lanes<LaneBits>(from[0] + i);
    for (int level = 1; level < levels; level++) sums += load_lanes<LaneBits>(from[level] + i);
    const ByteLanes rows = rows_of_colors(sums);
    uint8_t* place = to + size_t(i / 16) * slice + size_t(i / 4 % 4) * line;
    std::memcpy(place, &rows, 12);
    std::memcpy(place + line, reinterpret_cast<const uint8_t*>(&rows) + 16, 12);
  }
}

// Writes the sums of a block: voxels x fastest, channels side by side.
void sum_block(float* to, const CompressedVolume& volume, const BlockEntries& entries, int detail) {
  const int channels = volume.channels;
  if (detail == 2) {
    const size_t apart = channels == 3 ? 4 : 1;
    float sums[4] = {};
    for (int level = 0; level < entries.levels; level++)
      for (size_t i = 0; i < apart; i++)
        sums[i] += volume.quarters[entries.entry[level] * apart + i];
    for (int channel = 0; channel < channels; channel++) to[channel] = sums[channel];
  } else if (detail == 1) {
    for (int channel = 0; channel < channels; channel++) {
      Lanes sums{};
      for (int level = 0; level < entries.levels; level++)
        sums += load_lanes(
            &volume.halves[size_t(8 * channels) * entries.entry[level] + size_t(8 * channel)]);
      for (int i = 0; i < lane_count; i++) to[i * channels + channel] = sums[i];
    }
  } else if (channels == 3) {
    for (int i = 0; i < block_voxels; i++) {
      uint32_t word = 0;
      for (int level = 0; level < entries.levels; level++)
        word += volume.words[entries.entry[level] * block_voxels + size_t(i)];
      const glm::vec3 color = from_biased_rgb(word);
      for (int channel = 0; channel < 3; channel++) *to++ = color[channel];
    }
  } else {
    for (int i = 0; i < block_voxels; i += lane_count) {
      Lanes sums{};
      for (int level = 0; level < entries.levels; level++)
        sums += load_lanes(&volume.values[entries.entry[level] * block_voxels + size_t(i)]);
      store_lanes(to + i, sums);
    }
  }
}

template <class Sample>
inline Sample to_sample(float sum, float slope, float intercept) {
  if constexpr (std::is_same_v<Sample, float>) {
    return slope * sum + intercept;
  } else {
    constexpr float least = float(std::numeric_limits<Sample>::min());
    constexpr float most = float(std::numeric_limits<Sample>::max());
    const float cut = std::min(std::max(sum, least), most) - least;
    return Sample(int(cut + 0.5f) + int(least));
  }
}

template <class Sample>
void write_block(Sample* to, const CompressedVolume& volume, size_t block, int detail, size_t line,
                 size_t slice) {
  const BlockEntries entries = entries_of(volume, block);
  if constexpr (std::is_same_v<Sample, uint8_t>)
    if (volume.channels == 3 && detail == 0) {
      if (volume.levels == 4) write_colors<4>(to, volume, entries, line, slice);
      else write_colors<0>(to, volume, entries, line, slice);
      return;
    }
  alignas(32) float sums[3 * block_voxels];
  Sample samples[3 * block_voxels];
  sum_block(sums, volume, entries, detail);
  const int side = block_side >> detail, row = side * volume.channels, count = row * side * side;
  const float slope = float(volume.slope), intercept = float(volume.intercept);
  for (int i = 0; i < count; i++) samples[i] = to_sample<Sample>(sums[i], slope, intercept);
  const Sample* from = samples;
  for (int z = 0; z < side; z++)
    for (int y = 0; y < side; y++, from += row)
      std::memcpy(to + size_t(z) * slice + size_t(y) * line, from, size_t(row) * sizeof(Sample));
}

// Repeats the outermost voxels of the part `inside`, which has been written, in the whole box.
template <class Sample>
void fill_outside(Sample* samples, Box box, Box inside, size_t channels) {
  const glm::ivec3 begin = inside.first - box.first, end = begin + inside.size;
  const size_t line = size_t(box.size.x) * channels, slice = line * size_t(box.size.y);
  for (int z = begin.z; z < end.z; z++) {
    Sample* here = samples + size_t(z) * slice;
    for (int y = begin.y; y < end.y; y++) {
      Sample* row = here + size_t(y) * line;
      for (int x = 0; x < box.size.x; x++)
        if (x < begin.x || x >= end.x)
          std::copy_n(row + size_t(x < begin.x ? begin.x : end.x - 1) * channels, channels,
                      row + size_t(x) * channels);
    }
    for (int y = 0; y < box.size.y; y++)
      if (y < begin.y || y >= end.y)
        std::copy_n(here + size_t(y < begin.y ? begin.y : end.y - 1) * line, line,
                    here + size_t(y) * line);
  }
  for (int z = 0; z < box.size.z; z++)
    if (z < begin.z || z >= end.z)
      std::copy_n(samples + size_t(z < begin.z ? begin.z : end.z - 1) * slice, slice,
                  samples + size_t(z) * slice);
}

template <class Sample>
void decode_box(std::span<Sample> samples, const CompressedVolume& volume, int detail, Box box) {
  if (detail < 0 || detail >= details) throw std::invalid_argument("details are 0, 1 and 2");
  const glm::ivec3 extent = size_at(volume, detail);
  const size_t channels = size_t(volume.channels);
  Box inside;
  inside.first = glm::max(box.first, glm::ivec3(0));
  inside.size = glm::min(box.first + box.size, extent) - inside.first;
  if (inside.size.x < 1 || inside.size.y < 1 || inside.size.z < 1)
    throw std::invalid_argument("a box to decode does not meet the volume");
  const size_t line = size_t(box.size.x) * channels, slice = line * size_t(box.size.y);
  if (samples.size() != slice * size_t(box.size.z))
    throw std::invalid_argument("a box to decode has another size than its place");

  const int side = block_side >> detail;
  const glm::ivec3 last = inside.first + inside.size, blocks = volume.blocks();
  const glm::ivec3 first_block = inside.first / side, end_block = (last + side - 1) / side;
  Sample whole[3 * block_voxels];
  for (int z = first_block.z; z < end_block.z; z++)
    for (int y = first_block.y; y < end_block.y; y++)
      for (int x = first_block.x; x < end_block.x; x++) {
        const size_t block =
            (size_t(z) * size_t(blocks.y) + size_t(y)) * size_t(blocks.x) + size_t(x);
        const glm::ivec3 origin = glm::ivec3(x, y, z) * side;
        const glm::ivec3 begin = glm::max(origin, inside.first);
        const glm::ivec3 end = glm::min(origin + side, last);
        Sample* to = samples.data() + size_t(begin.z - box.first.z) * slice +
                     size_t(begin.y - box.first.y) * line +
                     size_t(begin.x - box.first.x) * channels;
        if (end - begin == glm::ivec3(side)) {
          write_block(to, volume, block, detail, line, slice);
          continue;
        }
        const size_t row = size_t(side) * channels;
        write_block(whole, volume, block, detail, row, row * size_t(side));
        for (int k = begin.z; k < end.z; k++)
          for (int j = begin.y; j < end.y; j++) {
            const glm::ivec3 at = glm::ivec3(begin.x, j, k) - origin;
            std::copy_n(
                whole + (size_t(at.z * side + at.y) * size_t(side) + size_t(at.x)) * channels,
                size_t(end.x - begin.x) * channels,
                to + size_t(k - begin.z) * slice + size_t(j - begin.y) * line);
          }
      }
  if (inside.size != box.size) fill_outside(samples.data(), box, inside, channels);
}

void check_kind(const CompressedVolume& volume, SampleKind kind) {
  if (volume.kind != kind)
    throw std::invalid_argument("a compressed volume has samples of another kind");
}

}  // namespace

Box brick_box(glm::ivec3 brick, int detail, int skirt) {
  const int side = brick_side >> detail;
  return {brick * side - skirt, glm::ivec3(side + 2 * skirt)};
}

void decode(std::span<uint8_t> samples, const CompressedVolume& volume, int detail, Box box) {
  check_kind(volume, SampleKind::u8);
  decode_box(samples, volume, detail, box);
}

void decode(std::span<uint16_t> samples, const CompressedVolume& volume, int detail, Box box) {
  check_kind(volume, SampleKind::u16);
  decode_box(samples, volume, detail, box);
}

void decode(std::span<int16_t> samples, const CompressedVolume& volume, int detail, Box box) {
  check_kind(volume, SampleKind::i16);
  decode_box(samples, volume, detail, box);
}

void decode(std::span<float> samples, const CompressedVolume& volume, int detail, Box box) {
  decode_box(samples, volume, detail, box);
}

}  // namespace wellspring::volume
