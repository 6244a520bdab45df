// SPDX-License-Identifier: Apache-2.0
// Enters answers of the renderer into the cache (Walter 1999, sections 4.1 to 4.3): a resampled
// point is improved in place, or begins anew if it was found changed; a new point overwrites the
// oldest of eight.
#pragma once
#include <span>
#include <vector>

#include "cache/point_cache.h"
#include "cache/point_image.h"
#include "light/sample.h"
#include "world/view.h"

namespace wellspring::cache {

struct RememberSettings {
  float color_change = 0.25f;
  // `view` is the one the image was projected for: answers show at once, in the pixel that asked.
  // Other answers (asked frames ago, or for places not in view yet) find their point by their
  // place.
  bool current = true;
  bool still = false;  // answers are spread over their pixel and join the point that shows there
  uint8_t longest_mean = 64;      // samples that a mean looks back on
  uint8_t longest_specular = 64;  // likewise, for light that moves with the view
  // Answers are of the reference: smooth light shows no change if only one of answer and point is.
  bool reference = false;
};

struct Remembered {
  int kept = 0, merged = 0, added = 0, changed = 0, rejected = 0;
  int unplaced = 0;  // kept samples without a pixel of the current view
};

// Puts samples into the cache. Light that surfaces emit themselves (Sample::glow) is not
// remembered: whoever shows the surfaces knows it. image.renewed marks pixels whose points began
// anew. Samples that are not finite are rejected; negative light counts as none; pixels outside the
// image are wrong in answers for the current view, unless no_pixel. `targets` is overwritten with
// the point each sample went to, or no_point. The result does not depend on the number of threads.
Remembered remember_samples(PointCache& points, const View& view, std::span<const Request> requests,
                            std::span<const Sample> samples, const RememberSettings& settings,
                            PointImage& image, std::vector<uint32_t>& targets);

}  // namespace wellspring::cache
