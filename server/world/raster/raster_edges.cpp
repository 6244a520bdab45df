// SPDX-License-Identifier: Apache-2.0
#include "world/raster/raster_edges.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace wellspring::world {
namespace {

// Share of the depth; surfaces farther apart are different ones.
constexpr float step_tolerance = 0.01f;
constexpr float least_gap = 1 / 16.0f;  // pixels
// Cosine between normals; a surface that turns by more has a crease.
constexpr float smooth_cosine = 0.9f;

vec3 normal_of(const RasterTriangle& t, float focal) {
  vec3 d = t.depth;  // in the eye's coordinates the plane is dot(normal, place) = 1
  return {d.y * focal, d.z * focal, d.x - d.y * t.corner.x - d.z * t.corner.y};
}

// Returns how much nearer than the other side one side's plane would be there, as a share of the
// depth; above 0: so the plane ends in between.
float lead(const EdgeSide& of, const EdgeSide& other, float slope) {
  return of.triangle ? (of.depth + slope - other.depth) / std::max(of.depth, other.depth) : -1;
}

bool is_smooth(const RasterTriangle& a, const RasterTriangle& b, float focal) {
  vec3 na = normal_of(a, focal), nb = normal_of(b, focal);
  float cosine = dot(na, nb);
  return cosine > 0 && cosine * cosine > smooth_cosine * smooth_cosine * dot(na, na) * dot(nb, nb);
}

// Returns the share of a pixel that is beyond the edge, which lies `at` pixels from its middle.
float share_beyond(float at, float slope) {
  float high = 0.5f - at + 0.5f * slope, low = 0.5f - at - 0.5f * slope;
  if (high <= 0) return 0;
  return low >= 0 ? 0.5f - at : high * high / (2 * slope);
}

bool is_thin(const EdgeSide& side) {
  return side.triangle && side.triangle->bar && side.triangle->width * side.depth < thin_width;
}

// Returns whether the edge cuts the line rather than runs along it.
bool is_across(const EdgeLine& e, bool vertical) {
  return e.at <= 1 && (vertical ? e.slope < 1 : e.slope <= 1);
}

// Returns the share of a pixel between its own surface and the other.
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
  // If all lies on one wall, the surface between two of its strips looks much like these, so only
  // surfaces apart are followed.
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

namespace {

constexpr float crease_cosine = 0.9f;  // cosine of the angle between neighbours' normals
constexpr float slender = 4;           // parts of bars are so many times longer than wide
constexpr int most_steps = 8;

vec3 corner_of(const Mesh& mesh, uint32_t triangle, int k) {
  return mesh.positions[mesh.triangles[triangle][k % 3]];
}
vec3 normal_of(const Mesh& mesh, uint32_t triangle) {
  vec3 a = corner_of(mesh, triangle, 0);
  return cross(corner_of(mesh, triangle, 1) - a, corner_of(mesh, triangle, 2) - a);
}
float length_of(const Mesh& mesh, uint32_t triangle) {  // length of the longest edge
  float longest = 0;
  for (int k = 0; k < 3; k++)
    longest =
        std::max(longest, length(corner_of(mesh, triangle, k + 1) - corner_of(mesh, triangle, k)));
  return longest;
}
// Returns the least distance from an edge to the corner on its other side.
float width_of(const Mesh& mesh, uint32_t triangle) {
  float longest = length_of(mesh, triangle);
  return longest > 0 ? length(normal_of(mesh, triangle)) / longest : 0;
}

// Numbers the places of vertices; vertices at the same place get the same number.
std::vector<uint32_t> number_places(const Mesh& mesh) {
  std::vector<uint32_t> order(mesh.positions.size()), number(order.size());
  for (uint32_t i = 0; i < order.size(); i++) order[i] = i;
  auto key = [&](uint32_t i) {
    vec3 p = is_finite(mesh.positions[i]) ? mesh.positions[i] : vec3(0);
    return std::tuple(p.x, p.y, p.z);
  };
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return key(a) < key(b); });
  for (size_t i = 0; i < order.size(); i++)
    number[order[i]] =
        i > 0 && key(order[i]) == key(order[i - 1]) ? number[order[i - 1]] : uint32_t(i);
  return number;
}

}  // namespace

MeshNeighbours find_neighbours(const Mesh& mesh) {
  MeshNeighbours found;
  size_t count = mesh.triangles.size();
  found.over.assign(count, {MeshNeighbours::none, MeshNeighbours::none, MeshNeighbours::none});
  found.width.resize(count);
  found.bar.assign(count, 0);
  std::vector<uint32_t> place = number_places(mesh);
  struct Side {
    uint32_t low, high, which;
    auto edge() const { return std::pair(low, high); }
  };
  std::vector<Side> sides;
  sides.reserve(3 * count);
  for (uint32_t t = 0; t < count; t++)
    for (int k = 0; k < 3; k++) {
      uint32_t a = place[mesh.triangles[t][k]], b = place[mesh.triangles[t][(k + 1) % 3]];
      sides.push_back({std::min(a, b), std::max(a, b), t * 4 + uint32_t(k)});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tuple(a.low, a.high, a.which) < std::tuple(b.low, b.high, b.which);
  });
  for (size_t i = 0, end; i < sides.size(); i = end) {
    for (end = i + 1; end < sides.size() && sides[end].edge() == sides[i].edge();) end++;
    if (end - i != 2) {
      for (size_t k = i; k < end; k++) found.bar[sides[k].which / 4] = 1;
      continue;
    }
    uint32_t a = sides[i].which, b = sides[i + 1].which;
    found.over[a / 4][a % 4] = b, found.over[b / 4][b % 4] = a;
    vec3 na = normal_of(mesh, a / 4), nb = normal_of(mesh, b / 4);
    if (!(dot(na, nb) > crease_cosine * length(na) * length(nb)))
      found.bar[a / 4] = found.bar[b / 4] = 1;
  }
  for (uint32_t t = 0; t < count; t++) {
    found.width[t] = width_of(mesh, t);
    for (uint32_t n : found.over[t])
      if (n != MeshNeighbours::none)
        found.width[t] = std::min(found.width[t], width_of(mesh, n / 4));
    found.bar[t] &= length_of(mesh, t) > slender * found.width[t];
  }
  return found;
}

TriangleExit exit_of(const RasterTriangle& t, int x, int y, int step, bool vertical,
                     const RasterView& view) {
  TriangleExit nearest;
  for (int i = 0; i < 3; i++) {
    int32_t change = (vertical ? t.b[i] : t.a[i]) * step;
    if (change >= 0) continue;
    int64_t steps_x = x * raster_steps - view.centre_steps_x - t.from_x[i];
    int64_t steps_y = y * raster_steps - view.centre_steps_y - t.from_y[i];
    float edge = float(t.a[i] * steps_x + t.b[i] * steps_y) * (1.0f / raster_steps);
    float inverse = -1 / float(change), at = std::max(edge, 0.0f) * inverse;
    if (at > 1 || at >= nearest.at) continue;
    nearest.at = at, nearest.edge = i;
    nearest.slope = std::abs(float(vertical ? t.a[i] : t.b[i])) * inverse;
  }
  return nearest;
}

EdgeLine SurfaceWalk::end_of(const RasterTriangle& t, const TriangleExit& exit, int x, int y,
                             int step, bool vertical) const {
  if (t.clipped) return exit;
  const PlacedMesh& placed = world.placed(t.instance);
  const Mesh& mesh = *placed.mesh;
  const MeshNeighbours& neighbours = meshes[mesh_of[t.instance]];
  uint32_t triangle = t.triangle;
  int edge = t.turned ? 2 - exit.edge : exit.edge;
  uint32_t next = neighbours.over[triangle][size_t(edge)];
  if (next == MeshNeighbours::none) return exit;

  // Returns a place along the way and across it, in pixels from the sampling place.
  auto on_the_way = [&](vec2 at) {
    return vertical ? vec2(at.y * float(step), at.x) : vec2(at.x * float(step), at.y);
  };
  bool seen = true;
  auto project = [&](vec3 p) {
    if (placed.apart) {
      p = mat3(placed.to_world) * p + (vec3(placed.to_world[3]) - view.position);
    } else {
      if (!placed.moving && !placed.in_place) p = vec3(placed.to_world * vec4(p, 1));
      p -= view.position;
    }
    float w = dot(p, view.forward), scale = focal / w;
    seen &= w >= raster.near;
    return on_the_way({dot(p, right_of_middle(view)) * scale + raster.centre_x - float(x),
                       -dot(p, above_middle(view)) * scale + raster.centre_y - float(y)});
  };
  auto corner = [&](int i) {  // corner of the triangle itself
    return on_the_way({float(t.from_x[i] + raster.centre_steps_x) / raster_steps - float(x),
                       float(t.from_y[i] + raster.centre_steps_y) / raster_steps - float(y)});
  };
  auto line = [](vec2 a, vec2 b) {
    float slope = (b.x - a.x) / (b.y - a.y);
    return EdgeLine{a.x - slope * a.y, std::abs(slope)};
  };
  // These are the edge's ends.
  vec2 a = corner(exit.edge), b = corner((exit.edge + 1) % 3);
  if (t.turned) std::swap(a, b);
  if ((a.y < 0) == (b.y < 0)) return exit;  // rounding
  vec3 a_place = corner_of(mesh, triangle, edge), b_place = corner_of(mesh, triangle, edge + 1);
  EdgeLine end = exit;
  for (int i = 0; i < most_steps && end.at <= 1 && next != MeshNeighbours::none; i++) {
    triangle = next / 4;
    int shared = int(next % 4);
    vec3 c_place = corner_of(mesh, triangle, shared + 2);
    vec2 c = project(c_place);
    if (!seen) break;
    bool a_first = corner_of(mesh, triangle, shared) == a_place;
    bool past_a = (a.y < 0) != (c.y < 0);  // between a and c, else between c and b
    EdgeLine e = past_a ? line(a, c) : line(c, b);
    if (!(e.at > end.at)) break;  // the surface turns away
    end = e;
    edge = past_a == a_first ? (shared + 2) % 3 : (shared + 1) % 3;
    (past_a ? b : a) = c, (past_a ? b_place : a_place) = c_place;
    next = neighbours.over[triangle][size_t(edge)];
  }
  return end;
}

}  // namespace wellspring::world
