// SPDX-License-Identifier: Apache-2.0
#include "cache/reconstruct.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/parallel.h"
#include "base/rng.h"
#include "cache/packing.h"

namespace wellspring {

SurfaceCounts gather_surface(const PointCache& points, const PointImage& image, SurfaceImage& surface, Frame& frame) {
  constexpr size_t ahead = 24;  // pixels by which point data is fetched early
  std::atomic<int64_t> shown{0}, ages{0}, converged{0};
  parallel_ranges(image.height, 8, [&](int begin, int end) {
    size_t first = size_t(begin) * size_t(image.width), last = size_t(end) * size_t(image.width);
    SurfaceCounts here;
    for (size_t i = first; i < last; i++) {
      if (i + ahead < last && image.point[i + ahead] != no_point) {
        __builtin_prefetch(&points.color[image.point[i + ahead]]);
        __builtin_prefetch(&points.normal[image.point[i + ahead]]);
      }
      uint32_t point = image.point[i];
      if (point == no_point) {
        surface.albedo[i] = surface.rest[i] = 0;
        surface.normal[i] = 0;
        frame.color[i] = vec3(0);
        frame.confidence[i] = 0;
        frame.depth[i] = 0;
        frame.object[i] = 0;
        continue;
      }
      const PointColor& color = points.color[point];
      surface.albedo[i] = color.albedo;
      surface.rest[i] = color.rest;
      surface.normal[i] = points.normal[point];
      frame.color[i] = unpack_rgb9e5(color.smooth);
      frame.confidence[i] = float(points.count[point]);
      frame.depth[i] = image.depth[i];
      frame.object[i] = color.object;
      here.points++;
      here.ages += points.age[point];
      here.converged += points.count[point] >= converged_samples;
    }
    shown += here.points;
    ages += here.ages;
    converged += here.converged;
  });
  return {shown, ages, converged};
}

namespace {

struct Neighbour {
  size_t pixel;
  float weight;
};

// The neighbours of the object with most weight among the eight around (x, y).
int choose_neighbours(const PointImage& image, const Frame& frame, int x, int y, Neighbour* chosen) {
  Neighbour all[8];
  int count = 0;
  for (int dy = -1; dy <= 1; dy++) {
    int ny = y + dy;
    if (ny < 0 || ny >= image.height) continue;
    for (int dx = -1; dx <= 1; dx++) {
      int nx = x + dx;
      if (nx < 0 || nx >= image.width || (dx == 0 && dy == 0)) continue;
      size_t i = size_t(ny) * size_t(image.width) + size_t(nx);
      if (image.point[i] != no_point) all[count++] = {i, dx == 0 || dy == 0 ? 2.0f : 1.0f};
    }
  }
  float best = 0;
  uint32_t object = no_object;
  for (int i = 0; i < count; i++) {
    float support = 0;
    for (int j = 0; j < count; j++)
      if (frame.object[all[j].pixel] == frame.object[all[i].pixel]) support += all[j].weight;
    if (support > best) best = support, object = frame.object[all[i].pixel];
  }
  int kept = 0;
  for (int i = 0; i < count; i++)
    if (frame.object[all[i].pixel] == object) chosen[kept++] = all[i];
  return kept;
}

// A pixel from the cells around it: bilinear among those of the object with most weight.
void fill_from_cells(const PixelRays& rays, const mat3& to_world, const Cells& cells, int x, int y, size_t i,
                     SurfaceImage& surface, Frame& frame) {
  int cx = (x + cell_size / 2) / cell_size - 1, cy = (y + cell_size / 2) / cell_size - 1;
  float fx = (float(x) + 0.5f) / cell_size - 0.5f - float(cx), fy = (float(y) + 0.5f) / cell_size - 0.5f - float(cy);
  size_t cell[4];
  float weight[4];
  for (int k = 0; k < 4; k++) {
    int ax = std::clamp(cx + (k & 1), 0, cells.width - 1), ay = std::clamp(cy + (k >> 1), 0, cells.height - 1);
    cell[k] = size_t(cells.index(ax, ay));
    weight[k] = ((k & 1) ? fx : 1 - fx) * ((k >> 1) ? fy : 1 - fy) + 1e-4f;
  }
  float best = 0;
  uint32_t object = no_object;
  for (int k = 0; k < 4; k++) {
    float support = 0;
    for (int j = 0; j < 4; j++)
      if (cells.object[cell[j]] == cells.object[cell[k]]) support += weight[j];
    if (support > best) best = support, object = cells.object[cell[k]];
  }
  vec3 albedo(0), rest(0), smooth(0), normal(0);
  float inverse_depth = 0, sum = 0;
  vec3 ray(rays.x(float(x) + 0.5f), rays.y(float(y) + 0.5f), 1);
  for (int k = 0; k < 4; k++) {
    if (cells.object[cell[k]] != object) continue;
    for (size_t c = 0; c < 3; c++) {
      albedo[int(c)] += weight[k] * cells.albedo[c][cell[k]];
      rest[int(c)] += weight[k] * cells.rest[c][cell[k]];
      smooth[int(c)] += weight[k] * cells.smooth[c][cell[k]];
      normal[int(c)] += weight[k] * cells.normal[c][cell[k]];
    }
    vec3 plane(cells.plane[0][cell[k]], cells.plane[1][cell[k]], cells.plane[2][cell[k]]);
    float middle = 1 / cells.depth[cell[k]];
    inverse_depth += weight[k] * std::clamp(dot(plane, ray), 0.5f * middle, 2 * middle);
    sum += weight[k];
  }
  float share = 1 / sum;
  surface.albedo[i] = pack_albedo(albedo * share);
  surface.rest[i] = pack_rgb9e5(rest * share);
  surface.normal[i] = pack_normal(to_world * normal);
  frame.color[i] = smooth * share;
  frame.depth[i] = sum / inverse_depth;
  frame.object[i] = object;
}

}  // namespace

void fill_holes(const View& view, const PointImage& image, const Cells& cells, bool known,
                SurfaceImage& surface, Frame& frame) {
  PixelRays rays(view);
  mat3 to_world(view.right, view.up, view.forward);
  parallel_ranges(image.height, 4, [&](int begin, int end) {
    for (int y = begin; y < end; y++)
      for (int x = 0; x < image.width; x++) {
        size_t i = size_t(y) * size_t(image.width) + size_t(x);
        if (image.point[i] != no_point) continue;
        Neighbour near[8];
        int count = choose_neighbours(image, frame, x, y, near);
        if (count == 0) {
          if (known) fill_from_cells(rays, to_world, cells, x, y, i, surface, frame);
          continue;
        }
        vec3 albedo(0), rest(0), smooth(0);
        float inverse_depth = 0, sum = 0;
        for (int k = 0; k < count; k++) {
          size_t j = near[k].pixel;
          albedo += near[k].weight * unpack_albedo(surface.albedo[j]);
          rest += near[k].weight * unpack_rgb9e5(surface.rest[j]);
          smooth += near[k].weight * frame.color[j];
          inverse_depth += near[k].weight / frame.depth[j];
          sum += near[k].weight;
        }
        surface.albedo[i] = pack_albedo(albedo / sum);
        surface.rest[i] = pack_rgb9e5(rest / sum);
        surface.normal[i] = surface.normal[near[0].pixel];
        frame.color[i] = smooth / sum;
        frame.depth[i] = sum / inverse_depth;
        frame.object[i] = frame.object[near[0].pixel];
      }
  });
}

}  // namespace wellspring
