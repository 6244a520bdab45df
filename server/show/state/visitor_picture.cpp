// SPDX-License-Identifier: Apache-2.0
#include "show/state/visitor_picture.h"

#include <algorithm>

#include "base/memory.h"
#include "base/parallel.h"
#include "picture/keyframe.h"

namespace wellspring::show {
namespace {

constexpr double duration = 0.5;  // seconds

}  // namespace

void begin_fade(const Keyframe& shown, double time, Fade& fade) {
  fade.view = shown.view;
  fade.began = time;
  copy_colors(shown, {0, 0, shown.view.width, shown.view.height}, fade.from);
}

float fade_share(const Fade& fade, const View& view, double time) {
  if (fade.from.rgb.empty() || fade.view != view) return 1;
  float passed = float(std::clamp((time - fade.began) / duration, 0.0, 1.0));
  return passed * passed * (3 - 2 * passed);
}

void mix_fade(const Fade& fade, float share, Image8& image) {
  if (fade.from.rgb.size() != image.rgb.size()) return;
  const int newer = int(256 * share + 0.5f), older = 256 - newer;
  parallel_ranges(int(image.rgb.size()), 1 << 16, [&](int begin, int end) {
    const uint8_t* from = fade.from.rgb.data();
    uint8_t* to = image.rgb.data();
    for (int i = begin; i < end; i++) to[i] = uint8_t((from[i] * older + to[i] * newer + 128) >> 8);
  });
}

size_t memory_bytes(const VisitorPicture& picture) {
  return picture.cache.memory_bytes() + picture.compositor.memory_bytes() +
         picture.broker.memory_bytes() + picture.away.memory_bytes() +
         memory_bytes(picture.keyframe) + memory_bytes(picture.around.keyframe) +
         memory_bytes(picture.moving) + memory_bytes(picture.surfaces) +
         memory_bytes(picture.settled) + bytes_of(picture.fade.from.rgb, picture.lens.picture.rgb) +
         (picture.lens.compositor ? picture.lens.compositor->memory_bytes() : 0);
}

}  // namespace wellspring::show
