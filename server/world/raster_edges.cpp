// SPDX-License-Identifier: Apache-2.0
#include "world/raster_edges.h"

#include <cmath>

namespace wellspring {
namespace {

constexpr float step_tolerance = 0.01f;  // of the depth: farther apart is another surface
constexpr float smooth_cosine = 0.9f;    // of normals: what turns by more is a crease

vec3 normal_of(const RasterTriangle& t, float focal) {
  vec3 d = t.depth;  // in the eye's coordinates the plane is dot(normal, place) = 1
  return {d.y * focal, d.z * focal, d.x - d.y * t.corner.x - d.z * t.corner.y};
}

// How much nearer than the other side one's plane would be there; above 0: so it ends in between.
float lead(const EdgeSide& of, const EdgeSide& other, float slope) {
  return of.triangle ? (of.depth + slope - other.depth) / std::max(of.depth, other.depth) : -1;
}

bool is_smooth(const RasterTriangle& a, const RasterTriangle& b, float focal) {
  vec3 na = normal_of(a, focal), nb = normal_of(b, focal);
  float cosine = dot(na, nb);
  return cosine > 0 && cosine * cosine > smooth_cosine * smooth_cosine * dot(na, na) * dot(nb, nb);
}

// An edge on the way from one sampling place to the next: pixels up to there, and those by which
// that changes a pixel to the side, 0 to 1.
struct EdgeLine {
  float at = -1, slope = 0;
};

// How much of a pixel whose middle lies so far before the edge is beyond it.
float share_beyond(float at, float slope) {
  float high = 0.5f - at + 0.5f * slope, low = 0.5f - at - 0.5f * slope;
  if (high <= 0) return 0;
  return low >= 0 ? 0.5f - at : high * high / (2 * slope);
}

// From the place (x, y), which the triangle covers, to where it ends on the way to the neighbour at
// `step` along the axis; at -1: it does not, or at an edge that runs along that way.
EdgeLine end_of(const RasterTriangle& t, int x, int y, int step, bool vertical,
             const RasterView& view) {
  EdgeLine nearest{2, 0};
  bool across = false;
  for (int i = 0; i < 3; i++) {
    int64_t steps_x = int64_t(x) * raster_steps - view.centre_steps_x - t.from_x[i];
    int64_t steps_y = int64_t(y) * raster_steps - view.centre_steps_y - t.from_y[i];
    float edge = float(t.a[i] * steps_x + t.b[i] * steps_y) * (1.0f / raster_steps);
    float change = float((vertical ? t.b[i] : t.a[i]) * step);
    if (!(change < 0) || edge + change > 0) continue;
    float at = std::max(edge, 0.0f) / -change;
    if (at >= nearest.at) continue;
    int32_t a = std::abs(t.a[i]), b = std::abs(t.b[i]);
    nearest = {at, vertical ? float(a) / float(b) : float(b) / float(a)};
    across = vertical ? b > a : a >= b;
  }
  return across && nearest.at <= 1 ? nearest : EdgeLine{};
}

}  // namespace

EdgeCover find_edge(const EdgeSide& first, const EdgeSide& second, int x, int y, bool vertical,
                const RasterView& view, float focal) {
  auto slope = [&](const EdgeSide& s) {
    if (!s.triangle) return 0.0f;
    return vertical ? s.triangle->depth.z : s.triangle->depth.y;
  };
  float lead1 = lead(first, second, slope(first)), lead2 = lead(second, first, -slope(second));
  if (first.triangle && second.triangle && std::abs(lead1) < step_tolerance &&
      std::abs(lead2) < step_tolerance && first.triangle->instance == second.triangle->instance &&
      is_smooth(*first.triangle, *second.triangle, focal))
    return {};
  for (bool own : {lead1 >= lead2, lead1 < lead2}) {  // the side in front first
    const EdgeSide& side = own ? first : second;
    if (!side.triangle) continue;
    EdgeLine e = own ? end_of(*side.triangle, x, y, 1, vertical, view)
                     : end_of(*side.triangle, x + !vertical, y + vertical, -1, vertical, view);
    if (e.at < 0) continue;
    float here = share_beyond(e.at, e.slope), there = share_beyond(1 - e.at, e.slope);
    return own ? EdgeCover{here, there} : EdgeCover{there, here};
  }
  return {};
}

}  // namespace wellspring
