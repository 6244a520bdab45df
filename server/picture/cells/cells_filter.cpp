// SPDX-License-Identifier: Apache-2.0
// Filters eight cells at a time. Rows are padded with empty cells, so nothing asks where a row
// ends.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/parallel.h"
#include "cache/packing.h"
#include "picture/cells/cells.h"

namespace wellspring::picture {
namespace {

constexpr int steps = 4;  // taps 1, 2, 4 and 8 cells apart
// Relative depth off the other cell's plane that halves a weight.
constexpr float plane_tolerance = 0.03f;
// Squared difference of light that halves a weight, in variances of the mean. The variance of a few
// samples is no better known than the light, and counts up to `unsure_variance` times as much.
constexpr float light_tolerance = 4, unsure_variance = 6;
constexpr float least_samples = 1 / 512.0f;  // samples that a cell without any counts for
// Samples that a cell counts for at most: its neighbours show other places.
constexpr float most_samples = 64;
constexpr float plenty_of_points = 48;  // points in nine cells that show how light deviates there
constexpr float enough_pairs = 12;      // pairs of neighbours that count for half in this
// Least detail of smooth light among nine cells: a variance over the mean squared.
constexpr float least_detail = 1 / 48.0f;
constexpr float most_prior_weight = 192;  // samples

Lanes load_at(std::span<const float> plane, size_t i) { return load_lanes(plane.data() + i); }
Lanes clamped(const Lanes& v, float low, float high) {
  return lanes_min(lanes_max(v, all_lanes(low)), all_lanes(high));
}

// Holds sums over cells of one object.
struct Pool {
  Lanes samples{}, points{}, sum{}, sum2{};
  Lanes rest{}, rest2{}, rest_noise{}, rest_known{};
  Lanes pairs{}, pair_sum{};
};
using PoolPlanes = decltype(Cells::pooled);

template <class Read>
void add(Pool& pool, const LaneMask& same, const Read& read) {
  pool.samples += keep_lanes(same, read(0)), pool.points += keep_lanes(same, read(1));
  pool.sum += keep_lanes(same, read(2)), pool.sum2 += keep_lanes(same, read(3));
  pool.rest += keep_lanes(same, read(4)), pool.rest2 += keep_lanes(same, read(5));
  pool.rest_noise += keep_lanes(same, read(6)), pool.rest_known += keep_lanes(same, read(7));
  pool.pairs += keep_lanes(same, read(8)), pool.pair_sum += keep_lanes(same, read(9));
}

PoolPlanes own_planes(const Cells& c) {
  return {c.samples,   c.points,     c.sum,        c.sum2,  c.rest_sum,
          c.rest_sum2, c.rest_noise, c.rest_known, c.pairs, c.pair_sum};
}

// Sums over eight cells and those `step` apart around each of them.
Pool pool_around(const Cells& cells, const PoolPlanes& planes, size_t i, const LaneBits& object,
                 int step) {
  Pool pool;
  for (int dy = -1; dy <= 1; dy++)
    for (int dx = -1; dx <= 1; dx++) {
      size_t j = size_t(ptrdiff_t(i) + step * (dy * cells.stride + dx));
      add(pool, load_lanes<LaneBits>(&cells.object[j]) == object,
          [&](size_t k) { return load_at(planes[k], j); });
    }
  return pool;
}

// Holds the brightest means of the cells around.
struct Brightest {
  Lanes light{}, rest{};
};
Brightest brightest_around(const Cells& cells, size_t i, const LaneBits& object) {
  Brightest b;
  for (int dy = -1; dy <= 1; dy++)
    for (int dx = -1; dx <= 1; dx++) {
      if (dx == 0 && dy == 0) continue;
      size_t j = size_t(ptrdiff_t(i) + dy * cells.stride + dx);
      LaneMask same = load_lanes<LaneBits>(&cells.object[j]) == object;
      Lanes per_sample =
          keep_lanes(same, 1.0f / lanes_max(load_at(cells.samples, j), all_lanes(least_samples)));
      b.light = lanes_max(b.light, load_at(cells.sum, j) * per_sample);
      b.rest = lanes_max(b.rest, load_at(cells.rest_sum, j) * per_sample);
    }
  return b;
}

struct Estimate {
  Lanes scale, rest_scale;  // below 1: an outlier, brought down to its surroundings
  Lanes mean_variance, prior_weight, rest_detail, rest_noise, rest_mean_variance;
};

// Holds what cells somewhat farther around say, for cells with few points near.
struct Prior {
  Lanes mean, variance, rest_mean;
  LaneMask told;
};
Prior make_prior(const Pool& wide) {
  constexpr float guess_points = 3;
  Lanes per_sample = 1.0f / lanes_max(wide.samples, all_lanes(least_samples));
  Prior prior;
  prior.mean = wide.sum * per_sample;
  Lanes spread = positive_lanes(wide.sum2 - wide.sum * prior.mean);
  prior.variance =
      (spread + prior.mean * prior.mean * guess_points) / (wide.points + guess_points) + 1e-6f;
  prior.rest_mean = wide.rest * per_sample;
  prior.told = wide.points >= 4.0f;
  return prior;
}

// Estimates the cells' variances and outliers. If there are few points, smooth light is assumed to
// deviate as it does farther around, and variation of the rest to be noise by `rest_share`.
// `samples` > 0; `light_sum` and `rest_sum` are the cells' sums over their samples; `unsure`: some
// point of a cell may owe its rest to chance, and the points differ.
Estimate estimate_cells(const Pool& pool, const Pool& wide, const Brightest& brightest,
                        const Lanes& samples, const Lanes& light_sum, const Lanes& rest_sum,
                        const LaneMask& unsure, float rest_share) {
  constexpr float guess_points = 3;
  Estimate e;
  Lanes per_sample = 1.0f / samples, per_pooled = 1.0f / pool.samples;
  Prior prior = make_prior(wide);
  Lanes mean = pool.sum * per_pooled, spread = positive_lanes(pool.sum2 - pool.sum * mean);
  Lanes expected = (pool.sum + prior.mean * guess_points) / (pool.samples + guess_points);
  Lanes variance = (spread + prior.variance * guess_points) / (pool.points + guess_points);
  // Variance of points beyond that of neighbouring pairs is detail: means of many samples differ
  // where the light does.
  Lanes paired = pool.pairs / (pool.pairs + enough_pairs);
  Lanes deviates = pool.pair_sum / lanes_max(pool.pairs, all_lanes(1));
  Lanes detail = paired * positive_lanes(variance - deviates) * pool.points * per_pooled;
  variance += paired * (deviates - variance);
  e.prior_weight = clamped(variance / (detail + least_detail * expected * expected + 1e-6f), 0.5f,
                           most_prior_weight);
  Lanes known_badly = 1.0f + (unsure_variance - 1) * (1.0f - paired);
  e.mean_variance = variance * per_sample * known_badly;
  // Variance from place to place beyond the variance from sample to sample is detail.
  Lanes rest_spread = positive_lanes(pool.rest2 - pool.rest * pool.rest * per_pooled) /
                      lanes_max(pool.points - 1.0f, all_lanes(1));
  Lanes wide_spread =
      positive_lanes(wide.rest2 - wide.rest * wide.rest / lanes_max(wide.samples, all_lanes(1))) /
      lanes_max(wide.points - 1.0f, all_lanes(1));
  Lanes near_share = pool.points / (pool.points + guess_points);
  rest_spread = rest_spread * near_share + wide_spread * (1.0f - near_share);
  e.rest_noise = (pool.rest_noise + rest_spread * rest_share) / (pool.rest_known + 1.0f);
  e.rest_detail = positive_lanes(rest_spread - e.rest_noise) * pool.points * per_pooled;
  e.rest_mean_variance = e.rest_noise * per_sample * known_badly;
  // A cell brighter than all around it, or far brighter than their mean, owes that to a lucky path,
  // unless many samples confirm it or, for the rest, it stays so from sample to sample.
  Lanes light = light_sum * per_sample, rest_light = rest_sum * per_sample;
  Lanes others = pool.samples - samples;
  LaneMask near = others >= 3.0f;
  Lanes all_others = wide.samples - samples;
  Lanes per_other = 1.0f / lanes_max(near ? others : all_others, all_lanes(1));
  Lanes other_light = ((near ? pool.sum : wide.sum) - light_sum) * per_other,
        other_rest = ((near ? pool.rest : wide.rest) - rest_sum) * per_other;
  Lanes confirmed = 2.5f + 0.05f * samples;
  Lanes peak = 1.25f + 0.05f * samples;
  Lanes most = confirmed * other_light, rest_most = confirmed * other_rest;
  most = near ? lanes_min(most, peak * brightest.light) : most;
  rest_most = near ? lanes_min(rest_most, peak * brightest.rest) : rest_most;
  LaneMask told = near | (all_others >= 6.0f),
           noisy = unsure | (e.rest_noise > 0.25f * rest_light * rest_light);
  Lanes one = all_lanes(1);
  e.scale = told & (light > most) ? (most + 1e-6f) / (light + 1e-6f) : one;
  e.rest_scale =
      told & noisy & (rest_light > rest_most) ? (rest_most + 1e-6f) / (rest_light + 1e-6f) : one;
  return e;
}

// Returns how much of all variation in the rest of the whole picture is noise. Every third row is
// looked at; each adds up for itself, so that the sum does not depend on the threads.
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
        float spread =
            cells.rest_sum2[i] - cells.rest_sum[i] * cells.rest_sum[i] / cells.samples[i];
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

void pool_cells(Cells& cells) {
  PoolPlanes own = own_planes(cells);
  parallel_ranges(cells.height, 4, [&](int begin, int end) {
    for (int y = begin; y < end; y++)
      for (int x = 0; x < cells.width; x += lane_count) {
        size_t i = size_t(cells.index(x, y));
        Pool pool = pool_around(cells, own, i, load_lanes<LaneBits>(&cells.object[i]), 1);
        const Lanes sums[] = {pool.samples, pool.points,  pool.sum,        pool.sum2,
                              pool.rest,    pool.rest2,   pool.rest_noise, pool.rest_known,
                              pool.pairs,   pool.pair_sum};
        for (size_t k = 0; k < cells.pooled.size(); k++) store_lanes(&cells.pooled[k][i], sums[k]);
      }
  });
}

// Replaces the moments by the variances that follow from them; the other side of the a-trous steps
// serves as scratch meanwhile.
void estimate_variance(Cells& cells) {
  float rest_share = share_of_noise(cells);
  auto &mean_variance = cells.spare[0], &rest_detail = cells.spare[1], &rest_noise = cells.spare[2];
  auto& rest_mean_variance = cells.rest_spare[0];
  pool_cells(cells);
  parallel_ranges(cells.height, 4, [&](int begin, int end) {
    for (int y = begin; y < end; y++)
      for (int x = 0; x < cells.width; x += lane_count) {
        size_t i = size_t(cells.index(x, y));
        LaneBits object = load_lanes<LaneBits>(&cells.object[i]);
        LaneMask known = object != no_object;
        if (!any_lane(known)) {
          for (auto* plane : {&mean_variance, &rest_detail, &rest_noise, &rest_mean_variance})
            store_lanes(&(*plane)[i], Lanes{});
          continue;
        }
        Pool pool;
        add(pool, known, [&](size_t k) { return load_at(cells.pooled[k], i); });
        Pool wide = pool;
        if (any_lane(known & (pool.points < plenty_of_points)))
          wide = pool_around(cells, cells.pooled, i, object, 3);
        const Lanes few = all_lanes(least_samples);
        pool.samples = lanes_max(pool.samples, few);
        Lanes samples = lanes_max(load_at(cells.samples, i), few);
        Lanes rest_sum = load_at(cells.rest_sum, i), rest_sum2 = load_at(cells.rest_sum2, i);
        Lanes spread = samples * rest_sum2 - rest_sum * rest_sum;
        LaneMask unsure = (load_at(cells.rest_known, i) < load_at(cells.points, i)) &
                          (spread > 0.25f * rest_sum * rest_sum);
        Estimate e = estimate_cells(pool, wide, brightest_around(cells, i, object), samples,
                                    load_at(cells.sum, i), rest_sum, unsure, rest_share);
        for (size_t c = 0; c < 3; c++) {
          store_lanes(&cells.smooth[c][i], load_at(cells.smooth[c], i) * e.scale);
          store_lanes(&cells.rest[c][i], load_at(cells.rest[c], i) * e.rest_scale);
        }
        store_lanes(&cells.prior_weight[i], keep_lanes(known, e.prior_weight));
        store_lanes(&mean_variance[i], keep_lanes(known, e.mean_variance));
        store_lanes(&rest_detail[i], keep_lanes(known, e.rest_detail));
        store_lanes(&rest_noise[i], keep_lanes(known, e.rest_noise));
        store_lanes(&rest_mean_variance[i], keep_lanes(known, e.rest_mean_variance));
      }
  });
  std::swap(cells.sum, mean_variance);
  std::swap(cells.rest_sum2, rest_detail);
  std::swap(cells.rest_noise, rest_noise);
  std::swap(cells.rest_known, rest_mean_variance);
}

// Holds light of eight cells and the variance of its mean, weighed by samples.
struct LightSums {
  Lanes r, g, b, variance, weight, own_r, own_g, own_b, tolerance;
};
struct LightPlanes {
  const float *r, *g, *b, *variance;
};
constexpr float own_weight = 4;  // weight of a step's middle cell; the other eight have 1 or 2
LightSums begin_sums(const LightPlanes& from, size_t i, const Lanes& samples) {
  Lanes r = load_lanes(from.r + i), g = load_lanes(from.g + i), b = load_lanes(from.b + i),
        v = load_lanes(from.variance + i), w = own_weight * samples;
  return {w * r, w * g, w * b, w * w * v, w, r, g, b, 1.0f / (light_tolerance * v + 1e-12f)};
}
// Adds eight cells. `common`: how much the two cells' surfaces agree; `apart`: one plus their
// squared distance. Returns the share of the cells' samples that counted.
Lanes add(LightSums& sums, const LightPlanes& from, size_t j, const Lanes& common,
          const Lanes& apart, const Lanes& samples) {
  Lanes r = load_lanes(from.r + j), g = load_lanes(from.g + j), b = load_lanes(from.b + j);
  Lanes dr = r - sums.own_r, dg = g - sums.own_g, db = b - sums.own_b;
  Lanes differs = luminance(dr * dr, dg * dg, db * db) * sums.tolerance;
  Lanes share = common / (apart * (1.0f + differs * differs)), weight = share * samples;
  sums.r += weight * r, sums.g += weight * g, sums.b += weight * b;
  sums.variance += weight * weight * load_lanes(from.variance + j);
  sums.weight += weight;
  return share;
}
// Stores the means; if no sample lies within reach, the earlier ones stay.
void store_sums(const LightSums& sums, const LightPlanes& from, size_t i, float* r, float* g,
                float* b, float* variance) {
  LaneMask told = sums.weight > 1e-6f;
  Lanes share = 1.0f / (told ? sums.weight : all_lanes(1));
  store_lanes(r, told ? sums.r * share : load_lanes(from.r + i));
  store_lanes(g, told ? sums.g * share : load_lanes(from.g + i));
  store_lanes(b, told ? sums.b * share : load_lanes(from.b + i));
  store_lanes(variance, told ? sums.variance * share * share : load_lanes(from.variance + i));
}

// Returns how much the surfaces of eight cells at i and those at j agree in object and orientation,
// and sets `apart` to one plus the squared distance of those at i from the planes at j.
Lanes compare_surfaces(const Cells& cells, size_t i, size_t j, const Lanes& ray_x, float ray_y,
                       Lanes& apart) {
  Lanes facing = load_at(cells.normal[0], i) * load_at(cells.normal[0], j) +
                 load_at(cells.normal[1], i) * load_at(cells.normal[1], j) +
                 load_at(cells.normal[2], i) * load_at(cells.normal[2], j);
  facing = positive_lanes(facing);
  facing *= facing, facing *= facing, facing *= facing;
  Lanes off =
      load_at(cells.depth, i) * (load_at(cells.plane[0], j) * ray_x +
                                 load_at(cells.plane[1], j) * ray_y + load_at(cells.plane[2], j)) -
      1.0f;
  off *= 1 / plane_tolerance;
  apart = 1.0f + off * off;
  return keep_lanes(
      load_lanes<LaneBits>(&cells.object[i]) == load_lanes<LaneBits>(&cells.object[j]), facing);
}

}  // namespace

void filter_cells(const WindowView& view, Cells& cells) {
  estimate_variance(cells);
  PixelRays rays(view);
  std::vector<float> ray_x(size_t(cells.width) + lane_count);
  for (int x = 0; x < int(ray_x.size()); x++)
    ray_x[size_t(x)] = rays.x((float(x) + 0.5f) * cell_size);
  std::span<float>& next_samples = cells.pooled[0];
  for (int k = 0; k < steps; k++) {
    int step = 1 << k;
    LightPlanes smooth{cells.smooth[0].data(), cells.smooth[1].data(), cells.smooth[2].data(),
                       cells.sum.data()},
        rest{cells.rest[0].data(), cells.rest[1].data(), cells.rest[2].data(),
             cells.rest_known.data()};
    parallel_ranges(cells.height, 4, [&](int begin, int end) {
      for (int y = begin; y < end; y++) {
        float ray_y = rays.y((float(y) + 0.5f) * cell_size);
        for (int x = 0; x < cells.width; x += lane_count) {
          size_t i = size_t(cells.index(x, y));
          Lanes own = lanes_min(load_at(cells.samples, i), all_lanes(most_samples));
          LightSums s = begin_sums(smooth, i, own), r = begin_sums(rest, i, own);
          // A mean has as many samples as equally weighed ones of its variance would be.
          Lanes weights = own_weight * own, weights2 = own_weight * own_weight * own;
          Lanes across = load_lanes(&ray_x[size_t(x)]);
          for (int dy = -1; dy <= 1; dy++)
            for (int dx = -1; dx <= 1; dx++) {
              if (dx == 0 && dy == 0) continue;
              size_t j = size_t(ptrdiff_t(i) + step * (dy * cells.stride + dx));
              Lanes apart, common = compare_surfaces(cells, i, j, across, ray_y, apart);
              if (dx == 0 || dy == 0) common += common;
              Lanes samples = lanes_min(load_at(cells.samples, j), all_lanes(most_samples));
              Lanes share = add(s, smooth, j, common, apart, samples);
              add(r, rest, j, common, apart, samples);
              weights += share * samples, weights2 += share * share * samples;
            }
          store_sums(s, smooth, i, &cells.spare[0][i], &cells.spare[1][i], &cells.spare[2][i],
                     &cells.sum2[i]);
          store_sums(r, rest, i, &cells.rest_spare[0][i], &cells.rest_spare[1][i],
                     &cells.rest_spare[2][i], &cells.points[i]);
          store_lanes(&next_samples[i], weights * weights / lanes_max(weights2, all_lanes(1e-12f)));
        }
      }
    });
    std::swap(cells.smooth, cells.spare);
    std::swap(cells.rest, cells.rest_spare);
    std::swap(cells.sum, cells.sum2);
    std::swap(cells.rest_known, cells.points);
    std::swap(cells.samples, next_samples);
  }
}

}  // namespace wellspring::picture
