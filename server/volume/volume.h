// SPDX-License-Identifier: Apache-2.0
// A scanned volume as its file gives it, and the grids of floats that are computed from it.
#pragma once
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "base/layers.h"

namespace wellspring::volume {

enum class SampleKind { u8, i8, u16, i16, u32, i32, f32, f64 };

int bytes_of(SampleKind kind);

// A grid of samples. Sample (x, y, z) has its centre at the index (x, y, z); x runs fastest. Bytes
// are in this machine's order, and may be a mapped file: who copies a Volume shares them.
struct Volume {
  glm::ivec3 size{0};
  int channels = 1;  // 1, or 3: red, green, blue as display codes, side by side
  SampleKind kind = SampleKind::u8;
  // A sample `s` measures `slope * s + intercept`, in Hounsfield units for CT.
  double slope = 1, intercept = 0;
  // Leads from index to metres, in the frame in which a patient stands upright and looks at the
  // visitor: +X is the patient's left, +Y is up (superior), +Z is to the front (anterior). Never
  // singular.
  glm::dmat4 to_metres{1};
  std::shared_ptr<const std::byte> bytes;

  size_t samples() const { return size_t(size.x) * size_t(size.y) * size_t(size.z); }
  size_t byte_count() const { return samples() * size_t(channels) * size_t(bytes_of(kind)); }
  // Returns what the sample measures. Arguments must lie inside.
  double at(int x, int y, int z, int channel = 0) const;
};

// A grid of floats, x fastest, in memory.
struct Grid {
  glm::ivec3 size{0};
  std::vector<float> values;

  Grid() = default;
  explicit Grid(glm::ivec3 size)
      : size(size), values(size_t(size.x) * size_t(size.y) * size_t(size.z)) {}
  size_t index(int x, int y, int z) const {
    return (size_t(z) * size_t(size.y) + size_t(y)) * size_t(size.x) + size_t(x);
  }
  float at(int x, int y, int z) const { return values[index(x, y, z)]; }
  float& at(int x, int y, int z) { return values[index(x, y, z)]; }
};

// Returns what a channel's samples measure. Values that are not finite become 0.
Grid to_grid(const Volume& volume, int channel = 0);

}  // namespace wellspring::volume
