// SPDX-License-Identifier: Apache-2.0
// Writes the pixels of a drawn picture, eight at a time.
#pragma once
#include <algorithm>

#include "frame/frame.h"
#include "frame/tonemap.h"
#include "picture/cells/pixel_light.h"

namespace wellspring::picture {

// Holds eight lit pixels of a row.
struct Shown {
  Color color;
  Lanes samples, depth;  // depth: metres; infinity: nothing there
  LaneBits object;
};

// The pixels [begin, end) of eight that are written to a plane; lane `begin` comes first there.
struct LanePart {
  int begin, end;
  bool all() const { return end - begin == lane_count; }
  unsigned bits() const { return (1u << end) - (1u << begin); }
  template <class T, class V>
  void put(T* to, const V& from) const {
    if (all()) return store_lanes(to, from);
    std::memcpy(to, reinterpret_cast<const T*>(&from) + begin, size_t(end - begin) * sizeof(T));
  }
};

// Writes all planes of a frame.
struct FramePlanes {
  Frame& frame;
  Lanes differ(uint32_t pixel, uint32_t step, int count) const {
    Lanes codes{};
    for (int k = 0; k < count; k++) {
      const size_t at = pixel + size_t(k);
      // Light without a white: any difference counts.
      codes[k] = frame.color[at] == frame.color[at + step] ? 0 : 1 << 16;
    }
    return codes;
  }
  void put(size_t at, LanePart part, const Shown& s) const {
    float cut[3 * lane_count], *color = part.all() ? &frame.color[at].x : cut;
    const Color& c = s.color;
    interleave(wellspring::frame::part<0>(c.r), wellspring::frame::part<0>(c.g),
               wellspring::frame::part<0>(c.b), color);
    interleave(wellspring::frame::part<4>(c.r), wellspring::frame::part<4>(c.g),
               wellspring::frame::part<4>(c.b), color + 12);
    if (!part.all())
      std::memcpy(&frame.color[at].x, cut + 3 * part.begin,
                  size_t(part.end - part.begin) * sizeof(vec3));
    part.put(&frame.confidence[at], s.samples / (s.samples + 8.0f));
    part.put(&frame.depth[at], s.depth);
    part.put(&frame.object[at], s.object);
  }
};

// Lays pixels that are nearer than the frame's over it.
struct NearerPlanes {
  Frame& frame;
  void put(size_t at, LanePart part, const Shown& s) const {
    for (int k = part.begin; k < part.end; k++, at++) {
      if (!(s.depth[k] < frame.depth[at])) continue;
      frame.color[at] = vec3(s.color.r[k], s.color.g[k], s.color.b[k]);
      frame.confidence[at] = s.samples[k] / (s.samples[k] + 8.0f);
      frame.depth[at] = s.depth[k];
      frame.object[at] = s.object[k];
    }
  }
};

// Lays pixels that are nearer over a picture for the eye.
struct NearerEyePlanes {
  float exposure;
  const float* disparity;  // 1 / depth of that picture
  uint8_t* covered;        // becomes 0 at pixels that were laid over
  float* nearer;           // becomes 1 / the new depth there; null: not wanted
  uint8_t *rgb, *peaks;    // as EyePlanes'
  void put(size_t at, LanePart part, const Shown& s) const {
    const Color& c = s.color;
    Lanes3 light = Lanes3{c.r, c.g, c.b} * all_lanes(exposure);
    uint8_t bytes[3 * lane_count];
    store_pixels(bytes, eval_tone_curve(light));
    LaneMask peak = eval_peak_codes(max_component(light));
    for (int k = part.begin; k < part.end; k++, at++) {
      if (!(s.depth[k] * disparity[at] < 1)) continue;
      std::memcpy(rgb + 3 * at, bytes + 3 * k, 3);
      peaks[at] = uint8_t(peak[k]);
      covered[at] = 0;
      if (nearer) nearer[at] = 1 / s.depth[k];
    }
  }
};

// Writes a picture for the eye.
struct EyePlanes {
  float exposure;
  uint8_t *rgb, *peaks;  // codes of the shown colours, and eval_peak_codes() of their light
  float* depth;          // null: not wanted
  // Returns how much pixels differ from those `step` farther, in codes; light beyond white counts
  // for more than its codes show.
  Lanes differ(uint32_t pixel, uint32_t step, int count) const {
    uint8_t one[3 * lane_count] = {}, other[3 * lane_count] = {}, peak[lane_count] = {};
    const uint8_t *a = rgb + 3 * size_t(pixel), *b = a + 3 * size_t(step);
    std::memcpy(one, a, 3 * size_t(count)), std::memcpy(other, b, 3 * size_t(count));
    for (int i = 0; i < 3 * lane_count; i++)
      one[i] = std::max(one[i], other[i]) - std::min(one[i], other[i]);
    for (int k = 0; k < count; k++)
      peak[k] = std::max(peaks[pixel + uint32_t(k)], peaks[pixel + step + uint32_t(k)]);
    Lanes codes;
    for (int k = 0; k < lane_count; k++)
      codes[k] = std::max({one[3 * k], one[3 * k + 1], one[3 * k + 2]});
    if (peak_of(*std::max_element(peak, peak + lane_count)) <= 1) return codes;
    for (int k = 0; k < lane_count; k++)
      codes[k] = std::floor(codes[k] * std::max(peak_of(peak[k]), 1.0f));
    return codes;
  }
  void put(size_t at, LanePart part, const Shown& s) const {
    const Color& c = s.color;
    Lanes3 light = Lanes3{c.r, c.g, c.b} * all_lanes(exposure);
    LaneMask codes = eval_tone_curve(light);
    using Bytes = uint8_t __attribute__((vector_size(lane_count)));
    Bytes peak = __builtin_convertvector(eval_peak_codes(max_component(light)), Bytes);
    if (part.all()) {
      store_pixels(rgb + 3 * at, codes);
    } else {
      uint8_t bytes[3 * lane_count];
      store_pixels(bytes, codes);
      std::memcpy(rgb + 3 * at, bytes + 3 * part.begin, 3 * size_t(part.end - part.begin));
    }
    part.put(peaks + at, peak);
    if (depth) part.put(depth + at, s.depth);
  }
};

// Reads the points of eight pixels of a picture, as picture/cells/surface_image.h packs them.

struct OwnLight {
  LaneBits plane[surface_planes];
};
// Reads eight pixels, not all of which are in the picture.
[[gnu::noinline]] inline void read_cut(const Frame& light, int lx, int ly,
                                       uint32_t (*words)[lane_count]) {
  for (int p = 0; p < surface_planes; p++)
    std::fill_n(words[p], lane_count, p == plane_object ? no_object : 0);
  for (int x = std::max(lx, 0); x < std::min(lx + lane_count, light.width); x++) {
    uint32_t word[surface_planes];
    read_packed(light, x, ly, word);
    for (int p = 0; p < surface_planes; p++) words[p][x - lx] = word[p];
  }
}
inline OwnLight read_own(const Frame& light, int lx, int ly) {
  OwnLight own;
  if (lx < 0 || lx + lane_count > light.width) {
    uint32_t words[surface_planes][lane_count];
    read_cut(light, lx, ly, words);
    for (int p = 0; p < surface_planes; p++) own.plane[p] = load_lanes<LaneBits>(words[p]);
    return own;
  }
  size_t at = size_t(ly) * size_t(light.width) + size_t(lx);
  auto bits = [&](const std::vector<float>& plane) {
    return reinterpret_cast<const uint32_t*>(&plane[at]);
  };
  own.plane[plane_object] = load_lanes<LaneBits>(&light.object[at]);
  own.plane[plane_more] = load_lanes<LaneBits>(bits(light.confidence));
  own.plane[plane_depth] = load_lanes<LaneBits>(bits(light.depth));
  const uint32_t* words = packed_words(light, lx, ly);
  for (int p : {plane_albedo, plane_rest, plane_smooth}) {
    const uint32_t* four = words + packed_four * p;
    own.plane[p] = join_halves(load_lanes<HalfLaneBits>(four),
                               load_lanes<HalfLaneBits>(four + 3 * packed_four));
  }
  return own;
}

}  // namespace wellspring::picture
