// SPDX-License-Identifier: Apache-2.0
#include "volume/compressed/compress.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <span>
#include <stdexcept>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/rng.h"
#include "base/worker.h"
#include "volume/compressed/block_source.h"
#include "volume/compressed/codebook.h"
#include "volume/compressed/decode.h"
#include "volume/compressed/rgb_word.h"

namespace wellspring::volume {

namespace {

using Progress = std::function<void(double)>;

constexpr int blocks_a_piece = 96;     // whole bytes of codes, whatever a code's bits
constexpr int pieces_a_turn = 16;      // between two looks whether the work is cancelled
constexpr double training_time = 0.4;  // its part of the progress

// A level's codevectors as the file has them, and what these mean.
struct StoredLevel {
  std::vector<uint32_t> words;
  std::vector<int16_t> samples;
  int fraction = 0, offset = 0;
  Codebook codebook;
};

StoredLevel store_level(const std::vector<float>& vectors, int channels) {
  StoredLevel level;
  std::vector<float> meant(vectors.size());
  if (channels == 3) {
    level.words.resize(vectors.size() / 3);
    for (size_t i = 0; i < level.words.size(); i++) {
      level.words[i] = to_rgb_word({vectors[3 * i], vectors[3 * i + 1], vectors[3 * i + 2]});
      const glm::vec3 color = from_rgb_word(level.words[i]);
      for (int channel = 0; channel < 3; channel++) meant[3 * i + size_t(channel)] = color[channel];
    }
  } else {
    // The fraction has as many bits as the range leaves, but no more than sums in floats keep.
    const auto [least, greatest] = std::ranges::minmax(vectors);
    const auto scaled = [&](float x) { return double(std::ldexp(x, level.fraction)); };
    level.fraction = 6;
    while (std::round(scaled(greatest)) - std::round(scaled(least)) > 65535) level.fraction--;
    level.offset = int(std::round(scaled(least))) + 32768;
    for (size_t i = 0; i < vectors.size(); i++) {
      level.samples.push_back(int16_t(int(std::round(scaled(vectors[i]))) - level.offset));
      meant[i] = std::ldexp(float(level.samples[i] + level.offset), -level.fraction);
    }
  }
  level.codebook = make_codebook(block_voxels * channels, std::move(meant));
  return level;
}

struct Training {
  std::vector<float> rows;
  std::vector<float> background;  // mean of the background blocks that were seen; empty: none were
};

glm::ivec3 block_at(uint64_t index, glm::ivec3 blocks) {
  const uint64_t line = index / uint64_t(blocks.x);
  return {int(index % uint64_t(blocks.x)), int(line % uint64_t(blocks.y)),
          int(line / uint64_t(blocks.y))};
}

// Finds the blocks that are no background: a bit a block.
struct Foreground {
  std::vector<uint8_t> bits;
  uint64_t count = 0;
  std::vector<float> background;  // the mean of the others, for each channel
  bool has(uint64_t block) const { return bits[block / 8] >> (block & 7) & 1; }
};

Foreground find_foreground(const BlockSource& source, uint64_t blocks,
                           const CompressionSettings& settings) {
  const glm::ivec3 extent = blocks_of(source.volume.size);
  constexpr uint64_t piece = 8 * 1024;
  const int pieces = int((blocks + piece - 1) / piece), channels = source.volume.channels;
  Foreground all;
  all.bits.resize((blocks + 7) / 8);
  struct Sum {
    uint64_t foreground = 0, background = 0;
    double color[3] = {};
  };
  std::vector<Sum> sums(static_cast<size_t>(pieces));
  for (int first = 0; first < pieces; first += pieces_a_turn) {
    check_cancelled();
    parallel_each(std::min(pieces_a_turn, pieces - first), [&](int i) {
      const uint64_t begin = uint64_t(first + i) * piece;
      Sum& sum = sums[size_t(first + i)];
      alignas(32) float block[3 * block_voxels];
      for (uint64_t index = begin; index < std::min(begin + piece, blocks); index++) {
        read_block(block, source, block_at(index, extent));
        if (is_background(source, block, settings.background)) {
          sum.background++;
          for (int k = 0; k < source.dimensions(); k++) sum.color[k % channels] += double(block[k]);
        } else {
          sum.foreground++;
          all.bits[index / 8] |= uint8_t(1 << (index & 7));
        }
      }
    });
  }
  Sum total;
  for (const Sum& sum : sums) {
    total.foreground += sum.foreground, total.background += sum.background;
    for (int k = 0; k < 3; k++) total.color[k] += sum.color[k];
  }
  all.count = total.foreground;
  if (total.background > 0)
    for (int k = 0; k < source.dimensions(); k++)
      all.background.push_back(
          float(total.color[k % channels] / (double(total.background) * block_voxels)));
  return all;
}

// Returns the blocks to train on, of those in the foreground, as rows.
std::vector<float> choose_rows(const BlockSource& source, const Foreground& foreground,
                               uint64_t blocks, const CompressionSettings& settings) {
  const uint64_t wanted =
      std::min<uint64_t>(std::max<uint64_t>(uint64_t(settings.training_share * double(blocks)),
                                            uint64_t(settings.least_training_blocks)),
                         uint64_t(settings.most_training_blocks));
  const double part = foreground.count == 0 ? 1 : 1.05 * double(wanted) / double(foreground.count);
  const uint64_t most = part >= 1 ? ~uint64_t(0) : uint64_t(std::ldexp(part, 64));
  std::vector<std::pair<uint64_t, uint64_t>> chosen;  // hash, block
  for (uint64_t index = 0; index < blocks; index++) {
    const uint64_t hash = mix64(mix64(~settings.seed) ^ index);
    if (hash <= most && foreground.has(index)) chosen.emplace_back(hash, index);
  }
  if (chosen.size() > wanted) {
    std::ranges::nth_element(chosen, chosen.begin() + ptrdiff_t(wanted));
    chosen.resize(wanted);
  }
  std::ranges::sort(chosen, {}, &std::pair<uint64_t, uint64_t>::second);
  const size_t width = size_t(source.dimensions());
  std::vector<float> rows(chosen.size() * width);
  const glm::ivec3 extent = blocks_of(source.volume.size);
  parallel_ranges(int(chosen.size()), 64, [&](int begin, int end) {
    for (size_t i = size_t(begin); i < size_t(end); i++)
      read_block(&rows[i * width], source, block_at(chosen[i].second, extent));
  });
  return rows;
}

// Quantises rows by one level: `row` becomes what is left, the indices are returned. From level 1
// on codevector 0 is zero, and is taken unless another one lessens the error.
void quantise(float* rows, std::span<int> indices, const StoredLevel& level, bool may_keep) {
  const int dimensions = level.codebook.dimensions;
  find_nearest(indices, level.codebook, rows);
  for (int& index : indices) {
    const float* vector = &level.codebook.vectors[size_t(index) * size_t(dimensions)];
    if (may_keep) {
      const std::vector<float>& all = level.codebook.vectors;  // codevector 0 is zero
      if (squared_distance(rows, vector, dimensions) >=
          squared_distance(rows, all.data(), dimensions))
        index = 0, vector = all.data();
    }
    for (int d = 0; d < dimensions; d++) rows[d] -= vector[d];
    rows += dimensions;
  }
}

std::vector<StoredLevel> train(std::vector<float> rows, const std::vector<float>& background,
                               const BlockSource& source, const CompressionSettings& settings,
                               const Progress& progress) {
  const int dimensions = source.dimensions();
  const int count = int(rows.size() / size_t(dimensions));
  std::vector<StoredLevel> levels;
  TrainingSettings training;
  training.codevectors = settings.codevectors;
  training.most_rounds = settings.most_rounds;
  training.first = background;
  for (int level = 0; level < settings.levels; level++) {
    training.seed = mix64(settings.seed + uint64_t(level));
    std::vector<float> vectors = train_codebook(rows, dimensions, training, [&](double part) {
      if (progress) progress(training_time * (level + part) / settings.levels);
    });
    // All levels have as many as the first.
    if (level == 0) training.codevectors = int(vectors.size() / size_t(dimensions));
    vectors.resize(size_t(training.codevectors) * size_t(dimensions), 0);
    levels.push_back(store_level(vectors, source.volume.channels));
    training.first.assign(size_t(dimensions), 0);
    constexpr int piece = blocks_a_piece;
    parallel_each((count + piece - 1) / piece, [&](int i) {
      int indices[piece];
      const int first = i * piece, some = std::min(piece, count - first);
      quantise(&rows[size_t(first) * size_t(dimensions)], std::span(indices, size_t(some)),
               levels.back(), level > 0);
    });
  }
  return levels;
}

// Returns whether sums of colours lie where words can tell them (see rgb_word.h).
bool can_be_told(const float* block, const float* left, int dimensions) {
  for (int d = 0; d < dimensions; d++) {
    const float sum = block[d] - left[d];
    if (sum < float(1 - rgb_below) || sum > 380.f - float(rgb_below)) return false;
  }
  return true;
}

void encode_piece(std::byte* codes, const BlockSource& source, const Foreground& foreground,
                  const std::vector<StoredLevel>& levels, uint64_t first, int count) {
  const int dimensions = source.dimensions();
  const size_t width = size_t(dimensions);
  const glm::ivec3 extent = blocks_of(source.volume.size);
  std::vector<float> rows;
  rows.reserve(size_t(count) * width);
  std::vector<int> places;
  for (int i = 0; i < count; i++) {
    const uint64_t index = first + uint64_t(i);
    if (!foreground.has(index)) continue;
    rows.resize(rows.size() + width);
    read_block(rows.data() + rows.size() - width, source, block_at(index, extent));
    places.push_back(i);
  }
  const std::vector<float> blocks = rows;
  const int bits = index_bits(levels[0].codebook.count);
  uint64_t words[blocks_a_piece] = {};
  std::vector<int> indices(places.size());
  for (size_t level = 0; level < levels.size(); level++) {
    quantise(rows.data(), indices, levels[level], level > 0);
    for (size_t i = 0; i < places.size(); i++)
      words[places[i]] |= uint64_t(indices[i]) << (level * size_t(bits));
  }
  if (source.volume.channels == 3)
    for (size_t i = 0; i < places.size(); i++)
      if (!can_be_told(&blocks[i * width], &rows[i * width], dimensions))
        words[places[i]] &= (uint64_t(1) << bits) - 1;  // level 0 alone lies within 0 to 255
  const int code_bits = bits * int(levels.size());
  uint64_t held = 0;  // bits that fill no byte yet
  int holds = 0;
  for (int i = 0; i < count; i++) {
    held |= words[i] << holds;
    for (holds += code_bits; holds >= 8; holds -= 8, held >>= 8) *codes++ = std::byte(held);
  }
  if (holds > 0) *codes = std::byte(held);
}

template <class Sample>
void write_ranges(std::byte* ranges, const CompressedVolume& volume, const Progress& progress) {
  const glm::ivec3 bricks = bricks_of(volume.size);
  const int channels = volume.channels;
  for (int z = 0; z < bricks.z; z++) {
    check_cancelled();
    parallel_each(bricks.y * bricks.x, [&](int i) {
      const glm::ivec3 brick(i % bricks.x, i / bricks.x, z);
      const glm::ivec3 begin = glm::max(brick * brick_side - block_side, glm::ivec3(0));
      const glm::ivec3 end = glm::min((brick + 1) * brick_side + block_side, volume.size);
      const Box box{begin, end - begin};
      RawVector<Sample> samples(size_t(box.size.x) * size_t(box.size.y) * size_t(box.size.z) *
                                size_t(channels));
      decode(std::span<Sample>(samples), volume, 0, box);
      Sample range[6];
      for (int channel = 0; channel < channels; channel++) {
        Sample least = samples[size_t(channel)], greatest = least;
        for (size_t k = size_t(channel); k < samples.size(); k += size_t(channels))
          least = std::min(least, samples[k]), greatest = std::max(greatest, samples[k]);
        range[channel] = least, range[channels + channel] = greatest;
      }
      const size_t bytes = 2 * size_t(channels) * sizeof(Sample);
      const size_t at = size_t(z) * size_t(bricks.y) * size_t(bricks.x) + size_t(i);
      std::memcpy(ranges + at * bytes, range, bytes);
    });
    if (progress) progress(0.98 + 0.02 * (z + 1) / bricks.z);
  }
}

void check_settings(const CompressionSettings& settings) {
  const auto check = [](bool good, const char* what) {
    if (!good) throw std::invalid_argument(what);
  };
  check(settings.levels >= 1 && settings.levels <= most_code_levels, "1 to 8 levels are possible");
  check(settings.codevectors >= 1 && settings.codevectors <= most_codevectors,
        "1 to 65536 codevectors are possible");
  check(settings.levels * index_bits(settings.codevectors) <= most_code_bits,
        "codes of more than 56 bits are impossible");
  check(settings.training_share >= 0 && settings.training_share <= 1 &&
            settings.least_training_blocks >= 1 &&
            settings.most_training_blocks >= settings.least_training_blocks &&
            settings.most_rounds >= 0,
        "these settings of the training are out of range");
}

}  // namespace

CompressedVolume compress_volume(const Volume& given, const CompressionSettings& settings,
                                 const Progress& progress) {
  check_settings(settings);
  const BlockSource source = make_block_source(given);
  CompressedVolume volume;
  volume.size = given.size, volume.channels = given.channels, volume.kind = source.kind;
  volume.slope = source.slope, volume.intercept = source.intercept;
  volume.to_metres = given.to_metres;
  volume.levels = settings.levels;
  const glm::ivec3 extent = volume.blocks();
  const uint64_t blocks = uint64_t(extent.x) * uint64_t(extent.y) * uint64_t(extent.z);
  const Foreground foreground = find_foreground(source, blocks, settings);
  const std::vector<StoredLevel> levels = train(choose_rows(source, foreground, blocks, settings),
                                                foreground.background, source, settings, progress);
  volume.codevectors = levels[0].codebook.count;
  for (size_t level = 0; level < levels.size(); level++)
    volume.fraction[level] = levels[level].fraction, volume.offset[level] = levels[level].offset;

  const CompressedLayout layout = layout_of(volume);
  const std::shared_ptr<std::byte[]> file(new std::byte[layout.end]);
  write_header(file.get(), volume);
  std::byte* to = file.get() + layout.codebooks;
  for (const StoredLevel& level : levels) {
    to = std::ranges::copy(std::as_bytes(std::span(level.words)), to).out;
    to = std::ranges::copy(std::as_bytes(std::span(level.samples)), to).out;
  }
  const uint64_t code_bits = uint64_t(volume.levels * index_bits(volume.codevectors));
  const int pieces = int((blocks + blocks_a_piece - 1) / blocks_a_piece);
  for (int first = 0; first < pieces; first += pieces_a_turn) {
    check_cancelled();
    parallel_each(std::min(pieces_a_turn, pieces - first), [&](int i) {
      const uint64_t begin = uint64_t(first + i) * blocks_a_piece;
      encode_piece(file.get() + layout.codes + begin * code_bits / 8, source, foreground, levels,
                   begin, int(std::min<uint64_t>(blocks_a_piece, blocks - begin)));
    });
    if (progress)
      progress(training_time +
               (0.98 - training_time) * std::min(first + pieces_a_turn, pieces) / pieces);
  }
  const std::shared_ptr<const std::byte> bytes(file, file.get());
  volume = open_compressed(bytes, layout.end, "compressed volume");
  std::byte* ranges = file.get() + layout.ranges;
  switch (volume.kind) {
    case SampleKind::u8: write_ranges<uint8_t>(ranges, volume, progress); break;
    case SampleKind::u16: write_ranges<uint16_t>(ranges, volume, progress); break;
    default: write_ranges<int16_t>(ranges, volume, progress);
  }
  return volume;
}

}  // namespace wellspring::volume
