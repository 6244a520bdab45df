// SPDX-License-Identifier: Apache-2.0
#include "volume/volume.h"

#include <cmath>
#include <cstring>

#include "base/parallel.h"

namespace wellspring::volume {

namespace {

template <class Sample>
double read_as(const std::byte* from) {
  Sample sample;
  std::memcpy(&sample, from, sizeof sample);
  return double(sample);
}

double read_sample(SampleKind kind, const std::byte* from) {
  switch (kind) {
    case SampleKind::u8: return read_as<uint8_t>(from);
    case SampleKind::i8: return read_as<int8_t>(from);
    case SampleKind::u16: return read_as<uint16_t>(from);
    case SampleKind::i16: return read_as<int16_t>(from);
    case SampleKind::u32: return read_as<uint32_t>(from);
    case SampleKind::i32: return read_as<int32_t>(from);
    case SampleKind::f32: return read_as<float>(from);
    case SampleKind::f64: return read_as<double>(from);
  }
  return 0;
}

}  // namespace

int bytes_of(SampleKind kind) {
  switch (kind) {
    case SampleKind::u8:
    case SampleKind::i8: return 1;
    case SampleKind::u16:
    case SampleKind::i16: return 2;
    case SampleKind::u32:
    case SampleKind::i32:
    case SampleKind::f32: return 4;
    case SampleKind::f64: return 8;
  }
  return 0;
}

double Volume::at(int x, int y, int z, int channel) const {
  const size_t index = (size_t(z) * size_t(size.y) + size_t(y)) * size_t(size.x) + size_t(x);
  const size_t step = size_t(bytes_of(kind));
  const std::byte* from = bytes.get() + (index * size_t(channels) + size_t(channel)) * step;
  return slope * read_sample(kind, from) + intercept;
}

Grid to_grid(const Volume& volume, int channel) {
  Grid grid(volume.size);
  parallel_each(volume.size.z, [&](int z) {
    for (int y = 0; y < volume.size.y; ++y)
      for (int x = 0; x < volume.size.x; ++x) {
        const float value = float(volume.at(x, y, z, channel));
        grid.at(x, y, z) = std::isfinite(value) ? value : 0;
      }
  });
  return grid;
}

}  // namespace wellspring::volume
