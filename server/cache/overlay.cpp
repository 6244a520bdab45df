// SPDX-License-Identifier: Apache-2.0
#include "cache/overlay.h"

#include <atomic>
#include <bit>
#include <cmath>

#include "cache/packing.h"
#include "cache/pixel_light.h"

namespace wellspring {
namespace {

bool is_same(const SightRun& run, int i, uint32_t object, float depth) {
  if (object != run.object[i]) return false;
  bool far = !(run.depth[i] < infinite_depth), was_far = !(depth < 0.5f * infinite_depth);
  if (far || was_far) return far && was_far;
  return std::abs(depth - run.depth[i]) <= plane_tolerance * run.depth[i];
}

}  // namespace

int64_t overlay_sight(const View& view, const PictureSight& sight, bool still, Frame& frame) {
  std::atomic<int64_t> others = 0;
  sight.see(view, vec2(0.5f), [&](const SightRun& run) {
    uint64_t same = 0, guessed = 0;
    size_t row = size_t(run.y) * size_t(frame.width) + size_t(run.x);
    for (int i = 0; i < run.count; i++) {
      uint32_t more = std::bit_cast<uint32_t>(frame.confidence[row + size_t(i)]);
      same |= uint64_t(is_same(run, i, frame.object[row + size_t(i)], frame.depth[row + size_t(i)]))
              << i;
      guessed |= uint64_t((more >> 16 & 255) == 0) << i;
    }
    uint64_t all = run.count < 64 ? (uint64_t(1) << run.count) - 1 : ~uint64_t(0);
    uint64_t wrong = ~same & all;
    for (uint64_t rest = still ? wrong : 0; rest != 0; rest &= rest - 1) {
      int i = std::countr_zero(rest);
      if (!sight.moves(run.object[i]) && !sight.moves(frame.object[row + size_t(i)]))
        wrong &= ~(uint64_t(1) << i);
    }
    uint64_t wanted = wrong | (guessed & all);
    if (!wanted) return;
    RunReflectance reflectance;
    run.reflect(wanted, reflectance);
    int64_t others_here = 0;
    for (; wanted != 0; wanted &= wanted - 1) {
      int i = std::countr_zero(wanted);
      size_t at = row + size_t(i);
      int x = run.x + i;
      packed_word(frame, x, run.y, plane_albedo) =
          pack_albedo({reflectance.red[i], reflectance.green[i], reflectance.blue[i]});
      frame.depth[at] = std::min(run.depth[i], infinite_depth);
      if (same >> i & 1) continue;  // the light of its neighbours will do
      others_here++;
      Seen seen = run.see(i, false);
      frame.object[at] = run.object[i];
      bool shines = !seen.scatters || seen.glow != vec3(0);
      packed_word(frame, x, run.y, plane_rest) = pack_rgb9e5(seen.glow);
      packed_word(frame, x, run.y, plane_smooth) = 0;
      // What shines is known as well as it can be.
      uint32_t more =
          pack_normal(seen.normal) | (shines ? 255u << 16 : uint32_t(blind_deviation) << 24);
      frame.confidence[at] = std::bit_cast<float>(more);
    }
    others += others_here;
  });
  return others;
}

}  // namespace wellspring
