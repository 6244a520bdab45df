// SPDX-License-Identifier: Apache-2.0
#include "picture/cells/cells.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "cache/packing.h"

namespace wellspring::picture {
namespace {

// Samples that a point whose light was forgotten counts for: few, but something if nothing newer is
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

// Returns planes through places, seen at rays (x, y, 1) in depth 1 / inverse_depth: coefficients of
// inverse depth over the picture.
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

// Holds the sixteen pixels of eight cells side by side.
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

// Returns the object that most pixels of a cell see (majority vote of Boyer and Moore).
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

// Sums over the pixels of that object; `x` and `y` are counted from the cell's corner.
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
  Lanes above_light[cell_size], above_samples[cell_size];  // values of each column's last pixel
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

// Fills holes: the known cells are gathered into coarser and coarser levels, then every unknown
// cell takes what the level above knows (push and pull, Gortler et al. 1996), one object at a time.

namespace {

constexpr float flat = 0.97f;  // Coarse::flatness of a flat surface: normals some ten degrees apart

struct Coarse {
  vec3 albedo{0}, rest{0}, smooth{0}, normal{0};
  vec3 plane{0};  // as Cells::plane: the same for all cells of one plane
  float inverse_depth = 0, weight = 0;
  float flatness = 0;  // 1: all its cells face one way
  uint32_t object = no_object;
};

struct Level {
  int width = 0, height = 0;
  std::vector<Coarse> cells;
  const Coarse& at(int x, int y) const {
    return cells[size_t(std::clamp(y, 0, height - 1)) * size_t(width) +
                 size_t(std::clamp(x, 0, width - 1))];
  }
};

void add(Coarse& sum, const Coarse& c, float weight) {
  sum.albedo += c.albedo * weight;
  sum.rest += c.rest * weight;
  sum.smooth += c.smooth * weight;
  sum.normal += c.normal * weight;
  sum.plane += c.plane * weight;
  sum.inverse_depth += c.inverse_depth * weight;
  sum.flatness += c.flatness * weight;
  sum.weight += weight;
}

// Returns the mean of the candidates that show the object of most weight, with their weight.
Coarse blend(const Coarse* const* candidates, const float* weights, int count) {
  Coarse sum;
  float best = 0;
  for (int i = 0; i < count; i++) {
    if (weights[i] <= 0 || candidates[i]->object == no_object) continue;
    float support = 0;
    for (int j = 0; j < count; j++)
      if (candidates[j]->object == candidates[i]->object) support += weights[j];
    if (support > best) best = support, sum.object = candidates[i]->object;
  }
  if (best <= 0) return sum;
  for (int i = 0; i < count; i++)
    if (candidates[i]->object == sum.object) add(sum, *candidates[i], weights[i]);
  float share = 1 / sum.weight;
  sum.albedo *= share, sum.rest *= share, sum.smooth *= share, sum.inverse_depth *= share;
  sum.plane *= share;
  float facing = length(sum.normal);
  sum.flatness *= share * facing * share;
  sum.normal /= std::max(facing, 1e-6f);
  return sum;
}

Coarse read_cell(const Cells& cells, int x, int y) {
  Coarse c;
  if (x >= cells.width || y >= cells.height) return c;
  size_t i = size_t(cells.index(x, y));
  if (cells.object[i] == no_object) return c;
  for (int k = 0; k < 3; k++) {
    c.albedo[k] = cells.albedo[size_t(k)][i];
    c.rest[k] = cells.rest[size_t(k)][i];
    c.smooth[k] = cells.smooth[size_t(k)][i];
    c.normal[k] = cells.normal[size_t(k)][i];
    c.plane[k] = cells.plane[size_t(k)][i];
  }
  c.flatness = 1;
  c.inverse_depth = 1 / cells.depth[i];
  c.weight = std::min(cells.samples[i], 16.0f);
  c.object = cells.object[i];
  return c;
}

// Blends the children at (2x, 2y) .. (2x+1, 2y+1).
template <class Read>
Coarse reduce(const Read& read, int x, int y) {
  Coarse child[4] = {read(2 * x, 2 * y), read(2 * x + 1, 2 * y), read(2 * x, 2 * y + 1),
                     read(2 * x + 1, 2 * y + 1)};
  const Coarse* candidates[4] = {&child[0], &child[1], &child[2], &child[3]};
  float weights[4];
  for (int k = 0; k < 4; k++) weights[k] = child[k].weight;
  Coarse result = blend(candidates, weights, 4);
  result.weight = std::min(result.weight, 16.0f);
  return result;
}

// Returns what the level above knows around the middle of cell (x, y): its four nearest cells,
// bilinear.
Coarse pull(const Level& above, int x, int y) {
  int px = x >> 1, py = y >> 1, sx = x & 1 ? 1 : -1, sy = y & 1 ? 1 : -1;
  const Coarse* candidates[4] = {&above.at(px, py), &above.at(px + sx, py), &above.at(px, py + sy),
                                 &above.at(px + sx, py + sy)};
  constexpr float bilinear[4] = {9, 3, 3, 1};
  float weights[4];
  for (int k = 0; k < 4; k++) weights[k] = candidates[k]->object == no_object ? 0.0f : bilinear[k];
  return blend(candidates, weights, 4);
}

void write_cell(const PixelRays& rays, const Coarse& c, int x, int y, Cells& cells) {
  size_t i = size_t(cells.index(x, y));
  vec3 ray(rays.x((float(x) + 0.5f) * cell_size), rays.y((float(y) + 0.5f) * cell_size), 1);
  // A flat surface goes on as it does around. A cell of another surface faces the viewer: its depth
  // is a guess, and a slope would be a bolder one.
  float inverse_depth = c.inverse_depth, there = dot(c.plane, ray);
  vec3 plane(0, 0, inverse_depth);
  if (c.flatness > flat && there > 0.5f * inverse_depth && there < 2 * inverse_depth)
    plane = c.plane, inverse_depth = there;
  for (int k = 0; k < 3; k++) {
    cells.albedo[size_t(k)][i] = c.albedo[k];
    cells.rest[size_t(k)][i] = c.rest[k];
    cells.smooth[size_t(k)][i] = c.smooth[k];
    cells.normal[size_t(k)][i] = c.normal[k];
    cells.plane[size_t(k)][i] = plane[k];
  }
  cells.depth[i] = 1 / inverse_depth;
  cells.object[i] = c.object;
}

}  // namespace

bool fill_cells(const WindowView& view, Cells& cells) {
  PixelRays rays(view);
  int known = 0;
  for (int y = 0; y < cells.height; y++)
    for (int x = 0; x < cells.width; x++)
      known += cells.object[size_t(cells.index(x, y))] != no_object;
  if (known == 0) return false;
  if (known == cells.width * cells.height) return true;

  std::vector<Level> levels;
  int width = cells.width, height = cells.height;
  do {
    width = (width + 1) / 2, height = (height + 1) / 2;
    Level level{width, height, std::vector<Coarse>(size_t(width) * size_t(height))};
    const Level* below = levels.empty() ? nullptr : &levels.back();
    auto read = [&](int x, int y) {
      if (!below) return read_cell(cells, x, y);
      return x < below->width && y < below->height ? below->at(x, y) : Coarse{};
    };
    parallel_ranges(height, 8, [&](int begin, int end) {
      for (int y = begin; y < end; y++)
        for (int x = 0; x < width; x++)
          level.cells[size_t(y) * size_t(width) + size_t(x)] = reduce(read, x, y);
    });
    levels.push_back(std::move(level));
  } while (width > 1 || height > 1);
  if (levels.back().cells[0].object == no_object) return false;

  for (size_t k = levels.size() - 1; k-- > 0;) {
    Level& level = levels[k];
    parallel_ranges(level.height, 8, [&](int begin, int end) {
      for (int y = begin; y < end; y++)
        for (int x = 0; x < level.width; x++) {
          Coarse& c = level.cells[size_t(y) * size_t(level.width) + size_t(x)];
          if (c.object == no_object) c = pull(levels[k + 1], x, y);
        }
    });
  }
  parallel_ranges(cells.height, 8, [&](int begin, int end) {
    for (int y = begin; y < end; y++)
      for (int x = 0; x < cells.width; x++)
        if (cells.object[size_t(cells.index(x, y))] == no_object)
          write_cell(rays, pull(levels[0], x, y), x, y, cells);
  });
  return true;
}

}  // namespace wellspring::picture
