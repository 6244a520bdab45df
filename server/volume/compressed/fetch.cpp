// SPDX-License-Identifier: Apache-2.0
#include "volume/compressed/fetch.h"

#include <cmath>

#include "volume/compressed/rgb_word.h"

namespace wellspring::volume {

namespace {

// Remembers the code of the block looked at last: of eight neighbours most share one.
class VoxelFetcher {
 public:
  explicit VoxelFetcher(const CompressedVolume& volume)
      : volume_(volume),
        blocks_(volume.blocks()),
        bits_(index_bits(volume.codevectors)),
        mask_((uint64_t(1) << bits_) - 1) {}

  glm::vec3 operator()(glm::ivec3 voxel) {
    voxel = glm::clamp(voxel, glm::ivec3(0), volume_.size - 1);
    const glm::ivec3 at = voxel / block_side, in = voxel - block_side * at;
    const size_t block =
        (size_t(at.z) * size_t(blocks_.y) + size_t(at.y)) * size_t(blocks_.x) + size_t(at.x);
    if (block != block_) block_ = block, code_ = volume_.code(block);
    size_t place = size_t((in.z * block_side + in.y) * block_side + in.x);
    const size_t apart = size_t(block_voxels) << bits_;
    uint64_t code = code_;
    const float slope = float(volume_.slope), intercept = float(volume_.intercept);
    if (volume_.channels == 3) {
      uint32_t sum = 0;
      for (int level = 0; level < volume_.levels; level++, code >>= bits_, place += apart)
        sum += volume_.words[place + size_t(code & mask_) * block_voxels];
      return from_biased_rgb(sum) * slope + intercept;
    }
    float sum = 0;
    for (int level = 0; level < volume_.levels; level++, code >>= bits_, place += apart)
      sum += volume_.values[place + size_t(code & mask_) * block_voxels];
    return glm::vec3(slope * sum + intercept);
  }

 private:
  const CompressedVolume& volume_;
  glm::ivec3 blocks_;
  int bits_;
  uint64_t mask_;
  size_t block_ = ~size_t(0);
  uint64_t code_ = 0;
};

}  // namespace

glm::vec3 fetch(const CompressedVolume& volume, glm::ivec3 voxel) {
  return VoxelFetcher(volume)(voxel);
}

glm::vec3 fetch_between(const CompressedVolume& volume, glm::vec3 position) {
  position = glm::clamp(position, glm::vec3(0), glm::vec3(volume.size - 1));
  const glm::vec3 low = glm::floor(position), part = position - low;
  VoxelFetcher fetcher(volume);
  glm::vec3 sum(0);
  for (int corner = 0; corner < 8; corner++) {
    const glm::ivec3 step(corner & 1, corner >> 1 & 1, corner >> 2);
    const glm::vec3 weight = glm::mix(1.f - part, part, glm::vec3(step));
    sum += fetcher(glm::ivec3(low) + step) * (weight.x * weight.y * weight.z);
  }
  return sum;
}

}  // namespace wellspring::volume
