// SPDX-License-Identifier: Apache-2.0
// Parts a picture into subsplats by a min-max pyramid, lights them by all VPLs and carries their
// light back to pixels.
//
// The min-max pyramid holds mipmaps of a picture (Nichols and Wyman 2009, section 3.2): of its
// depth, of the three components of its unit normals, and, which the paper lacks, of the distance
// of each pixel's tangent plane from the eye. A plane has one such distance however steeply it is
// looked at, so that its range of depth alone is no discontinuity.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "base/memory.h"
#include "base/simd.h"
#include "base/vec.h"
#include "light/transport_settings.h"
#include "light/virtual/virtual_lights.h"
#include "light/visible/surface_buffer.h"
#include "world/view.h"

namespace wellspring::light {

// Describes the pixels of a view that light falls on, row by row, as a visibility pass or rays
// found them. The arrays are borrowed, each of width * height numbers.

struct SplatPixels {
  View view;
  vec2 offset{0.5f};             // sampling place in its pixel
  const float* depth = nullptr;  // along the viewing axis; infinite, NaN, <= 0: nothing is lit
  const float *nx = nullptr, *ny = nullptr, *nz = nullptr;  // unit normal, towards the eye
  const vec3* position = nullptr;  // scene coordinates, if more exact than by depth; or null
};

inline bool is_lit(const SplatPixels& pixels, size_t i) {
  return pixels.depth[i] > 0 && pixels.depth[i] < std::numeric_limits<float>::infinity();
}
inline PixelGrid make_pixel_grid(const SplatPixels& pixels) {
  return PixelGrid(pixels.view, pixels.offset);
}
inline vec3 place_from_eye(const SplatPixels& pixels, const PixelGrid& grid, int x, int y) {
  size_t i = size_t(y) * size_t(pixels.view.width) + size_t(x);
  if (pixels.position) return pixels.position[i] - pixels.view.position;
  return (grid.corner + grid.right * float(x) + grid.down * float(y)) * pixels.depth[i];
}

// Holds the least depth, nx, ny, nz of a square of pixels, then the greatest, negated; and the same
// of its planes. Pixels where nothing is lit have infinite depth and nothing else: `low_high[0]` is
// infinite if there are no others, `low_high[4]` is -infinity if there is one of them.
struct MinMaxCell {
  float low_high[lane_count];
  float plane_low, plane_high;
};
// Returns the cell of both squares together.
inline MinMaxCell join_cells(const MinMaxCell& a, const MinMaxCell& b) {
  MinMaxCell both;
  store_lanes(both.low_high, lanes_min(load_lanes(a.low_high), load_lanes(b.low_high)));
  both.plane_low = a.plane_low < b.plane_low ? a.plane_low : b.plane_low;
  both.plane_high = a.plane_high > b.plane_high ? a.plane_high : b.plane_high;
  return both;
}

struct MinMaxLevel {
  int columns = 0, rows = 0;
  size_t first = 0;  // index of its first cell in `cells`
};
// Holds levels of squares: level k has squares of 2^k pixels; level 0, the picture, is not kept.
// The last column and row may stick out of the picture.
struct MinMaxPyramid {
  std::vector<MinMaxLevel> levels;
  RawVector<MinMaxCell> cells;
  const MinMaxCell& at(int level, int x, int y) const {
    const MinMaxLevel& l = levels[size_t(level)];
    return cells[l.first + size_t(y) * size_t(l.columns) + size_t(x)];
  }
};

// Returns the cell of one pixel alone.
MinMaxCell look_at_pixel(const SplatPixels& pixels, const PixelGrid& grid, int x, int y);

// Returns the coarsest level of a picture by the settings, 0: pixels alone; then the finest.
int coarsest_level(const SplatSettings& settings, int width, int height);
inline int finest_level(const SplatSettings& settings, int coarsest) {
  return settings.levels < 0 || settings.levels > coarsest ? 0 : coarsest - settings.levels;
}
// Makes level `coarsest` and those below. Runs on all cores.
void make_min_max_pyramid(const SplatPixels& pixels, int coarsest, MinMaxPyramid& pyramid);

// Returns whether depth and normals vary more than one subsplat may hide, for a cell with something
// lit.
inline bool is_discontinuous(const MinMaxCell& cell, const SplatSettings& settings) {
  const float* v = cell.low_high;
  const float most = settings.normal_threshold;
  bool alike = -v[1] - v[5] <= most && -v[2] - v[6] <= most && -v[3] - v[7] <= most;
  if (!alike) return true;
  float allowed = settings.depth_threshold * v[0];
  if (-v[4] - v[0] <= allowed) return false;
  return !(cell.plane_high - cell.plane_low <= allowed) ||
         !(-v[4] < std::numeric_limits<float>::infinity());
}

// Carries light from subsplats back to pixels, coarse to fine (Nichols and Wyman 2009, section
// 3.5): a texel without light of its own takes the bilinear mean of the level above, of those
// texels only that hold some and that no discontinuity parts from the one it lies in. So light is
// neither pulled from empty texels nor spread across an edge, even along the border of two coarse
// texels.

// Holds the paper's illumination buffer: irradiance of each subsplat at its own resolution.

// Holds irradiance, W/m^2; `held` is 1, or 0 if the texel has none.
struct IlluminationTexel {
  float red = 0, green = 0, blue = 0, held = 0;
};

struct IlluminationLevel {
  int columns = 0, rows = 0;
  RawVector<IlluminationTexel> texels;  // at least columns * rows
  IlluminationTexel& at(int x, int y) { return texels[size_t(y) * size_t(columns) + size_t(x)]; }
  const IlluminationTexel& at(int x, int y) const {
    return texels[size_t(y) * size_t(columns) + size_t(x)];
  }
};

// Level k has squares of 2^k pixels.
struct IlluminationPyramid {
  std::vector<IlluminationLevel> levels;
};

// Holds for each texel the neighbours that it may be mixed with: workspace.
struct UpsampleRoom {
  RawVector<uint8_t> joined;
};

// Fills every texel below those that hold light, and writes level 0 to `irradiance`, 0 where
// nothing is lit. settings.detail: the surface detail term of section 4.2, by the cosine between
// normal and eye, where no subsplat was a pixel. Runs on all cores.
void upsample(const SplatPixels& pixels, const MinMaxPyramid& pyramid,
              const SplatSettings& settings, IlluminationPyramid& illumination, UpsampleRoom& room,
              std::span<vec3> irradiance);

// Adds up the light of all VPLs on each subsplat, by eight lights at a time (Nichols and
// Wyman 2009, section 3.4).

// Finds squares of pixels that are lit as one (Nichols and Wyman 2009, section 3.3): from about 16
// x 16 on, each is parted into four where the pyramid finds a discontinuity, down to single pixels.
// One list serves all VPLs, as the paper has it for matte surfaces.

// A subsplat is a column and a row among the squares of its level.
struct Subsplat {
  uint16_t x = 0, y = 0;
  uint8_t level = 0;  // level of the pyramid: 2^level pixels a side
};
inline constexpr int most_splat_side = 0xffff;  // pixels

// Holds subsplats that together cover every pixel where something is lit, once; none is without
// such a pixel. Subsplats of one coarsest square follow each other.
struct Subsplats {
  RawVector<Subsplat> list;
  size_t count = 0;  // used part of `list`; the remainder is room
  int coarsest = 0;
  RawVector<uint32_t> first;   // index of each coarsest square's first: workspace
  RawVector<uint8_t> split;    // 1 for each subsplat to be parted; workspace
  RawVector<Subsplat> parted;  // workspace
  std::span<const Subsplat> all() const { return {list.data(), count}; }
};

// Makes the list on all cores.
void make_subsplats(const SplatPixels& pixels, const MinMaxPyramid& pyramid,
                    const SplatSettings& settings, Subsplats& subsplats);

// Replaces the subsplats that `split` marks, none of them a pixel, by those of their four parts
// that have something lit.
void part_subsplats(const SplatPixels& pixels, Subsplats& subsplats);

// Finds the lit pixel that a subsplat is lit by: its middle, or its first lit one if nothing is lit
// in the middle. Returns false if there is none.
bool find_lit_pixel(const SplatPixels& pixels, const Subsplat& subsplat, int& x, int& y);

// Returns the irradiance at a place with nothing in between. `each`: null, or room for
// lights.padded() numbers, the luminance of what each light adds.
vec3 sum_virtual_lights(const VirtualLights& lights, vec3 position, vec3 normal,
                        float* each = nullptr);

// Returns light that a texel can hold: sums may overflow.
inline vec3 bounded_light(vec3 light) {
  constexpr float most = 1e30f;
  auto bounded = [](float v) { return v > 0 ? (v < most ? v : most) : 0.0f; };  // NaN: 0
  return {bounded(light.x), bounded(light.y), bounded(light.z)};
}

// Returns the irradiance by one light.
vec3 eval_virtual_light(const VirtualLights& lights, size_t light, vec3 position, vec3 normal);

// Makes `to` empty and as large as the picture of `pyramid`. Runs on all cores.
void clear_illumination(const MinMaxPyramid& pyramid, IlluminationPyramid& to);

// Puts each subsplat's irradiance into its texel, without shadows. Runs on all cores.
void splat_lights(const SplatPixels& pixels, const VirtualLights& lights,
                  std::span<const Subsplat> subsplats, IlluminationPyramid& to);

// Refines by convergence, which the paper proposes (section 5): of subsplats whose texels hold
// their light, those become four, level by level, between which and their neighbours linear
// interpolation would miss more than settings.convergence of the light. `to` then holds the light
// of the refined `subsplats`. Returns how many more places were lit.
uint64_t refine_by_convergence(const SplatPixels& pixels, const MinMaxPyramid& pyramid,
                               const VirtualLights& lights, const SplatSettings& settings,
                               Subsplats& subsplats, IlluminationPyramid& to);

}  // namespace wellspring::light
