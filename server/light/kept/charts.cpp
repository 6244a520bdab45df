// SPDX-License-Identifier: Apache-2.0
#include "light/kept/charts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "light/material/material_use.h"
#include "world/surface.h"

namespace wellspring::light {
namespace {

constexpr float least_facing = 0.766f;  // cosine of 40 degrees, to the chart's normal
constexpr float smooth_edge = 0.9f;     // cosine between the mesh's normals on its two sides
constexpr float one_normal = 0.9998f;   // cosine of a degree: normals that count as the same
constexpr float most_tiles = 1 << 20;   // tiles of a chart at most, however thin its triangles

struct Triangle {
  Face face;
  float area = 0;  // square metres; 0: the triangle has no chart
  uint32_t neighbor[3] = {no_chart, no_chart, no_chart};
};

// Returns the first vertex at each vertex's position, so that seams of texture coordinates do not
// cut charts.
std::vector<uint32_t> weld(const Mesh& mesh) {
  struct Less {
    bool operator()(vec3 a, vec3 b) const {
      return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
    }
  };
  std::map<vec3, uint32_t, Less> known;
  std::vector<uint32_t> of(mesh.positions.size());
  for (size_t i = 0; i < of.size(); i++) {
    vec3 place = mesh.positions[i] + 0.0f;  // -0 is 0
    of[i] = is_finite(place) ? known.try_emplace(place, uint32_t(i)).first->second : uint32_t(i);
  }
  return of;
}

// Finds each triangle's neighbours: two triangles are, if they alone share an edge.
void find_neighbors(const Mesh& mesh, std::vector<Triangle>& triangles) {
  struct Edge {
    uint64_t ends;
    uint32_t triangle, side;
    bool operator<(const Edge& o) const {
      return ends != o.ends ? ends < o.ends : triangle < o.triangle;
    }
  };
  const std::vector<uint32_t> welded = weld(mesh);
  std::vector<Edge> edges;
  for (uint32_t t = 0; t < triangles.size(); t++) {
    if (!(triangles[t].area > 0)) continue;
    for (uint32_t side = 0; side < 3; side++) {
      uint64_t a = welded[mesh.triangles[t][int(side)]],
               b = welded[mesh.triangles[t][int((side + 1) % 3)]];
      edges.push_back({std::min(a, b) << 32 | std::max(a, b), t, side});
    }
  }
  std::sort(edges.begin(), edges.end());
  for (size_t i = 0; i < edges.size();) {
    size_t end = i;
    while (end < edges.size() && edges[end].ends == edges[i].ends) end++;
    if (end - i == 2) {
      triangles[edges[i].triangle].neighbor[edges[i].side] = edges[i + 1].triangle;
      triangles[edges[i + 1].triangle].neighbor[edges[i + 1].side] = edges[i].triangle;
    }
    i = end;
  }
}

std::vector<Triangle> read_triangles(const World& world, uint32_t instance) {
  const PlacedMesh& placed = world.placed(instance);
  std::vector<Triangle> triangles(placed.mesh->triangles.size());
  for (uint32_t t = 0; t < triangles.size(); t++) {
    Triangle& it = triangles[t];
    it.face = make_face(placed, t);
    vec3 cross = glm::cross(it.face.edge1, it.face.edge2);
    float area = 0.5f * length(cross);
    if (it.face.normal != vec3(0) && std::isfinite(area)) it.area = area;
  }
  return triangles;
}

// Collects the triangles that are connected with `seed` and face about as it does.
void grow(const std::vector<Triangle>& triangles, uint32_t seed, uint32_t chart,
          std::vector<uint32_t>& chart_of, std::vector<uint32_t>& grown) {
  const vec3 normal = triangles[seed].face.normal;
  size_t next = grown.size();
  grown.push_back(seed);
  chart_of[seed] = chart;
  for (; next < grown.size(); next++)
    for (uint32_t beside : triangles[grown[next]].neighbor) {
      if (beside == no_chart || chart_of[beside] != no_chart) continue;
      if (dot(triangles[beside].face.normal, normal) < least_facing) continue;
      chart_of[beside] = chart;
      grown.push_back(beside);
    }
}

// Returns the rectangle around a chart's triangles, along the longest edge of the first, cut into
// tiles.
IlluminationChart lay_out(const std::vector<Triangle>& triangles,
                          std::span<const uint32_t> of_chart, float tile) {
  const Face& seed = triangles[of_chart.front()].face;
  vec3 longest = seed.edge1;
  for (vec3 edge : {seed.edge2, seed.edge2 - seed.edge1})
    if (dot(edge, edge) > dot(longest, longest)) longest = edge;
  vec3 u = normalize(longest), v = cross(seed.normal, u);
  v /= std::max(length(v), 1e-20f);
  vec2 low(INFINITY), high(-INFINITY);
  for (uint32_t t : of_chart) {
    const Face& f = triangles[t].face;
    for (vec3 corner : {f.corner, f.corner + f.edge1, f.corner + f.edge2}) {
      vec2 at(dot(corner - seed.corner, u), dot(corner - seed.corner, v));
      low = min(low, at), high = max(high, at);
    }
  }
  IlluminationChart chart;
  chart.origin = seed.corner + low.x * u + low.y * v;
  vec2 size = max(high - low, vec2(1e-6f * tile + 1e-20f));
  tile *= std::max(1.0f, std::sqrt((size.x / tile + 1) * (size.y / tile + 1) / most_tiles));
  chart.columns = int(std::clamp(std::ceil(size.x / tile), 1.0f, most_tiles));
  chart.rows = int(std::clamp(std::ceil(size.y / tile), 1.0f, most_tiles));
  chart.along_u = u * (float(chart.columns) / size.x);
  chart.along_v = v * (float(chart.rows) / size.y);
  return chart;
}

// Returns whether the mesh's normals differ at the corners of those triangles.
bool is_bent(const PlacedMesh& placed, std::span<const uint32_t> of_chart) {
  const Mesh& mesh = *placed.mesh;
  vec3 first(0);
  for (uint32_t t : of_chart)
    for (int k = 0; k < 3; k++) {
      vec3 normal = placed.normal_to_world * mesh.normals[mesh.triangles[t][k]];
      normal /= std::max(length(normal), 1e-30f);
      if (first == vec3(0)) first = normal;
      if (!(dot(normal, first) > one_normal)) return true;
    }
  return false;
}

// Returns the mesh's normal at that corner of a triangle; not unit.
vec3 corner_normal(const PlacedMesh& placed, uint32_t triangle, vec3 place) {
  const Mesh& mesh = *placed.mesh;
  vec3 nearest(0);
  float away = INFINITY;
  for (int k = 0; k < 3; k++) {
    uint32_t vertex = mesh.triangles[triangle][k];
    vec3 line = vec3(placed.to_world * vec4(mesh.positions[vertex], 1)) - place;
    if (dot(line, line) < away) away = dot(line, line), nearest = mesh.normals[vertex];
  }
  return placed.normal_to_world * nearest;
}

void find_seams(const World& world, uint32_t instance, bool back,
                const std::vector<Triangle>& triangles, const std::vector<uint32_t>& chart_of,
                std::vector<ChartSeam>& seams) {
  const PlacedMesh& placed = world.placed(instance);
  for (uint32_t t = 0; t < triangles.size(); t++)
    for (int side = 0; side < 3; side++) {
      uint32_t beside = triangles[t].neighbor[side];
      if (beside == no_chart || beside < t || chart_of[beside] == chart_of[t]) continue;
      const Face& f = triangles[t].face;
      vec3 corners[3] = {f.corner, f.corner + f.edge1, f.corner + f.edge2};
      vec3 from = corners[side], to = corners[(side + 1) % 3];
      ChartSeam seam{{chart_of[t], chart_of[beside]}, from, to, {}};
      bool smooth = true;
      for (int end = 0; end < 2; end++) {
        vec3 place = end == 0 ? from : to;
        vec3 a = corner_normal(placed, t, place), b = corner_normal(placed, beside, place);
        smooth = smooth && dot(a, b) > smooth_edge * std::sqrt(dot(a, a) * dot(b, b));
        a += b;
        seam.normal[end] = (back ? -a : a) / std::max(length(a), 1e-30f);
      }
      if (smooth) seams.push_back(seam);
    }
}

std::vector<char> kept_materials(const Scene& scene) {
  TextureRanges ranges(scene);
  std::vector<char> kept;
  for (const Material& m : scene.materials) kept.push_back(keeps_illumination(m, ranges));
  return kept;
}

}  // namespace

bool keeps_illumination(const Material& m, TextureRanges& ranges) {
  if (m.unlit || m.transmission > 0 || m.repaints) return false;
  if (!(max_component(vec3(m.base_color)) > 0)) return false;
  return m.metallic * ranges.of(m.metallic_roughness_texture).low.z < all_metal;
}

double charted_area(const World& world) {
  const Scene& scene = world.scene();
  const std::vector<char> kept = kept_materials(scene);
  double area = 0;
  for (uint32_t i = 0; i < scene.instances.size(); i++) {
    size_t material = size_t(world.mesh_of(i).material);
    if (!kept[material]) continue;
    const int sides = scene.materials[material].double_sided ? 2 : 1;
    for (const Triangle& t : read_triangles(world, i)) area += double(sides) * double(t.area);
  }
  return area;
}

BakeCharts make_charts(const World& world, float tile) {
  const Scene& scene = world.scene();
  const std::vector<char> kept = kept_materials(scene);
  BakeCharts charts;
  charts.places = std::make_shared<IlluminationCharts>();
  IlluminationCharts& places = *charts.places;
  places.tile = tile;
  places.first_triangle.assign(scene.instances.size() * 2, no_chart);
  std::vector<uint32_t> chart_of, order;
  for (uint32_t i = 0; i < scene.instances.size(); i++) {
    const Mesh& mesh = world.mesh_of(i);
    if (!kept[size_t(mesh.material)]) continue;
    std::vector<Triangle> triangles = read_triangles(world, i);
    find_neighbors(mesh, triangles);
    chart_of.assign(triangles.size(), no_chart);
    order.resize(triangles.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(),
                     [&](uint32_t a, uint32_t b) { return triangles[a].area > triangles[b].area; });
    const bool both = scene.materials[size_t(mesh.material)].double_sided;
    const bool mapped = scene.materials[size_t(mesh.material)].normal_texture.texture >= 0;
    charts.vertices += mesh.positions.size() * (both ? 2 : 1);
    for (int back = 0; back < (both ? 2 : 1); back++) {
      std::fill(chart_of.begin(), chart_of.end(), no_chart);
      for (uint32_t seed : order) {
        if (chart_of[seed] != no_chart || !(triangles[seed].area > 0)) continue;
        uint32_t first = uint32_t(charts.triangles.size());
        grow(triangles, seed, uint32_t(places.charts.size()), chart_of, charts.triangles);
        std::span<const uint32_t> grown(charts.triangles.data() + first,
                                        charts.triangles.size() - first);
        IlluminationChart chart = lay_out(triangles, grown, tile);
        chart.first_tile = charts.tiles;
        chart.bent = is_bent(world.placed(i), grown);
        // Points of a scan face otherwise than the square that stands in for them.
        chart.sloped = chart.bent || mapped || mesh.stands_in;
        chart.reflectance = scene.materials[size_t(mesh.material)].spectra.reflectance;
        charts.sloped |= chart.sloped;
        charts.tiles += uint32_t(chart.columns) * uint32_t(chart.rows);
        vec3 normal = triangles[seed].face.normal;
        charts.surfaces.push_back(
            {i, back == 1, back == 1 ? -normal : normal, first, uint32_t(grown.size())});
        for (uint32_t t : grown) charts.area += double(triangles[t].area);
        places.charts.push_back(chart);
      }
      find_seams(world, i, back == 1, triangles, chart_of, charts.seams);
      places.first_triangle[size_t(i) * 2 + size_t(back)] = uint32_t(places.chart_of.size());
      places.chart_of.insert(places.chart_of.end(), chart_of.begin(), chart_of.end());
    }
  }
  return charts;
}

}  // namespace wellspring::light
