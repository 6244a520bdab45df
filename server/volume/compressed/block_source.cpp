// SPDX-License-Identifier: Apache-2.0
#include "volume/compressed/block_source.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "base/parallel.h"

namespace wellspring::volume {

namespace {

struct SourceRange {
  double least = std::numeric_limits<double>::infinity(), greatest = -least;
};

template <class Sample>
SourceRange range_of_samples(const Volume& volume) {
  std::vector<SourceRange> ranges(size_t(volume.size.z));
  const size_t slice = volume.samples() / size_t(volume.size.z);
  parallel_each(volume.size.z, [&](int z) {
    SourceRange range;
    const std::byte* from = volume.bytes.get() + size_t(z) * slice * sizeof(Sample);
    for (size_t i = 0; i < slice; i++) {
      Sample sample;
      std::memcpy(&sample, from + i * sizeof(Sample), sizeof sample);
      const double value = double(sample);
      if (!std::isfinite(value)) continue;
      range.least = std::min(range.least, value);
      range.greatest = std::max(range.greatest, value);
    }
    ranges[size_t(z)] = range;
  });
  SourceRange all;
  for (const SourceRange& range : ranges) {
    all.least = std::min(all.least, range.least);
    all.greatest = std::max(all.greatest, range.greatest);
  }
  return all.least <= all.greatest ? all : SourceRange{0, 0};
}

SourceRange range_of_samples(const Volume& volume) {
  switch (volume.kind) {
    case SampleKind::u32: return range_of_samples<uint32_t>(volume);
    case SampleKind::i32: return range_of_samples<int32_t>(volume);
    case SampleKind::f32: return range_of_samples<float>(volume);
    default: return range_of_samples<double>(volume);
  }
}

template <class Sample>
void read_samples(float* to, const BlockSource& source, glm::ivec3 block) {
  const Volume& volume = source.volume;
  const glm::ivec3 last = volume.size - 1;
  const int channels = volume.channels;
  for (int z = 0; z < 4; z++)
    for (int y = 0; y < 4; y++) {
      const glm::ivec3 at = glm::min(4 * block + glm::ivec3(0, y, z), last);
      const size_t line =
          (size_t(at.z) * size_t(volume.size.y) + size_t(at.y)) * size_t(volume.size.x);
      Sample samples[12];
      for (int x = 0; x < 4; x++) {
        const size_t index = (line + size_t(std::min(at.x + x, last.x))) * size_t(channels);
        std::memcpy(samples + x * channels, volume.bytes.get() + index * sizeof(Sample),
                    size_t(channels) * sizeof(Sample));
      }
      for (int i = 0; i < 4 * channels; i++) {
        if (!source.brought) {
          *to++ = float(samples[i]);
          continue;
        }
        const double coded = std::round((double(samples[i]) - source.least) * source.scale);
        *to++ = std::isfinite(coded) ? float(coded) : 0;
      }
    }
}

}  // namespace

BlockSource make_block_source(const Volume& volume) {
  if (volume.size.x < 1 || volume.size.y < 1 || volume.size.z < 1)
    throw std::invalid_argument("a volume without voxels cannot be compressed");
  if (volume.channels != 1 && !(volume.channels == 3 && volume.kind == SampleKind::u8))
    throw std::invalid_argument("only grey and colours of 8 bits can be compressed");
  BlockSource source;
  source.volume = volume;
  source.kind = volume.kind;
  source.slope = volume.slope, source.intercept = volume.intercept;
  if (volume.kind == SampleKind::i8) source.kind = SampleKind::i16;
  if (bytes_of(volume.kind) <= 2) return source;
  const SourceRange range = range_of_samples(volume);
  source.kind = SampleKind::u16;
  source.brought = true;
  source.least = range.least;
  const double apart = range.greatest - range.least;
  const bool spans = apart > 0 && std::isfinite(apart);
  source.scale = spans ? 65535 / apart : 0;
  source.slope = spans ? volume.slope * (apart / 65535) : volume.slope;
  source.intercept = volume.slope * range.least + volume.intercept;
  return source;
}

void read_block(float* to, const BlockSource& source, glm::ivec3 block) {
  switch (source.volume.kind) {
    case SampleKind::u8: return read_samples<uint8_t>(to, source, block);
    case SampleKind::i8: return read_samples<int8_t>(to, source, block);
    case SampleKind::u16: return read_samples<uint16_t>(to, source, block);
    case SampleKind::i16: return read_samples<int16_t>(to, source, block);
    case SampleKind::u32: return read_samples<uint32_t>(to, source, block);
    case SampleKind::i32: return read_samples<int32_t>(to, source, block);
    case SampleKind::f32: return read_samples<float>(to, source, block);
    case SampleKind::f64: return read_samples<double>(to, source, block);
  }
}

bool is_background(const BlockSource& source, const float* block, std::optional<double> threshold) {
  const double most = threshold.value_or(0);
  const float coded =
      float(source.brought ? std::round((most - source.least) * source.scale) : most);
  return std::all_of(block, block + source.dimensions(),
                     [&](float x) { return threshold ? x <= coded : x == coded; });
}

}  // namespace wellspring::volume
