// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "cache/cells.h"
#include "cache/packing.h"

namespace wellspring {
namespace {

constexpr int steps = 4;  // taps 1, 2, 4 and 8 cells apart
constexpr float plane_tolerance =
    0.03f;  // relative depth off the other cell's plane that halves a weight
constexpr float light_tolerance = 9;  // squared, in variances of the mean
constexpr int lanes = cell_run;       // cells handled together

// Sums over a cell and its eight neighbours of the same object.
struct Pool {
  float samples = 0, points = 0, sum = 0, sum2 = 0;
  float rest = 0, rest2 = 0, rest_noise = 0, rest_known = 0;
};
Pool pool_around(const Cells& cells, int x, int y) {
  Pool pool;
  uint32_t object = cells.object[size_t(cells.index(x, y))];
  for (int dy = -1; dy <= 1; dy++)
    for (int dx = -1; dx <= 1; dx++) {
      size_t j = size_t(cells.index(x + dx, y + dy));
      if (cells.object[j] != object) continue;
      pool.samples += cells.samples[j];
      pool.points += cells.points[j];
      pool.sum += cells.sum[j];
      pool.sum2 += cells.sum2[j];
      pool.rest +=
          cells.samples[j] * luminance(vec3(cells.rest[0][j], cells.rest[1][j], cells.rest[2][j]));
      pool.rest2 += cells.rest_sum2[j];
      pool.rest_noise += cells.rest_noise[j];
      pool.rest_known += cells.rest_known[j];
    }
  return pool;
}

struct Estimate {
  float scale = 1, rest_scale = 1;  // below 1: an outlier, brought down to its surroundings
  float mean_variance = 0, patience = 0, rest_detail = 0, rest_noise = 0, rest_mean_variance = 0;
};

// Where few points tell, smooth light is assumed to deviate by as much as its mean, and what varies
// in the rest to be noise by `rest_share`.
Estimate estimate_cell(const Pool& pool, float samples, float light, float rest_light,
                       float rest_share) {
  constexpr float guess_points = 3;
  Estimate e;
  float mean = pool.sum / pool.samples,
        spread = std::max(0.0f, pool.sum2 - pool.samples * mean * mean);
  float guess = mean * mean + 1e-6f;
  float variance = (spread + guess * guess_points) / (pool.points + guess_points);
  e.patience = std::clamp(48 * variance / guess, 0.5f, 192.0f);
  e.mean_variance = variance / samples;
  // What varies from place to place beyond what varies from sample to sample is detail.
  float rest_mean = pool.rest / pool.samples;
  float per_sample = std::max(0.0f, pool.rest2 - pool.samples * rest_mean * rest_mean) /
                     std::max(pool.points - 1, 1.0f);
  float guessed = per_sample * rest_share;
  e.rest_noise = (pool.rest_noise + guessed) / (pool.rest_known + 1);
  float each = pool.samples / pool.points;  // samples a point
  e.rest_detail = std::max(0.0f, per_sample - e.rest_noise) / each;
  e.rest_mean_variance = e.rest_noise / samples;
  // A cell far brighter than those around it owes that to a lucky path, unless many samples say so
  // or, of the rest, it stays so from sample to sample.
  float others = pool.samples - samples;
  if (others >= 3) {
    float confirmed = 2.5f + 0.05f * samples;
    float around = (pool.sum - light * samples) / others,
          rest_around = (pool.rest - rest_light * samples) / others;
    if (light > confirmed * around) e.scale = (confirmed * around + 1e-6f) / (light + 1e-6f);
    bool noisy = e.rest_noise > 0.25f * rest_light * rest_light;
    if (noisy && rest_light > confirmed * rest_around)
      e.rest_scale = (confirmed * rest_around + 1e-6f) / (rest_light + 1e-6f);
  }
  return e;
}

float light_at(const std::array<std::span<float>, 3>& light, size_t i) {
  return luminance(vec3(light[0][i], light[1][i], light[2][i]));
}

// Of all that varies in the rest of the whole picture, how much is noise? Every third row tells;
// each adds up for itself, so that the sum does not depend on the threads.
float share_of_noise(const Cells& cells) {
  struct Sums {
    double noise = 0, spread = 0, known = 0;
  };
  std::vector<Sums> rows(size_t(cells.height + 2) / 3);
  parallel_ranges(int(rows.size()), 8, [&](int begin, int end) {
    for (int row = begin; row < end; row++) {
      Sums sums;
      for (int x = 0; x < cells.width; x++) {
        size_t i = size_t(cells.index(x, row * 3));
        if (cells.rest_known[i] == 0) continue;
        float mean = light_at(cells.rest, i),
              spread = cells.rest_sum2[i] - cells.samples[i] * mean * mean;
        sums.noise += double(std::min(cells.rest_noise[i], 1.0f));
        sums.spread += double(std::clamp(spread, 0.0f, 1.0f));
        sums.known += 1;
      }
      rows[size_t(row)] = sums;
    }
  });
  Sums all;
  for (const Sums& row : rows)
    all.noise += row.noise, all.spread += row.spread, all.known += row.known;
  if (all.known == 0) return 0.5f;
  return float(std::clamp(all.noise / (all.noise + all.spread + 1e-9), 0.5, 1.0));
}

// Replaces the moments by what follows from them.
void estimate_variance(Cells& cells) {
  float rest_share = share_of_noise(cells);
  std::vector<Estimate> estimates(size_t(cells.width) * size_t(cells.height));
  parallel_ranges(cells.height, 4, [&](int begin, int end) {
    for (int y = begin; y < end; y++)
      for (int x = 0; x < cells.width; x++) {
        size_t i = size_t(cells.index(x, y));
        if (cells.object[i] == no_object) continue;
        estimates[size_t(y) * size_t(cells.width) + size_t(x)] =
            estimate_cell(pool_around(cells, x, y), cells.samples[i], light_at(cells.smooth, i),
                          light_at(cells.rest, i), rest_share);
      }
  });
  parallel_ranges(cells.height, 8, [&](int begin, int end) {
    for (int y = begin; y < end; y++)
      for (int x = 0; x < cells.width; x++) {
        size_t i = size_t(cells.index(x, y));
        if (cells.object[i] == no_object) continue;
        const Estimate& e = estimates[size_t(y) * size_t(cells.width) + size_t(x)];
        for (size_t c = 0; c < 3; c++) {
          cells.smooth[c][i] *= e.scale;
          cells.rest[c][i] *= e.rest_scale;
        }
        cells.sum[i] = e.mean_variance;
        cells.patience[i] = e.patience;
        cells.rest_sum2[i] = e.rest_detail;
        cells.rest_noise[i] = e.rest_noise;
        cells.rest_known[i] = e.rest_mean_variance;
      }
  });
}

struct Row {
  const float *r, *g, *b, *variance;
  const float *nx, *ny, *nz, *px, *py, *pz;
  const uint32_t* object;
};

// One a-trous step over a run of `lanes` cells, of which `count` are written; taps `step` cells
// apart.
void filter_run(const Row& source, const float* depth, const float* ray_x, float ray_y, int stride,
                int step, int count, float* r, float* g, float* b, float* variance) {
  alignas(64) float sr[lanes], sg[lanes], sb[lanes], sv[lanes], sw[lanes], light[lanes],
      tolerance[lanes];
  for (int i = 0; i < lanes; i++) {
    sr[i] = 4 * source.r[i], sg[i] = 4 * source.g[i], sb[i] = 4 * source.b[i];
    sv[i] = 16 * source.variance[i], sw[i] = 4;
    light[i] = 0.2126f * source.r[i] + 0.7152f * source.g[i] + 0.0722f * source.b[i];
    tolerance[i] = 1 / (light_tolerance * source.variance[i] + 1e-12f);
  }
  for (int dy = -1; dy <= 1; dy++)
    for (int dx = -1; dx <= 1; dx++) {
      if (dx == 0 && dy == 0) continue;
      int at = dy * step * stride + dx * step;
      float kernel = dx != 0 && dy != 0 ? 1.0f : 2.0f;
      for (int i = 0; i < lanes; i++) {
        float qr = source.r[i + at], qg = source.g[i + at], qb = source.b[i + at];
        float facing = source.nx[i] * source.nx[i + at] + source.ny[i] * source.ny[i + at] +
                       source.nz[i] * source.nz[i + at];
        facing = 0.5f *
                 (facing + std::abs(facing));  // not below 0, and no branch in the compiler's eyes
        facing *= facing, facing *= facing, facing *= facing;
        float off = depth[i] * (source.px[i + at] * ray_x[i] + source.py[i + at] * ray_y +
                                source.pz[i + at]) -
                    1;
        off *= 1 / plane_tolerance;
        float differs = 0.2126f * qr + 0.7152f * qg + 0.0722f * qb - light[i];
        float lit = differs * differs * tolerance[i];
        float same = keep_if(source.object[i] == source.object[i + at], kernel);
        float weight = same * facing / ((1 + off * off) * (1 + lit * lit));
        sr[i] += weight * qr, sg[i] += weight * qg, sb[i] += weight * qb;
        sv[i] += weight * weight * source.variance[i + at];
        sw[i] += weight;
      }
    }
  for (int i = 0; i < count; i++) {
    float share = 1 / sw[i];
    r[i] = sr[i] * share, g[i] = sg[i] * share, b[i] = sb[i] * share;
    variance[i] = sv[i] * share * share;
  }
}

}  // namespace

namespace {

// All steps over one colour and the variance of its mean; `spare` and `spare_variance` are
// overwritten.
void filter_light(const PixelRays& rays, const std::vector<float>& ray_x, Cells& cells,
                  std::array<std::span<float>, 3>& light, std::span<float>& variance,
                  std::span<float>& spare_variance) {
  auto& spare = cells.spare;
  for (int k = 0; k < steps; k++) {
    parallel_ranges(cells.height, 4, [&](int begin, int end) {
      for (int y = begin; y < end; y++)
        for (int x = 0; x < cells.width; x += lanes) {
          size_t i = size_t(cells.index(x, y));
          Row row{&light[0][i],        &light[1][i],        &light[2][i],        &variance[i],
                  &cells.normal[0][i], &cells.normal[1][i], &cells.normal[2][i], &cells.plane[0][i],
                  &cells.plane[1][i],  &cells.plane[2][i],  &cells.object[i]};
          filter_run(row, &cells.depth[i], &ray_x[size_t(x + cell_pad)],
                     rays.y((float(y) + 0.5f) * cell_size), cells.stride, 1 << k,
                     std::min(lanes, cells.width - x), &spare[0][i], &spare[1][i], &spare[2][i],
                     &spare_variance[i]);
        }
    });
    std::swap(light, spare);
    std::swap(variance, spare_variance);
  }
}

}  // namespace

void filter_cells(const View& view, Cells& cells) {
  estimate_variance(cells);
  PixelRays rays(view);
  std::vector<float> ray_x(size_t(cells.stride) + lanes);
  for (int x = 0; x < int(ray_x.size()); x++)
    ray_x[size_t(x)] = rays.x((float(x - cell_pad) + 0.5f) * cell_size);
  filter_light(rays, ray_x, cells, cells.smooth, cells.sum, cells.sum2);
  filter_light(rays, ray_x, cells, cells.rest, cells.rest_known, cells.sum2);
}

}  // namespace wellspring
