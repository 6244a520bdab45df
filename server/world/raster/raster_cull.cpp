// SPDX-License-Identifier: Apache-2.0
#include "world/raster/raster_cull.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace wellspring::world {
namespace {

uint64_t spread(uint32_t x) {  // spreads ten bits to every third place
  uint64_t r = x & 0x3ffu;
  r = (r | r << 16) & 0x30000ffu;
  r = (r | r << 8) & 0x300f00fu;
  r = (r | r << 4) & 0x30c30c3u;
  return (r | r << 2) & 0x9249249u;
}

float area_of(const Mesh& mesh, const uvec3& t) {
  vec3 a = mesh.positions[t.x];
  return 0.5f * length(cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a));
}

// Returns about the power of 16 of the area; a triangle without an area counts as tiny.
uint32_t size_class(float area) {
  int power = area > 0 && std::isfinite(area) ? std::ilogb(area) : -140;
  return uint32_t(std::clamp(140 + power, 0, 255)) / 4;
}

// Returns the numbers of the finite triangles, the larger ones last, those of like size along a
// space-filling curve through their centres (Morton 1966).
std::vector<uint32_t> sort_in_space(const Mesh& mesh) {
  Bounds box;
  auto centre = [&](const uvec3& t) {
    return (mesh.positions[t.x] + mesh.positions[t.y] + mesh.positions[t.z]) / 3.0f;
  };
  std::vector<std::pair<uint64_t, uint32_t>> order;
  order.reserve(mesh.triangles.size());
  for (uint32_t i = 0; i < mesh.triangles.size(); i++) {
    vec3 c = centre(mesh.triangles[i]);
    if (!is_finite(c)) continue;
    box.low = min(box.low, c), box.high = max(box.high, c);
    order.push_back({0, i});
  }
  vec3 scale = 1023.0f / max(box.high - box.low, vec3(1e-30f));
  for (auto& [key, i] : order) {
    vec3 c = clamp((centre(mesh.triangles[i]) - box.low) * scale, 0.0f, 1023.0f);
    key = spread(uint32_t(c.x)) | spread(uint32_t(c.y)) << 1 | spread(uint32_t(c.z)) << 2 |
          uint64_t(size_class(area_of(mesh, mesh.triangles[i]))) << 32;
  }
  std::sort(order.begin(), order.end());
  std::vector<uint32_t> sorted(order.size());
  for (size_t i = 0; i < order.size(); i++) sorted[i] = order[i].second;
  return sorted;
}

void pad_corners(MeshClusters& mesh) {
  while (mesh.x.size() % 8 != 0) {
    mesh.x.push_back(mesh.x.back());
    mesh.y.push_back(mesh.y.back());
    mesh.z.push_back(mesh.z.back());
    mesh.vertex.push_back(mesh.vertex.back());
  }
}

void finish(MeshClusters& out, Cluster& cluster) {
  cluster.corners = uint32_t(out.x.size()) - cluster.first_corner;
  cluster.triangles = uint32_t(out.triangle.size()) - cluster.first_triangle;
  vec3 low(INFINITY), high(-INFINITY);
  auto place = [&](uint32_t i) { return vec3(out.x[i], out.y[i], out.z[i]); };
  for (uint32_t i = cluster.first_corner; i < out.x.size(); i++)
    low = min(low, place(i)), high = max(high, place(i));
  cluster.box = {low, high};
  cluster.centre = 0.5f * low + 0.5f * high;
  for (uint32_t i = cluster.first_corner; i < out.x.size(); i++)
    cluster.radius = std::max(cluster.radius, glm::length(place(i) - cluster.centre));
  pad_corners(out);
  out.clusters.push_back(cluster);
  cluster = {};
  cluster.first_corner = uint32_t(out.x.size());
  cluster.first_triangle = uint32_t(out.triangle.size());
}

}  // namespace

MeshClusters make_clusters(const Mesh& mesh) {
  MeshClusters out;
  Cluster cluster;
  std::unordered_map<uint32_t, uint8_t> known;  // vertex -> corner of this cluster
  for (uint32_t number : sort_in_space(mesh)) {
    if (out.triangle.size() - cluster.first_triangle >= Cluster::most_triangles ||
        known.size() + 3 > Cluster::most_corners) {
      finish(out, cluster);
      known.clear();
    }
    std::array<uint8_t, 3> corner;
    for (int k = 0; k < 3; k++) {
      uint32_t vertex = mesh.triangles[number][k];
      auto [entry, fresh] = known.try_emplace(vertex, uint8_t(known.size()));
      if (fresh) {
        vec3 p = mesh.positions[vertex];
        out.x.push_back(p.x), out.y.push_back(p.y), out.z.push_back(p.z);
        out.vertex.push_back(vertex);
      }
      corner[size_t(k)] = entry->second;
    }
    cluster.area += area_of(mesh, mesh.triangles[number]);
    out.corner.push_back(corner);
    out.triangle.push_back(number);
  }
  if (!known.empty()) finish(out, cluster);
  return out;
}

Bounds moving_box(const PlacedMesh& placed) {
  Bounds box;
  if (!placed.moving) return box;
  for (const vec3& p : placed.mesh->positions)
    box.low = min(box.low, p), box.high = max(box.high, p);
  return box;
}

void find_pieces(const View& view, const PlacedMesh& placed, const MeshClusters& mesh,
                 uint32_t instance, const Bounds& box, float near,
                 std::vector<RasterPiece>& pieces) {
  float up = view.tan_half_fov, side = up * float(view.width) / float(view.height);
  // Both sides take the border plane that is farther from the axis, so that nothing in sight is
  // left out.
  vec2 far_border = glm::abs(view.middle) + vec2(side, up);
  float up_norm = 1 / std::sqrt(1 + far_border.y * far_border.y),
        side_norm = 1 / std::sqrt(1 + far_border.x * far_border.x);
  vec3 to_right = right_of_middle(view), above = above_middle(view);
  // Returns the depth of the nearest place of a sphere, infinite if none of it is in sight.
  auto nearest = [&](vec3 centre, float radius) {
    vec3 d = centre - view.position;
    float w = dot(d, view.forward);
    bool beside = (std::abs(dot(d, to_right)) - side * w) * side_norm > radius ||
                  (std::abs(dot(d, above)) - up * w) * up_norm > radius;
    return w < -radius || beside ? INFINITY : w - radius;
  };
  auto add = [&](uint32_t cluster, float depth, float area, float size) {
    float away = std::max(depth, 0.1f * size) + near;
    pieces.push_back({instance, cluster, depth, area / (away * away)});
  };
  if (placed.moving) {  // its clusters have moved: all of it or nothing
    float radius = 0.5f * glm::length(box.high - box.low) * 1.001f + near;
    float depth = nearest(0.5f * box.low + 0.5f * box.high, radius);
    if (depth == INFINITY) return;
    for (uint32_t k = 0; k < mesh.clusters.size(); k++) add(k, depth, 0, radius);
    return;
  }
  float scale = 1;
  if (!placed.in_place) {
    float row = 0;  // no length grows by more than the root of the sum of squares
    for (int k = 0; k < 3; k++) row += dot(vec3(placed.to_world[k]), vec3(placed.to_world[k]));
    scale = std::sqrt(row);
  }
  for (uint32_t k = 0; k < mesh.clusters.size(); k++) {
    const Cluster& cluster = mesh.clusters[k];
    vec3 centre =
        placed.in_place ? cluster.centre : vec3(placed.to_world * vec4(cluster.centre, 1));
    float radius = cluster.radius * scale * 1.001f + near, depth = nearest(centre, radius);
    if (depth != INFINITY) add(k, depth, cluster.area * scale * scale, radius);
  }
}

size_t put_hiding_first(std::vector<RasterPiece>& pieces) {
  constexpr size_t share = 6, least = 32;  // a sixth of them hides most of what is hidden
  size_t first = std::min(std::max(pieces.size() / share, least), pieces.size());
  auto same_order = [](const RasterPiece& a, const RasterPiece& b) {
    return a.instance != b.instance ? a.instance < b.instance : a.cluster < b.cluster;
  };
  auto middle = pieces.begin() + ptrdiff_t(first);
  std::nth_element(pieces.begin(), middle, pieces.end(),
                   [&](const RasterPiece& a, const RasterPiece& b) {
                     return a.hiding != b.hiding ? a.hiding > b.hiding : same_order(a, b);
                   });
  auto nearer = [&](const RasterPiece& a, const RasterPiece& b) {
    return a.depth != b.depth ? a.depth < b.depth : same_order(a, b);
  };
  std::sort(pieces.begin(), middle, nearer);
  std::sort(middle, pieces.end(), nearer);
  return first;
}

bool is_hidden(const View& view, const RasterView& raster, const Bounds& box, const mat4* to_world,
               std::span<const TilePixels> tiles) {
  Lanes x, y, z;
  for (int k = 0; k < lane_count; k++) {
    vec3 p(k & 1 ? box.high.x : box.low.x, k & 2 ? box.high.y : box.low.y,
           k & 4 ? box.high.z : box.low.z);
    if (to_world) p = vec3(*to_world * vec4(p, 1));
    p -= view.position;
    x[k] = p.x, y[k] = p.y, z[k] = p.z;
  }
  auto along = [&](vec3 axis) { return axis.x * x + axis.y * y + axis.z * z; };
  Lanes w = along(view.forward);
  // Rounding grows with the distance of the projected corners.
  Lanes nearest = w - 1e-5f * (lanes_abs(x) + lanes_abs(y) + lanes_abs(z));
  if (negative_lanes(LaneMask(nearest > raster.near)) != 255) return false;
  float scale = 0.5f * float(view.height) / view.tan_half_fov;
  Lanes inverse = 1 / nearest;
  Lanes column = along(right_of_middle(view)) * scale / w + raster.centre_x,
        row = raster.centre_y - along(above_middle(view)) * scale / w;
  float low_x = column[0], high_x = low_x, low_y = row[0], high_y = low_y, most = inverse[0];
  for (int k = 1; k < lane_count; k++) {
    low_x = std::min(low_x, column[k]), high_x = std::max(high_x, column[k]);
    low_y = std::min(low_y, row[k]), high_y = std::max(high_y, row[k]);
    most = std::max(most, inverse[k]);
  }
  auto square_of = [](float at, int size) {
    return at > 0 ? int(std::min(at, float(size - 1))) / TilePixels::square : 0;
  };
  int x0 = square_of(low_x - 1, view.width), x1 = square_of(high_x + 1, view.width),
      y0 = square_of(low_y - 1, view.height), y1 = square_of(high_y + 1, view.height);
  constexpr int across = TilePixels::across, down = tile_height / TilePixels::square;
  int columns = (view.width + tile_width - 1) / tile_width;
  for (int sy = y0; sy <= y1; sy++)
    for (int sx = x0; sx <= x1; sx++) {
      const TilePixels& tile = tiles[size_t(sy / down * columns + sx / across)];
      if (tile.least[sy % down * across + sx % across] < most) return false;
    }
  return true;
}

}  // namespace wellspring::world
