// SPDX-License-Identifier: Apache-2.0
// Eight places of a spline at a time. Two places share a vector, each with a row of four
// coefficients: rows are loaded as they lie, and only sums are turned into lanes of places.
#include <utility>

#include "volume/reconstruct/spline.h"
#include "volume/reconstruct/spline_weights.h"

namespace wellspring::volume {

namespace {

using AxisWeights = std::array<Lanes, 4>;

// Holds sums of rows before those along x, for places i and i + 4 in the halves of sum[i].
using RowSums = Lanes[4];

// Turns the sums into a vector for each of the four coefficients of a row, and adds those up.
Lanes add_rows(const RowSums& sum, const AxisWeights& weights) {
  const Lanes ab01 = __builtin_shufflevector(sum[0], sum[1], 0, 8, 1, 9, 4, 12, 5, 13),
              cd01 = __builtin_shufflevector(sum[0], sum[1], 2, 10, 3, 11, 6, 14, 7, 15),
              ab23 = __builtin_shufflevector(sum[2], sum[3], 0, 8, 1, 9, 4, 12, 5, 13),
              cd23 = __builtin_shufflevector(sum[2], sum[3], 2, 10, 3, 11, 6, 14, 7, 15);
  return __builtin_shufflevector(ab01, ab23, 0, 1, 8, 9, 4, 5, 12, 13) * weights[0] +
         __builtin_shufflevector(ab01, ab23, 2, 3, 10, 11, 6, 7, 14, 15) * weights[1] +
         __builtin_shufflevector(cd01, cd23, 0, 1, 8, 9, 4, 5, 12, 13) * weights[2] +
         __builtin_shufflevector(cd01, cd23, 2, 3, 10, 11, 6, 7, 14, 15) * weights[3];
}

// Fills each half with the weight of its place.
template <int place>
Lanes spread(const Lanes& weights) {
  return __builtin_shufflevector(weights, weights, place, place, place, place, place + 4, place + 4,
                                 place + 4, place + 4);
}

struct LanesCorner {
  LaneMask at;  // index of the first of the 64 coefficients
  Lanes way_x, way_y, way_z;
};
LanesCorner corner_of(const SampleBox<float>& box, const Lanes3& place, const LaneMask& first) {
  const LanesPlace x = place_on_axis(place.x, box.size.x), y = place_on_axis(place.y, box.size.y),
                   z = place_on_axis(place.z, box.size.z);
  return {first + (x.at - 1) + (y.at - 1) * box.row + (z.at - 1) * box.slice, x.way, y.way, z.way};
}

template <int place>
const Lanes load_rows(const SampleBox<float>& box, const LaneMask& corner, int j, int k) {
  const ptrdiff_t shift = ptrdiff_t(j) * box.row + ptrdiff_t(k) * box.slice;
  const float* from = box.samples + shift;
  const HalfLanes low = load_lanes<HalfLanes>(from + corner[place]),
                  high = load_lanes<HalfLanes>(from + corner[place + 4]);
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
}

// Holds weights and slopes along y and z, which all rows of a place share.
struct RowWeights {
  AxisWeights y, z, slope_y, slope_z;
};

template <int place>
void add_place(const SampleBox<float>& box, const LaneMask& corner, const RowWeights& weights,
               RowSums& value, RowSums& along_y, RowSums& along_z) {
  Lanes sum{}, sum_y{}, sum_z{};
#pragma GCC unroll 4
  for (int k = 0; k < 4; k++) {
    Lanes plane{}, plane_y{};
#pragma GCC unroll 4
    for (int j = 0; j < 4; j++) {
      const Lanes rows = load_rows<place>(box, corner, j, k);
      plane += rows * spread<place>(weights.y[size_t(j)]);
      plane_y += rows * spread<place>(weights.slope_y[size_t(j)]);
    }
    const Lanes weight_z = spread<place>(weights.z[size_t(k)]);
    sum += plane * weight_z, sum_y += plane_y * weight_z;
    sum_z += plane * spread<place>(weights.slope_z[size_t(k)]);
  }
  value[place] = sum, along_y[place] = sum_y, along_z[place] = sum_z;
}

template <int place>
Lanes sum_place(const SampleBox<float>& box, const LaneMask& corner, const AxisWeights& y,
                const AxisWeights& z) {
  Lanes sum{};
#pragma GCC unroll 4
  for (int k = 0; k < 4; k++) {
    Lanes plane{};
#pragma GCC unroll 4
    for (int j = 0; j < 4; j++)
      plane += load_rows<place>(box, corner, j, k) * spread<place>(y[size_t(j)]);
    sum += plane * spread<place>(z[size_t(k)]);
  }
  return sum;
}

}  // namespace

Lanes spline_value(const SampleBox<float>& box, const Lanes3& place, const LaneMask& first) {
  const LanesCorner corner = corner_of(box, place, first);
  const AxisWeights y = spline_weights<float>(corner.way_y),
                    z = spline_weights<float>(corner.way_z);
  const RowSums sum{sum_place<0>(box, corner.at, y, z), sum_place<1>(box, corner.at, y, z),
                    sum_place<2>(box, corner.at, y, z), sum_place<3>(box, corner.at, y, z)};
  return add_rows(sum, spline_weights<float>(corner.way_x)) * box.scale + box.offset;
}

LanesGradient spline_gradient(const SampleBox<float>& box, const Lanes3& place,
                              const LaneMask& first) {
  const LanesCorner corner = corner_of(box, place, first);
  const RowWeights weights{spline_weights<float>(corner.way_y), spline_weights<float>(corner.way_z),
                           spline_slopes<float>(corner.way_y), spline_slopes<float>(corner.way_z)};
  RowSums value, along_y, along_z;
  [&]<int... places>(std::integer_sequence<int, places...>) {
    (add_place<places>(box, corner.at, weights, value, along_y, along_z), ...);
  }
  (std::make_integer_sequence<int, 4>());
  const AxisWeights x = spline_weights<float>(corner.way_x);
  const Lanes3 gradient{add_rows(value, spline_slopes<float>(corner.way_x)), add_rows(along_y, x),
                        add_rows(along_z, x)};
  return {add_rows(value, x) * box.scale + box.offset, gradient * all_lanes(box.scale)};
}

}  // namespace wellspring::volume
