// SPDX-License-Identifier: Apache-2.0
// A picture of the light of lights that move or change alone, for tests and benchmarks.
#pragma once
#include <vector>

#include "light/virtual/dynamic_image.h"
#include "light/visible/surface_buffer.h"

namespace wellspring::scenes {

// Radiance of each pixel of `view`, which `image` was computed for.
inline std::vector<vec3> draw_dynamic_light(const VisibilityPass& visibility,
                                            const DynamicImage& image, const View& view) {
  std::vector<vec3> picture(size_t(view.width) * size_t(view.height));
  visibility.see(view, vec2(0.5f), [&](const VisibleRun& run) {
    RunPixels p;
    describe_run(run, p);
    RunDynamic seen;
    read_dynamic_light(image, view, run, p.surface, seen);
    auto at = [](const auto& of, int i) { return vec3(of.red[i], of.green[i], of.blue[i]); };
    for (int i = 0; i < run.count; i++) {
      vec3 color = at(seen.light, i) * at(p.surface, i);
      if (seen.any_gloss) color += at(seen.gloss, i);
      const size_t pixel = size_t(run.y) * size_t(view.width) + size_t(run.x + i);
      picture[pixel] = run.object[i] == 0 ? vec3(0) : color;
    }
  });
  return picture;
}

}  // namespace wellspring::scenes
