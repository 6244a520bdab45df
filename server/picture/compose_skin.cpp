// SPDX-License-Identifier: Apache-2.0
// What moves, drawn in the light that is kept on its skin (light/known/skin_light.h).
#include <algorithm>

#include "light/known/skin_light.h"
#include "picture/compose_drawn.h"
#include "picture/drawn_run.h"
#include "picture/soften_edges.h"

namespace wellspring::picture {
namespace {

Shown light_part(const VisibleRun& run, const RunPixels& p, const RunMoving& moving,
                 const RunDynamic& dynamic, const RunGlow& emitting, int i) {
  Shown shown{{}, Lanes{}, load_lanes(run.depth + i), load_lanes<LaneBits>(run.object + i)};
  put_moving(p, moving.light, i, LaneMask{} - 1, shown);
  if (dynamic.any) add_dynamic(p, dynamic, i, shown);
  add_glow(p, emitting, i, 0xff, shown);
  return shown;
}

bool shows_any(const VisibleRun& run) {
  return std::any_of(run.object, run.object + run.count, [](uint32_t o) { return o != 0; });
}

}  // namespace

void compose_moving(const View& view, const VisibilityPass& visibility, const PictureWindow& window,
                    const Tonemap& tonemap, std::span<const float> disparity,
                    std::span<uint8_t> covered, const KeptLight& kept, MovingLight& light) {
  NearerEyePlanes planes{
      tonemap.exposure,         disparity.data(),
      covered.data(),           light.disparity.empty() ? nullptr : light.disparity.data(),
      light.picture.rgb.data(), light.peaks.data()};
  auto take = [&](const VisibleRun& run) {
    if (run.x < window.left || run.x + run.count > window.left + window.width) return;
    if (run.y < window.top || run.y >= window.top + window.height || !shows_any(run)) return;
    RunPixels p;
    RunMoving moving;
    RunGlow emitting = describe_run(run, p);
    moving.pixels = run.light(*kept.skin, *kept.lights, p.surface, moving.light);
    const RunDynamic dynamic = find_dynamic(kept.dynamic, view, run, p);
    size_t row = size_t(run.y) * size_t(view.width) + size_t(run.x);
    for (int i = 0; i < run.count; i += lane_count)
      planes.put(row + size_t(i), LanePart{0, std::min(run.count - i, lane_count)},
                 light_part(run, p, moving, dynamic, emitting, i));
  };
  soften_edges(visibility.see_edges(view, vec2(0.5f), take, RasterShows::moving), light.picture,
               light.peaks);
}

}  // namespace wellspring::picture
