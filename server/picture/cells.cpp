// SPDX-License-Identifier: Apache-2.0
#include "picture/cells.h"

#include <algorithm>
#include <cmath>

#include "cache/simd.h"

namespace wellspring {
namespace {

// Samples that a point counts for whose light was forgotten: something where nothing newer is
// known.
constexpr float forgotten_samples = 1 / 256.0f;
constexpr float least_samples = forgotten_samples / 2;

constexpr int float_planes = 3 * 7 + 12 + 10;  // all but object

size_t padded(int width, int height) {
  int columns = (width + cell_size - 1) / cell_size, rows = (height + cell_size - 1) / cell_size;
  return size_t(columns + 2 * cell_pad) * size_t(rows + 2 * cell_pad) + cell_run;
}

struct Vec {
  f8 x{}, y{}, z{};
};
f8 dot(const Vec& a, const Vec& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec operator*(const Vec& a, const f8& s) { return {a.x * s, a.y * s, a.z * s}; }
void add(Vec& sum, const i8& mask, const Vec& v) {
  sum.x += keep(mask, v.x), sum.y += keep(mask, v.y), sum.z += keep(mask, v.z);
}

// Planes through places, seen at rays (x, y, 1) in depth 1 / inverse_depth: coefficients of inverse
// depth over the picture.
Vec inverse_depth_plane(Vec normal, const Vec& ray, const f8& inverse_depth) {
  f8 facing = dot(normal, ray), length2 = dot(ray, ray);
  // A plane seen edge-on would reach from the eye to infinity within a pixel; bend it towards the
  // viewer.
  f8 least = -0.05f * lanes_sqrt(length2);
  f8 bend = keep(~(facing < least), (facing - least) / length2);
  normal = {normal.x - ray.x * bend, normal.y - ray.y * bend, normal.z - ray.z * bend};
  normal = normal * (1.0f / lanes_sqrt(dot(normal, normal)));
  return normal * (inverse_depth / dot(normal, ray));
}

// The sixteen pixels of eight cells side by side.
struct Pixels {
  u8 plane[surface_planes][cell_size * cell_size];
};
void read_pixels(const SurfaceRows& rows, int cx, int cy, Pixels& pixels) {
  for (int p = 0; p < surface_planes; p++)
    for (int r = 0; r < cell_size; r++) {
      u8* to = pixels.plane[p] + r * cell_size;
      const uint32_t* from = rows.row(SurfacePlane(p), cy * cell_size + r) + cx * cell_size;
      transpose([=](int i) { return from + i * cell_size; }, to[0], to[1], to[2], to[3]);
    }
}

struct Gathered {
  u8 object = u8{} + no_object;
  Vec albedo, rest, smooth, normal;
  f8 x{}, y{}, inverse_depth{}, samples{}, points{}, sum{}, sum2{};
  f8 rest_sum{}, rest_sum2{}, rest_noise{}, rest_known{};
  f8 pairs{}, pair_sum{};
  f8 told{};  // points that were not forgotten
};

// The object most pixels of a cell see (majority vote of Boyer and Moore).
u8 elect_object(const Pixels& pixels) {
  u8 elected = u8{} + no_object;
  i8 votes{};
  for (const u8& object : pixels.plane[plane_object]) {
    i8 there = object != no_object;
    elected = (there & (votes == 0)) ? object : elected;
    i8 same = object == elected;
    votes += there & (-2 * same - 1);
  }
  return elected;
}

// The means over the pixels of that object; `x` and `y` are counted from the cell's corner.
Gathered gather_cells(const Pixels& pixels) {
  Gathered g;
  g.object = elect_object(pixels);
  // The first pixel of the object says where a crease begins.
  u8 first{};
  for (int k = cell_size * cell_size - 1; k >= 0; k--)
    first = pixels.plane[plane_object][k] == g.object ? pixels.plane[plane_more][k] : first;
  Vec reference;
  unpack_octahedron(first & 0xffffu, reference.x, reference.y, reference.z);
  f8 least2 = 0.49f * dot(reference, reference);  // 0.7 is the cosine
  f8 above_light[cell_size], above_samples[cell_size];  // of the pixels before, columnwise
  // Means of neighbours differ by what one sample's light deviates, and hardly by detail.
  auto add_pair = [&](const f8& light, const f8& samples, const f8& other, const f8& others) {
    f8 both = samples * others, difference = light - other;
    i8 told = both > 0.0f;
    g.pairs += keep(told, splat(1));
    g.pair_sum += keep(told, difference * difference * both / larger(samples + others, splat(1)));
  };
  for (int k = 0; k < cell_size * cell_size; k++) {
    u8 object = pixels.plane[plane_object][k], more = pixels.plane[plane_more][k];
    i8 use = (object == g.object) & (object != no_object);
    Vec normal;
    unpack_octahedron(more & 0xffffu, normal.x, normal.y, normal.z);
    f8 facing = dot(normal, reference);
    // Beyond a crease lies another surface.
    use &= (facing > 0.0f) & (facing * facing >= least2 * dot(normal, normal));

    u8 count = (more >> 16) & 255u;
    i8 forgotten = (count <= 1u) & ((more >> 24) == forgotten_noise);
    f8 told = keep(use & ~forgotten, to_float(count));
    f8 samples = forgotten ? keep(use, splat(forgotten_samples)) : told;
    Vec albedo, rest, smooth;
    unpack_albedo(pixels.plane[plane_albedo][k], albedo.x, albedo.y, albedo.z);
    unpack_rgb9e5(pixels.plane[plane_rest][k], rest.x, rest.y, rest.z);
    unpack_rgb9e5(pixels.plane[plane_smooth][k], smooth.x, smooth.y, smooth.z);
    f8 deviation = unpack_deviation(more >> 24);
    i8 known = use & ~forgotten & ((samples > 1.0f) | ((samples > 0.0f) & (deviation > 0.0f)));
    f8 rest_light = luminance(rest.x, rest.y, rest.z),
       light = luminance(smooth.x, smooth.y, smooth.z);
    f8 one = keep(use, splat(1));
    add(g.albedo, use, albedo);
    add(g.rest, use, rest * samples);
    add(g.smooth, use, smooth * samples);
    add(g.normal, use, normal);
    g.rest_sum += samples * rest_light;
    g.rest_sum2 += samples * rest_light * rest_light;
    g.rest_noise += keep(known, deviation * deviation);
    g.rest_known += keep(known, splat(1));
    g.x += one * (float(k % cell_size) + 0.5f);
    g.y += one * (float(k / cell_size) + 0.5f);
    g.inverse_depth += keep(use, 1.0f / as<f8>(pixels.plane[plane_depth][k]));
    g.samples += samples;
    g.points += one;
    g.told += keep(~forgotten, one);
    g.sum += samples * light;
    g.sum2 += samples * light * light;
    int column = k % cell_size;
    if (column > 0) add_pair(light, told, above_light[column - 1], above_samples[column - 1]);
    if (k >= cell_size) add_pair(light, told, above_light[column], above_samples[column]);
    above_light[column] = light, above_samples[column] = told;
  }
  return g;
}

void store_vec(std::array<std::span<float>, 3>& planes, size_t i, const i8& mask, const Vec& v) {
  store(&planes[0][i], keep(mask, v.x));
  store(&planes[1][i], keep(mask, v.y));
  store(&planes[2][i], keep(mask, v.z));
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
  size_t count = padded(width, height), stride = size_t(cells.stride);
  auto take = [&]<class T>(std::span<T>& plane, T empty) {
    plane = scratch.take<T>(count);
    std::fill_n(plane.begin(), cell_pad * stride, empty);
    for (int y = 0; y < cells.height; y++) {
      std::fill_n(&plane[size_t(cells.index(-cell_pad, y))], cell_pad, empty);
      std::fill_n(&plane[size_t(cells.index(cells.width, y))], cell_pad, empty);
    }
    std::fill(plane.begin() + cells.index(-cell_pad, cells.height), plane.end(), empty);
  };
  for (auto* triple :
       {&cells.albedo, &cells.rest, &cells.smooth, &cells.spare, &cells.rest_spare, &cells.normal,
        &cells.plane})
    for (auto& plane : *triple) take(plane, 0.0f);
  for (auto* plane : {&cells.depth, &cells.samples, &cells.points, &cells.sum, &cells.sum2,
                      &cells.patience, &cells.rest_sum, &cells.rest_sum2, &cells.rest_noise,
                      &cells.rest_known, &cells.pairs, &cells.pair_sum})
    take(*plane, 0.0f);
  for (auto& plane : cells.pooled) take(plane, 0.0f);
  take(cells.object, no_object);
}

void build_cells(const WindowView& view, const SurfaceRows& rows, int cy, Cells& cells) {
  static_assert(cell_pad >= lanes - 1, "the last eight cells of a row may lie in the padding");
  PixelRays rays(view);
  vec3 axes[3] = {view.right, view.up, view.forward};
  f8 steps{0, 1, 2, 3, 4, 5, 6, 7};
  for (int cx = 0; cx < cells.width; cx += lanes) {
    Pixels pixels;
    read_pixels(rows, cx, cy, pixels);
    Gathered g = gather_cells(pixels);
    i8 any_point = g.points > 0.0f;
    f8 share = 1.0f / larger(g.points, splat(1)),
       per_sample = 1.0f / larger(g.samples, splat(least_samples));
    Vec normal = g.normal * (1.0f / larger(lanes_sqrt(dot(g.normal, g.normal)), splat(1e-6f)));
    auto along = [&](vec3 axis) {
      return normal.x * axis.x + normal.y * axis.y + normal.z * axis.z;
    };
    f8 left = (steps + float(cx)) * float(cell_size), top = splat(float(cy * cell_size));
    auto ray_to = [&](const f8& x, const f8& y) {
      return Vec{(left + x - rays.half_width) * rays.inverse_focal,
                 (rays.half_height - top - y) * rays.inverse_focal, splat(1)};
    };
    f8 mean = g.inverse_depth * share;
    Vec plane = inverse_depth_plane({along(axes[0]), along(axes[1]), along(axes[2])},
                                    ray_to(g.x * share, g.y * share), mean);
    f8 middle = splat(0.5f * cell_size),
       at_middle = larger(smaller(dot(plane, ray_to(middle, middle)), 2.0f * mean), 0.5f * mean);
    size_t i = size_t(cells.index(cx, cy));
    store_vec(cells.albedo, i, any_point, g.albedo * share);
    store_vec(cells.rest, i, any_point, g.rest * per_sample);
    store_vec(cells.smooth, i, any_point, g.smooth * per_sample);
    store_vec(cells.normal, i, any_point, normal);
    store_vec(cells.plane, i, any_point, plane);
    store(&cells.depth[i], keep(any_point, 1.0f / at_middle));
    store(&cells.samples[i], g.samples);
    store(&cells.points[i], g.told);
    store(&cells.sum[i], g.sum);
    store(&cells.sum2[i], g.sum2);
    store(&cells.rest_sum[i], g.rest_sum);
    store(&cells.rest_sum2[i], g.rest_sum2);
    store(&cells.rest_noise[i], g.rest_noise);
    store(&cells.rest_known[i], g.rest_known);
    store(&cells.pairs[i], g.pairs);
    store(&cells.pair_sum[i], g.pair_sum);
    store(&cells.patience[i], f8{});
    store(&cells.object[i], any_point ? g.object : u8{} + no_object);
  }
}

}  // namespace wellspring
