// SPDX-License-Identifier: Apache-2.0
// Reads a level of a volume at eight places at a time, or at one: whole, or out of bricks.
#pragma once
#include <optional>

#include "volume/draw/shown_volume.h"
#include "volume/reconstruct/trilinear.h"

namespace wellspring::volume {

inline constexpr int brick_bits = 5;
static_assert(1 << brick_bits == inner_side);

// Both have value() and value_and_normal(): places of lanes outside the mask may be anywhere, and
// their values mean nothing.
class WholeSamples {
 public:
  WholeSamples(const ShownVolume& volume, int level)
      : box_(volume.levels[size_t(level)].box()),
        normals_(volume.levels[size_t(level)].normals.words.data()) {}
  [[gnu::always_inline]] Lanes value(const Lanes3& place, const LaneMask& lanes) {
    return linear_value(box_, place);
  }
  [[gnu::always_inline]] LanesLit value_and_normal(const Lanes3& place, const LaneMask& lanes) {
    return linear_value_and_normal(box_, normals_, place);
  }

 private:
  const SampleBox<uint16_t> box_;
  const uint32_t* const normals_;
};

// Lives as long as a BrickReader does. A lane's brick is looked up when the lane comes to another
// one; where it is not there, the lane reads a coarser one, until it leaves the brick.
class BrickSamples {
 public:
  BrickSamples(const ShownVolume& volume, int level);
  [[gnu::always_inline]] Lanes value(const Lanes3& place, const LaneMask& lanes) {
    return mix_samples(box_, cell(place, lanes));
  }
  [[gnu::always_inline]] LanesLit value_and_normal(const Lanes3& place, const LaneMask& lanes) {
    const LanesCell at = cell(place, lanes);
    return {mix_samples(box_, at), mix_normals(normals_, at)};
  }

 private:
  // Finds the samples around places, as place_on_axis() does.
  LanesCell cell(const Lanes3& place, const LaneMask& lanes) {
    const LanesPlace x = place_on_axis(place.x, level_.size.x),
                     y = place_on_axis(place.y, level_.size.y),
                     z = place_on_axis(place.z, level_.size.z);
    const LaneMask brick = (x.at >> brick_bits) + (y.at >> brick_bits) * level_.bricks.x +
                           (z.at >> brick_bits) * (level_.bricks.x * level_.bricks.y);
    const LaneMask others = lanes & (brick != brick_);
    if (any_lane(others)) look_up(others, x.at, y.at, z.at, brick);
    if (coarser_ != 0) return coarser_cell(place);
    constexpr int inside = inner_side - 1;
    return {
        first_ + (x.at & inside) + (y.at & inside) * stored_row + (z.at & inside) * stored_slice,
        x.way,
        y.way,
        z.way,
        stored_row,
        stored_slice};
  }
  void look_up(const LaneMask& lanes, const LaneMask& x, const LaneMask& y, const LaneMask& z,
               const LaneMask& brick);
  void put(int lane, const FoundBrick& found);
  LanesCell coarser_cell(const Lanes3& place) const;

  const BrickReader reader_;
  const BrickFile& file_;
  const int number_;  // the level
  const BrickLevel& level_;
  SampleBox<uint16_t> box_;  // all slots of the pool
  const uint32_t* normals_;
  // Each lane's brick, by its number within the level; the index in the pool of the sample at
  // which it begins, behind the skirt; and which lanes have a coarser one, as bits.
  LaneMask brick_, first_;
  unsigned coarser_ = 0;
  // A place p of the level is (p + 0.5) * scale - 0.5 in the lane's brick's level, whose last
  // samples are `last`; the brick begins at sample `begin`.
  Lanes scale_;
  Lanes3 last_, begin_;
};

// Reads any volume at one place after the other; lives as long as a BrickReader does: for a ray.
class PlaceSamples {
 public:
  PlaceSamples(const ShownVolume& volume, int level);
  float value(vec3 place) {
    const vec3 in = enter(place);
    return linear_value(box_, in);
  }
  // All lanes have the same.
  LanesLit value_and_normal(vec3 place) {
    const vec3 in = enter(place);
    return linear_value_and_normal(box_, normals_, all_lanes(in));
  }

 private:
  // Returns the place in the box, which becomes that of the brick around it.
  vec3 enter(vec3 place) { return bricks_ ? enter_brick(place) : place; }
  vec3 enter_brick(vec3 place);

  const ResidentBricks* const bricks_;
  const int number_;  // the level
  const glm::ivec3 size_;
  std::optional<BrickReader> reader_;
  SampleBox<uint16_t> box_;
  const uint32_t* normals_ = nullptr;
  glm::ivec3 brick_{-1};
  FoundBrick found_;
};

}  // namespace wellspring::volume
