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

using ShortLanes = int16_t __attribute__((vector_size(32)));
using LongLanes = uint64_t __attribute__((vector_size(32)));
using ByteLanes = uint8_t __attribute__((vector_size(32)));

// Finds a block's codevectors, as indices into the tables.
struct BlockEntries {
  size_t entry[most_code_levels];
  int levels;
};

class EntryReader {
 public:
  explicit EntryReader(const CompressedVolume& volume)
      : codes_(volume.codes),
        levels_(volume.levels),
        bits_(index_bits(volume.codevectors)),
        mask_((uint64_t(1) << bits_) - 1) {}
  void read(BlockEntries& entries, size_t block) const {
    const uint64_t at = block * uint64_t(levels_ * bits_);
    uint64_t code;
    std::memcpy(&code, codes_ + at / 8, sizeof code);
    code >>= at & 7;
    entries.levels = levels_;
    for (int level = 0; level < levels_; level++, code >>= bits_)
      entries.entry[level] = (size_t(level) << bits_) + size_t(code & mask_);
  }

 private:
  const std::byte* codes_;
  int levels_, bits_;
  uint64_t mask_;
};

// Cuts sixteen numbers, which count from -rgb_below, to 0 to 255.
inline ShortLanes cut_shorts(ShortLanes numbers) {
  constexpr int16_t least = rgb_below, most = rgb_below + 255;
  numbers = numbers > least ? numbers : ShortLanes{} + least;
  numbers = numbers < most ? numbers : ShortLanes{} + most;
  return numbers - least;
}

inline ShortLanes red_green_of(LaneBits sums) {
  return cut_shorts(lanes_as<ShortLanes>((sums >> 12 & 0x1ffu) | (sums >> 7 & 0x01ff0000u)));
}

// Turns sixteen sums into four rows of four colours, each in the first 12 bytes of a half.
inline void rows_of_colors(ByteLanes (&rows)[2], LaneBits first, LaneBits second) {
  // Bytes of a lane: green and red, of the first and the second in turns; blue of either.
  const ByteLanes red_green = lanes_as<ByteLanes>(red_green_of(first) | red_green_of(second) << 8);
  const ByteLanes blue = lanes_as<ByteLanes>(
      cut_shorts(lanes_as<ShortLanes>((first >> 1 & 0x1ffu) | (second << 15 & 0x01ff0000u))));
  rows[0] = __builtin_shufflevector(red_green, blue, 2, 0, 32, 6, 4, 36, 10, 8, 40, 14, 12, 44, 33,
                                    33, 33, 33, 18, 16, 48, 22, 20, 52, 26, 24, 56, 30, 28, 60, 49,
                                    49, 49, 49);
  rows[1] = __builtin_shufflevector(red_green, blue, 3, 1, 34, 7, 5, 38, 11, 9, 42, 15, 13, 46, 33,
                                    33, 33, 33, 19, 17, 50, 23, 21, 54, 27, 25, 58, 31, 29, 62, 49,
                                    49, 49, 49);
}

// Writes a block of colours of 1:1. `line` and `slice` lead to the next y and z, in samples.
template <int known_levels>
inline void write_colors(uint8_t* to, const CompressedVolume& volume, const BlockEntries& entries,
                         size_t line, size_t slice) {
  const uint32_t* from[most_code_levels];
  const int levels = known_levels > 0 ? known_levels : entries.levels;
  for (int level = 0; level < levels; level++)
    from[level] = volume.words.data() + entries.entry[level] * block_voxels;
  const auto sum = [&](int i) {
    LaneBits sums = load_lanes<LaneBits>(from[0] + i);
    for (int level = 1; level < levels; level++) sums += load_lanes<LaneBits>(from[level] + i);
    return sums;
  };
  for (int z = 0; z < block_side; z++, to += slice) {
    ByteLanes rows[2];
    rows_of_colors(rows, sum(16 * z), sum(16 * z + lane_count));
#pragma GCC unroll 4
    for (int y = 0; y < block_side; y++) {
      const LongLanes pair = lanes_as<LongLanes>(rows[y / 2]);
      store_lanes(to + size_t(y) * line, uint64_t(pair[y % 2 * 2]));
      store_lanes(to + size_t(y) * line + 8, uint32_t(pair[y % 2 * 2 + 1]));
    }
  }
}

// Asks for the codevectors of colours that are needed next.
inline void prefetch(const CompressedVolume& volume, const BlockEntries& entries) {
  for (int level = 0; level < entries.levels; level++) {
    const uint32_t* from = volume.words.data() + entries.entry[level] * block_voxels;
    for (int i = 0; i < block_voxels; i += 16) __builtin_prefetch(from + i);
  }
}

// Writes blocks of colours of 1:1 that are neighbours along x.
template <int known_levels>
void write_color_run(uint8_t* to, const CompressedVolume& volume, const EntryReader& reader,
                     size_t block, int count, size_t line, size_t slice) {
  BlockEntries entries, next;
  reader.read(next, block);
  for (; count > 0; count--, to += 3 * block_side) {
    entries = next;
    if (count > 1) {
      reader.read(next, ++block);
      prefetch(volume, next);
    }
    write_colors<known_levels>(to, volume, entries, line, slice);
  }
}

// Rounds and cuts colours, a byte each: red in the lowest.
inline LaneBits bytes_of_colors(Lanes red, Lanes green, Lanes blue) {
  const auto cut = [](Lanes x) {
    return to_whole(lanes_min(lanes_max(x, Lanes{}), all_lanes(255)) + 0.5f);
  };
  return cut(red) | cut(green) << 8 | cut(blue) << 16;
}

// The same at 2:1.
inline void write_half_colors(uint8_t* to, const CompressedVolume& volume,
                              const BlockEntries& entries, size_t line, size_t slice) {
  Lanes red{}, green{}, blue{};
  for (int level = 0; level < entries.levels; level++) {
    const float* from = &volume.halves[24 * entries.entry[level]];
    red += load_lanes(from), green += load_lanes(from + 8), blue += load_lanes(from + 16);
  }
  const ByteLanes bytes = lanes_as<ByteLanes>(bytes_of_colors(red, green, blue));
  const ByteLanes rows =
      __builtin_shufflevector(bytes, bytes, 0, 1, 2, 4, 5, 6, 3, 3, 8, 9, 10, 12, 13, 14, 3, 3, 16,
                              17, 18, 20, 21, 22, 19, 19, 24, 25, 26, 28, 29, 30, 19, 19);
  const uint8_t* from = reinterpret_cast<const uint8_t*>(&rows);
  std::memcpy(to, from, 6);
  std::memcpy(to + line, from + 8, 6);
  std::memcpy(to + slice, from + 16, 6);
  std::memcpy(to + slice + line, from + 24, 6);
}

// The same at 4:1.
inline void write_quarter_color(uint8_t* to, const CompressedVolume& volume,
                                const BlockEntries& entries) {
  HalfLanes sums{};
  for (int level = 0; level < entries.levels; level++)
    sums += load_lanes<HalfLanes>(&volume.quarters[4 * entries.entry[level]]);
  constexpr HalfLanes none{}, most{255, 255, 255, 255};
  sums = sums > none ? sums : none;
  sums = sums < most ? sums : most;
  for (int channel = 0; channel < 3; channel++) to[channel] = uint8_t(int(sums[channel] + 0.5f));
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
void write_block(Sample* to, const CompressedVolume& volume, const BlockEntries& entries,
                 int detail, size_t line, size_t slice) {
  if constexpr (std::is_same_v<Sample, uint8_t>)
    if (volume.channels == 3) {
      if (detail == 2) write_quarter_color(to, volume, entries);
      else if (detail == 1) write_half_colors(to, volume, entries, line, slice);
      else if (entries.levels == 4) write_colors<4>(to, volume, entries, line, slice);
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
  const EntryReader reader(volume);
  const size_t row = size_t(side) * channels;
  Sample whole[3 * block_voxels];
  for (int z = first_block.z; z < end_block.z; z++)
    for (int y = first_block.y; y < end_block.y; y++) {
      const size_t first = (size_t(z) * size_t(blocks.y) + size_t(y)) * size_t(blocks.x);
      glm::ivec3 begin = glm::max(glm::ivec3(0, y, z) * side, inside.first);
      glm::ivec3 end = glm::min(glm::ivec3(0, y + 1, z + 1) * side, last);
      const bool whole_rows = end.y - begin.y == side && end.z - begin.z == side;
      Sample* to = samples.data() + size_t(begin.z - box.first.z) * slice +
                   size_t(begin.y - box.first.y) * line +
                   size_t(inside.first.x - box.first.x) * channels;
      for (int x = first_block.x; x < end_block.x; x++) {
        const size_t block = first + size_t(x);
        if constexpr (std::is_same_v<Sample, uint8_t>) {
          const int run = last.x / side - x;
          if (channels == 3 && detail == 0 && whole_rows && run > 0 && x * side >= inside.first.x) {
            const auto write = volume.levels == 4 ? write_color_run<4> : write_color_run<0>;
            write(to, volume, reader, block, run, line, slice);
            to += size_t(run) * row, x += run - 1;
            continue;
          }
        }
        BlockEntries entries;
        reader.read(entries, block);
        begin.x = std::max(x * side, inside.first.x), end.x = std::min((x + 1) * side, last.x);
        const size_t wide = size_t(end.x - begin.x) * channels;
        if (whole_rows && wide == row) {
          write_block(to, volume, entries, detail, line, slice);
        } else {
          write_block(whole, volume, entries, detail, row, row * size_t(side));
          const glm::ivec3 skipped = begin - glm::ivec3(x, y, z) * side;
          for (int k = 0; k < end.z - begin.z; k++)
            for (int j = 0; j < end.y - begin.y; j++)
              std::copy_n(whole + size_t((skipped.z + k) * side + skipped.y + j) * row +
                              size_t(skipped.x) * channels,
                          wide, to + size_t(k) * slice + size_t(j) * line);
        }
        to += wide;
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
