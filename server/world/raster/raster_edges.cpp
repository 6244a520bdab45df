// SPDX-License-Identifier: Apache-2.0
#include "world/raster/raster_edges.h"

#include <cmath>

namespace wellspring::world {
namespace {

constexpr float step_tolerance = 0.01f;  // of the depth: farther apart is another surface
constexpr float least_gap = 1 / 16.0f;   // of a pixel
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

// How much of a pixel whose middle lies so far before the edge is beyond it.
float share_beyond(float at, float slope) {
  float high = 0.5f - at + 0.5f * slope, low = 0.5f - at - 0.5f * slope;
  if (high <= 0) return 0;
  return low >= 0 ? 0.5f - at : high * high / (2 * slope);
}

bool is_thin(const EdgeSide& side) {
  return side.triangle && side.triangle->bar && side.triangle->width * side.depth < thin_width;
}

// Does the edge cut the line rather than run along it?
bool is_across(const EdgeLine& e, bool vertical) {
  return e.at <= 1 && (vertical ? e.slope < 1 : e.slope <= 1);
}

// What is left of a pixel between its own surface and the other.
float share_between(const EdgeLine& own, const EdgeLine& other) {
  float share = share_beyond(own.at, own.slope) - share_beyond(1 - other.at, other.slope);
  return std::max(share, 0.0f);
}

}  // namespace

EdgeCover find_gap(const EdgeSide& first, const EdgeSide& second, int x, int y, bool vertical,
                   const SurfaceWalk& walk) {
  if (!is_thin(first) || !is_thin(second)) return {};
  int next_x = x + !vertical, next_y = y + vertical;
  TriangleExit here = exit_of(*first.triangle, x, y, 1, vertical, walk.raster),
               there = exit_of(*second.triangle, next_x, next_y, -1, vertical, walk.raster);
  if (here.at + there.at > 1 - least_gap) return {};  // they have an edge in common, or no end
  EdgeLine one = walk.end_of(*first.triangle, here, x, y, 1, vertical),
           other = walk.end_of(*second.triangle, there, next_x, next_y, -1, vertical);
  if (one.at + other.at > 1 - least_gap || !is_across(one, vertical) || !is_across(other, vertical))
    return {};
  return {share_between(one, other), share_between(other, one)};
}

EdgeCover find_edge(const EdgeSide& first, const EdgeSide& second, int x, int y, bool vertical,
                    const SurfaceWalk& walk) {
  // Where all lies on one wall, what is between two of its strips looks much as these do.
  bool apart =
      std::min(first.depth, second.depth) < behind_both * std::max(first.depth, second.depth);
  auto surface_end = [&](bool own) -> EdgeLine {
    const EdgeSide& side = own ? first : second;
    int from_x = own ? x : x + !vertical, from_y = own ? y : y + vertical, step = own ? 1 : -1;
    TriangleExit e = exit_of(*side.triangle, from_x, from_y, step, vertical, walk.raster);
    if (e.at > 1 || !apart || !is_thin(side)) return e;
    return walk.end_of(*side.triangle, e, from_x, from_y, step, vertical);
  };
  auto slope = [&](const EdgeSide& s) {
    if (!s.triangle) return 0.0f;
    return vertical ? s.triangle->depth.z : s.triangle->depth.y;
  };
  float lead1 = lead(first, second, slope(first)), lead2 = lead(second, first, -slope(second));
  if (first.triangle && second.triangle && std::abs(lead1) < step_tolerance &&
      std::abs(lead2) < step_tolerance && first.triangle->instance == second.triangle->instance &&
      is_smooth(*first.triangle, *second.triangle, walk.focal))
    return {};
  for (bool own : {lead1 >= lead2, lead1 < lead2}) {  // the side in front first
    const EdgeSide& side = own ? first : second;
    if (!side.triangle) continue;
    EdgeLine e = surface_end(own);
    if (!is_across(e, vertical)) continue;
    float here = share_beyond(e.at, e.slope), there = share_beyond(1 - e.at, e.slope);
    return own ? EdgeCover{here, there} : EdgeCover{there, here};
  }
  return {};
}

}  // namespace wellspring::world
