// SPDX-License-Identifier: Apache-2.0
#include "volume/compressed/coding_loss.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "base/parallel.h"
#include "volume/compressed/block_source.h"
#include "volume/compressed/decode.h"

namespace wellspring::volume {

namespace {

struct SliceLoss {
  double squares = 0;
  uint64_t samples = 0, foreground = 0, background = 0;
};

template <class Sample>
SliceLoss compare_slice(const BlockSource& source, const CompressedVolume& compressed,
                        std::optional<double> threshold, int z) {
  const glm::ivec3 blocks = compressed.blocks();
  const int channels = compressed.channels;
  SliceLoss all;
  float block[3 * block_voxels];
  Sample decoded[3 * block_voxels];
  for (int y = 0; y < blocks.y; y++)
    for (int x = 0; x < blocks.x; x++) {
      read_block(block, source, {x, y, z});
      if (is_background(source, block, threshold)) {
        all.background++;
        continue;
      }
      all.foreground++;
      Box box{glm::ivec3(x, y, z) * block_side, glm::ivec3(block_side)};
      decode(std::span<Sample>(decoded, size_t(source.dimensions())), compressed, 0, box);
      const glm::ivec3 end = glm::min(box.size, compressed.size - box.first);
      for (int k = 0; k < end.z; k++)
        for (int j = 0; j < end.y; j++)
          for (int i = 0; i < end.x * channels; i++) {
            const int at = (k * block_side + j) * block_side * channels + i;
            const double apart = double(block[at]) - double(decoded[at]);
            all.squares += apart * apart, all.samples++;
          }
    }
  return all;
}

}  // namespace

CodingLoss compare_compressed(const Volume& volume, const CompressedVolume& compressed,
                              std::optional<double> background) {
  const BlockSource source = make_block_source(volume);
  if (volume.size != compressed.size || volume.channels != compressed.channels ||
      source.kind != compressed.kind)
    throw std::invalid_argument("volumes of different sizes or kinds are compared");
  std::vector<SliceLoss> slices(size_t(compressed.blocks().z));
  parallel_each(int(slices.size()), [&](int z) {
    SliceLoss& slice = slices[size_t(z)];
    switch (compressed.kind) {
      case SampleKind::u8: slice = compare_slice<uint8_t>(source, compressed, background, z); break;
      case SampleKind::u16:
        slice = compare_slice<uint16_t>(source, compressed, background, z);
        break;
      default: slice = compare_slice<int16_t>(source, compressed, background, z);
    }
  });
  CodingLoss all;
  double squares = 0;
  uint64_t samples = 0;
  for (const SliceLoss& slice : slices) {
    squares += slice.squares, samples += slice.samples;
    all.foreground += slice.foreground, all.background += slice.background;
  }
  all.mean_square = samples > 0 ? squares / double(samples) : 0;
  const double peak = compressed.kind == SampleKind::u8 ? 255 : 65535;
  all.decibel = all.mean_square > 0 ? 10 * std::log10(peak * peak / all.mean_square)
                                    : std::numeric_limits<double>::infinity();
  all.bits_a_voxel = 8 * double(compressed.file_bytes) / double(volume.samples());
  return all;
}

}  // namespace wellspring::volume
