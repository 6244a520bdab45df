// SPDX-License-Identifier: Apache-2.0
// Puts light on a run of pixels (light/visible/surface_buffer.h), eight at a time, for
// picture/compose_drawn.h.
#pragma once
#include <bit>
#include <cstdint>
#include <cstring>

#include "light/virtual/dynamic_image.h"
#include "light/visible/surface_buffer.h"
#include "picture/drawn_planes.h"
#include "world/raster/raster.h"

namespace wellspring::picture {

// Returns eight lanes of a run's array from lane `i` on, which may begin before it and end behind
// it.
inline Lanes lanes_at(const float* from, int i) {
  if (i >= 0) return load_lanes(from + i);  // arrays may be read up to eight beyond their end
  Lanes v{};
  std::memcpy(reinterpret_cast<float*>(&v) - i, from, size_t(lane_count + i) * sizeof(float));
  return v;
}

// Holds which of a run's pixels move, and their light.
struct RunMoving {
  uint64_t pixels = 0;  // one bit a pixel
  RunSkin light;
};

// Holds which of a run's pixels an illumination map lights, and its light.
struct RunMapped {
  uint64_t pixels = 0;  // one bit a pixel
  uint64_t plain = 0;   // those that the map alone lights
  RunKnown unit;
};

// Returns eight of a run's bits, from lane `i` on, which may begin before it.
inline unsigned bits_at(uint64_t bits, int i) {
  return unsigned(i < 0 ? bits << -i : bits >> i) & 0xff;
}

inline constexpr float skin_samples = 64;  // samples that the skin's light counts for

// Puts the radiance of those of eight pixels, from lane `i` on, that reflect the light of the skin.
inline void put_moving(const RunPixels& p, const RunSkin& skin, int i,
                       const LaneMask& lanes_that_move, Shown& shown) {
  const Lanes gloss = lanes_at(skin.gloss, i);
  auto put = [&](const float* light, const float* shine, const float* reflectance, Lanes& to) {
    const Lanes lit =
        lanes_at(light, i) * lanes_at(reflectance, i) * (1.0f - gloss) + lanes_at(shine, i) * gloss;
    to = lanes_that_move ? positive_lanes(lit) : to;
  };
  put(skin.red, skin.shine_red, p.surface.red, shown.color.r);
  put(skin.green, skin.shine_green, p.surface.green, shown.color.g);
  put(skin.blue, skin.shine_blue, p.surface.blue, shown.color.b);
  shown.samples = lanes_that_move ? all_lanes(skin_samples) : shown.samples;
}

// Puts the radiance of those of eight pixels, from lane `i` on, that a map alone lights; `raised`:
// as Sample::raised.
inline void put_plain(const RunPixels& p, const RunKnown& known, float raised, int i,
                      const LaneMask& lanes, Shown& shown) {
  const Lanes gloss = lanes_at(known.gloss, i);
  auto put = [&](const float* light, const float* reflectance, Lanes& to) {
    const Lanes lit =
        (lanes_at(light, i) - raised) * (lanes_at(reflectance, i) * (1.0f - gloss) + gloss);
    to = lanes ? positive_lanes(lit) : to;
  };
  put(known.red, p.surface.red, shown.color.r);
  put(known.green, p.surface.green, shown.color.g);
  put(known.blue, p.surface.blue, shown.color.b);
  shown.samples = lanes ? all_lanes(skin_samples) : shown.samples;
}

// A sphere around what moves, in the view's axes: moving things may change the light of surfaces in
// it.
struct Shade {
  static constexpr float reach = 2.5f;  // radius over half the size of what moves
  vec3 centre{0};                       // metres to the right, up and ahead
  float radius = 0;                     // metres; 0: nothing moves
  Shade() = default;
  Shade(const View& view, const Bounds& box) {
    if (!(box.low.x <= box.high.x)) return;
    const vec3 to = 0.5f * (box.low + box.high) - view.position;
    centre = {dot(to, view.right), dot(to, view.up), dot(to, view.forward)};
    radius = reach * 0.5f * length(box.high - box.low);
  }
  // Returns the pixels of a run that see a place in the sphere, a bit each, maybe others beyond.
  uint64_t pixels(const VisibleRun& run, const PixelRays& rays, vec2 offset) const {
    constexpr Lanes lane{0, 1, 2, 3, 4, 5, 6, 7};
    uint64_t found = 0;
    const float up = rays.y(float(run.y) + offset.y);
    for (int i = 0; radius > 0 && i < run.count; i += lane_count) {
      const Lanes depth = load_lanes(run.depth + i),
                  x = depth * (rays.x(float(run.x + i) + offset.x) + rays.inverse_focal * lane) -
                      centre.x,
                  y = depth * up - centre.y, z = depth - centre.z;
      found |= uint64_t(negative_lanes(x * x + y * y + z * z < radius * radius)) << i;
    }
    return found;
  }
};

// Returns the dynamic light of a run. `image`: null, or computed for pictures of `view`.
inline RunDynamic find_dynamic(const DynamicImage* image, const View& view, const VisibleRun& run,
                               const RunPixels& p) {
  RunDynamic found;
  if (image) read_dynamic_light(*image, view, run, p.surface, found);
  return found;
}

// Adds the dynamic light that the surfaces reflect.
inline void add_dynamic(const RunPixels& p, const RunDynamic& dynamic, int i, Shown& shown) {
  Color& c = shown.color;
  c.r += lanes_at(p.surface.red, i) * lanes_at(dynamic.light.red, i);
  c.g += lanes_at(p.surface.green, i) * lanes_at(dynamic.light.green, i);
  c.b += lanes_at(p.surface.blue, i) * lanes_at(dynamic.light.blue, i);
  if (!dynamic.any_gloss) return;
  c.r += lanes_at(dynamic.gloss.red, i), c.g += lanes_at(dynamic.gloss.green, i);
  c.b += lanes_at(dynamic.gloss.blue, i);
}

// Adds the light that eight pixels emit by themselves. `here`: lanes that count, a bit each.
inline void add_glow(const RunPixels& p, const RunGlow& emitting, int i, unsigned here,
                     Shown& shown) {
  const unsigned only = bits_at(emitting.only, i);
  for (unsigned bits = bits_at(emitting.some, i) & here; bits != 0; bits &= bits - 1) {
    int k = std::countr_zero(bits);
    Color& c = shown.color;
    if (only >> k & 1) c.r[k] = c.g[k] = c.b[k] = 0, shown.samples[k] = 255;
    c.r[k] += p.glow_red[i + k], c.g[k] += p.glow_green[i + k], c.b[k] += p.glow_blue[i + k];
  }
}

}  // namespace wellspring::picture
