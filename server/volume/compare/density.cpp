// SPDX-License-Identifier: Apache-2.0
#include "volume/compare/density.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "base/parallel.h"

namespace wellspring::volume {

namespace {

constexpr int density_bins = 2048;

Lanes gather_floats(const float* from, LaneMask at) {
#ifdef __AVX2__
  return Lanes(_mm256_i32gather_ps(from, __m256i(at), 4));
#else
  Lanes found{};
  for (int i = 0; i < lane_count; i++) found[i] = from[at[i]];
  return found;
#endif
}

// Splits a coordinate into the sample before it and the way from there, 0 to 1.
void split_coordinate(Lanes at, int size, LaneMask& before, Lanes& way) {
  const Lanes inside = lanes_min(lanes_max(at, Lanes{}), all_lanes(float(size - 1)));
  const LaneMask last = LaneMask{} + std::max(size - 2, 0);
  before = lanes_as<LaneMask>(to_whole(inside));
  before = before < last ? before : last;
  way = inside - to_float(lanes_as<LaneBits>(before));
}

// Splits the classes where the variance between them is largest (Otsu 1979, equation 18).
void find_classes(DensityField& field) {
  const std::vector<float>& values = field.grid.values;
  const int slices = field.grid.size.z;
  const size_t slice = values.size() / size_t(slices);
  std::vector<vec2> ranges(slices);
  parallel_each(slices, [&](int z) {
    const auto [low, high] = std::minmax_element(values.begin() + ptrdiff_t(slice * size_t(z)),
                                                 values.begin() + ptrdiff_t(slice * size_t(z + 1)));
    ranges[z] = {*low, *high};
  });
  double low = ranges[0].x, high = ranges[0].y;
  for (vec2 range : ranges)
    low = std::min(low, double(range.x)), high = std::max(high, double(range.y));
  field.split = field.low = field.high = low;
  if (!(high > low)) return;
  const double scale = density_bins / (high - low);
  const int parts = std::min(slices, 16);
  std::vector<std::array<double, density_bins>> counts(parts);
  parallel_each(parts, [&](int part) {
    counts[part].fill(0);
    const size_t end = slice * size_t(slices * (part + 1) / parts);
    for (size_t i = slice * size_t(slices * part / parts); i < end; i++)
      counts[part][std::min(int((values[i] - low) * scale), density_bins - 1)]++;
  });
  double all = 0, moment = 0;
  for (int part = 1; part < parts; part++)
    for (int i = 0; i < density_bins; i++) counts[0][i] += counts[part][i];
  for (int i = 0; i < density_bins; i++) all += counts[0][i], moment += counts[0][i] * (i + 0.5);
  double below = 0, moment_below = 0, best = -1;
  for (int i = 0; i + 1 < density_bins; i++) {
    below += counts[0][i], moment_below += counts[0][i] * (i + 0.5);
    if (below == 0 || below == all) continue;
    const double mean_below = moment_below / below;
    const double mean_above = (moment - moment_below) / (all - below);
    const double apart = mean_above - mean_below;
    const double variance = below * (all - below) * apart * apart;
    if (variance <= best) continue;
    best = variance;
    field.low = low + mean_below / scale, field.high = low + mean_above / scale;
  }
  field.split = (field.low + field.high) / 2;
}

}  // namespace

DensityField make_density_field(const Volume& volume, int channel) {
  if (std::min({volume.size.x, volume.size.y, volume.size.z}) < 1 || !volume.bytes)
    throw std::invalid_argument("the volume is empty");
  if (volume.samples() > size_t(std::numeric_limits<int32_t>::max()))
    throw std::invalid_argument("the volume has more than 2^31 - 1 samples; make a smaller one");
  DensityField field;
  field.to_metres = volume.to_metres;
  field.to_index = glm::inverse(volume.to_metres);
  field.voxel = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; i++)
    field.voxel = std::min(field.voxel, glm::length(dvec3(volume.to_metres[i])));
  bool good = field.voxel > 0 && std::isfinite(field.voxel);
  for (int i = 0; i < 16; i++)
    good = good && std::isfinite(field.to_index[i / 4][i % 4]) &&
           std::isfinite(field.to_metres[i / 4][i % 4]);
  if (!good) throw std::invalid_argument("the volume's place is not finite or has no extent");
  field.grid = to_grid(volume, channel);
  find_classes(field);
  return field;
}

Lanes sample_density(const DensityField& field, const Lanes3& place) {
  const glm::ivec3 size = field.grid.size;
  LaneMask x, y, z;
  Lanes right, up, front;
  split_coordinate(place.x, size.x, x, right);
  split_coordinate(place.y, size.y, y, up);
  split_coordinate(place.z, size.z, z, front);
  const int step_x = size.x > 1 ? 1 : 0, step_y = size.y > 1 ? size.x : 0,
            step_z = size.z > 1 ? size.x * size.y : 0;
  const LaneMask at = (z * size.y + y) * size.x + x;
  const float* from = field.grid.values.data();
  auto row = [&](LaneMask begin) {
    const Lanes a = gather_floats(from, begin), b = gather_floats(from, begin + step_x);
    return a + (b - a) * right;
  };
  auto plane = [&](LaneMask begin) {
    const Lanes a = row(begin), b = row(begin + step_y);
    return a + (b - a) * up;
  };
  const Lanes a = plane(at), b = plane(at + step_z);
  return a + (b - a) * front;
}

dvec3 density_gradient(const DensityField& field, dvec3 place) {
  const vec3 middle(field.to_index * glm::dvec4(place, 1));
  // With 1/6, 4/6, 1/6 across, each component loses as much as the others up to the third order:
  // the direction is kept where the density bends, as it does at blurred boundaries.
  constexpr double across[3] = {1 / 6.0, 4 / 6.0, 1 / 6.0};
  dvec3 in_index(0);
  for (int first = 0; first < 27; first += lane_count) {
    Lanes3 around = all_lanes(middle);
    auto beside = [&](int lane) {
      const int i = std::min(first + lane, 26);
      return glm::ivec3(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
    };
    for (int i = 0; i < lane_count; i++) around.set(i, middle + vec3(beside(i)));
    const Lanes found = sample_density(field, around);
    for (int i = 0; i < lane_count && first + i < 27; i++) {
      const glm::ivec3 at = beside(i);
      const dvec3 weight(across[at.x + 1], across[at.y + 1], across[at.z + 1]);
      in_index += dvec3(at) * 0.5 * double(found[i]) *
                  dvec3(weight.y * weight.z, weight.x * weight.z, weight.x * weight.y);
    }
  }
  return glm::transpose(glm::dmat3(field.to_index)) * in_index;
}

}  // namespace wellspring::volume
