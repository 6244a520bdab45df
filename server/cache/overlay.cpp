// SPDX-License-Identifier: Apache-2.0
#include "cache/overlay.h"

#include <bit>
#include <cmath>

#include "cache/lanes.h"
#include "cache/packing.h"
#include "cache/pixel_light.h"

namespace wellspring {
namespace {

// Up to eight neighbours in memory; the rest is 0.
template <class V, class T>
V load_some(const T* from, int count) {
  if (count >= lanes) return load<V>(from);
  V v{};
  std::memcpy(&v, from, size_t(count) * sizeof(uint32_t));
  return v;
}

// Words of a plane, kept where the mask says so; `x` is where pixels of a run begin.
void put(Frame& frame, int x, int y, SurfacePlane plane, const u8& words, unsigned bits) {
  for (; bits != 0; bits &= bits - 1) {
    int i = std::countr_zero(bits);
    packed_word(frame, x + i, y, plane) = words[i];
  }
}

// Eight pixels that the points and the drawing tell of.
struct Verdict {
  i8 same;     // both show the same surface
  i8 guessed;  // the points only know it from neighbours
};
Verdict judge(const Frame& frame, size_t at, const SightRun& run, int i) {
  int count = std::min(run.count - i, lanes);
  u8 object = load_some<u8>(&frame.object[at], count),
     more = load_some<u8>(&frame.confidence[at], count);
  f8 depth = load_some<f8>(&frame.depth[at], count), drawn = load_some<f8>(run.depth + i, count);
  i8 there = drawn < std::numeric_limits<float>::infinity(), was = depth < 0.5f * infinite_depth;
  i8 near = magnitude(depth - drawn) <= plane_tolerance * drawn;
  return {(object == load_some<u8>(run.object + i, count)) &
              ((there & was & near) | (~there & ~was)),
          ((more >> 16) & 255u) == 0u};
}

uint32_t all_of(int count) { return count >= lanes ? 255u : (1u << count) - 1; }

}  // namespace

void overlay_sight(const View& view, const PictureSight& sight, const RestingPoints* resting, Frame& frame) {
  sight.see(view, vec2(0.5f), [&](const SightRun& run) {
    uint64_t wrong = 0, guessed = 0;
    size_t row = size_t(run.y) * size_t(frame.width) + size_t(run.x);
    for (int i = 0; i < run.count; i += lanes) {
      Verdict verdict = judge(frame, row + size_t(i), run, i);
      unsigned all = all_of(run.count - i);
      wrong |= uint64_t(negative_lanes(~verdict.same) & all) << i;
      guessed |= uint64_t(negative_lanes(verdict.guessed) & all) << i;
    }
    for (uint64_t rest = resting ? wrong & ~guessed : 0; rest != 0; rest &= rest - 1) {
      int i = std::countr_zero(rest);
      uint32_t point = resting->image.point[row + size_t(i)];
      if (point == no_point || !(resting->points.flags[point] & point_verified)) continue;
      if (!sight.moves(run.object[i]) && !sight.moves(frame.object[row + size_t(i)]))
        wrong &= ~(uint64_t(1) << i);
    }
    uint64_t wanted = wrong | guessed;
    if (!wanted) return;
    RunSurface surface;
    uint64_t alone = run.describe(wanted, surface);
    for (int i = 0; i < run.count; i += lanes) {
      unsigned told = unsigned((wanted & ~alone) >> i & 255),
               lost = unsigned((wrong & ~alone) >> i & 255);
      if (!told) continue;
      int x = run.x + i, count = std::min(run.count - i, lanes);
      size_t at = row + size_t(i);
      u8 albedo = pack_albedo(load<f8>(surface.red + i), load<f8>(surface.green + i),
                              load<f8>(surface.blue + i));
      put(frame, x, run.y, plane_albedo, albedo, told);
      f8 depth = lanes_of_bits(told) ? load_some<f8>(run.depth + i, count)
                               : load_some<f8>(&frame.depth[at], count);
      std::memcpy(&frame.depth[at], &depth, size_t(count) * sizeof(float));
      if (!lost) continue;  // the light of its neighbours will do
      i8 mask = lanes_of_bits(lost);
      u8 object = mask ? load_some<u8>(run.object + i, count)
                       : load_some<u8>(&frame.object[at], count);
      std::memcpy(&frame.object[at], &object, size_t(count) * sizeof(uint32_t));
      u8 normal = pack_normal(load<f8>(surface.nx + i), load<f8>(surface.ny + i),
                              load<f8>(surface.nz + i));
      u8 more = mask ? normal | uint32_t(blind_deviation) << 24
                     : load_some<u8>(&frame.confidence[at], count);
      std::memcpy(&frame.confidence[at], &more, size_t(count) * sizeof(uint32_t));
      put(frame, x, run.y, plane_rest, u8{}, lost);
      put(frame, x, run.y, plane_smooth, u8{}, lost);
    }
    for (; alone != 0; alone &= alone - 1) {
      int i = std::countr_zero(alone), x = run.x + i;
      size_t at = row + size_t(i);
      Seen seen = run.see(i);
      packed_word(frame, x, run.y, plane_albedo) = pack_albedo(seen.albedo);
      frame.depth[at] = std::min(run.depth[i], infinite_depth);
      if (!(wrong >> i & 1)) continue;
      frame.object[at] = run.object[i];
      bool shines = !seen.scatters || seen.glow != vec3(0);
      packed_word(frame, x, run.y, plane_rest) = pack_rgb9e5(seen.glow);
      packed_word(frame, x, run.y, plane_smooth) = 0;
      // What shines is known as well as it can be.
      uint32_t more =
          pack_normal(seen.normal) | (shines ? 255u << 16 : uint32_t(blind_deviation) << 24);
      frame.confidence[at] = std::bit_cast<float>(more);
    }
  });
}

}  // namespace wellspring
