// SPDX-License-Identifier: Apache-2.0
#include "world/raster/raster_setup.h"

#include <algorithm>
#include <cmath>

#include "base/simd.h"

namespace wellspring::world {
namespace {

RasterPoint to_picture(const RasterCorner& c) {
  float inverse = 1 / c.w;
  RasterPoint p{c.x * inverse, c.y * inverse, inverse, c.barycentric, 0, 0};
  p.step_x = int32_t(std::lrint(p.x * raster_steps));
  p.step_y = int32_t(std::lrint(p.y * raster_steps));
  return p;
}

// Makes a linear function from its values f0, f1, f2 at three corners: value at the first and
// slopes.
struct Slopes {
  float x1, y1, x2, y2, inverse;
  vec3 operator()(float f0, float f1, float f2) const {
    float d1 = f1 - f0, d2 = f2 - f0;
    return {f0, (d1 * y2 - d2 * y1) * inverse, (d2 * x1 - d1 * x2) * inverse};
  }
};

// Returns an edge's bias: places on an edge belong to the triangle to the right of it or below it,
// so to one of two.
int32_t bias_of(int32_t a, int32_t b) { return a > 0 || (a == 0 && b > 0) ? 0 : -1; }

// Returns whether the triangle covers this place. Corners must be in the order that leaves the
// inside on the inner side.
bool covers(const RasterPoint& p0, const RasterPoint& p1, const RasterPoint& p2, int32_t x,
            int32_t y) {
  auto inside = [&](const RasterPoint& from, const RasterPoint& to) {
    int32_t a = from.step_y - to.step_y, b = to.step_x - from.step_x;
    return int64_t(a) * (x - from.step_x) + int64_t(b) * (y - from.step_y) + bias_of(a, b) >= 0;
  };
  return inside(p0, p1) && inside(p1, p2) && inside(p2, p0);
}

void finish(const RasterView& view, const RasterPoint& p0, RasterPoint p1, RasterPoint p2,
            const RasterTriangle& unfinished, std::vector<RasterTriangle>& out) {
  int32_t low_x = std::min({p0.step_x, p1.step_x, p2.step_x});
  int32_t high_x = std::max({p0.step_x, p1.step_x, p2.step_x});
  int32_t low_y = std::min({p0.step_y, p1.step_y, p2.step_y});
  int32_t high_y = std::max({p0.step_y, p1.step_y, p2.step_y});
  // These are the pixels whose sampling places lie between; shifting rounds down.
  int left = std::max((low_x + view.centre_steps_x + raster_steps - 1) >> raster_step_bits, 0);
  int right = std::min((high_x + view.centre_steps_x) >> raster_step_bits, view.width - 1);
  int top = std::max((low_y + view.centre_steps_y + raster_steps - 1) >> raster_step_bits, 0);
  int bottom = std::min((high_y + view.centre_steps_y) >> raster_step_bits, view.height - 1);
  if (left > right || top > bottom) return;
  int64_t area = int64_t(p1.step_x - p0.step_x) * (p2.step_y - p0.step_y) -
                 int64_t(p2.step_x - p0.step_x) * (p1.step_y - p0.step_y);
  if (area == 0) return;
  // Places are counted downwards, so that counterclockwise triangles have a negative area.
  if (unfinished.one_sided && (area < 0) == unfinished.mirrored) return;
  if (area < 0) std::swap(p1, p2);
  if (left == right && top == bottom &&
      !covers(p0, p1, p2, left * raster_steps - view.centre_steps_x,
              top * raster_steps - view.centre_steps_y))
    return;
  RasterTriangle& t = out.emplace_back(unfinished);
  t.turned = area < 0;
  t.left = int16_t(left), t.right = int16_t(right), t.top = int16_t(top),
  t.bottom = int16_t(bottom);

  const RasterPoint* p[3] = {&p0, &p1, &p2};
  for (int i = 0; i < 3; i++) {
    const RasterPoint &from = *p[i], &to = *p[(i + 1) % 3];
    t.a[i] = from.step_y - to.step_y;
    t.b[i] = to.step_x - from.step_x;
    t.from_x[i] = from.step_x, t.from_y[i] = from.step_y;
    t.bias[i] = bias_of(t.a[i], t.b[i]);
  }

  Slopes slopes{p1.x - p0.x, p1.y - p0.y, p2.x - p0.x, p2.y - p0.y, 0};
  float twice = slopes.x1 * slopes.y2 - slopes.x2 * slopes.y1;
  slopes.inverse = std::abs(twice) > 1e-12f ? 1 / twice : 0;
  t.corner = {p0.x, p0.y};
  t.depth = slopes(p0.depth, p1.depth, p2.depth);
  t.u =
      slopes(p0.depth * p0.barycentric.x, p1.depth * p1.barycentric.x, p2.depth * p2.barycentric.x);
  t.v =
      slopes(p0.depth * p0.barycentric.y, p1.depth * p1.barycentric.y, p2.depth * p2.barycentric.y);
  t.least_depth = std::min({p0.depth, p1.depth, p2.depth});
  t.most_depth = std::max({p0.depth, p1.depth, p2.depth});
}

constexpr int planes = 5;
// Returns how far inside plane `i` of the visible space the corner is: in front of the eye, and
// within reach of the centre.
float inside(const RasterView& view, const RasterCorner& c, int i) {
  switch (i) {
    case 0: return c.w - view.near;
    case 1: return raster_reach * c.w - c.x;
    case 2: return raster_reach * c.w + c.x;
    case 3: return raster_reach * c.w - c.y;
    default: return raster_reach * c.w + c.y;
  }
}

RasterCorner between(const RasterCorner& a, const RasterCorner& b, float t) {
  auto mix = [t](float from, float to) { return from + (to - from) * t; };
  return {mix(a.x, b.x), mix(a.y, b.y), mix(a.w, b.w),
          a.barycentric + (b.barycentric - a.barycentric) * t};
}

}  // namespace

void project_corners(const RasterView& view, int count, RasterCorners& corners) {
  for (int i = 0; i < count; i += lane_count) {
    Lanes x = load_lanes(corners.x + i), y = load_lanes(corners.y + i),
          w = load_lanes(corners.w + i);
    Lanes reach = raster_reach * w;
    // The tests are negated, so that NaN is outside.
    LaneMask outside = ~LaneMask(w >= view.near) & 1;
    outside |= (~LaneMask(x <= reach) & 2) | (~LaneMask(x >= -reach) & 4);
    outside |= (~LaneMask(y <= reach) & 8) | (~LaneMask(y >= -reach) & 16);
    Lanes inverse = 1 / (outside == 0 ? w : all_lanes(1));
    Lanes px = (outside == 0 ? x : all_lanes(0)) * inverse,
          py = (outside == 0 ? y : all_lanes(0)) * inverse;
    store_lanes(corners.depth + i, inverse);
    store_lanes(corners.picture_x + i, px);
    store_lanes(corners.picture_y + i, py);
    store_lanes(corners.step_x + i, round_lanes(px * float(raster_steps)));
    store_lanes(corners.step_y + i, round_lanes(py * float(raster_steps)));
    store_lanes(corners.outside + i, outside);
  }
}

void add_triangle(const RasterView& view, const RasterCorners& c, int i, int j, int k,
                  const RasterTriangle& unfinished, std::vector<RasterTriangle>& out) {
  if (c.outside[i] & c.outside[j] & c.outside[k]) return;
  int32_t outside = c.outside[i] | c.outside[j] | c.outside[k];
  if (outside == 0) {
    auto point = [&](int n, vec2 barycentric) {
      return RasterPoint{c.picture_x[n], c.picture_y[n], c.depth[n],
                         barycentric,    c.step_x[n],    c.step_y[n]};
    };
    finish(view, point(i, {0, 0}), point(j, {1, 0}), point(k, {0, 1}), unfinished, out);
    return;
  }
  auto corner = [&](int n, vec2 barycentric) {
    return RasterCorner{c.x[n], c.y[n], c.w[n], barycentric};
  };
  RasterCorner corners[3] = {corner(i, {0, 0}), corner(j, {1, 0}), corner(k, {0, 1})};
  // Clip as in Sutherland and Hodgman, "Reentrant Polygon Clipping", 1974.
  RasterCorner polygon[2][3 + planes];
  int count = 3, side = 0;
  std::copy(corners, corners + 3, polygon[0]);
  for (int plane = 0; plane < planes; plane++) {
    if (!(outside >> plane & 1)) continue;
    const RasterCorner* in = polygon[side];
    RasterCorner* kept = polygon[side ^ 1];
    int n = 0;
    for (int m = 0; m < count; m++) {
      const RasterCorner &a = in[m], &b = in[(m + 1) % count];
      float at_a = inside(view, a, plane), at_b = inside(view, b, plane);
      if (at_a >= 0) kept[n++] = a;
      // Edges are cut from the inner end, so that neighbours cut their common edge at the same
      // place.
      if (at_a >= 0 && at_b < 0) kept[n++] = between(a, b, at_a / (at_a - at_b));
      if (at_a < 0 && at_b >= 0) kept[n++] = between(b, a, at_b / (at_b - at_a));
    }
    count = n, side ^= 1;
    if (count < 3) return;
  }
  for (int m = 0; m < count; m++) {
    RasterCorner& cut = polygon[side][m];
    if (!(cut.w > 0)) return;  // rounding, for a triangle that ends at the eye
    cut.x = std::clamp(cut.x, -raster_reach * cut.w, raster_reach * cut.w);
    cut.y = std::clamp(cut.y, -raster_reach * cut.w, raster_reach * cut.w);
  }
  RasterTriangle part = unfinished;
  part.clipped = true;
  for (int m = 1; m + 1 < count; m++)
    finish(view, to_picture(polygon[side][0]), to_picture(polygon[side][m]),
           to_picture(polygon[side][m + 1]), part, out);
}

}  // namespace wellspring::world
