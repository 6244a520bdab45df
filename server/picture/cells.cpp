// SPDX-License-Identifier: Apache-2.0
#include "picture/cells.h"

#include <algorithm>
#include <cmath>

#include "cache/packing_simd.h"

namespace wellspring::picture {
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
  Lanes x{}, y{}, z{};
};
Lanes dot(const Vec& a, const Vec& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec operator*(const Vec& a, const Lanes& s) { return {a.x * s, a.y * s, a.z * s}; }
void add(Vec& sum, const LaneMask& mask, const Vec& v) {
  sum.x += keep_lanes(mask, v.x), sum.y += keep_lanes(mask, v.y), sum.z += keep_lanes(mask, v.z);
}

// Planes through places, seen at rays (x, y, 1) in depth 1 / inverse_depth: coefficients of inverse
// depth over the picture.
Vec inverse_depth_plane(Vec normal, const Vec& ray, const Lanes& inverse_depth) {
  Lanes facing = dot(normal, ray), length2 = dot(ray, ray);
  // A plane seen edge-on would reach from the eye to infinity within a pixel; bend it towards the
  // viewer.
  Lanes least = -0.05f * lanes_sqrt(length2);
  Lanes bend = keep_lanes(~(facing < least), (facing - least) / length2);
  normal = {normal.x - ray.x * bend, normal.y - ray.y * bend, normal.z - ray.z * bend};
  normal = normal * (1.0f / lanes_sqrt(dot(normal, normal)));
  return normal * (inverse_depth / dot(normal, ray));
}

// The sixteen pixels of eight cells side by side.
struct Pixels {
  LaneBits plane[surface_planes][cell_size * cell_size];
};
void read_pixels(const SurfaceRows& rows, int cx, int cy, Pixels& pixels) {
  for (int p = 0; p < surface_planes; p++)
    for (int r = 0; r < cell_size; r++) {
      LaneBits* to = pixels.plane[p] + r * cell_size;
      const uint32_t* from = rows.row(SurfacePlane(p), cy * cell_size + r) + cx * cell_size;
      transpose_records([=](int i) { return from + i * cell_size; }, to[0], to[1], to[2], to[3]);
    }
}

struct Gathered {
  LaneBits object = LaneBits{} + no_object;
  Vec albedo, rest, smooth, normal;
  Lanes x{}, y{}, inverse_depth{}, samples{}, points{}, sum{}, sum2{};
  Lanes rest_sum{}, rest_sum2{}, rest_noise{}, rest_known{};
  Lanes pairs{}, pair_sum{};
  Lanes told{};  // points that were not forgotten
};

// The object most pixels of a cell see (majority vote of Boyer and Moore).
LaneBits elect_object(const Pixels& pixels) {
  LaneBits elected = LaneBits{} + no_object;
  LaneMask votes{};
  for (const LaneBits& object : pixels.plane[plane_object]) {
    LaneMask there = object != no_object;
    elected = (there & (votes == 0)) ? object : elected;
    LaneMask same = object == elected;
    votes += there & (-2 * same - 1);
  }
  return elected;
}

// The means over the pixels of that object; `x` and `y` are counted from the cell's corner.
Gathered gather_cells(const Pixels& pixels) {
  Gathered g;
  g.object = elect_object(pixels);
  // The first pixel of the object says where a crease begins.
  LaneBits first{};
  for (int k = cell_size * cell_size - 1; k >= 0; k--)
    first = pixels.plane[plane_object][k] == g.object ? pixels.plane[plane_more][k] : first;
  Vec reference;
  unpack_octahedron(first & 0xffffu, reference.x, reference.y, reference.z);
  Lanes least2 = 0.49f * dot(reference, reference);        // 0.7 is the cosine
  Lanes above_light[cell_size], above_samples[cell_size];  // of the pixels before, columnwise
  // Means of neighbours differ by what one sample's light deviates, and hardly by detail.
  auto add_pair = [&](const Lanes& light, const Lanes& samples, const Lanes& other,
                      const Lanes& others) {
    Lanes both = samples * others, difference = light - other;
    LaneMask told = both > 0.0f;
    g.pairs += keep_lanes(told, all_lanes(1));
    g.pair_sum += keep_lanes(
        told, difference * difference * both / lanes_max(samples + others, all_lanes(1)));
  };
  for (int k = 0; k < cell_size * cell_size; k++) {
    LaneBits object = pixels.plane[plane_object][k], more = pixels.plane[plane_more][k];
    LaneMask use = (object == g.object) & (object != no_object);
    Vec normal;
    unpack_octahedron(more & 0xffffu, normal.x, normal.y, normal.z);
    Lanes facing = dot(normal, reference);
    // Beyond a crease lies another surface.
    use &= (facing > 0.0f) & (facing * facing >= least2 * dot(normal, normal));

    LaneBits count = (more >> 16) & 255u;
    LaneMask forgotten = (count <= 1u) & ((more >> 24) == forgotten_noise);
    Lanes told = keep_lanes(use & ~forgotten, to_float(count));
    Lanes samples = forgotten ? keep_lanes(use, all_lanes(forgotten_samples)) : told;
    Vec albedo, rest, smooth;
    unpack_albedo(pixels.plane[plane_albedo][k], albedo.x, albedo.y, albedo.z);
    unpack_rgb9e5(pixels.plane[plane_rest][k], rest.x, rest.y, rest.z);
    unpack_rgb9e5(pixels.plane[plane_smooth][k], smooth.x, smooth.y, smooth.z);
    Lanes deviation = unpack_deviation(more >> 24);
    LaneMask known =
        use & ~forgotten & ((samples > 1.0f) | ((samples > 0.0f) & (deviation > 0.0f)));
    Lanes rest_light = luminance(rest.x, rest.y, rest.z),
          light = luminance(smooth.x, smooth.y, smooth.z);
    Lanes one = keep_lanes(use, all_lanes(1));
    add(g.albedo, use, albedo);
    add(g.rest, use, rest * samples);
    add(g.smooth, use, smooth * samples);
    add(g.normal, use, normal);
    g.rest_sum += samples * rest_light;
    g.rest_sum2 += samples * rest_light * rest_light;
    g.rest_noise += keep_lanes(known, deviation * deviation);
    g.rest_known += keep_lanes(known, all_lanes(1));
    g.x += one * (float(k % cell_size) + 0.5f);
    g.y += one * (float(k / cell_size) + 0.5f);
    g.inverse_depth += keep_lanes(use, 1.0f / lanes_as<Lanes>(pixels.plane[plane_depth][k]));
    g.samples += samples;
    g.points += one;
    g.told += keep_lanes(~forgotten, one);
    g.sum += samples * light;
    g.sum2 += samples * light * light;
    int column = k % cell_size;
    if (column > 0) add_pair(light, told, above_light[column - 1], above_samples[column - 1]);
    if (k >= cell_size) add_pair(light, told, above_light[column], above_samples[column]);
    above_light[column] = light, above_samples[column] = told;
  }
  return g;
}

void store_vec(std::array<std::span<float>, 3>& planes, size_t i, const LaneMask& mask,
               const Vec& v) {
  store_lanes(&planes[0][i], keep_lanes(mask, v.x));
  store_lanes(&planes[1][i], keep_lanes(mask, v.y));
  store_lanes(&planes[2][i], keep_lanes(mask, v.z));
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
  for (auto* triple : {&cells.albedo, &cells.rest, &cells.smooth, &cells.spare, &cells.rest_spare,
                       &cells.normal, &cells.plane})
    for (auto& plane : *triple) take(plane, 0.0f);
  for (auto* plane : {&cells.depth, &cells.samples, &cells.points, &cells.sum, &cells.sum2,
                      &cells.prior_weight, &cells.rest_sum, &cells.rest_sum2, &cells.rest_noise,
                      &cells.rest_known, &cells.pairs, &cells.pair_sum})
    take(*plane, 0.0f);
  for (auto& plane : cells.pooled) take(plane, 0.0f);
  take(cells.object, no_object);
}

void build_cells(const WindowView& view, const SurfaceRows& rows, int cy, Cells& cells) {
  static_assert(cell_pad >= lane_count - 1, "the last eight cells of a row may lie in the padding");
  PixelRays rays(view);
  vec3 axes[3] = {view.right, view.up, view.forward};
  Lanes steps{0, 1, 2, 3, 4, 5, 6, 7};
  for (int cx = 0; cx < cells.width; cx += lane_count) {
    Pixels pixels;
    read_pixels(rows, cx, cy, pixels);
    Gathered g = gather_cells(pixels);
    LaneMask any_point = g.points > 0.0f;
    Lanes share = 1.0f / lanes_max(g.points, all_lanes(1)),
          per_sample = 1.0f / lanes_max(g.samples, all_lanes(least_samples));
    Vec normal =
        g.normal * (1.0f / lanes_max(lanes_sqrt(dot(g.normal, g.normal)), all_lanes(1e-6f)));
    auto along = [&](vec3 axis) {
      return normal.x * axis.x + normal.y * axis.y + normal.z * axis.z;
    };
    Lanes left = (steps + float(cx)) * float(cell_size), top = all_lanes(float(cy * cell_size));
    auto ray_to = [&](const Lanes& x, const Lanes& y) {
      return Vec{(left + x - rays.axis.x) * rays.inverse_focal,
                 (rays.axis.y - top - y) * rays.inverse_focal, all_lanes(1)};
    };
    Lanes mean = g.inverse_depth * share;
    Vec plane = inverse_depth_plane({along(axes[0]), along(axes[1]), along(axes[2])},
                                    ray_to(g.x * share, g.y * share), mean);
    Lanes middle = all_lanes(0.5f * cell_size),
          at_middle =
              lanes_max(lanes_min(dot(plane, ray_to(middle, middle)), 2.0f * mean), 0.5f * mean);
    size_t i = size_t(cells.index(cx, cy));
    store_vec(cells.albedo, i, any_point, g.albedo * share);
    store_vec(cells.rest, i, any_point, g.rest * per_sample);
    store_vec(cells.smooth, i, any_point, g.smooth * per_sample);
    store_vec(cells.normal, i, any_point, normal);
    store_vec(cells.plane, i, any_point, plane);
    store_lanes(&cells.depth[i], keep_lanes(any_point, 1.0f / at_middle));
    store_lanes(&cells.samples[i], g.samples);
    store_lanes(&cells.points[i], g.told);
    store_lanes(&cells.sum[i], g.sum);
    store_lanes(&cells.sum2[i], g.sum2);
    store_lanes(&cells.rest_sum[i], g.rest_sum);
    store_lanes(&cells.rest_sum2[i], g.rest_sum2);
    store_lanes(&cells.rest_noise[i], g.rest_noise);
    store_lanes(&cells.rest_known[i], g.rest_known);
    store_lanes(&cells.pairs[i], g.pairs);
    store_lanes(&cells.pair_sum[i], g.pair_sum);
    store_lanes(&cells.prior_weight[i], Lanes{});
    store_lanes(&cells.object[i], any_point ? g.object : LaneBits{} + no_object);
  }
}

}  // namespace wellspring::picture
