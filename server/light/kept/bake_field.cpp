// SPDX-License-Identifier: Apache-2.0
#include "light/kept/bake_field.h"

#include <algorithm>
#include <cmath>

#include "base/memory.h"
#include "base/parallel.h"
#include "world/surface.h"

namespace wellspring::light {
namespace {

// Share of a tile's side; rounding puts places that far beside it.
constexpr float occupied_margin = 1e-3f;
constexpr float least_area = 1e-9f;  // share of a cell; a smaller part counts as none
constexpr float nearest_eye = 0.5f;  // share of the median distance; nearer eyes count as that far

// Holds a convex polygon, with room for a triangle clipped by a rectangle.
struct Polygon {
  vec2 corner[8];
  int count = 0;
};

// Returns the part of a polygon on the side of `line` of an axis where `sign` times the coordinate
// is less.
Polygon clip(const Polygon& in, int axis, float line, float sign) {
  Polygon out;
  for (int i = 0; i < in.count; i++) {
    vec2 a = in.corner[i], b = in.corner[(i + 1) % in.count];
    float from = sign * (line - a[axis]), to = sign * (line - b[axis]);
    if (from >= 0 && out.count < 8) out.corner[out.count++] = a;
    if ((from < 0) != (to < 0) && out.count < 8) {
      vec2 cut = a + (b - a) * (from / (from - to));
      cut[axis] = line;
      out.corner[out.count++] = cut;
    }
  }
  return out;
}

Polygon clip_to_box(const vec2* triangle, vec2 low, vec2 high) {
  Polygon p;
  p.count = 3;
  std::copy_n(triangle, 3, p.corner);
  p = clip(p, 0, high.x, 1), p = clip(p, 0, low.x, -1);
  p = clip(p, 1, high.y, 1), p = clip(p, 1, low.y, -1);
  return p;
}

float cross(vec2 a, vec2 b) { return a.x * b.y - a.y * b.x; }

float area_of(const Polygon& p) {
  float area = 0;
  for (int i = 2; i < p.count; i++)
    area += cross(p.corner[i - 1] - p.corner[0], p.corner[i] - p.corner[0]);
  return 0.5f * std::abs(area);
}

vec2 sample_polygon(const Polygon& p, vec2 u) {
  float area = area_of(p), sought = u.x * area;
  for (int i = 2; i < p.count; i++) {
    vec2 a = p.corner[i - 1] - p.corner[0], b = p.corner[i] - p.corner[0];
    float part = 0.5f * std::abs(cross(a, b));
    if (sought > part && i + 1 < p.count) {
      sought -= part;
      continue;
    }
    float root = std::sqrt(part > 0 ? std::clamp(sought / part, 0.0f, 1.0f) : 0.0f);
    return p.corner[0] + root * (a + u.y * (b - a));
  }
  return p.corner[0];
}

// Projects a triangle's corners into its chart, in tiles.
void project(const World& world, const IlluminationChart& chart, uint32_t instance,
             uint32_t triangle, vec2* corners) {
  Face f = make_face(world.placed(instance), triangle);
  vec3 at[3] = {f.corner, f.corner + f.edge1, f.corner + f.edge2};
  for (int i = 0; i < 3; i++) {
    vec3 to = at[i] - chart.origin;
    corners[i] = {dot(to, chart.along_u), dot(to, chart.along_v)};
  }
}

struct Box {
  vec2 low, high;
};
Box box_of(const vec2* c) { return {min(c[0], min(c[1], c[2])), max(c[0], max(c[1], c[2]))}; }

// Calls visit(tile, corners in tiles from the tile's own corner) for the tiles that come within
// `margin` tiles of the triangle's box.
template <class Visit>
void for_each_tile(const IlluminationChart& chart, const vec2* corners, float margin,
                   const Visit& visit) {
  Box box = box_of(corners);
  auto index = [](float x, int count) {
    return int(std::clamp(std::floor(x), 0.0f, float(count - 1)));
  };
  int left = index(box.low.x - margin, chart.columns),
      right = index(box.high.x + margin, chart.columns);
  int bottom = index(box.low.y - margin, chart.rows), top = index(box.high.y + margin, chart.rows);
  for (int row = bottom; row <= top; row++)
    for (int column = left; column <= right; column++) {
      vec2 local[3];
      for (int k = 0; k < 3; k++) local[k] = corners[k] - vec2(float(column), float(row));
      visit(chart.first_tile + uint32_t(row * chart.columns + column), local);
    }
}

// Calls visit(number of the chart, triangle, corners) for all triangles, charts in parallel.
template <class Visit>
void for_each_triangle(const World& world, const BakeCharts& charts, const Visit& visit) {
  parallel_ranges(int(charts.surfaces.size()), 16, [&](int begin, int end) {
    for (int c = begin; c < end; c++) {
      const ChartSurface& surface = charts.surfaces[size_t(c)];
      const IlluminationChart& chart = charts.places->charts[size_t(c)];
      for (uint32_t i = 0; i < surface.count; i++) {
        uint32_t triangle = charts.triangles[surface.first + i];
        vec2 corners[3];
        project(world, chart, surface.instance, triangle, corners);
        visit(uint32_t(c), triangle, corners);
      }
    }
  });
}

vec2 centroid_of(const Polygon& p) {
  vec2 sum(0);
  float areas = 0;
  for (int i = 2; i < p.count; i++) {
    const float area = cross(p.corner[i - 1] - p.corner[0], p.corner[i] - p.corner[0]);
    sum += area * (p.corner[0] + p.corner[i - 1] + p.corner[i]) / 3.0f, areas += area;
  }
  return areas != 0 ? sum / areas : p.corner[0];
}

// Finds the weights of a triangle's second and third corner at a place of its plane; returns false
// if the triangle has no area.
bool find_barycentric(const vec2* corners, vec2 place, vec2& weights) {
  const vec2 p = place - corners[0], a = corners[1] - corners[0], b = corners[2] - corners[0];
  const float whole = cross(a, b);
  if (!(std::abs(whole) > 1e-12f)) return false;
  weights = clamp(vec2(cross(p, b) / whole, cross(a, p) / whole), vec2(0), vec2(1));
  if (float both = weights.x + weights.y; both > 1) weights /= both;
  return true;
}

// Returns a ray towards that place of a triangle, from the side that the chart shows.
Ray look_at(const World& world, const ChartSurface& surface, const Hit& hit) {
  const vec3 normal = eval_face(world, hit.instance, hit.triangle);
  Ray ray;
  ray.direction = surface.back ? normal : -normal;
  ray.origin = eval_position(world, hit.instance, hit.triangle, hit.barycentric) - ray.direction;
  return ray;
}

// Calls visit(node, its part of the triangle, area, both in cells of the tile) for the tile's nodes
// that the triangle is a part of; `scaled` are the triangle's corners in cells.
template <class Visit>
void for_each_node(const IlluminationTile& tile, const vec2* scaled, const Visit& visit) {
  const vec2 cells(float(tile.columns), float(tile.rows));
  Box box = box_of(scaled);
  ivec2 low = max(ivec2(ceil(max(box.low, vec2(-1)) - 0.5f)), ivec2(0));
  ivec2 high = min(ivec2(floor(min(box.high, cells + 1.0f) + 0.5f)), ivec2(cells));
  for (int j = low.y; j <= high.y; j++)
    for (int i = low.x; i <= high.x; i++) {
      vec2 at{float(i), float(j)};
      const Polygon part = clip_to_box(scaled, at - 0.5f, at + 0.5f);
      const float area = area_of(part);
      if (area > least_area) visit(uint32_t(j) * (tile.columns + 1u) + uint32_t(i), part, area);
    }
}

// Calls visit(node, the triangle's corners in cells of the node's tile, its part of the triangle,
// area) for all nodes of a chart that the triangle is a part of.
template <class Visit>
void for_each_part(const IlluminationChart& chart, std::span<const IlluminationTile> tiles,
                   const vec2* corners, const Visit& visit) {
  for_each_tile(chart, corners, 0.5f, [&](uint32_t t, const vec2* local) {
    const IlluminationTile& tile = tiles[t];
    if (tile.first == no_tile) return;
    vec2 scaled[3];
    for (int k = 0; k < 3; k++) scaled[k] = local[k] * vec2(float(tile.columns), float(tile.rows));
    for_each_node(tile, scaled, [&](uint32_t node, const Polygon& part, float area) {
      visit(tile.first + node, scaled, part, area);
    });
  });
}

uint8_t cell_count(float side, float spacing) {
  float exact = std::clamp(side / spacing, 1.0f, float(most_cells_a_tile));
  return uint8_t(1 << int(std::lround(std::log2(exact))));
}

}  // namespace

double BakeField::mean_of(size_t node) const {
  vec3 sum(0);
  for (int p = 0; p < layers; p++) sum += light_of(node)[p];
  return double(luminance(sum)) / double(count[node]);
}

double BakeField::variance_of(size_t node) const {
  const double mean = mean_of(node);
  return std::max(double(squares[node]) / double(count[node]) - mean * mean, 0.0);
}

void copy_tile(const BakeField& from, uint32_t from_tile, BakeField& to, uint32_t to_tile) {
  const size_t a = from.tiles[from_tile].first, b = to.tiles[to_tile].first,
               nodes = to.tiles[to_tile].nodes();
  to.asked[to_tile] = from.asked[from_tile];
  std::copy_n(from.count.data() + a, nodes, to.count.data() + b);
  std::copy_n(from.hidden.data() + a, nodes, to.hidden.data() + b);
  std::copy_n(from.squares.data() + a, nodes, to.squares.data() + b);
  std::copy_n(from.light_of(a), nodes * size_t(to.layers), to.light_of(b));
  const size_t layers = size_t(to.layers);
  if (!to.slope.empty())
    std::copy_n(from.slope.data() + a * layers, nodes * layers, to.slope.data() + b * layers);
}

void clear_samples(BakeField& field) {
  std::fill(field.light.begin(), field.light.end(), vec3(0));
  std::fill(field.slope.begin(), field.slope.end(), vec3(0));
  for (auto* sums : {&field.squares, &field.count, &field.hidden})
    std::fill(sums->begin(), sums->end(), 0.0f);
}

size_t memory_bytes(const BakeField& f) {
  return bytes_of(f.tiles) + bytes_of(f.first_support) + bytes_of(f.supports) + bytes_of(f.light) +
         bytes_of(f.slope) + bytes_of(f.normal) + bytes_of(f.squares) + bytes_of(f.count) +
         bytes_of(f.hidden) + bytes_of(f.asked);
}

std::vector<TilePlace> tile_places(const BakeCharts& charts) {
  std::vector<TilePlace> places;
  places.reserve(charts.tiles);
  for (uint32_t c = 0; c < charts.surfaces.size(); c++) {
    const IlluminationChart& chart = charts.places->charts[c];
    for (int row = 0; row < chart.rows; row++)
      for (int column = 0; column < chart.columns; column++) places.push_back({c, column, row});
  }
  return places;
}

std::vector<TileCells> find_occupied(const World& world, const BakeCharts& charts) {
  std::vector<TileCells> cells(charts.tiles);
  for_each_triangle(world, charts, [&](uint32_t c, uint32_t, const vec2* at) {
    for_each_tile(charts.places->charts[c], at, occupied_margin,
                  [&](uint32_t tile, const vec2* local) {
                    if (cells[tile].columns > 0) return;
                    vec2 margin(occupied_margin);
                    if (clip_to_box(local, -margin, 1.0f + margin).count >= 3) cells[tile] = {1, 1};
                  });
  });
  return cells;
}

size_t node_count(std::span<const TileCells> cells) {
  size_t sum = 0;
  for (TileCells c : cells)
    if (c.columns > 0) sum += (c.columns + size_t(1)) * (c.rows + size_t(1));
  return sum;
}

std::vector<TileCells> cells_of(const BakeField& field) {
  std::vector<TileCells> cells(field.tiles.size());
  for (size_t t = 0; t < cells.size(); t++)
    if (field.tiles[t].first != no_tile)
      cells[t] = {uint8_t(field.tiles[t].columns), uint8_t(field.tiles[t].rows)};
  return cells;
}

std::vector<TileCells> choose_cells(const World& world, const BakeCharts& charts,
                                    std::span<const vec3> places, size_t nodes) {
  std::vector<TileCells> cells = find_occupied(world, charts);
  const std::vector<TilePlace> at = tile_places(charts);
  std::vector<float> away(cells.size(), 1);
  for (size_t t = 0; t < cells.size() && !places.empty(); t++) {
    const IlluminationChart& chart = charts.places->charts[at[t].chart];
    vec3 middle = chart.origin +
                  (float(at[t].column) + 0.5f) * chart.along_u / dot(chart.along_u, chart.along_u) +
                  (float(at[t].row) + 0.5f) * chart.along_v / dot(chart.along_v, chart.along_v);
    away[t] = INFINITY;
    for (vec3 eye : places) away[t] = std::min(away[t], length(middle - eye));
  }
  std::vector<float> sorted = away;
  if (sorted.empty()) return cells;
  std::nth_element(sorted.begin(), sorted.begin() + long(sorted.size() / 2), sorted.end());
  const float least = std::max(nearest_eye * sorted[sorted.size() / 2], 1e-12f);
  float low = 1e-6f, high = 1e3f;  // sizes of cells, metres, a metre away
  std::vector<TileCells> chosen = cells;
  for (int step = 0; step <= 40; step++) {
    float size = step < 40 ? std::sqrt(low * high) : high;  // `high` was not too fine
    for (size_t t = 0; t < cells.size(); t++) {
      if (cells[t].columns == 0) continue;
      const IlluminationChart& chart = charts.places->charts[at[t].chart];
      float spacing = size * std::max(away[t], least);
      chosen[t] = {cell_count(1 / length(chart.along_u), spacing),
                   cell_count(1 / length(chart.along_v), spacing)};
    }
    (node_count(chosen) > nodes ? low : high) = size;
  }
  return chosen;
}

std::vector<uint32_t> node_normals(const World& world, const BakeCharts& charts,
                                   std::span<const IlluminationTile> tiles, size_t nodes) {
  std::vector<vec3> sums(nodes, vec3(0));
  for_each_triangle(world, charts, [&](uint32_t c, uint32_t triangle, const vec2* at) {
    const IlluminationChart& chart = charts.places->charts[c];
    if (!chart.bent) return;
    auto add = [&](uint32_t node, const vec2* corners, const Polygon& part, float area) {
      Hit hit;
      hit.instance = charts.surfaces[c].instance, hit.triangle = triangle;
      if (!find_barycentric(corners, centroid_of(part), hit.barycentric)) return;
      sums[node] += area * eval_mesh_normal(world, look_at(world, charts.surfaces[c], hit), hit);
    };
    for_each_part(chart, tiles, at, add);
  });
  std::vector<uint32_t> normals(nodes);
  for (size_t i = 0; i < nodes; i++) {
    const float length2 = dot(sums[i], sums[i]);
    normals[i] = length2 > 0 ? pack_node_normal(sums[i] / std::sqrt(length2)) : no_normal;
  }
  return normals;
}

BakeField make_field(const World& world, const BakeCharts& charts, std::span<const TileCells> cells,
                     int layers) {
  BakeField field;
  field.layers = layers;
  field.tiles.resize(cells.size());
  uint32_t nodes = 0;
  for (size_t t = 0; t < cells.size(); t++) {
    if (cells[t].columns == 0) continue;
    field.tiles[t] = {nodes, cells[t].columns, cells[t].rows};
    nodes += field.tiles[t].nodes();
  }
  // Charts share no nodes, so their supports may be counted and filled in parallel.
  std::vector<uint32_t> counts(nodes + size_t(1), 0);
  auto for_each_support = [&](const auto& visit) {
    for_each_triangle(world, charts, [&](uint32_t c, uint32_t triangle, const vec2* at) {
      for_each_part(charts.places->charts[c], field.tiles, at,
                    [&](uint32_t node, const vec2*, const Polygon&, float area) {
                      visit(node, triangle, area);
                    });
    });
  };
  for_each_support([&](uint32_t node, uint32_t, float) { counts[node]++; });
  field.first_support.resize(nodes + size_t(1));
  uint32_t sum = 0;
  for (size_t i = 0; i <= nodes; i++) {
    field.first_support[i] = sum;
    sum += counts[i];
    counts[i] = field.first_support[i];
  }
  field.supports.resize(sum);
  for_each_support([&](uint32_t node, uint32_t triangle, float area) {
    field.supports[counts[node]++] = {triangle, area};
  });
  field.light.assign(size_t(nodes) * size_t(layers), vec3(0));
  if (charts.sloped) {
    field.slope = field.light;
    field.normal = node_normals(world, charts, field.tiles, nodes);
  }
  field.squares.assign(nodes, 0);
  field.count.assign(nodes, 0);
  field.hidden.assign(nodes, 0);
  field.asked.assign(cells.size(), 0);
  return field;
}

NodePlace sample_node(const World& world, const BakeCharts& charts, const BakeField& field,
                      const TilePlace& at, uint32_t tile, uint32_t node_of_tile, float choice,
                      vec2 u) {
  NodePlace place;
  const IlluminationTile& grid = field.tiles[tile];
  const ChartSurface& surface = charts.surfaces[at.chart];
  const IlluminationChart& chart = charts.places->charts[at.chart];
  const size_t node = grid.first + node_of_tile;
  const NodeSupport* begin = field.supports.data() + field.first_support[node];
  const NodeSupport* end = field.supports.data() + field.first_support[node + 1];
  if (begin == end) return place;
  float sum = 0;
  for (const NodeSupport* s = begin; s != end; s++) sum += s->area;
  float sought = choice * sum;
  const NodeSupport* picked = begin;
  while (picked + 1 != end && sought > picked->area) sought -= picked++->area;
  vec2 corners[3], cells(float(grid.columns), float(grid.rows));
  project(world, chart, surface.instance, picked->triangle, corners);
  for (vec2& c : corners) c = (c - vec2(float(at.column), float(at.row))) * cells;
  vec2 middle{float(node_of_tile % (grid.columns + 1u)), float(node_of_tile / (grid.columns + 1u))};
  Polygon part = clip_to_box(corners, middle - 0.5f, middle + 0.5f);
  if (part.count < 3) return place;
  place.hit.instance = surface.instance;
  place.hit.triangle = picked->triangle;
  place.hit.t = 1;
  if (!find_barycentric(corners, sample_polygon(part, u), place.hit.barycentric)) return place;
  place.valid = true;
  place.ray = look_at(world, surface, place.hit);
  return place;
}

}  // namespace wellspring::light
