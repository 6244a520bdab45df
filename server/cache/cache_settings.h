// SPDX-License-Identifier: Apache-2.0
// What a render cache is told once, with the paper's words (Walter, Drettakis, Parker 1999).
#pragma once

namespace wellspring::cache {

struct CacheSettings {
  float points_per_pixel = 1.0625f;  // capacity over pixels (paper, section 4.3: slightly larger)
  float depth_threshold = 0.1f;      // paper, section 3.1
  float color_change = 0.25f;  // relative change of a resampled point that ages its neighbours
  float budget_share_old = 1;  // weight of age against emptiness in the priority
  bool attention = true;       // false: samples spread evenly
};

}  // namespace wellspring::cache
