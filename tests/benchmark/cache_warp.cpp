// SPDX-License-Identifier: Apache-2.0
// What a warped picture (picture/warp_picture.h) differs from one that is drawn for its view, along
// recorded visits: reflectances in a light from one direction, without noise, so that nothing but
// the warp shows.
#include <algorithm>
#include <cmath>
#include <fmt/core.h>

#include "base/clock.h"
#include "cache_visit_stage.h"
#include "drawn_picture.h"
#include "frame/picture_file.h"
#include "judge/flip.h"
#include "picture/warp_picture.h"
#include "report.h"

namespace wellspring::test {
namespace {

constexpr int width = 1280, height = 720, levels = 16;
constexpr double ages[] = {0.016, 0.033, 0.05,
                           0.3};  // seconds from the keyframe's view to the picture's

// Share of pixels that no pixel of the other picture within one pixel explains: a channel is
// outside of the range of these by more than `levels` of 255.
double displaced_share(const Image8& test, const Image8& reference) {
  size_t displaced = 0;
  for (int y = 1; y + 1 < reference.height; y++)
    for (int x = 1; x + 1 < reference.width; x++) {
      bool wrong = false;
      for (size_t c = 0; c < 3; c++) {
        auto at = [&](int dx, int dy) {
          return (size_t(y + dy) * size_t(reference.width) + size_t(x + dx)) * 3 + c;
        };
        int low = 255, high = 0, value = test.rgb[at(0, 0)];
        for (int dy = -1; dy <= 1; dy++)
          for (int dx = -1; dx <= 1; dx++) {
            int near = reference.rgb[at(dx, dy)];
            low = std::min(low, near), high = std::max(high, near);
          }
        wrong |= value < low - levels || value > high + levels;
      }
      displaced += wrong;
    }
  return double(displaced) / (double(reference.width - 2) * (reference.height - 2));
}

double mean_flip(const Image8& test, const Image8& reference) {
  return eval_flip(test, reference).mean;
}

}  // namespace

void bench_cache_warp(BenchReport& report, const BenchOptions& options) {
  VisitStage stage(options.content + "/castle", "direct");
  VisibilityPass visibility(stage.world(), stage.lights());
  const int instants = options.quick ? 4 : 12;
  WarpScratch scratch;
  DrawnPicture before, held, now;
  Keyframe keyframe;
  Image8 warped;
  for (const char* name : {"stroll", "turn", "approach", "orbit"}) {
    if (!options.visit_trace.empty() && options.visit_trace != name) continue;
    VisitTrace trace = load_visit_trace(options.scenes + "/../traces/" + name + ".json");
    for (double age : ages) {
      double flip = 0, hold = 0, displaced = 0, unknown = 0, seconds = 0, making = 0;
      for (int i = 0; i < instants; i++) {
        double time = trace_seconds(trace) * (i + 0.5) / instants;
        View view = stage.view(trace, time, width, height),
             old = stage.view(trace, time - age, width, height);
        draw_picture(visibility, view, now);
        draw_picture(visibility, old, held);
        draw_picture(visibility, keyframe_view(old), before);
        double began = process_seconds_now();
        make_keyframe(keyframe_view(old), before.image, before.depth, keyframe);
        double made = process_seconds_now();
        unknown += double(warp_picture(keyframe, view, 1, scratch, warped)) / instants;
        seconds += (process_seconds_now() - made) / instants;
        making += (made - began) / instants;
        flip += mean_flip(warped, now.image) / instants;
        hold += mean_flip(held.image, now.image) / instants;
        displaced += displaced_share(warped, now.image) / instants;
        if (options.visit_pictures.empty()) continue;
        std::string stem =
            fmt::format("{}/warp_{}_{:.0f}ms_{}", options.visit_pictures, name, 1000 * age, i);
        save_image8(stem + ".png", warped);
        save_image8(stem + "_true.png", now.image);
      }
      nlohmann::json fields = {
          {"trace", name}, {"age_ms", std::round(1000 * age)}, {"size", "1280x720"}};
      report.add("cache.warp.flip", flip, "", fields);
      report.add("cache.warp.held_flip", hold, "", fields);
      report.add("cache.warp.displaced", 100 * displaced, "%", fields);
      report.add("cache.warp.unknown", 100 * unknown, "%", fields);
      report.add("cache.warp.processor_ms", 1000 * seconds, "ms", fields);
      report.add("cache.warp.keyframe_processor_ms", 1000 * making, "ms", fields);
    }
  }
}

}  // namespace wellspring::test
