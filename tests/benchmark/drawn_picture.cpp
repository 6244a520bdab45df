// SPDX-License-Identifier: Apache-2.0
#include "drawn_picture.h"

#include <cmath>

#include "frame/tonemap.h"

namespace wellspring::test {

void draw_picture(const VisibilityPass& visibility, const View& view, DrawnPicture& drawn) {
  Frame frame;
  frame.width = view.width, frame.height = view.height;
  frame.color.resize(size_t(view.width) * size_t(view.height));
  drawn.depth.resize(frame.color.size());
  const vec3 towards_light = normalize(vec3(0.3f, 0.8f, 0.5f));
  visibility.see(view, vec2(0.5f), [&](const VisibleRun& run) {
    for (int i = 0; i < run.count; i++) {
      PrimaryHit seen = run.see(i);
      size_t at = size_t(run.y) * size_t(view.width) + size_t(run.x + i);
      float size = length(seen.normal);
      float light =
          0.35f + (size > 0 ? 0.65f * std::abs(dot(seen.normal, towards_light)) / size : 0);
      frame.color[at] = seen.albedo * light + 0.5f * seen.glow;
      drawn.depth[at] = run.depth[i];
    }
  });
  tonemap(frame, Tonemap{}, drawn.image);
}

}  // namespace wellspring::test
