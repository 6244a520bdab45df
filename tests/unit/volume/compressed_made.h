// SPDX-License-Identifier: Apache-2.0
// Volumes for the tests of compressed ones.
#pragma once
#include <cmath>
#include <cstring>
#include <memory>
#include <vector>

#include "base/rng.h"
#include "volume/compressed/compress.h"
#include "volume/compressed/decode.h"
#include "volume/volume.h"

namespace wellspring::test {

template <class Sample>
inline constexpr SampleKind kind_of = SampleKind::u8;
template <>
inline constexpr SampleKind kind_of<uint16_t> = SampleKind::u16;
template <>
inline constexpr SampleKind kind_of<int16_t> = SampleKind::i16;
template <>
inline constexpr SampleKind kind_of<float> = SampleKind::f32;

// Asks `sample(x, y, z, channel)` for every sample.
template <class Sample, class Ask>
Volume made_volume(glm::ivec3 size, int channels, const Ask& sample) {
  Volume volume;
  volume.size = size, volume.channels = channels, volume.kind = kind_of<Sample>;
  const std::shared_ptr<std::byte[]> bytes(
      new std::byte[volume.samples() * size_t(channels) * sizeof(Sample)]);
  std::byte* to = bytes.get();
  for (int z = 0; z < size.z; z++)
    for (int y = 0; y < size.y; y++)
      for (int x = 0; x < size.x; x++)
        for (int channel = 0; channel < channels; channel++, to += sizeof(Sample)) {
          const Sample value = Sample(sample(x, y, z, channel));
          std::memcpy(to, &value, sizeof value);
        }
  volume.bytes = std::shared_ptr<const std::byte>(bytes, bytes.get());
  return volume;
}

// A coloured ball with waves and noise in emptiness.
inline Volume colored_ball(glm::ivec3 size, uint64_t seed = 1) {
  Rng random(seed);
  const glm::vec3 middle = glm::vec3(size - 1) * 0.5f;
  return made_volume<uint8_t>(size, 3, [&](int x, int y, int z, int channel) {
    const glm::vec3 away = (glm::vec3(x, y, z) - middle) / (middle + 1.f);
    const float noise = 8 * random.uniform();
    if (glm::dot(away, away) > 0.8f) return 0.f;
    const float wave = std::sin(0.3f * float(x) + float(channel)) * std::cos(0.2f * float(y + z));
    return 120 + 60 * wave + noise - 20 * float(channel);
  });
}

// Settings of tests that do not wait: few codevectors.
inline CompressionSettings few_codevectors(int codevectors, int levels = 4) {
  CompressionSettings settings;
  settings.codevectors = codevectors, settings.levels = levels;
  settings.most_rounds = 4;
  return settings;
}

// Returns all samples of a detail.
template <class Sample>
std::vector<Sample> decode_all(const CompressedVolume& volume, int detail = 0) {
  const glm::ivec3 size = size_at(volume, detail);
  std::vector<Sample> samples(size_t(size.x) * size_t(size.y) * size_t(size.z) *
                              size_t(volume.channels));
  decode(std::span<Sample>(samples), volume, detail, Box{glm::ivec3(0), size});
  return samples;
}

template <class Sample>
std::vector<Sample> samples_of(const Volume& volume) {
  std::vector<Sample> samples(volume.samples() * size_t(volume.channels));
  std::memcpy(samples.data(), volume.bytes.get(), samples.size() * sizeof(Sample));
  return samples;
}

}  // namespace wellspring::test
