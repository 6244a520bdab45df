// SPDX-License-Identifier: Apache-2.0
#include "volume/draw/level_samples.h"

#include <bit>
#include <cmath>

namespace wellspring::volume {
namespace {

constexpr int skirt = 1 + stored_row + stored_slice;  // samples before the one at which it begins

}  // namespace

BrickSamples::BrickSamples(const ShownVolume& volume, int level)
    : reader_(*volume.bricks),
      file_(volume.bricks->file()),
      number_(level),
      level_(file_.levels[size_t(level)]),
      normals_(volume.bricks->pool().normals()) {
  const BrickPool& pool = volume.bricks->pool();
  box_ = {.samples = pool.codes(),
          .size = glm::ivec3(stored_side),
          .row = stored_row,
          .slice = stored_slice,
          .count = pool.samples()};
  // Lanes that have not looked anything up read what may be read.
  const FoundBrick coarsest = reader_.coarsest();
  for (int k = 0; k < lane_count; k++) put(k, coarsest), brick_[k] = -1;
  coarser_ = 0;
}

void BrickSamples::look_up(const LaneMask& lanes, const LaneMask& x, const LaneMask& y,
                           const LaneMask& z, const LaneMask& brick) {
  for (unsigned bits = negative_lanes(lanes); bits != 0; bits &= bits - 1) {
    const int k = std::countr_zero(bits);
    put(k, reader_.find(number_, glm::ivec3(x[k], y[k], z[k]) >> brick_bits));
    brick_[k] = brick[k];
  }
}

void BrickSamples::put(int lane, const FoundBrick& found) {
  first_[lane] = found.place + skirt;
  scale_[lane] = std::ldexp(1.0f, number_ - found.level);
  last_.set(lane, vec3(file_.levels[size_t(found.level)].size - 1));
  begin_.set(lane, vec3(found.brick * inner_side));
  const unsigned bit = 1u << lane;
  coarser_ = found.level == number_ ? coarser_ & ~bit : coarser_ | bit;
}

LanesCell BrickSamples::coarser_cell(const Lanes3& place) const {
  const auto on_axis = [&](const Lanes& at, const Lanes& last, const Lanes& begin) {
    // The skirt has what is half a sample before the brick, too.
    const Lanes inside =
        lanes_min(positive_lanes((at + 0.5f) * scale_ - 0.5f), last) - begin + 1.0f;
    const Lanes kept = lanes_min(positive_lanes(inside), all_lanes(float(stored_side - 1)));
    const LaneMask whole = __builtin_convertvector(kept, LaneMask);
    const LaneMask most = LaneMask{} + (stored_side - 2);
    const LaneMask first = whole < most ? whole : most;
    return LanesPlace{first, kept - __builtin_convertvector(first, Lanes)};
  };
  const LanesPlace x = on_axis(place.x, last_.x, begin_.x), y = on_axis(place.y, last_.y, begin_.y),
                   z = on_axis(place.z, last_.z, begin_.z);
  return {first_ - skirt + x.at + y.at * stored_row + z.at * stored_slice,
          x.way,
          y.way,
          z.way,
          stored_row,
          stored_slice};
}

PlaceSamples::PlaceSamples(const ShownVolume& volume, int level)
    : bricks_(volume.bricks.get()), number_(level), size_(volume.levels[size_t(level)].size) {
  const VolumeLevel& of = volume.levels[size_t(level)];
  if (bricks_) reader_.emplace(*bricks_);
  else box_ = of.box(), normals_ = of.normals.words.data();
}

vec3 PlaceSamples::enter_brick(vec3 place) {
  const glm::ivec3 brick =
      glm::ivec3(place_on_axis(place.x, size_.x).at, place_on_axis(place.y, size_.y).at,
                 place_on_axis(place.z, size_.z).at) >>
      brick_bits;
  if (brick != brick_) {
    brick_ = brick, found_ = reader_->find(number_, brick);
    box_ = whole_box(bricks_->pool().codes() + found_.place, glm::ivec3(stored_side));
    normals_ = bricks_->pool().normals() + found_.place;
  }
  if (found_.level > number_)
    place = (place + 0.5f) * std::ldexp(1.0f, number_ - found_.level) - 0.5f;
  const vec3 last(bricks_->file().levels[size_t(found_.level)].size - 1);
  return glm::clamp(place, vec3(0), last) - vec3(found_.brick * inner_side) + 1.0f;
}

}  // namespace wellspring::volume
