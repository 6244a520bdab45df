// SPDX-License-Identifier: Apache-2.0
// How urgent a new sample is at every pixel (Walter 1999, section 4 and 4.1).
#pragma once
#include "cache/cache.h"
#include "cache/point_cache.h"
#include "cache/point_image.h"
#include "cache/still_image.h"
#include "world/view.h"

namespace wellspring {

// Where several resampled points close by had changed (one may err), points nearby get older by a
// quarter of the scale and forget most of their samples, and the picture's mean there starts over.
// The image is projected for `view`. Uses up image.witnesses.
void age_changed(PointCache& points, const View& view, PointImage& image, StillImage& still);

// Points that were relit show their reflectance in the light of newer points of their object, as soon
// as there are any in the same block of `relit_block` pixels a side. Returns whether any waits.
inline constexpr int relit_block = 4;  // a cell's (cache/cells.h)
bool blind_relit(PointCache& points, const PointImage& image);

// Overwrites image.priority: empty pixels 255 (alone) to 143 (surrounded by points); pixels with a
// point by its age (up to 127) and by how few samples it holds. 255 everywhere counts when
// attention is off.
void prioritise(const PointCache& points, const CacheSettings& settings, PointImage& image);

}  // namespace wellspring
