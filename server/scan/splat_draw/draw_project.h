// SPDX-License-Identifier: Apache-2.0
// Brings splats to the picture: elliptical weighted averages (Zwicker et al. 2001, as in Kerbl et
// al. 2023, section 4), widened to the size of a pixel with their opacity lowered to match (Yu et
// al. 2024, "Mip-Splatting", section 4.2), and their colours as seen from the eye.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "scan/splat_draw/draw_shown.h"
#include "scan/camera.h"

namespace wellspring::scan {

inline constexpr float splat_threshold = 1 / 255.0f;  // less opacity at a pixel is not drawn
inline constexpr float log_threshold = -7.9943534f;   // its logarithm to base 2
inline constexpr float most_opacity = 0.99f;  // a splat hides no more of a pixel, as in training

// Pixels of a rectangle, the last ones included.
struct PixelBox {
  int16_t left, top, right, bottom;
};

// A splat in the picture, a cache line. Pixel (i, j) lies at (i, j). In row j the splat is widest
// at x_j = x + lean * (j - y), and its opacity is 2 to the power of
// opacity - fall_y * (j - y)^2 - fall_x * (i - x_j)^2.
struct alignas(64) DrawnSplat {
  float x, y, lean, fall_x, fall_y, opacity;
  vec3 color;  // display codes, 0 to 1 and above
  // One over the depth (metres) of the place at which the ray of a pixel passes most of the splat:
  // nearness + slope_y * (j - y) + slope_x * (i - x_j), but no less than `farthest` and no more
  // than `nearest`. For flat splats it is where the ray meets their plane.
  float nearness, slope_x, slope_y, farthest, nearest;
  PixelBox box;
};

struct DrawnKey {
  uint32_t depth, number;  // order from the front; index of the splat
};

// Splats in the picture, no matter in which order; memory is kept from picture to picture.
struct DrawnSplats {
  std::vector<DrawnSplat> splats;  // some places are not used
  std::vector<PixelBox> boxes;     // those of `splats`, side by side
  std::vector<DrawnKey> keys;      // those of all that are seen
  int64_t looked_at = 0;           // splats that nodes brought here
};

struct ProjectSettings {
  float blur = 0.3f;           // variance of the pixel's filter, square pixels
  bool keep_opacity = false;   // splats become wider by the filter, but not clearer
  float cell_pixels = 1;       // cells of merged splats are at most so large in the picture
  int64_t budget = INT64_MAX;  // about as many splats at most, by larger cells
  bool nearest_first = false;  // keys are by the nearest depth, not by that of the middle
};

void project_splats(DrawnSplats& drawn, std::span<const PlacedSplats> sets, const ScanCamera& view,
                    const ProjectSettings& settings);

}  // namespace wellspring::scan
