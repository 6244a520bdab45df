// SPDX-License-Identifier: Apache-2.0
// Trilinear interpolation of samples, and of normals that are stored beside them: what a ray that
// marches through a volume asks for at each step. Eight places at a time; one, for rare places.
#pragma once
#include "volume/reconstruct/load_pairs.h"
#include "volume/reconstruct/normal_grid.h"
#include "volume/reconstruct/sample_box.h"

namespace wellspring::volume {

inline float mix(float a, float b, float way) { return a + way * (b - a); }
inline Lanes mix(const Lanes& a, const Lanes& b, const Lanes& way) { return a + way * (b - a); }

// Returns what is measured at a place. Sample: uint8_t, uint16_t or float.
template <class Sample>
inline float linear_value(const SampleBox<Sample>& box, glm::vec3 place) {
  const auto x = place_on_axis(place.x, box.size.x), y = place_on_axis(place.y, box.size.y),
             z = place_on_axis(place.z, box.size.z);
  const Sample* corner =
      box.samples + x.at + ptrdiff_t(y.at) * box.row + ptrdiff_t(z.at) * box.slice;
  const ptrdiff_t right = box.size.x > 1, down = box.size.y > 1 ? box.row : 0,
                  behind = box.size.z > 1 ? box.slice : 0;
  auto row = [&](ptrdiff_t shift) {
    return mix(float(corner[shift]), float(corner[shift + right]), x.way);
  };
  const float front = mix(row(0), row(down), y.way),
              back = mix(row(behind), row(down + behind), y.way);
  return mix(front, back, z.way) * box.scale + box.offset;
}

// Holds eight places in a box: index of the first of eight samples, and the ways from it.
struct LanesCell {
  LaneMask at;
  Lanes way_x, way_y, way_z;
  int down, behind;  // samples to the next row and slice
};
template <class Sample>
inline LanesCell cell_of(const SampleBox<Sample>& box, const Lanes3& place, const LaneMask& first) {
  const LanesPlace x = place_on_axis(place.x, box.size.x), y = place_on_axis(place.y, box.size.y),
                   z = place_on_axis(place.z, box.size.z);
  return {first + x.at + y.at * box.row + z.at * box.slice,
          x.way,
          y.way,
          z.way,
          box.size.y > 1 ? box.row : 0,
          box.size.z > 1 ? box.slice : 0};
}

// Returns whether pairs of samples can be loaded.
template <class Sample>
inline bool has_pairs(const SampleBox<Sample>& box) {
  return box.size.x > 1 && box.count >= 4;
}

template <class Sample>
[[gnu::always_inline]] inline Lanes mix_samples(const SampleBox<Sample>& box,
                                                const LanesCell& cell) {
  auto row = [&](int shift) {
    Lanes near, far;
    load_pairs(box.samples, box.count, cell.at + shift, near, far);
    return mix(near, far, cell.way_x);
  };
  const Lanes front = mix(row(0), row(cell.down), cell.way_y),
              back = mix(row(cell.behind), row(cell.down + cell.behind), cell.way_y);
  return mix(front, back, cell.way_z) * box.scale + box.offset;
}

// Adds up packed normals of eight corners (normal_grid.h) by their trilinear weights.
[[gnu::always_inline]] inline Lanes3 mix_normals(const uint32_t* normals, const LanesCell& cell) {
  const Lanes back_x = 1.0f - cell.way_x, back_y = 1.0f - cell.way_y, back_z = 1.0f - cell.way_z;
  Lanes3 sum;
  auto add_row = [&](int shift, const Lanes& weight) __attribute__((always_inline)) {
    LaneBits near, far;
    load_word_pairs(normals, cell.at + shift, near, far);
    sum = sum + unpack_normals(near) * (weight * back_x) +
          unpack_normals(far) * (weight * cell.way_x);
  };
  add_row(0, back_y * back_z);
  add_row(cell.down, cell.way_y * back_z);
  add_row(cell.behind, back_y * cell.way_z);
  add_row(cell.down + cell.behind, cell.way_y * cell.way_z);
  return sum * all_lanes(normal_step);
}

// Asks for one place after the other: in boxes that are too small for pairs.
template <class Sample>
[[gnu::noinline]] Lanes linear_value_slowly(SampleBox<Sample> box, const Lanes3& place,
                                            const LaneMask& first) {
  const Sample* samples = box.samples;
  Lanes value;
  for (int i = 0; i < lane_count; i++) {
    box.samples = samples + first[i];
    value[i] = linear_value(box, place.at(i));
  }
  return value;
}
template <class Sample>
[[gnu::noinline]] Lanes3 mix_normals_slowly(const SampleBox<Sample>& box, const uint32_t* normals,
                                            const LanesCell& cell) {
  Lanes3 sum;
  for (int corner = 0; corner < 8; corner++) {
    const int right = corner & 1, down = corner >> 1 & 1, behind = corner >> 2;
    const Lanes weight = (right ? cell.way_x : 1.0f - cell.way_x) *
                         (down ? cell.way_y : 1.0f - cell.way_y) *
                         (behind ? cell.way_z : 1.0f - cell.way_z);
    LaneBits words;
    const int shift = (box.size.x > 1 ? right : 0) + down * cell.down + behind * cell.behind;
    for (int i = 0; i < lane_count; i++) words[i] = normals[cell.at[i] + shift];
    sum = sum + unpack_normals(words) * (weight * normal_step);
  }
  return sum;
}

// The same as for one place. `first` is added to the index of each lane's samples, so that lanes
// can be in different bricks of a pool.
template <class Sample>
inline Lanes linear_value(const SampleBox<Sample>& box, const Lanes3& place,
                          const LaneMask& first = LaneMask{}) {
  if (!has_pairs(box)) return linear_value_slowly(box, place, first);
  return mix_samples(box, cell_of(box, place, first));
}

struct LanesLit {
  Lanes value;
  Lanes3 normal;  // its length is up to 1: shorter where neighbours disagree, 0 where none has one
};
// Returns normals, too, of packed ones that lie as the samples do: `normals` has that of sample 0.
template <class Sample>
[[gnu::always_inline]] inline LanesLit linear_value_and_normal(const SampleBox<Sample>& box,
                                                               const uint32_t* normals,
                                                               const Lanes3& place,
                                                               const LaneMask& first = LaneMask{}) {
  const LanesCell cell = cell_of(box, place, first);
  if (has_pairs(box)) return {mix_samples(box, cell), mix_normals(normals, cell)};
  return {linear_value_slowly(box, place, first), mix_normals_slowly(box, normals, cell)};
}

}  // namespace wellspring::volume
