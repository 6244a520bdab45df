// SPDX-License-Identifier: Apache-2.0
// What the points say about every pixel, before light is put together: the planes that
// reconstruction works on. Borrowed from a Scratch for the length of one frame.
#pragma once
#include <cstdint>
#include <span>

#include "cache/point_cache.h"
#include "cache/point_image.h"
#include "cache/scratch.h"
#include "frame/frame.h"
#include "world/view.h"

namespace wellspring {

struct SurfaceImage {
  std::span<uint32_t> albedo;  // pack_albedo
  std::span<uint32_t> rest;    // pack_rgb9e5
  std::span<uint16_t> normal;  // pack_normal
};

inline size_t surface_bytes(size_t pixels) {
  return 2 * Scratch::rounded<uint32_t>(pixels) + Scratch::rounded<uint16_t>(pixels);
}

// Rays through pixel centres in view coordinates (right, up, forward = 1).
struct PixelRays {
  float half_width, half_height, inverse_focal;
  explicit PixelRays(const View& view)
      : half_width(0.5f * float(view.width)),
        half_height(0.5f * float(view.height)),
        inverse_focal(view.tan_half_fov * 2 / float(view.height)) {}
  float x(float column) const { return (column - half_width) * inverse_focal; }
  float y(float row) const { return (half_height - row) * inverse_focal; }
};

// What gather_surface() saw on its way.
struct SurfaceCounts {
  int64_t points = 0;     // pixels with a point
  int64_t ages = 0;       // their sum
  int64_t converged = 0;  // pixels whose point holds `converged_samples` or more
};
inline constexpr int converged_samples = 32;

// Reads every visible point: fills the planes and, of `frame`, color (the point's own smooth
// light), confidence (its samples), depth and object; pixels without a point get 0 everywhere.
SurfaceCounts gather_surface(const PointCache& points, const PointImage& image,
                             SurfaceImage& surface, Frame& frame);

}  // namespace wellspring
