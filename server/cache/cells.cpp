// SPDX-License-Identifier: Apache-2.0
#include "cache/cells.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "cache/packing.h"

namespace wellspring {
namespace {

constexpr int float_planes = 3 * 6 + 9;  // all but object

size_t padded(int width, int height) {
  int columns = (width + cell_size - 1) / cell_size, rows = (height + cell_size - 1) / cell_size;
  return size_t(columns + 2 * cell_pad) * size_t(rows + 2 * cell_pad) + cell_run;
}

// Plane through a place, seen at ray (x, y, 1) in depth z: coefficients of inverse depth over the
// picture.
vec3 inverse_depth_plane(vec3 normal, float x, float y, float z) {
  vec3 ray(x, y, 1);
  float facing = dot(normal, ray);
  // A plane seen edge-on would reach from the eye to infinity within a pixel; bend it towards the
  // viewer.
  float least = -0.05f * length(ray);
  if (!(facing < least)) {
    normal = normalize(normal - ray * ((facing - least) / dot(ray, ray)));
    facing = dot(normal, ray);
  }
  return normal / (facing * z);
}

struct Gathered {
  uint32_t object = no_object;
  vec3 albedo{0}, rest{0}, smooth{0}, normal{0};
  float x = 0, y = 0, inverse_depth = 0, samples = 0, points = 0, sum = 0, sum2 = 0;
  float rest_sum2 = 0, rest_noise = 0, rest_known = 0;
};

// The object most pixels of a cell see (majority vote of Boyer and Moore), then the mean over it.
Gathered gather_cell(const PointCache& points, const PointImage& image, const SurfaceImage& surface,
                     const Frame& frame, int cx, int cy) {
  int x0 = cx * cell_size, y0 = cy * cell_size;
  int x1 = std::min(x0 + cell_size, image.width), y1 = std::min(y0 + cell_size, image.height);
  Gathered g;
  int votes = 0;
  size_t pixels[cell_size * cell_size];
  int count = 0;
  for (int y = y0; y < y1; y++)
    for (int x = x0; x < x1; x++) {
      size_t i = size_t(y) * size_t(image.width) + size_t(x);
      if (image.point[i] == no_point) continue;
      pixels[count++] = i;
      uint32_t object = frame.object[i];
      if (votes == 0) g.object = object;
      votes += object == g.object ? 1 : -1;
    }
  vec3 reference(0);
  for (int k = 0; k < count; k++) {
    size_t i = pixels[k];
    if (frame.object[i] != g.object) continue;
    vec3 normal = unpack_normal(surface.normal[i]);
    if (g.points == 0)
      reference = normal;
    else if (dot(normal, reference) < 0.7f)
      continue;  // beyond a crease
    float samples = frame.confidence[i];
    vec3 smooth = frame.color[i];
    g.albedo += unpack_albedo(surface.albedo[i]);
    vec3 rest = unpack_rgb9e5(surface.rest[i]);
    g.rest += rest * samples;
    float rest_light = luminance(rest);
    g.rest_sum2 += samples * rest_light * rest_light;
    if (samples > 1) {
      float deviation = unpack_deviation(points.noise[image.point[i]]);
      g.rest_noise += deviation * deviation;
      g.rest_known += 1;
    }
    g.smooth += smooth * samples;
    g.normal += normal;
    g.x += float(i % size_t(image.width)) + 0.5f;
    g.y += float(i / size_t(image.width)) + 0.5f;
    g.inverse_depth += 1 / frame.depth[i];
    g.samples += samples;
    g.points += 1;
    float light = luminance(smooth);
    g.sum += samples * light;
    g.sum2 += samples * light * light;
  }
  return g;
}

}  // namespace

size_t cells_bytes(int width, int height) {
  return float_planes * Scratch::rounded<float>(padded(width, height)) +
         Scratch::rounded<uint32_t>(padded(width, height));
}

void take_cells(Cells& cells, int width, int height, Scratch& scratch) {
  cells.width = (width + cell_size - 1) / cell_size;
  cells.height = (height + cell_size - 1) / cell_size;
  cells.stride = cells.width + 2 * cell_pad;
  size_t count = padded(width, height);
  auto take = [&] {
    std::span<float> plane = scratch.take<float>(count);
    std::fill(plane.begin(), plane.end(), 0.0f);
    return plane;
  };
  for (auto* triple :
       {&cells.albedo, &cells.rest, &cells.smooth, &cells.spare, &cells.normal, &cells.plane})
    for (auto& plane : *triple) plane = take();
  for (auto* plane : {&cells.depth, &cells.samples, &cells.points, &cells.sum, &cells.sum2,
                      &cells.patience, &cells.rest_sum2, &cells.rest_noise, &cells.rest_known})
    *plane = take();
  cells.object = scratch.take<uint32_t>(count);
  std::fill(cells.object.begin(), cells.object.end(), no_object);
}

void build_cells(const View& view, const PointCache& points, const PointImage& image,
                 const SurfaceImage& surface, const Frame& frame, Cells& cells) {
  PixelRays rays(view);
  mat3 to_view = transpose(mat3(view.right, view.up, view.forward));
  parallel_ranges(cells.height, 4, [&](int begin, int end) {
    for (int cy = begin; cy < end; cy++)
      for (int cx = 0; cx < cells.width; cx++) {
        Gathered g = gather_cell(points, image, surface, frame, cx, cy);
        size_t i = size_t(cells.index(cx, cy));
        if (g.points == 0) continue;
        float share = 1 / g.points, per_sample = 1 / std::max(g.samples, 1.0f);
        vec3 albedo = g.albedo * share, rest = g.rest * per_sample, smooth = g.smooth * per_sample;
        vec3 normal = to_view * g.normal;
        normal /= std::max(length(normal), 1e-6f);
        float x = rays.x(g.x * share), y = rays.y(g.y * share);
        vec3 plane = inverse_depth_plane(normal, x, y, g.points / g.inverse_depth);
        float middle_x = rays.x((float(cx) + 0.5f) * cell_size),
              middle_y = rays.y((float(cy) + 0.5f) * cell_size);
        float at_middle = dot(plane, vec3(middle_x, middle_y, 1)), mean = g.inverse_depth * share;
        cells.depth[i] = 1 / std::clamp(at_middle, 0.5f * mean, 2 * mean);
        for (int c = 0; c < 3; c++) {
          cells.albedo[size_t(c)][i] = albedo[c];
          cells.rest[size_t(c)][i] = rest[c];
          cells.smooth[size_t(c)][i] = smooth[c];
          cells.normal[size_t(c)][i] = normal[c];
          cells.plane[size_t(c)][i] = plane[c];
        }
        cells.samples[i] = g.samples;
        cells.points[i] = g.points;
        cells.sum[i] = g.sum;
        cells.sum2[i] = g.sum2;
        cells.rest_sum2[i] = g.rest_sum2;
        cells.rest_noise[i] = g.rest_noise;
        cells.rest_known[i] = g.rest_known;
        cells.object[i] = g.object;
      }
  });
}

}  // namespace wellspring
