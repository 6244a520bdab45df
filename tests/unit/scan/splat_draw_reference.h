// SPDX-License-Identifier: Apache-2.0
// Draws splats plainly, in double precision: every pixel asks every splat. For comparison.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/rng.h"
#include "scan/splat_draw/draw_splats.h"

namespace wellspring::test {

struct ReferencePixel {
  dvec3 code{0};  // display codes
  double clear = 1, depth = std::numeric_limits<double>::infinity();
};

struct ReferenceSplat {
  dvec2 middle, slope;
  double xx, xy, yy, opacity, depth, nearness, farthest, nearest;
  dvec3 color;
};

inline dvec3 reference_color(const scan::SplatSet& set, size_t i, dvec3 d) {
  const double x = d.x, y = d.y, z = d.z, xx = x * x, yy = y * y, zz = z * z;
  // Ramamoorthi's and Sloan's polynomials, as the reference's program has them.
  const double basis[15] = {-0.4886025119029199 * y,
                            0.4886025119029199 * z,
                            -0.4886025119029199 * x,
                            1.0925484305920792 * x * y,
                            -1.0925484305920792 * y * z,
                            0.31539156525252005 * (2 * zz - xx - yy),
                            -1.0925484305920792 * x * z,
                            0.5462742152960396 * (xx - yy),
                            -0.5900435899266435 * y * (3 * xx - yy),
                            2.890611442640554 * x * y * z,
                            -0.4570457994644658 * y * (4 * zz - xx - yy),
                            0.3731763325901154 * z * (2 * zz - 3 * xx - 3 * yy),
                            -0.4570457994644658 * x * (4 * zz - xx - yy),
                            1.445305721320277 * z * (xx - yy),
                            -0.5900435899266435 * x * (xx - 3 * yy)};
  dvec3 color(set.color[i]);
  const size_t count = size_t(scan::splat_harmonics[set.degree]);
  for (size_t k = 0; k < count; k++) color += basis[k] * dvec3(set.harmonics[i * count + k]);
  return glm::max(color, 0.0);
}

inline std::vector<ReferenceSplat> reference_splats(const scan::SplatSet& set,
                                                    const scan::PlacedSplats& at,
                                                    const scan::ScanCamera& view, double blur) {
  std::vector<ReferenceSplat> splats;
  const double focal = double(view.height) / (2.0 * double(view.tan_half_fov));
  const glm::dmat3 turn = glm::mat3_cast(glm::normalize(glm::dquat(at.turn)));
  const dvec3 right(view.right), down(-view.up), forward(view.forward);
  for (size_t i = 0; i < set.size(); i++) {
    const dvec3 away = turn * (at.scale * dvec3(set.place[i])) + at.shift - view.eye;
    const double z = dot(away, forward);
    if (z <= std::max(double(view.near), 0.1)) continue;
    glm::dmat3 axes = turn * glm::mat3_cast(glm::normalize(glm::dquat(set.turn[i])));
    for (int k = 0; k < 3; k++) axes[k] *= double(set.scale[i][k]) * at.scale;
    const glm::dmat3 cov = axes * glm::transpose(axes);
    const double x = dot(away, right) / z, y = dot(away, down) / z;
    const auto held = [&](double slant, double axis, double size) {
      return std::clamp(slant, (-axis - 0.15 * size) / focal, (1.15 * size - axis) / focal);
    };
    const dvec3 jx =
        focal / z * (right - held(x, double(view.axis_place().x), view.width) * forward);
    const dvec3 jy =
        focal / z * (down - held(y, double(view.axis_place().y), view.height) * forward);
    const dvec3 jw = -1 / (z * z) * forward;
    ReferenceSplat s;
    s.xx = dot(jx, cov * jx), s.xy = dot(jx, cov * jy), s.yy = dot(jy, cov * jy);
    const double sharp = std::max(s.xx * s.yy - s.xy * s.xy, 0.0);
    s.xx += blur, s.yy += blur;
    const double det = s.xx * s.yy - s.xy * s.xy;
    s.opacity = double(set.opacity[i]) * std::sqrt(sharp / det);
    if (s.opacity < 1 / 255.0) continue;
    s.middle = dvec2(view.axis_place()) + focal * dvec2(x, y);
    s.depth = z;
    s.nearness = 1 / z;
    const double wx = dot(jw, cov * jx), wy = dot(jw, cov * jy);
    s.slope = dvec2(s.yy * wx - s.xy * wy, s.xx * wy - s.xy * wx) / det;
    const double deep = std::sqrt(2 * std::log(255 * s.opacity) * dot(forward, cov * forward));
    s.farthest = 1 / (z + deep);
    s.nearest = 1 / std::max(z - deep, std::max(double(view.near), 0.1));
    s.color = reference_color(set, i, glm::normalize(glm::transpose(turn) * away));
    splats.push_back(s);
  }
  std::stable_sort(splats.begin(), splats.end(),
                   [](const auto& a, const auto& b) { return a.depth < b.depth; });
  return splats;
}

// Draws one set, every splat of it; `surface` as in SplatDrawing.
inline std::vector<ReferencePixel> draw_reference(const scan::SplatSet& set,
                                                  const scan::PlacedSplats& at,
                                                  const scan::ScanCamera& view, bool by_pixel,
                                                  std::span<const float> surface = {},
                                                  double blur = 0.3) {
  struct Hit {
    double nearness, alpha;
    const ReferenceSplat* splat;
  };
  const auto splats = reference_splats(set, at, view, blur);
  std::vector<ReferencePixel> picture(size_t(view.width) * size_t(view.height));
  std::vector<Hit> hits;
  for (int row = 0; row < view.height; row++)
    for (int column = 0; column < view.width; column++) {
      const size_t p = size_t(row) * size_t(view.width) + size_t(column);
      hits.clear();
      for (const ReferenceSplat& s : splats) {
        const dvec2 d = dvec2(column, row) + dvec2(view.offset) - s.middle;
        const double det = s.xx * s.yy - s.xy * s.xy;
        const double square = (s.yy * d.x * d.x - 2 * s.xy * d.x * d.y + s.xx * d.y * d.y) / det;
        const double alpha = std::min(0.99, s.opacity * std::exp(-0.5 * square));
        const double near = std::clamp(s.nearness + dot(s.slope, d), s.farthest, s.nearest);
        if (alpha < 1 / 255.0 || (!surface.empty() && 1 / near >= double(surface[p]))) continue;
        hits.push_back({near, alpha, &s});
      }
      if (by_pixel)
        std::stable_sort(hits.begin(), hits.end(),
                         [](const Hit& a, const Hit& b) { return a.nearness > b.nearness; });
      ReferencePixel& pixel = picture[p];
      for (const Hit& hit : hits) {
        const double before = pixel.clear;
        pixel.code += hit.alpha * pixel.clear * hit.splat->color;
        pixel.clear *= 1 - hit.alpha;
        if (before > 0.5 && pixel.clear <= 0.5) pixel.depth = 1 / hit.nearness;
      }
    }
  return picture;
}

inline double display_code(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

// Returns decibels, of display codes.
inline double signal_to_noise(const scan::SplatPlanes& picture,
                              const std::vector<ReferencePixel>& reference) {
  double sum = 0;
  for (size_t i = 0; i < reference.size(); i++)
    for (int c = 0; c < 3; c++) {
      const double d = display_code(double(picture.light[i][c])) - reference[i].code[c];
      sum += d * d;
    }
  return -10 * std::log10(sum / (3.0 * double(reference.size())));
}

inline scan::ScanCamera make_test_view(int width, int height, dvec3 eye = dvec3(0)) {
  scan::ScanCamera view;
  view.width = width, view.height = height, view.eye = eye;
  view.axis = vec2(width, height) * 0.5f;
  return view;
}

inline void add_splat(scan::SplatSet& set, vec3 place, vec3 scale, quat turn, float opacity,
                      vec3 color) {
  set.place.push_back(place);
  set.scale.push_back(scale);
  set.turn.push_back(turn);
  set.opacity.push_back(opacity);
  set.color.push_back(color);
  set.harmonics.resize(set.size() * size_t(scan::splat_harmonics[set.degree]), vec3(0));
}

inline vec3 random_vector(Rng& rng) {
  const float x = rng.uniform(), y = rng.uniform();
  return vec3(x, y, rng.uniform());
}

inline quat random_turn(Rng& rng) {
  const vec3 v = random_vector(rng);
  return glm::normalize(quat(rng.uniform() - 0.5f, v.x - 0.5f, v.y - 0.5f, v.z - 0.501f));
}

// Splats of all sizes and opacities around (0, 0, -4), two metres wide.
inline scan::SplatSet make_random_splats(int count, int degree, uint64_t seed) {
  scan::SplatSet set;
  set.degree = degree;
  Rng rng(seed);
  for (int i = 0; i < count; i++) {
    const vec3 place = (random_vector(rng) - 0.5f) * vec3(3, 2, 3) + vec3(0, 0, -4);
    const vec3 size = vec3(0.2f) * glm::pow(random_vector(rng), vec3(3));
    const quat turn = random_turn(rng);
    const float opacity = rng.uniform();
    add_splat(set, place, size, turn, opacity, random_vector(rng));
  }
  for (vec3& v : set.harmonics) v = 0.3f * (random_vector(rng) - 0.5f);
  return set;
}

// A chequered floor of flat splats that ends in a wall; no two are as far away.
inline scan::SplatSet make_floor_and_wall(int degree) {
  scan::SplatSet set;
  set.degree = degree;
  Rng rng(3);
  const quat lying = glm::angleAxis(0.5f * pi, vec3(1, 0, 0));
  for (int z = 0; z < 24; z++)
    for (int x = 0; x < 24; x++) {
      const float bright = (x / 3 + z / 3) % 2 == 0 ? 0.8f : 0.2f;
      add_splat(set,
                vec3(0.2f * float(x) - 2.3f, -0.8f, -1.5f - 0.2f * float(z) - 0.1f * rng.uniform()),
                vec3(0.12f, 0.12f, 0.004f), lying, 0.95f, vec3(bright, bright, 0.4f));
      add_splat(set,
                vec3(0.2f * float(x) - 2.3f, 0.1f * float(z) - 0.8f, -6.4f + 0.1f * rng.uniform()),
                vec3(0.1f, 0.06f, 0.004f), quat(1, 0, 0, 0), 0.9f, vec3(0.3f, bright, 0.6f));
    }
  for (vec3& v : set.harmonics) v = 0.1f * (random_vector(rng) - 0.5f);
  return set;
}

inline scan::SplatPlanes draw_set(const scan::SplatSet& set, const scan::ScanCamera& view,
                                  const scan::SplatDrawing& settings = {},
                                  scan::PlacedSplats at = {}) {
  const scan::ShownSplats shown = scan::make_shown_splats(set);
  at.splats = &shown;
  scan::SplatDrawer drawer;
  scan::SplatPlanes picture;
  drawer.draw(picture, {&at, 1}, view, settings);
  return picture;
}

}  // namespace wellspring::test
