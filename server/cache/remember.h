// SPDX-License-Identifier: Apache-2.0
// Answers of the renderer enter the cache (Walter 1999, sections 4.1 to 4.3): a resampled point is
// improved in place, or begins anew if it was found changed; a new point overwrites the oldest of
// eight.
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
  // Others (asked frames ago, or for what is not in view yet) find their place by where they are.
  bool current = true;
  bool still = false;  // answers are spread over their pixel and join the point that shows there
  uint8_t longest_mean = 64;      // samples a mean looks back on
  uint8_t longest_specular = 64;  // likewise, of what moves with the view
  bool reference = false;  // answers are of the reference; of a point that others know, smooth
                           // light tells no change
};

struct Remembered {
  int kept = 0, merged = 0, added = 0, changed = 0, rejected = 0;
  int unplaced = 0;  // of those kept: without a pixel of the current view
};

// What surfaces emit themselves (Sample::glow) is not remembered: whoever shows them knows it.
// Pixels whose points began anew are told in image.renewed. Samples that are not finite are
// rejected; negative light counts as none; pixels outside the image are wrong in answers for the
// current view, unless no_pixel. `targets` is overwritten with the point each sample went to, or
// no_point. The result does not depend on the number of threads.
Remembered remember_samples(PointCache& points, const View& view, std::span<const Request> requests,
                            std::span<const Sample> samples, const RememberSettings& settings,
                            PointImage& image, std::vector<uint32_t>& targets);

}  // namespace wellspring::cache
