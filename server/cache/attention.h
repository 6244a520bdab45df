// SPDX-License-Identifier: Apache-2.0
// Computes the priority image: how urgent a new sample is at every pixel (Walter 1999, sections 4
// and 4.1). A disocclusion, on which no point falls, comes first.
#pragma once
#include <cstdint>
#include <span>

#include "cache/point_cache.h"
#include "cache/point_image.h"
#include "world/view.h"

namespace wellspring::cache {

// Settings of a render cache, in the paper's words (Walter, Drettakis, Parker 1999).

struct CacheSettings {
  float points_per_pixel = 1.0625f;  // capacity over pixels (paper, section 4.3: slightly larger)
  float depth_threshold = 0.1f;      // share of the depth; paper, section 3.1
  float color_change = 0.25f;  // relative change of a resampled point that ages its neighbours
  float budget_share_old = 1;  // weight of age against emptiness in the priority
  bool attention = true;       // false: samples spread evenly
};

// Ages the points of a tile by an eighth of the scale, and makes them forget their light as
// invalidate_light() does, if the change samples of 3x3 tiles agree that the light has changed, by
// more than their noise can explain; marks their pixels in image.renewed. The image is projected
// for `view`. Change samples that have counted and those out of view are removed. Returns whether
// there was such a tile.
bool age_changed(PointCache& points, const View& view, PointImage& image);

// Lends points whose light was forgotten that of the nearest newer point of the same surface in
// their block of `lent_block` pixels a side, if there is one. Returns whether any still waits for a
// sample.
inline constexpr int lent_block = 8;
bool lend_light(PointCache& points, const PointImage& image);

// Overwrites image.priority: empty pixels get 255 (alone) to 143 (surrounded by points), pixels
// with a point a sum for its age (up to 127) and for how few samples it holds. All pixels get 255
// if attention is off.
void prioritise(const PointCache& points, const CacheSettings& settings, PointImage& image);

// Overwrites image.weight: each cell gets the weight of the object of one of its points, in turns
// with `turn`, so that all objects of a cell count; weight_one if there is no point or its object
// has no weight. If `of_object` is empty, so is image.weight.
void weigh(const PointCache& points, std::span<const uint8_t> of_object, uint32_t turn,
           PointImage& image);

}  // namespace wellspring::cache
