// SPDX-License-Identifier: Apache-2.0
#include "scan/tree/import/voxel_means.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "image/srgb.h"
#include "scan/tree/octahedral.h"

namespace wellspring::scan {
namespace {

constexpr uint32_t absent = 0xffffffff;
constexpr int half_bits = voxel_bits - 1;

// Encodes by a table of so many even steps, each a fifth of the smallest step of codes.
constexpr int encode_steps = 1 << 14;
uint32_t encode_srgb(float linear) {
  static const std::array<uint8_t, encode_steps + 1> table = [] {
    std::array<uint8_t, encode_steps + 1> codes;
    for (int i = 0; i <= encode_steps; i++) {
      const double c = double(i) / encode_steps;
      const double code = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
      codes[size_t(i)] = uint8_t(std::lround(255 * code));
    }
    return codes;
  }();
  return table[size_t(std::clamp(linear, 0.0f, 1.0f) * encode_steps + 0.5f)];
}

vec3 aligned(vec3 normal, vec3 with) { return glm::dot(normal, with) < 0 ? -normal : normal; }

void vote(VoxelSum& sum, uint32_t classification, uint32_t votes) {
  if (sum.classification == classification) sum.votes += votes;
  else if (votes > sum.votes) sum.classification = classification, sum.votes = votes - sum.votes;
  else sum.votes -= votes;
}

// Splits a place along an axis, in steps of 2^-bits of the parent's edge, into a voxel and what is
// left.
struct InVoxel {
  uint32_t voxel;
  float rest;
};
InVoxel in_voxel(uint64_t steps, int bits, float beyond) {
  const int shift = bits - voxel_bits;
  const uint64_t voxel = steps >> shift;
  return {uint32_t(voxel),
          (float(steps - (voxel << shift)) + beyond) / float(uint64_t(1) << shift)};
}

glm::u64vec3 cell_in_parent(const NodeCube& parent, const NodeCube& child) {
  const uint32_t finer = child.level - parent.level;
  return glm::u64vec3(child.cell) - (glm::u64vec3(parent.cell) << uint64_t(finer));
}

}  // namespace

void NodeColumnData::resize(size_t count) {
  x.resize(count), y.resize(count), z.resize(count), normal.resize(count);
  color.resize(count), classification.resize(count), own_spacing.resize(count);
}

VoxelSum& VoxelGatherer::find(std::vector<VoxelSum>& sums, glm::uvec3 voxel) {
  constexpr uint32_t mask = (1u << half_bits) - 1;
  uint32_t& number =
      numbers_[((voxel.z & mask) << half_bits | (voxel.y & mask)) << half_bits | (voxel.x & mask)];
  if (number == absent) {
    number = uint32_t(sums.size());
    sums.emplace_back();
    sums.back().key = voxel.x | voxel.y << voxel_bits | voxel.z << (2 * voxel_bits);
  }
  return sums[number];
}

void VoxelGatherer::forget(const std::vector<VoxelSum>& sums, size_t from) {
  constexpr uint32_t mask = (1u << half_bits) - 1;
  for (size_t i = from; i < sums.size(); i++) {
    const uint32_t key = sums[i].key;
    numbers_[((key >> (2 * voxel_bits) & mask) << half_bits | (key >> voxel_bits & mask))
                 << half_bits |
             (key & mask)] = absent;
  }
}

void VoxelGatherer::add_points(std::vector<VoxelSum>& sums, const NodeCube& parent,
                               const NodeCube& child, const NodeColumnData& points) {
  numbers_.resize(size_t(1) << (3 * half_bits), absent);
  const size_t from = sums.size();
  const glm::u64vec3 cell = cell_in_parent(parent, child) << uint64_t(16);
  const int bits = int(child.level - parent.level) + 16;
  for (size_t i = 0; i < points.size(); i++) {
    const InVoxel x = in_voxel(cell.x | points.x[i], bits, 0.5f),
                  y = in_voxel(cell.y | points.y[i], bits, 0.5f),
                  z = in_voxel(cell.z | points.z[i], bits, 0.5f);
    VoxelSum& sum = find(sums, {x.voxel, y.voxel, z.voxel});
    sum.weight++;
    sum.place += vec3(x.rest, y.rest, z.rest);
    const uint32_t color = points.color[i];
    sum.color += vec3(image::decode_srgb(uint8_t(color)), image::decode_srgb(uint8_t(color >> 8)),
                      image::decode_srgb(uint8_t(color >> 16)));
    sum.intensity += float(color >> 24);
    sum.normal += aligned(decode_octahedral(points.normal[i]), sum.normal);
    vote(sum, points.classification[i], 1);
  }
  forget(sums, from);
}

void VoxelGatherer::add_sums(std::vector<VoxelSum>& sums, const NodeCube& parent,
                             const NodeCube& child, std::span<const VoxelSum> of_child) {
  numbers_.resize(size_t(1) << (3 * half_bits), absent);
  const size_t from = sums.size();
  const glm::u64vec3 cell = cell_in_parent(parent, child) << uint64_t(voxel_bits);
  const int bits = int(child.level - parent.level) + voxel_bits;
  for (const VoxelSum& part : of_child) {
    const vec3 mean = part.place / float(part.weight);
    const uint64_t mask = voxel_side - 1;
    const InVoxel x = in_voxel(cell.x | (part.key & mask), bits, mean.x),
                  y = in_voxel(cell.y | (part.key >> voxel_bits & mask), bits, mean.y),
                  z = in_voxel(cell.z | (part.key >> (2 * voxel_bits) & mask), bits, mean.z);
    VoxelSum& sum = find(sums, {x.voxel, y.voxel, z.voxel});
    sum.weight += part.weight;
    sum.place += float(part.weight) * vec3(x.rest, y.rest, z.rest);
    sum.color += part.color, sum.intensity += part.intensity;
    sum.normal += aligned(part.normal, sum.normal);
    vote(sum, part.classification, part.votes);
  }
  forget(sums, from);
}

void make_means(NodeColumnData& means, std::span<const VoxelSum> sums) {
  constexpr int steps = 65536 / voxel_side;
  means.resize(sums.size());
  for (size_t i = 0; i < sums.size(); i++) {
    const VoxelSum& sum = sums[i];
    const float weight = float(sum.weight);
    const auto place = [&](uint32_t voxel, float within) {
      const int step = int(within / weight * float(steps));
      return uint16_t(voxel * steps + uint32_t(std::clamp(step, 0, steps - 1)));
    };
    means.x[i] = place(sum.key & (voxel_side - 1), sum.place.x);
    means.y[i] = place(sum.key >> voxel_bits & (voxel_side - 1), sum.place.y);
    means.z[i] = place(sum.key >> (2 * voxel_bits), sum.place.z);
    const vec3 color = sum.color / weight;
    means.color[i] = encode_srgb(color.x) | encode_srgb(color.y) << 8 | encode_srgb(color.z) << 16 |
                     uint32_t(std::min(sum.intensity / weight + 0.5f, 255.0f)) << 24;
    means.normal[i] = encode_octahedral(sum.normal);
    means.classification[i] = uint8_t(sum.classification);
  }
}

}  // namespace wellspring::scan
