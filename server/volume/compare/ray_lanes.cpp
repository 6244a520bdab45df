// SPDX-License-Identifier: Apache-2.0
#include "volume/compare/ray_lanes.h"

#include <array>
#include <limits>

namespace wellspring::volume {

namespace {

constexpr int line_margin = 6;
constexpr int line_middle = most_line_steps + line_margin;
using LineSamples = std::array<Lanes, 2 * line_middle + 1>;

Lanes median_of_three(Lanes a, Lanes b, Lanes c) {
  return lanes_max(lanes_min(a, b), lanes_min(lanes_max(a, b), c));
}

Lanes median_of_five(Lanes a, Lanes b, Lanes c, Lanes d, Lanes e) {
  // The least and the greatest of four are not the median of five.
  const Lanes low = lanes_max(lanes_min(a, b), lanes_min(c, d));
  const Lanes high = lanes_min(lanes_max(a, b), lanes_max(c, d));
  return median_of_three(low, high, e);
}

// Samples lines from the middle outwards, as far as is asked for.
struct SampledLines {
  const DensityField& field;
  const LineBatch& lines;
  LineSamples raw, median, derivative;
  int reached = -1;

  SampledLines(const DensityField& field, const LineBatch& lines) : field(field), lines(lines) {}
  void sample(int i) {
    raw[line_middle + i] = sample_density(field, lines.middle + lines.step * all_lanes(float(i)));
  }
  void filter(int i) {
    const Lanes* at = &raw[line_middle + i];
    median[line_middle + i] = median_of_five(at[-2], at[-1], at[1], at[2], at[0]);
  }
  void derive(int i) {
    const Lanes* at = &median[line_middle + i];
    derivative[line_middle + i] = (at[1] - at[-1]) + (at[2] - at[-2]);
  }
  // Makes the derivatives from -(i + 1) to i + 1.
  void reach(int i) {
    if (i == 0) {
      for (int k = -5; k <= 5; k++) sample(k);
      for (int k = -3; k <= 3; k++) filter(k);
      for (int k = -1; k <= 1; k++) derive(k);
    } else {
      for (int side : {1, -1}) sample(side * (i + 5));
      for (int side : {1, -1}) filter(side * (i + 3));
      for (int side : {1, -1}) derive(side * (i + 1));
    }
    reached = i;
  }
};

}  // namespace

LineScale line_scale(const DensityField& field, vec3 ray, double slope) {
  LineScale scale;
  const dvec3 way = glm::dmat3(field.to_index) * dvec3(ray);
  scale.metres = 1 / (steps_per_voxel * glm::length(way));
  scale.step = vec3(way * scale.metres);
  const double apart = field.high - field.low;
  scale.threshold = slope > 0   ? slope * scale.metres
                    : apart > 0 ? apart / 10 / steps_per_voxel
                                : std::numeric_limits<double>::infinity();
  return scale;
}

LineHits first_boundaries(const DensityField& field, const LineBatch& lines, bool falling) {
  SampledLines samples(field, lines);
  const Lanes least = lines.threshold * derivative_scale;
  LineHits hits;
  for (int i = 0; i < most_line_steps; i++) {
    const LaneMask looking = ~hits.found & (all_lanes(float(i) - 0.5f) <= lines.limit);
    if (!any_lane(looking)) break;
    samples.reach(i);
    for (int side = i == 0 ? -1 : 1; side >= -1; side -= 2) {
      const int at = side * i;
      const Lanes* slope = &samples.derivative[line_middle + at];
      const Lanes here = lanes_abs(slope[0]);
      // Outwards, so that the first of equals is taken from either side.
      const Lanes nearer = lanes_abs(slope[-side]), farther = lanes_abs(slope[side]);
      LaneMask peak = (here >= nearer) & (here > farther) & (here > least);
      if (falling) peak &= slope[0] < Lanes{};
      const Lanes bend = nearer - 2 * here + farther;  // negative at a peak
      const Lanes offset = float(at) + float(side) * (nearer - farther) /
                                           (2 * (bend < Lanes{} ? bend : Lanes{} - 1));
      const LaneMask closer = ~hits.found | (lanes_abs(offset) < lanes_abs(hits.offset));
      const LaneMask taken = peak & looking & closer & (lanes_abs(offset) <= lines.limit);
      hits.offset = taken ? offset : hits.offset;
      hits.found |= taken;
    }
  }
  return hits;
}

std::vector<float> line_slopes(const DensityField& field, const LineBatch& lines, int steps) {
  SampledLines samples(field, lines);
  for (int i = 0; i < steps; i++) samples.reach(i);
  std::vector<float> slopes;
  for (int i = -steps; i <= steps; i++)
    slopes.push_back(samples.derivative[line_middle + i][0] / derivative_scale);
  return slopes;
}

}  // namespace wellspring::volume
