// SPDX-License-Identifier: Apache-2.0
// Takes triangles from the eye's coordinates to pixels: clips them if needed, and makes their edges
// and interpolated values linear functions of the picture place. Pixels are counted from the
// picture's centre, x to the right, y down.
#pragma once
#include <cstdint>
#include <vector>

#include "base/vec.h"

namespace wellspring::world {

// Subdivision of a pixel to which corners are rounded; the furthest pixel from the centre that they
// may reach.
inline constexpr int raster_step_bits = 8, raster_steps = 1 << raster_step_bits;
inline constexpr float raster_reach = 4096;

// Holds a corner before division: picture place is (x, y) / w.
struct RasterCorner {
  float x = 0, y = 0, w = 0;
  vec2 barycentric{0};
};

// Holds a corner after division.
struct RasterPoint {
  float x, y, depth;  // picture place, inverse depth
  vec2 barycentric;
  int32_t step_x, step_y;  // the place, rounded
};

// Holds corners of many triangles; the second half is meaningless if `outside` is not 0.
struct RasterCorners {
  static constexpr int most = 256;
  alignas(32) float x[most], y[most], w[most];
  alignas(32) float picture_x[most], picture_y[most], depth[most];
  alignas(32) int32_t step_x[most], step_y[most];
  // A bit for each plane of the visible space behind which the corner is.
  alignas(32) int32_t outside[most];
};

struct RasterTriangle {
  // Twice the area on the inner side of edge i at (x, y), in steps from the picture's centre, is
  // a * (x - from.x) + b * (y - from.y) + bias; inside: none of the three is negative.
  int32_t a[3], b[3], from_x[3], from_y[3], bias[3];
  uint32_t instance, triangle;
  float width;  // least width with its neighbours, pixels over inverse depth
  bool bar;     // MeshNeighbours::bar (world/raster/raster_edges.h)
  // Inverse depth, and inverse depth times the barycentrics: value at `corner` and slopes a pixel.
  vec2 corner;
  vec3 depth, u, v;  // value, slope along x, slope along y
  float least_depth, most_depth;
  int16_t left, top, right, bottom;  // pixels it may cover, inclusive, from the picture's top left
  bool has_alpha;
  bool one_sided, mirrored;  // as in PlacedMesh
  bool turned;               // its corners in the mesh are the first, the third and the second
  bool clipped;              // its corners differ from those in the mesh
  uint8_t veils;             // its material's RasterSettings::see_through
};

struct RasterView {
  float near = 0;  // smallest w
  int width = 0, height = 0;
  float centre_x = 0,
        centre_y = 0;  // picture centre minus sampling offset: pixel i samples i - centre
  int32_t centre_steps_x = 0, centre_steps_y = 0;  // the same in steps, exactly
};

// Fills all but x, y and w of the first `count` corners, a multiple of eight.
void project_corners(const RasterView& view, int count, RasterCorners& corners);

// Appends the parts of triangle (i, j, k) that can cover a sampling place. `unfinished` holds
// instance, triangle, has_alpha, bar, veils and width.
void add_triangle(const RasterView& view, const RasterCorners& corners, int i, int j, int k,
                  const RasterTriangle& unfinished, std::vector<RasterTriangle>& out);

}  // namespace wellspring::world
