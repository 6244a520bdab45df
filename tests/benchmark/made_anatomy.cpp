// SPDX-License-Identifier: Apache-2.0
#include "made_anatomy.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/parallel.h"
#include "base/rng.h"

namespace wellspring::test {
namespace {

float hash_at(glm::ivec3 p, uint64_t seed) {
  const uint64_t place =
      uint64_t(uint32_t(p.x)) | uint64_t(uint32_t(p.y)) << 21 | uint64_t(uint32_t(p.z)) << 42;
  return float(mix64(place ^ seed) >> 40) * 0x1p-24f;
}

// Returns smooth noise, 0 to 1, whose waves are about two units long.
float smooth_noise(glm::vec3 p, uint64_t seed) {
  const glm::vec3 low = glm::floor(p);
  glm::vec3 part = p - low;
  part = part * part * (3.f - 2.f * part);
  const glm::ivec3 cell = glm::ivec3(low) + 4096;
  const auto row = [&](int y, int z) {
    const glm::ivec3 at = cell + glm::ivec3(0, y, z);
    return glm::mix(hash_at(at, seed), hash_at(at + glm::ivec3(1, 0, 0), seed), part.x);
  };
  return glm::mix(glm::mix(row(0, 0), row(1, 0), part.y), glm::mix(row(0, 1), row(1, 1), part.y),
                  part.z);
}

struct Tube {
  glm::vec3 from, to;
  float radius;
  glm::vec3 color;
};

// Vessels wander and branch; they are kept by the cells of a coarse grid that they touch.
class Vessels {
 public:
  Vessels(glm::ivec3 size, uint64_t seed) : cells_((size + (cell - 1)) / cell) {
    grid_.resize(size_t(cells_.x) * size_t(cells_.y) * size_t(cells_.z));
    Rng random(seed);
    const glm::vec3 extent(size);
    const int trees = std::max(4, int(extent.x * extent.y * extent.z / 1.5e6f));
    for (int i = 0; i < trees; i++) {
      const glm::vec3 start =
          glm::vec3(random.uniform(), random.uniform(), random.uniform()) * extent;
      const glm::vec3 color = i % 2 ? glm::vec3(150, 25, 30) : glm::vec3(70, 40, 75);
      grow(random, start, 7 * random.uniform() + 2, color, 3);
    }
  }
  // Returns whether a vessel is here, and its colour: a wall, paler than what flows.
  bool find(glm::vec3 p, glm::vec3& color) const {
    const glm::ivec3 at = glm::ivec3(p) / cell;
    for (const Tube& tube : grid_[index(at)]) {
      const glm::vec3 along = tube.to - tube.from, away = p - tube.from;
      const float part = std::clamp(glm::dot(away, along) / glm::dot(along, along), 0.f, 1.f);
      const float distance = glm::length(away - part * along);
      if (distance > tube.radius) continue;
      color = distance > 0.75f * tube.radius ? glm::vec3(190, 140, 130) : tube.color;
      return true;
    }
    return false;
  }

 private:
  static constexpr int cell = 16;
  size_t index(glm::ivec3 at) const {
    return (size_t(at.z) * size_t(cells_.y) + size_t(at.y)) * size_t(cells_.x) + size_t(at.x);
  }
  void add(const Tube& tube) {
    const glm::ivec3 low = glm::ivec3(
                         glm::floor((glm::min(tube.from, tube.to) - tube.radius) / float(cell))),
                     high = glm::ivec3(
                         glm::floor((glm::max(tube.from, tube.to) + tube.radius) / float(cell)));
    for (int z = std::max(low.z, 0); z <= std::min(high.z, cells_.z - 1); z++)
      for (int y = std::max(low.y, 0); y <= std::min(high.y, cells_.y - 1); y++)
        for (int x = std::max(low.x, 0); x <= std::min(high.x, cells_.x - 1); x++)
          grid_[index({x, y, z})].push_back(tube);
  }
  void grow(Rng& random, glm::vec3 from, float radius, glm::vec3 color, int branches) {
    const auto any = [&] {
      return glm::vec3(random.uniform(), random.uniform(), random.uniform()) - 0.5f;
    };
    glm::vec3 towards = glm::normalize(any() + glm::vec3(0, 0, 0.3f));
    for (int step = 0; step < 24 && radius > 1; step++) {
      towards = glm::normalize(towards + 0.5f * any());
      const glm::vec3 to = from + 8.f * towards;
      add({from, to, radius, color});
      from = to, radius *= 0.98f;
      if (step % 8 == 7 && branches > 0) grow(random, from, 0.6f * radius, color, branches - 1);
    }
  }
  glm::ivec3 cells_;
  std::vector<std::vector<Tube>> grid_;
};

// Bone of radius `radius` around a line along z: a dense shell, beams of marrow within.
glm::vec3 bone_color(glm::vec3 p, float distance, float radius, uint64_t seed) {
  const float grain = smooth_noise(p / 3.f, seed);
  if (distance > radius - 6) return glm::vec3(232, 222, 198) + 16.f * (grain - 0.5f);
  const float beam = smooth_noise(p / 5.f, seed + 1) - 0.5f;
  return std::abs(beam) < 0.05f ? glm::vec3(215, 195, 165)
                                : glm::vec3(168, 92, 70) + 30.f * (grain - 0.5f);
}

glm::vec3 muscle_color(glm::vec3 p, uint64_t seed) {
  // Bundles run along z, bent; fat lies between them.
  const glm::vec3 bend(6 * smooth_noise(p / 60.f, seed), 6 * smooth_noise(p / 60.f, seed + 1), 0);
  const glm::vec3 q = p + bend;
  const float bundle = smooth_noise({q.x / 14, q.y / 14, q.z / 90}, seed + 2);
  const float fibre = smooth_noise({q.x / 2.5f, q.y / 2.5f, q.z / 20}, seed + 3);
  if (std::abs(bundle - 0.5f) < 0.025f) return {205, 165, 110};
  return glm::vec3(125, 45, 42) + (bundle - 0.5f) * glm::vec3(50, 30, 28) +
         (fibre - 0.5f) * glm::vec3(26, 16, 15);
}

glm::vec3 fat_color(glm::vec3 p, uint64_t seed) {
  const float lobe = smooth_noise(p / 11.f, seed), grain = smooth_noise(p / 3.f, seed + 1);
  if (std::abs(lobe - 0.5f) < 0.03f) return {175, 120, 80};
  return glm::vec3(222, 182, 112) + (lobe - 0.5f) * glm::vec3(30, 34, 40) + 14.f * (grain - 0.5f);
}

glm::vec3 organ_color(glm::vec3 p, float kind, uint64_t seed) {
  const glm::vec3 base = kind > 0.62f   ? glm::vec3(110, 52, 40)
                         : kind > 0.55f ? glm::vec3(165, 110, 95)
                                        : glm::vec3(142, 78, 66);
  const float lobule = smooth_noise(p / 8.f, seed), grain = smooth_noise(p / 2.5f, seed + 1);
  return base + (lobule - 0.5f) * glm::vec3(36, 28, 24) + 20.f * (grain - 0.5f);
}

// `p` in voxels; `extent` is the volume's size.
glm::vec3 tissue_color(glm::vec3 p, glm::vec3 extent, const Vessels& vessels, uint64_t seed) {
  const glm::vec3 middle = 0.5f * extent;
  const float bulge = 24 * (smooth_noise(p / 90.f, seed) - 0.5f);
  const glm::vec2 half(0.46f * extent.x, 0.40f * extent.y);
  const glm::vec2 away(p.x - middle.x, p.y - middle.y);
  const float inward =  // about the depth below the skin
      (1 - glm::length(away / half)) * std::min(half.x, half.y) + bulge;
  if (inward < 0) return glm::vec3(0);
  if (inward < 5)
    return glm::vec3(205, 160, 130) + 20.f * (smooth_noise(p / 2.5f, seed + 1) - 0.5f);
  for (const float side : {-0.45f, 0.45f}) {
    const float sway = 20 * (smooth_noise({side, 0, p.z / 150}, seed + 2) - 0.5f);
    const float radius = 0.07f * extent.x + 6 * (smooth_noise({side, 1, p.z / 60}, seed + 2));
    const float distance = glm::length(away - glm::vec2(side * half.x + sway, 0.2f * half.y));
    if (distance < radius) return bone_color(p, distance, radius, seed + 3);
  }
  glm::vec3 vessel;
  if (vessels.find(p, vessel)) return vessel + 8.f * (smooth_noise(p / 3.f, seed + 5) - 0.5f);
  const float layer = 25 + 40 * smooth_noise(p / 70.f, seed + 6);
  if (inward < layer) return fat_color(p, seed + 7);
  const float inner = smooth_noise(p / 45.f, seed + 9);
  if (inward > layer + 60 && inner > 0.48f) return organ_color(p, inner, seed + 10);
  return muscle_color(p, seed + 12);
}

}  // namespace

Volume made_anatomy(glm::ivec3 size, float noise, uint64_t seed) {
  Volume volume;
  volume.size = size, volume.channels = 3, volume.kind = SampleKind::u8;
  volume.to_metres = glm::dmat4(0.00033);
  volume.to_metres[3][3] = 1;
  const std::shared_ptr<std::byte[]> bytes(new std::byte[volume.byte_count()]);
  const Vessels vessels(size, seed);
  parallel_each(size.z, [&](int z) {
    Rng random(sample_seed(seed, 0, 0, uint32_t(z)));
    std::byte* to = bytes.get() + size_t(z) * size_t(size.y) * size_t(size.x) * 3;
    for (int y = 0; y < size.y; y++)
      for (int x = 0; x < size.x; x++, to += 3) {
        const glm::vec3 p(x, y, z);
        const glm::vec3 color = tissue_color(p, glm::vec3(size), vessels, seed << 8);
        const bool empty = color == glm::vec3(0);
        for (int channel = 0; channel < 3; channel++) {
          // Three uniform numbers make a bell of a standard deviation of a half.
          const float bell = random.uniform() + random.uniform() + random.uniform() - 1.5f;
          const float sample = empty ? 0 : color[channel] + 2 * noise * bell;
          to[channel] = std::byte(std::clamp(int(sample + 0.5f), 0, 255));
        }
      }
  });
  volume.bytes = std::shared_ptr<const std::byte>(bytes, bytes.get());
  return volume;
}

}  // namespace wellspring::test
