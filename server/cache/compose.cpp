// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "base/rng.h"
#include "cache/packing.h"
#include "cache/reconstruct.h"

namespace wellspring {
namespace {

constexpr int block = cell_size, block_pixels = block * block;
constexpr float plane_tolerance = 0.02f;

// The pixels between four cell centres, as arrays.
struct Block {
  alignas(32) float x[block_pixels], y[block_pixels], depth[block_pixels];
  alignas(32) float nx[block_pixels], ny[block_pixels], nz[block_pixels];
  alignas(32) float r[block_pixels], g[block_pixels], b[block_pixels], samples[block_pixels];
  alignas(32) uint32_t object[block_pixels];
};

// Smooth light of a block: what the four cells say as far as they lie on the same surface, and the more
// of the pixel's own the more samples it has.
void upsample(const Cells& cells, int bx, int by, Block& p) {
  alignas(32) float r[block_pixels] = {}, g[block_pixels] = {}, b[block_pixels] = {}, w[block_pixels] = {},
                    patience[block_pixels] = {};
  for (int k = 0; k < 4; k++) {
    int cx = std::clamp(bx - 1 + (k & 1), 0, cells.width - 1), cy = std::clamp(by - 1 + (k >> 1), 0, cells.height - 1);
    size_t c = size_t(cells.index(cx, cy));
    uint32_t object = cells.object[c];
    float cr = cells.smooth[0][c], cg = cells.smooth[1][c], cb = cells.smooth[2][c], wait = cells.patience[c];
    float nx = cells.normal[0][c], ny = cells.normal[1][c], nz = cells.normal[2][c];
    float px = cells.plane[0][c], py = cells.plane[1][c], pz = cells.plane[2][c];
    for (int i = 0; i < block_pixels; i++) {
      float fx = (float(i % block) + 0.5f) / block, fy = (float(i / block) + 0.5f) / block;
      float near = ((k & 1) ? fx : 1 - fx) * ((k >> 1) ? fy : 1 - fy);
      float facing = nx * p.nx[i] + ny * p.ny[i] + nz * p.nz[i];
      facing = facing > 0 ? facing : 0.0f;
      facing *= facing, facing *= facing, facing *= facing;
      float off = (p.depth[i] * (px * p.x[i] + py * p.y[i] + pz) - 1) * (1 / plane_tolerance);
      float same = object == p.object[i] ? near : 0.0f;
      float weight = same * facing / (1 + off * off);
      r[i] += weight * cr, g[i] += weight * cg, b[i] += weight * cb;
      w[i] += weight, patience[i] += weight * wait;
    }
  }
  for (int i = 0; i < block_pixels; i++) {
    float share = w[i] > 1e-4f ? 1 / w[i] : 0.0f;
    float own = p.samples[i] / (p.samples[i] + patience[i] * share + 1e-6f);
    own = w[i] > 1e-4f ? own : 1.0f;
    p.r[i] = own * p.r[i] + (1 - own) * r[i] * share;
    p.g[i] = own * p.g[i] + (1 - own) * g[i] * share;
    p.b[i] = own * p.b[i] + (1 - own) * b[i] * share;
  }
}

}  // namespace

void compose(const View& view, const PointCache& points, const PointImage& image, const SurfaceImage& surface,
             const Cells& cells, Frame& frame) {
  PixelRays rays(view);
  mat3 to_view = transpose(mat3(view.right, view.up, view.forward));
  int width = image.width, height = image.height;
  parallel_ranges(cells.height + 1, 2, [&](int begin, int end) {
    Block p;
    for (int by = begin; by < end; by++)
      for (int bx = 0; bx <= cells.width; bx++) {
        int x0 = bx * block - block / 2, y0 = by * block - block / 2;
        for (int i = 0; i < block_pixels; i++) {
          int x = std::clamp(x0 + i % block, 0, width - 1), y = std::clamp(y0 + i / block, 0, height - 1);
          size_t at = size_t(y) * size_t(width) + size_t(x);
          vec3 n = to_view * unpack_normal(surface.normal[at]);
          p.x[i] = rays.x(float(x) + 0.5f), p.y[i] = rays.y(float(y) + 0.5f);
          p.depth[i] = frame.depth[at];
          p.nx[i] = n.x, p.ny[i] = n.y, p.nz[i] = n.z;
          p.r[i] = frame.color[at].x, p.g[i] = frame.color[at].y, p.b[i] = frame.color[at].z;
          p.samples[i] = frame.confidence[at];
          p.object[i] = frame.object[at];
        }
        upsample(cells, bx, by, p);
        for (int i = 0; i < block_pixels; i++) {
          int x = x0 + i % block, y = y0 + i / block;
          if (x < 0 || y < 0 || x >= width || y >= height) continue;
          size_t at = size_t(y) * size_t(width) + size_t(x);
          frame.color[at] = unpack_albedo(surface.albedo[at]) * vec3(p.r[i], p.g[i], p.b[i]) + unpack_rgb9e5(surface.rest[at]);
          frame.confidence[at] = p.samples[i] / (p.samples[i] + 8);
          if (!(frame.depth[at] < 0.5f * infinite_depth) || frame.depth[at] <= 0)
            frame.depth[at] = std::numeric_limits<float>::infinity();
        }
      }
  });
}

void accumulate_still(const PointCache& points, const PointImage& image, uint32_t seed, StillImage& still,
                      Frame& frame) {
  parallel_ranges(image.height, 8, [&](int begin, int end) {
    size_t first = size_t(begin) * size_t(image.width), last = size_t(end) * size_t(image.width);
    for (size_t i = first; i < last; i++) {
      uint32_t point = image.point[i];
      if (point == no_point || (points.flags[point] & point_moving)) {
        still.count[i] = 0;
        continue;
      }
      int n = still.count[i] & ~still_fresh;
      vec3 mean(unpack_half(still.mean[0][i]), unpack_half(still.mean[1][i]), unpack_half(still.mean[2][i]));
      if (still.count[i] & still_fresh) {
        n = std::min(n + 1, still_longest);
        // Later samples count more: the light they were shown in was known better.
        mean += (frame.color[i] - (n == 1 ? vec3(0) : mean)) * (n == 1 ? 1.0f : 1.5f / (float(n) + 0.5f)) - (n == 1 ? mean : vec3(0));
        uint64_t random = mix64(uint64_t(seed) << 32 | i);
        for (size_t c = 0; c < 3; c++)
          still.mean[c][i] = pack_half(mean[int(c)], uint32_t(random >> (16 * c)));
        still.count[i] = uint8_t(n);
      }
      if (n == 0) continue;
      float share = float(n) / (float(n) + 2);
      frame.color[i] += (mean - frame.color[i]) * share;
      frame.confidence[i] = std::max(frame.confidence[i], float(n) / (float(n) + 8));
    }
  });
}

}  // namespace wellspring
