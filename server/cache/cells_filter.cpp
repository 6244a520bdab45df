// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "cache/cells.h"

namespace wellspring {
namespace {

constexpr int steps = 4;                 // taps 1, 2, 4 and 8 cells apart
constexpr float plane_tolerance = 0.03f; // relative depth off the other cell's plane that halves a weight
constexpr float light_tolerance = 9;     // squared, in variances of the mean
constexpr int lanes = cell_run;          // cells handled together

// Variance of one sample, estimated over a cell and its eight neighbours of the same object, becomes the
// variance of each cell's mean (in `sum`, freed by then) and its patience. Where few points tell, a
// deviation as large as the mean is assumed.
void estimate_variance(Cells& cells) {
  parallel_ranges(cells.height, 4, [&](int begin, int end) {
    for (int y = begin; y < end; y++)
      for (int x = 0; x < cells.width; x++) {
        size_t i = size_t(cells.index(x, y));
        if (cells.object[i] == no_object) continue;
        float n = 0, points = 0, s1 = 0, s2 = 0;
        for (int dy = -1; dy <= 1; dy++)
          for (int dx = -1; dx <= 1; dx++) {
            size_t j = size_t(cells.index(x + dx, y + dy));
            float same = cells.object[j] == cells.object[i] ? 1.0f : 0.0f;
            n += same * cells.samples[j];
            points += same * cells.points[j];
            s1 += same * cells.sum[j];
            s2 += same * cells.sum2[j];
          }
        float mean = s1 / n, spread = std::max(0.0f, s2 - n * mean * mean);
        constexpr float guess_points = 3;
        float guess = mean * mean + 1e-6f;
        float variance = (spread + guess * guess_points) / (points + guess_points);
        cells.patience[i] = std::clamp(48 * variance / guess, 0.5f, 192.0f);
        cells.points[i] = variance / cells.samples[i];  // parked: `sum` is still read by neighbours
      }
  });
  std::swap(cells.points, cells.sum);
}

struct Row {
  const float *r, *g, *b, *variance;
  const float *nx, *ny, *nz, *px, *py, *pz;
  const uint32_t* object;
};

// One a-trous step over a run of `lanes` cells, of which `count` are written; taps `step` cells apart.
void filter_run(const Row& source, const float* depth, const float* ray_x, float ray_y, int stride, int step,
                int count, float* r, float* g, float* b, float* variance) {
  alignas(64) float sr[lanes], sg[lanes], sb[lanes], sv[lanes], sw[lanes], light[lanes], tolerance[lanes];
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
        float facing = source.nx[i] * source.nx[i + at] + source.ny[i] * source.ny[i + at] + source.nz[i] * source.nz[i + at];
        facing = facing > 0 ? facing : 0.0f;
        facing *= facing, facing *= facing, facing *= facing;
        float off = depth[i] * (source.px[i + at] * ray_x[i] + source.py[i + at] * ray_y + source.pz[i + at]) - 1;
        off *= 1 / plane_tolerance;
        float differs = 0.2126f * qr + 0.7152f * qg + 0.0722f * qb - light[i];
        float lit = differs * differs * tolerance[i];
        float same = source.object[i] == source.object[i + at] ? kernel : 0.0f;
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

void filter_cells(const View& view, Cells& cells) {
  estimate_variance(cells);
  PixelRays rays(view);
  std::vector<float> ray_x(size_t(cells.stride) + lanes);
  for (int x = 0; x < int(ray_x.size()); x++) ray_x[size_t(x)] = rays.x((float(x - cell_pad) + 0.5f) * cell_size);
  auto& smooth = cells.smooth;
  auto& spare = cells.spare;
  for (int k = 0; k < steps; k++) {
    parallel_ranges(cells.height, 4, [&](int begin, int end) {
      for (int y = begin; y < end; y++)
        for (int x = 0; x < cells.width; x += lanes) {
          size_t i = size_t(cells.index(x, y));
          Row row{&smooth[0][i], &smooth[1][i], &smooth[2][i], &cells.sum[i], &cells.normal[0][i],
                  &cells.normal[1][i], &cells.normal[2][i], &cells.plane[0][i], &cells.plane[1][i],
                  &cells.plane[2][i], &cells.object[i]};
          filter_run(row, &cells.depth[i], &ray_x[size_t(x + cell_pad)], rays.y((float(y) + 0.5f) * cell_size),
                     cells.stride, 1 << k, std::min(lanes, cells.width - x), &spare[0][i], &spare[1][i], &spare[2][i], &cells.sum2[i]);
        }
    });
    std::swap(smooth, spare);
    std::swap(cells.sum, cells.sum2);
  }
}

}  // namespace wellspring
