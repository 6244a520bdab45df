// SPDX-License-Identifier: Apache-2.0
#include "cache/looks.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "cache/pixel_light.h"

namespace wellspring {
namespace {

// Two places of a pixel; its neighbours' are mirrored, so that no slope is always unlucky.
vec2 place_of(int x, int y, int k) {
  float across = k == 0 ? 0.25f : 0.75f;
  return {(x ^ y) & 1 ? 1 - across : across, across};
}

// Four pixels with two looks each, side by side: lanes 2p and 2p + 1 are pixel p's.
constexpr int group = lanes / looks_a_pixel;
static_assert(group * looks_a_pixel == lanes);

struct Looks {
  int x[group], y[group];  // of the pixels
  Pixels pixels;
  f8 place_x, place_y;   // in the pixel
  Color albedo, glow;
  i8 scatters;
};

// Of a group that is not whole, the last pixel stands in for the missing ones.
void read_looks(const View& view, const PixelRays& rays, std::span<const uint32_t> pixels,
                std::span<const Seen> seen, size_t first, Looks& l) {
  Pixels& p = l.pixels;
  for (int g = 0; g < group; g++) {
    size_t index = std::min(first + size_t(g), pixels.size() - 1);
    int x = l.x[g] = int(pixels[index] % uint32_t(view.width)),
        y = l.y[g] = int(pixels[index] / uint32_t(view.width));
    for (int k = 0; k < looks_a_pixel; k++) {
      int i = g * looks_a_pixel + k;
      const Seen& s = seen[index * looks_a_pixel + size_t(k)];
      vec2 place = place_of(x, y, k);
      l.place_x[i] = place.x, l.place_y[i] = place.y;
      p.x[i] = rays.x(float(x) + place.x), p.y[i] = rays.y(float(y) + place.y);
      float along = 1 / std::sqrt(p.x[i] * p.x[i] + p.y[i] * p.y[i] + 1);
      p.depth[i] = std::min(s.distance * along, infinite_depth);
      p.object[i] = s.object;
      p.nx[i] = s.normal.x, p.ny[i] = s.normal.y, p.nz[i] = s.normal.z;
      l.albedo.r[i] = s.albedo.x, l.albedo.g[i] = s.albedo.y, l.albedo.b[i] = s.albedo.z;
      l.glow.r[i] = s.glow.x, l.glow.g[i] = s.glow.y, l.glow.b[i] = s.glow.z;
      l.scatters[i] = s.scatters ? -1 : 0;
    }
  }
  p.normal2 = p.nx * p.nx + p.ny * p.ny + p.nz * p.nz;
}

// The packed surface of one pixel for each of the group, as lanes; beyond the picture nothing.
struct Neighbours {
  u8 plane[surface_planes];
};
Neighbours read_neighbours(const Frame& frame, const Looks& l, int dx, int dy) {
  alignas(32) uint32_t words[surface_planes][lanes];
  for (int g = 0; g < group; g++) {
    int x = l.x[g] + dx, y = l.y[g] + dy;
    uint32_t word[surface_planes] = {};
    word[plane_object] = no_object;
    if (x >= 0 && y >= 0 && x < frame.width && y < frame.height) read_packed(frame, x, y, word);
    for (int p = 0; p < surface_planes; p++)
      for (int k = 0; k < looks_a_pixel; k++) words[p][g * looks_a_pixel + k] = word[p];
  }
  Neighbours n;
  for (int p = 0; p < surface_planes; p++) n.plane[p] = load<u8>(words[p]);
  return n;
}

// Own light of the looks: that of the points in the pixels around, as far as they lie on the same
// surface, the nearer and the better known the more.
void gather_points(const View& view, const PixelRays& rays, const Frame& frame, Looks& l) {
  Pixels& p = l.pixels;
  auto along = [&](vec3 axis) { return p.nx * axis.x + p.ny * axis.y + p.nz * axis.z; };
  f8 vx = along(view.right), vy = along(view.up), vz = along(view.forward);
  f8 weights{}, samples{}, deviation{}, inverse_depth = 1.0f / (p.depth * plane_tolerance);
  f8 column, row;
  for (int i = 0; i < lanes; i++)
    column[i] = float(l.x[i / looks_a_pixel]), row[i] = float(l.y[i / looks_a_pixel]);
  Color smooth, rest;
  for (int dy = -1; dy <= 1; dy++)
    for (int dx = -1; dx <= 1; dx++) {
      Neighbours n = read_neighbours(frame, l, dx, dy);
      u8 more = n.plane[plane_more];
      f8 known = to_float((more >> 16) & 255u);
      i8 same = (p.object == n.plane[plane_object]) & (known > 0.0f);
      if (!any(same)) continue;
      f8 nx, ny, nz;
      unpack_octahedron(more & 0xffffu, nx, ny, nz);
      f8 facing = positive(p.nx * nx + p.ny * ny + p.nz * nz);
      facing *= facing / (nx * nx + ny * ny + nz * nz);
      facing *= facing, facing *= facing;
      f8 depth = as<f8>(n.plane[plane_depth]);
      f8 rx = (column + (float(dx) + 0.5f) - rays.half_width) * rays.inverse_focal,
         ry = (rays.half_height - (row + (float(dy) + 0.5f))) * rays.inverse_focal;
      f8 off = (vx * (p.depth * p.x - depth * rx) + vy * (p.depth * p.y - depth * ry) +
                vz * (p.depth - depth)) * inverse_depth;
      off = keep(l.albedo.r + l.albedo.g + l.albedo.b != 0.0f, off);  // mirrors' points are images
      f8 ax = l.place_x - (float(dx) + 0.5f), ay = l.place_y - (float(dy) + 0.5f);
      f8 weight = keep(same, facing / ((1.0f + off * off) * (0.25f + ax * ax + ay * ay)));
      f8 share = weight * known;
      weights += weight;
      samples += share;
      deviation += share * unpack_deviation(more >> 24);
      Color light, other;
      unpack_rgb9e5(n.plane[plane_smooth], light.r, light.g, light.b);
      add(smooth, share, light.r, light.g, light.b);
      unpack_rgb9e5(n.plane[plane_rest], light.r, light.g, light.b);
      unpack_albedo(n.plane[plane_albedo], other.r, other.g, other.b);
      add(rest, share, f8(light.r * rest_ratio(l.albedo.r, other.r)),
          f8(light.g * rest_ratio(l.albedo.g, other.g)),
          f8(light.b * rest_ratio(l.albedo.b, other.b)));
    }
  f8 share = 1.0f / larger(samples, splat(1e-6f));
  p.smooth = {smooth.r * share, smooth.g * share, smooth.b * share};
  p.rest = {rest.r * share, rest.g * share, rest.b * share};
  p.deviation = deviation * share;
  p.samples = keep(weights > 1e-3f, samples / larger(weights, splat(1e-6f)));
}

// The four cells around each pixel, and how much of each its places ask for.
struct Around {
  CellLightOf<f8, u8> corner[4];
  f8 weight[4];
};
void read_around(const Cells& cells, const Looks& l, Around& around) {
  constexpr float step = 1.0f / cell_size;
  f8 fx, fy;
  for (int g = 0; g < group; g++) {
    int bx = (l.x[g] + cell_size / 2) / cell_size - 1,
        by = (l.y[g] + cell_size / 2) / cell_size - 1;
    int lane = g * looks_a_pixel;
    for (int i = lane; i < lane + looks_a_pixel; i++) {
      fx[i] = (float(l.x[g]) + l.place_x[i]) * step - 0.5f - float(bx);
      fy[i] = (float(l.y[g]) + l.place_y[i]) * step - 0.5f - float(by);
    }
    for (int k = 0; k < 4; k++) {
      CellLight one;
      read_cell(cells, bx + (k & 1), by + (k >> 1), one);
      CellLightOf<f8, u8>& all = around.corner[k];
      for (int i = lane; i < lane + looks_a_pixel; i++) {
        for (int c = 0; c < 3; c++) {
          all.smooth[c][i] = one.smooth[c], all.rest[c][i] = one.rest[c];
          all.normal[c][i] = one.normal[c], all.plane[c][i] = one.plane[c];
        }
        all.patience[i] = one.patience, all.detail[i] = one.detail, all.noise[i] = one.noise;
        all.object[i] = one.object;
      }
    }
  }
  for (int k = 0; k < 4; k++)
    around.weight[k] = ((k & 1) ? fx : 1.0f - fx) * ((k >> 1) ? fy : 1.0f - fy);
}

void choose(const i8& mask, const Color& from, Color& to) {
  to.r = mask ? from.r : to.r, to.g = mask ? from.g : to.g, to.b = mask ? from.b : to.b;
}

// Where neither a point nor a cell around knows anything of a surface, it is lit as its
// surroundings are.
void light_unknown(const Around& around, const Looks& l, Surroundings& s) {
  i8 unknown = s.lonely & (l.pixels.samples == 0.0f);
  if (!any(unknown)) return;
  Surroundings anybody;
  for (int k = 0; k < 4; k++) add(anybody, around.weight[k], around.corner[k]);
  choose(unknown, anybody.smooth, s.smooth);
  choose(unknown, anybody.rest, s.rest);
  s.lonely &= ~unknown;
}

LookedPixel pixel_of(const Looks& l, int g) {
  const Pixels& p = l.pixels;
  LookedPixel pixel;
  pixel.depth = infinite_depth;
  for (int i = g * looks_a_pixel; i < (g + 1) * looks_a_pixel; i++) {
    vec3 albedo(l.albedo.r[i], l.albedo.g[i], l.albedo.b[i]),
        smooth(p.smooth.r[i], p.smooth.g[i], p.smooth.b[i]),
        rest(p.rest.r[i], p.rest.g[i], p.rest.b[i]), glow(l.glow.r[i], l.glow.g[i], l.glow.b[i]);
    vec3 light = l.scatters[i] ? max(albedo * smooth + rest, vec3(0)) : glow;
    pixel.color += light * (1.0f / looks_a_pixel);
    if (p.depth[i] > pixel.depth) continue;
    pixel.depth = p.depth[i];
    pixel.object = p.object[i];
  }
  if (pixel.depth >= 0.5f * infinite_depth) pixel.depth = std::numeric_limits<float>::infinity();
  return pixel;
}

}  // namespace

void make_looks(const View& view, std::span<const uint32_t> pixels, std::vector<Ray>& looks) {
  looks.resize(pixels.size() * looks_a_pixel);
  parallel_ranges(int(pixels.size()), 512, [&](int begin, int end) {
    for (size_t i = size_t(begin); i < size_t(end); i++) {
      int x = int(pixels[i] % uint32_t(view.width)), y = int(pixels[i] / uint32_t(view.width));
      for (int k = 0; k < looks_a_pixel; k++) {
        vec2 place = place_of(x, y, k);
        looks[i * looks_a_pixel + size_t(k)] =
            view_ray(view, float(x) + place.x, float(y) + place.y);
      }
    }
  });
}

void light_looks(const View& view, const Cells& cells, const Frame& frame,
                 std::span<const uint32_t> pixels, std::span<const Seen> seen,
                 std::vector<LookedPixel>& looked) {
  looked.resize(pixels.size());
  PixelRays rays(view);
  int groups = int((pixels.size() + group - 1) / group);
  parallel_ranges(groups, 64, [&](int begin, int end) {
    for (size_t first = size_t(begin) * group; first < size_t(end) * group; first += group) {
      Looks l;
      read_looks(view, rays, pixels, seen, first, l);
      gather_points(view, rays, frame, l);
      Around around;
      read_around(cells, l, around);
      const CellLightOf<f8, u8>* corners[4] = {&around.corner[0], &around.corner[1],
                                               &around.corner[2], &around.corner[3]};
      Surroundings s = look_around(corners, false, around.weight, l.pixels);
      light_unknown(around, l, s);
      blend_light(s, l.pixels);
      for (size_t g = 0; g < group && first + g < pixels.size(); g++)
        looked[first + g] = pixel_of(l, int(g));
    }
  });
}

void show_looks(std::span<const uint32_t> pixels, std::span<const LookedPixel> looked,
                const StillImage& still, Frame& frame) {
  constexpr float few_samples = 4;  // of a pixel: their mean is as good as the looks
  parallel_ranges(int(pixels.size()), 2048, [&](int begin, int end) {
    for (size_t i = size_t(begin); i < size_t(end); i++) {
      uint32_t at = pixels[i];
      float n = float(still.count[at] & ~still_fresh);
      frame.color[at] += (looked[i].color - frame.color[at]) * (few_samples / (n + few_samples));
      frame.object[at] = looked[i].object;
      frame.depth[at] = looked[i].depth;
    }
  });
}

}  // namespace wellspring
