// SPDX-License-Identifier: Apache-2.0
#include "world/raster/raster_clusters.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace wellspring::world {
namespace {

uint64_t spread(uint32_t x) {  // ten bits to every third place
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

// The power of 16 that the area is about; what has none counts as tiny.
uint32_t size_class(float area) {
  int power = area > 0 && std::isfinite(area) ? std::ilogb(area) : -140;
  return uint32_t(std::clamp(140 + power, 0, 255)) / 4;
}

// Numbers of the finite triangles, the larger ones last, those of like size along a space-filling
// curve through their centres (Morton 1966).
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

}  // namespace wellspring::world
