// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/parallel.h"
#include "base/rng.h"
#include "cache/packing.h"
#include "cache/reconstruct.h"

namespace wellspring {
namespace {

constexpr int block = cell_size, block_pixels = block * block;
constexpr float plane_tolerance = 0.02f;

// Bilinear weights of a block's pixels towards the four cell centres around it.
struct Bilinear {
  alignas(32) float weight[4][block_pixels];
};
constexpr Bilinear make_bilinear() {
  Bilinear b{};
  for (int k = 0; k < 4; k++)
    for (int i = 0; i < block_pixels; i++) {
      float fx = (float(i % block) + 0.5f) / block, fy = (float(i / block) + 0.5f) / block;
      b.weight[k][i] = ((k & 1) ? fx : 1 - fx) * ((k >> 1) ? fy : 1 - fy);
    }
  return b;
}
constexpr Bilinear bilinear = make_bilinear();

// The pixels between four cell centres, as arrays.
struct Block {
  alignas(32) float x[block_pixels], y[block_pixels], depth[block_pixels];
  alignas(32) float nx[block_pixels], ny[block_pixels], nz[block_pixels];
  alignas(32) float r[block_pixels], g[block_pixels], b[block_pixels], samples[block_pixels];
  alignas(32) float rest_r[block_pixels], rest_g[block_pixels], rest_b[block_pixels];
  alignas(32) float deviation[block_pixels];  // of one sample's rest; negative: not known
  alignas(32) uint32_t object[block_pixels];
};

// What the four cells say at each pixel, as far as they lie on the same surface.
struct Surroundings {
  alignas(32) float r[block_pixels], g[block_pixels], b[block_pixels];
  alignas(32) float rest_r[block_pixels], rest_g[block_pixels], rest_b[block_pixels];
  alignas(32) float patience[block_pixels], detail[block_pixels], noise[block_pixels],
      weight[block_pixels];
};

void look_around(const Cells& cells, int bx, int by, const Block& __restrict p,
                 Surroundings& __restrict s) {
  std::memset(&s, 0, sizeof s);
  for (int k = 0; k < 4; k++) {
    int cx = std::clamp(bx - 1 + (k & 1), 0, cells.width - 1),
        cy = std::clamp(by - 1 + (k >> 1), 0, cells.height - 1);
    size_t c = size_t(cells.index(cx, cy));
    uint32_t object = cells.object[c];
    float cr = cells.smooth[0][c], cg = cells.smooth[1][c], cb = cells.smooth[2][c],
          wait = cells.patience[c];
    float er = cells.rest[0][c], eg = cells.rest[1][c], eb = cells.rest[2][c];
    float detail = cells.rest_sum2[c], noise = cells.rest_noise[c];
    float nx = cells.normal[0][c], ny = cells.normal[1][c], nz = cells.normal[2][c];
    float px = cells.plane[0][c], py = cells.plane[1][c], pz = cells.plane[2][c];
    for (int i = 0; i < block_pixels; i++) {
      float facing = nx * p.nx[i] + ny * p.ny[i] + nz * p.nz[i];
      facing =
          0.5f * (facing + std::abs(facing));  // not below 0, and no branch in the compiler's eyes
      facing *= facing, facing *= facing, facing *= facing;
      float off = (p.depth[i] * (px * p.x[i] + py * p.y[i] + pz) - 1) * (1 / plane_tolerance);
      float same = keep_if(object == p.object[i], bilinear.weight[k][i]);
      float weight = same * facing / (1 + off * off);
      s.r[i] += weight * cr, s.g[i] += weight * cg, s.b[i] += weight * cb;
      s.rest_r[i] += weight * er, s.rest_g[i] += weight * eg, s.rest_b[i] += weight * eb;
      s.patience[i] += weight * wait, s.detail[i] += weight * detail, s.noise[i] += weight * noise;
      s.weight[i] += weight;
    }
  }
}

// Smooth light: the more of the pixel's own the more samples it has. Rest: the more of its own the
// more of what varies around is detail rather than noise (Lee 1980, the local Wiener filter).
void blend_light(const Surroundings& __restrict s, Block& __restrict p) {
  for (int i = 0; i < block_pixels; i++) {
    // Arithmetic instead of conditions, so that it vectorises. `alone`: no cell lies on this
    // surface.
    float alone = keep_if(s.weight[i] <= 1e-4f, 1.0f), share = (1 - alone) / (s.weight[i] + alone);
    float samples = p.samples[i];
    float r = s.r[i] * share, g = s.g[i] * share, b = s.b[i] * share;
    // A lone bright sample may exceed its surroundings only as far as more samples confirm it.
    float light = 0.2126f * r + 0.7152f * g + 0.0722f * b;
    float own_light = 0.2126f * p.r[i] + 0.7152f * p.g[i] + 0.0722f * p.b[i];
    float most = light * (2 + 0.25f * samples) + alone * own_light, over = own_light - most;
    float cut = most / (most + 0.5f * (over + std::abs(over)) + 1e-12f);
    float own = samples / (samples + s.patience[i] * share + 1e-6f);
    own = own + (1 - own) * alone;
    p.r[i] = own * cut * p.r[i] + (1 - own) * r;
    p.g[i] = own * cut * p.g[i] + (1 - own) * g;
    p.b[i] = own * cut * p.b[i] + (1 - own) * b;

    float known = keep_if(p.deviation[i] >= 0, 1.0f);
    // The same for the rest, unless it is known to repeat itself: then it is a highlight, not a
    // lucky path.
    float rest_r = s.rest_r[i] * share, rest_g = s.rest_g[i] * share, rest_b = s.rest_b[i] * share;
    float own_rest = 0.2126f * p.rest_r[i] + 0.7152f * p.rest_g[i] + 0.0722f * p.rest_b[i];
    float quiet = known * keep_if(p.deviation[i] <= 0.1f * own_rest, 1.0f);
    float most_rest =
        (0.2126f * rest_r + 0.7152f * rest_g + 0.0722f * rest_b) * (3 + samples) + 1e-4f;
    most_rest += (quiet + alone) * own_rest;
    float over_rest = own_rest - most_rest,
          rest_cut = most_rest / (most_rest + 0.5f * (over_rest + std::abs(over_rest)));
    float variance = (1 - known) * s.noise[i] * share + known * p.deviation[i] * p.deviation[i];
    variance /= samples + keep_if(samples < 1, 1.0f);
    float detail = s.detail[i] * share;
    float keep = (detail + 1e-9f) / (detail + variance + 1e-9f);
    keep = keep + (1 - keep) * alone;
    p.rest_r[i] = keep * rest_cut * p.rest_r[i] + (1 - keep) * rest_r;
    p.rest_g[i] = keep * rest_cut * p.rest_g[i] + (1 - keep) * rest_g;
    p.rest_b[i] = keep * rest_cut * p.rest_b[i] + (1 - keep) * rest_b;
  }
}

// Packed values of a block, read before and unpacked together.
struct Packed {
  alignas(32) uint32_t albedo[block_pixels], rest[block_pixels];
  alignas(32) int32_t normal[block_pixels];
};

void unpack_block(const mat3& to_view, const Packed& __restrict packed, Block& __restrict p) {
  for (int i = 0; i < block_pixels; i++) {
    float x = float(packed.normal[i] & 255) * (1.0f / 127) - 1,
          y = float(packed.normal[i] >> 8) * (1.0f / 127) - 1;
    float z = 1 - std::abs(x) - std::abs(y), fold = z < 0 ? -z : 0.0f;
    x += x >= 0 ? -fold : fold;
    y += y >= 0 ? -fold : fold;
    float scale = 1 / std::sqrt(x * x + y * y + z * z);
    p.nx[i] = (to_view[0].x * x + to_view[1].x * y + to_view[2].x * z) * scale;
    p.ny[i] = (to_view[0].y * x + to_view[1].y * y + to_view[2].y * z) * scale;
    p.nz[i] = (to_view[0].z * x + to_view[1].z * y + to_view[2].z * z) * scale;
    uint32_t rest = packed.rest[i];
    float unit = std::bit_cast<float>(((rest >> 27) + 127 - 24) << 23);
    p.rest_r[i] = float(int32_t(rest & 511)) * unit;
    p.rest_g[i] = float(int32_t((rest >> 9) & 511)) * unit;
    p.rest_b[i] = float(int32_t((rest >> 18) & 511)) * unit;
  }
}

// Reflectance times light plus the rest, into p.r, p.g, p.b.
void light_block(const Packed& __restrict packed, Block& __restrict p) {
  for (int i = 0; i < block_pixels; i++) {
    uint32_t albedo = packed.albedo[i];
    float r = float(int32_t(albedo & 2047)) * (1.0f / 2047),
          g = float(int32_t((albedo >> 11) & 2047)) * (1.0f / 2047),
          b = float(int32_t(albedo >> 22)) * (1.0f / 1023);
    r = r * r * p.r[i] + p.rest_r[i], g = g * g * p.g[i] + p.rest_g[i],
    b = b * b * p.b[i] + p.rest_b[i];
    // Shares that add up to one by a rounding too much can leave a hair of negative light.
    p.r[i] = 0.5f * (r + std::abs(r)), p.g[i] = 0.5f * (g + std::abs(g)),
    p.b[i] = 0.5f * (b + std::abs(b));
  }
}

// Where the pixels of a block lie; outside the picture its nearest pixel stands in.
struct Places {
  size_t at[block_pixels];
  bool inside[block_pixels];
};

}  // namespace

void compose(const View& view, const PointCache& points, const PointImage& image,
             const SurfaceImage& surface, const Cells& cells, Frame& frame) {
  PixelRays rays(view);
  mat3 to_view = transpose(mat3(view.right, view.up, view.forward));
  int width = image.width, height = image.height;
  parallel_ranges(cells.height + 1, 2, [&](int begin, int end) {
    Block p;
    Packed packed;
    Surroundings s;
    Places places;
    for (int by = begin; by < end; by++)
      for (int bx = 0; bx <= cells.width; bx++) {
        int x0 = bx * block - block / 2, y0 = by * block - block / 2;
        for (int i = 0; i < block_pixels; i++) {
          int wanted_x = x0 + i % block, wanted_y = y0 + i / block;
          int x = std::clamp(wanted_x, 0, width - 1), y = std::clamp(wanted_y, 0, height - 1);
          places.inside[i] = x == wanted_x && y == wanted_y;
          size_t at = places.at[i] = size_t(y) * size_t(width) + size_t(x);
          packed.normal[i] = surface.normal[at];
          packed.albedo[i] = surface.albedo[at];
          packed.rest[i] = surface.rest[at];
          p.x[i] = rays.x(float(x) + 0.5f), p.y[i] = rays.y(float(y) + 0.5f);
          p.depth[i] = frame.depth[at];
          p.r[i] = frame.color[at].x, p.g[i] = frame.color[at].y, p.b[i] = frame.color[at].z;
          p.samples[i] = frame.confidence[at];
          p.object[i] = frame.object[at];
          p.deviation[i] =
              p.samples[i] > 1 ? unpack_deviation(points.noise[image.point[at]]) : -1.0f;
        }
        unpack_block(to_view, packed, p);
        look_around(cells, bx, by, p, s);
        blend_light(s, p);
        light_block(packed, p);
        for (int i = 0; i < block_pixels; i++) {
          if (!places.inside[i]) continue;
          size_t at = places.at[i];
          frame.color[at] = vec3(p.r[i], p.g[i], p.b[i]);
          frame.confidence[at] = p.samples[i] / (p.samples[i] + 8);
          bool far = !(p.depth[i] < 0.5f * infinite_depth) || p.depth[i] <= 0;
          frame.depth[at] = far ? std::numeric_limits<float>::infinity() : p.depth[i];
        }
      }
  });
}

void accumulate_still(const PointCache& points, const PointImage& image, uint32_t seed,
                      StillImage& still, Frame& frame) {
  parallel_ranges(image.height, 8, [&](int begin, int end) {
    size_t first = size_t(begin) * size_t(image.width), last = size_t(end) * size_t(image.width);
    for (size_t i = first; i < last; i++) {
      uint32_t point = image.point[i];
      if (point == no_point || (points.flags[point] & point_moving)) {
        still.count[i] = 0;
        continue;
      }
      int n = still.count[i] & ~still_fresh;
      vec3 mean(unpack_half(still.mean[0][i]), unpack_half(still.mean[1][i]),
                unpack_half(still.mean[2][i]));
      if (still.count[i] & still_fresh) {
        n = std::min(n + 1, still_longest);
        // Later samples count more: the light they were shown in was known better.
        mean += (frame.color[i] - (n == 1 ? vec3(0) : mean)) *
                    (n == 1 ? 1.0f : 1.5f / (float(n) + 0.5f)) -
                (n == 1 ? mean : vec3(0));
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
