// SPDX-License-Identifier: Apache-2.0
#include "light/bake/bake.h"

#include <algorithm>
#include <cmath>

#include "base/cancel.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/rng.h"
#include "light/material/bsdf.h"

namespace wellspring {
namespace {

constexpr int pilot_samples = 8;  // of a node, by which its tile is refined or not
constexpr int refine_rounds = 3;
constexpr int gathers_a_pass = 8;  // samples of a gathering node for one of a direct node
constexpr int tiles_a_step = 64;
constexpr double tile_nodes = 64;      // of a tile, on average, before refinement
constexpr float most_brightness = 25;  // of a gathered sample, times the mean light
// A thing that lies nearer than either covers a place: shares of the widths of a cell and a tile.
constexpr float cell_covering = 0.3f, tile_covering = 0.03f;
// Neighbouring nodes that differ by that share of their light, of which a share of the scene's mean
// counts as there everywhere.
constexpr float rough_contrast = 0.15f, contrast_floor = 0.25f;
constexpr float sure_deviations = 4;  // by which they must differ beyond chance

uint64_t node_seed(const Bake& bake, int field, uint32_t tile, uint32_t node) {
  return mix64(bake.settings.seed + mix64(uint64_t(tile) << 32 | node << 1 | uint32_t(field)));
}

// One sample finds this of each layer.
struct LayerLight {
  std::vector<vec3> light, slope;  // luminance times slope_of()
  explicit LayerLight(int layers) : light(size_t(layers)), slope(size_t(layers)) {}
};

void add_light(BakeField& field, size_t node, const LayerLight& found, float scale) {
  vec3 sum(0);
  for (vec3 l : found.light) sum += l;
  if (!is_finite(sum)) return;
  vec3 *to = field.light_of(node), *slope = field.slope_of(node);
  for (size_t p = 0; p < found.light.size(); p++) to[p] += scale * found.light[p];
  for (size_t p = 0; slope && p < found.slope.size(); p++) slope[p] += scale * found.slope[p];
  float whole = scale * luminance(sum);
  field.squares[node] += whole * whole;
  field.count[node] += 1;
}

// A light that one walk in thousands comes upon (the sun in a brass knob) would stay a spark on the
// wall for hours.
void cut_off(float most, std::span<vec3> light) {
  vec3 sum(0);
  for (vec3 l : light) sum += l;
  if (!(luminance(sum) > most)) return;
  for (vec3& l : light) l *= most / luminance(sum);
}

// A place around a node, ready to be lit: a white Lambertian surface but for its coat.
struct LitPlace {
  Surface surface;
  Bsdf bsdf;
  float uncoated = 1;  // what undoes the coat's darkening towards the viewer
};

LitPlace light_place(const BakeScene& scene, const NodePlace& place) {
  LitPlace lit;
  lit.surface = eval_surface(scene.world, place.ray, place.hit);
  // What a map of normals adds is finer than nodes.
  lit.surface.normal = eval_mesh_normal(scene.world, place.hit, lit.surface);
  const Material& material = scene.world.material_of(place.hit.instance);
  lit.bsdf = make_bsdf_in(scene.parts.front(), Media{}, lit.surface, material, place.ray.direction);
  lit.bsdf.diffuse = vec3(1);
  float passes = lit.bsdf.coat_passes * lit.bsdf.beneath;
  lit.uncoated = passes > 0.05f ? 1 / passes : 1;
  return lit;
}

// The ray over the cosine that leaves the place. False: none does.
bool leave(const LitPlace& lit, Sampler& sampler, Walk& walk) {
  sampler.seek(Dimensions::first_surface + Dimensions::scatter);
  BsdfSample scattered = sample_bsdf(lit.bsdf, Lobes::diffuse, sampler);
  if (!advance(walk, lit.surface, scattered)) return false;
  walk.from_normal = lit.surface.geometric_normal;
  return true;
}

// Something lies upon the surface there, or closely before it: no eye comes between, and the dark
// there must not bleed into what is seen.
bool is_covered(const World& world, const SurfacePlace& place, float distance) {
  Ray up;
  up.origin = offset_origin(place, place.geometric_normal);
  up.direction = place.geometric_normal;
  up.t_max = distance;
  return world.occluded(up);
}

// One more sample of each node of a tile: visit(node, place, number of the sample, sampler).
template <class Visit>
void for_each_sample(const BakeScene& scene, const Bake& bake, uint32_t tile, BakeField& field,
                     const Visit& visit) {
  const IlluminationTile& grid = field.tiles[tile];
  const int which = &field == &bake.gather;
  const uint32_t number = field.asked[tile]++;
  const IlluminationChart& chart = bake.charts.places->charts[bake.places[tile].chart];
  const float cell = 1 / std::max(length(chart.along_u) * float(grid.columns),
                                  length(chart.along_v) * float(grid.rows)),
              covering = std::min(cell_covering * cell, tile_covering * bake.tile);
  for (uint32_t i = 0; i < grid.nodes(); i++) {
    Sampler sampler(node_seed(bake, which, tile, i), number);
    float choice = sampler.next();
    NodePlace place = sample_node(scene.world, bake.charts, field, bake.places[tile], tile, i,
                                  choice, sampler.next2());
    if (!place.valid) continue;
    const LitPlace lit = light_place(scene, place);
    const size_t node = size_t(grid.first) + i;
    if (is_covered(scene.world, lit.surface, covering)) field.hidden[node] += 1;
    else visit(node, lit, number, sampler);
  }
}

void sample_direct(const BakeScene& scene, Bake& bake, uint32_t tile, LayerLight& found) {
  BakeField& field = bake.direct;
  auto sample = [&](size_t node, const LitPlace& lit, uint32_t number, Sampler& sampler) {
    Walk probe;
    bool probes = number < pilot_samples || field.hidden[node] > 0;
    if (probes && leave(lit, sampler, probe) &&
        is_inside(scene.world, probe, scene.world.intersect(probe.ray))) {
      field.hidden[node] += 1;
      return;
    }
    for (size_t p = 0; p < found.light.size(); p++) {
      sampler.seek(Dimensions::first_surface);
      DirectLight direct =
          sample_direct_light(scene.parts[p], Walk{}, lit.surface, lit.bsdf, true, sampler);
      found.light[p] = direct.area_diffuse + direct.punctual_diffuse;
      found.slope[p] = vec3(0);
      auto add_slope = [&](vec3 light, vec3 direction) {
        if (float l = luminance(light); l > 0)
          found.slope[p] += l * slope_of(direction, lit.surface.normal);
      };
      if (field.slope.empty()) continue;
      add_slope(direct.area_diffuse, direct.area_direction);
      add_slope(direct.punctual_diffuse, direct.punctual_direction);
    }
    add_light(field, node, found, lit.uncoated);
  };
  for_each_sample(scene, bake, tile, field, sample);
}

void sample_gather(const BakeScene& scene, Bake& bake, uint32_t tile, LayerLight& found) {
  BakeField& field = bake.gather;
  auto sample = [&](size_t node, const LitPlace& lit, uint32_t, Sampler& sampler) {
    Walk walk;
    std::fill(found.light.begin(), found.light.end(), vec3(0));
    std::fill(found.slope.begin(), found.slope.end(), vec3(0));
    bool inside = false;
    if (leave(lit, sampler, walk)) {
      gather_light(scene, walk, sampler, found.light, inside);
      // Coarse light knows its mean only when it is whole.
      if (scene.known && bake.refined > 0)
        cut_off(most_brightness * scene.known->mean, found.light);
      if (!field.slope.empty()) {
        const vec3 slope = slope_of(walk.ray.direction, lit.surface.normal);
        for (size_t p = 0; p < found.light.size(); p++)
          found.slope[p] = luminance(found.light[p]) * slope;
      }
    }
    if (inside) field.hidden[node] += 1;
    else add_light(field, node, found, lit.uncoated);
  };
  for_each_sample(scene, bake, tile, field, sample);
}

// How much a tile's neighbouring nodes differ, beyond what chance explains.
float contrast_of(const BakeField& field, const IlluminationTile& tile, float floor) {
  // Few samples do not tell each node's noise: that of the whole tile does.
  double squares = 0, variances = 0;
  for (uint32_t i = 0; i < tile.nodes(); i++) {
    const size_t node = tile.first + i;
    if (field.count[node] < 2) continue;
    const double mean = field.mean_of(node);
    squares += mean * mean, variances += field.variance_of(node) / double(field.count[node]);
  }
  const float noise = squares > 0 ? float(variances / squares) : 0;
  float most = 0;
  auto compare = [&](uint32_t a, uint32_t b) {
    if (field.count[tile.first + a] < 2 || field.count[tile.first + b] < 2) return;
    float ma = float(field.mean_of(tile.first + a)), mb = float(field.mean_of(tile.first + b));
    float differ = std::abs(ma - mb) - sure_deviations * std::sqrt(noise * (ma * ma + mb * mb));
    most = std::max(most, differ / (0.5f * (ma + mb) + floor));
  };
  const uint32_t stride = tile.columns + 1u;
  for (uint32_t j = 0; j <= tile.rows; j++)
    for (uint32_t i = 0; i <= tile.columns; i++) {
      if (i < tile.columns) compare(j * stride + i, j * stride + i + 1);
      if (j < tile.rows) compare(j * stride + i, (j + 1) * stride + i);
    }
  return most;
}

float mean_light(const BakeField& field) {
  double sum = 0, count = 0;
  for (size_t i = 0; i < field.nodes(); i++) {
    if (!(field.count[i] > 0)) continue;
    sum += field.mean_of(i), count++;
  }
  return count > 0 ? float(sum / count) : 0;
}

// Tiles whose light differs most from node to node get nodes twice as close, as far as there are
// more to be had; what their coarser nodes have found is given up.
void refine(const BakeScene& scene, Bake& bake) {
  const BakeField& old = bake.direct;
  std::vector<float> contrast(old.tiles.size(), 0);
  const float floor = contrast_floor * mean_light(old);
  parallel_for(int(contrast.size()), [&](int t) {
    if (old.tiles[size_t(t)].first != no_tile)
      contrast[size_t(t)] = contrast_of(old, old.tiles[size_t(t)], floor);
  });
  std::vector<uint32_t> order;
  for (uint32_t t = 0; t < contrast.size(); t++)
    if (contrast[t] > rough_contrast) order.push_back(t);
  std::stable_sort(order.begin(), order.end(),
                   [&](uint32_t a, uint32_t b) { return contrast[a] > contrast[b]; });
  std::vector<TileCells> cells = cells_of(old);
  size_t nodes = old.nodes();
  for (uint32_t t : order) {
    TileCells& c = cells[t];
    TileCells finer{uint8_t(std::min(2 * c.columns, most_cells_a_tile)),
                    uint8_t(std::min(2 * c.rows, most_cells_a_tile))};
    size_t more = (finer.columns + 1u) * (finer.rows + 1u) - old.tiles[t].nodes();
    if (nodes + more > bake.settings.direct_nodes) break;
    nodes += more;
    c = finer;
  }
  BakeField field = make_field(scene.world, bake.charts, cells, old.layers, !old.slope.empty());
  for (uint32_t t = 0; t < cells.size(); t++) {
    const IlluminationTile &from = old.tiles[t], &to = field.tiles[t];
    if (from.nodes() != to.nodes() || from.columns != to.columns) continue;
    copy_tile(old, t, field, t);
  }
  bake.direct = std::move(field);
}

void pass_tile(const BakeScene& scene, Bake& bake, uint32_t tile) {
  LayerLight light(scene.layers());
  sample_direct(scene, bake, tile, light);
  for (int k = 0; k < gathers_a_pass; k++) sample_gather(scene, bake, tile, light);
}

// Tiles from `cursor` on; the next one, or their number.
uint32_t do_step(const BakeScene& scene, Bake& bake) {
  const uint32_t tiles = bake.charts.tiles, first = bake.cursor;
  const bool pilot = bake.pilot();
  const uint32_t shards = pilot ? 1 : uint32_t(bake.settings.shards),
                 shard = pilot ? 0 : uint32_t(bake.settings.shard);
  const uint32_t end = uint32_t(std::min<uint64_t>(tiles, first + uint64_t(tiles_a_step) * shards));
  parallel_for(int(end - first), [&](int i) {
    const uint32_t tile = first + uint32_t(i);
    if (tile % shards != shard || bake.gather.tiles[tile].first == no_tile) return;
    if (!pilot) return pass_tile(scene, bake, tile);
    LayerLight light(scene.layers());
    while (bake.direct.asked[tile] < pilot_samples) sample_direct(scene, bake, tile, light);
  });
  return end;
}

}  // namespace

bool Bake::pilot() const { return refined <= refine_rounds; }

size_t memory_bytes(const Bake& bake) {
  return memory_bytes(bake.direct) + memory_bytes(bake.gather) + bytes_of(bake.places) +
         bytes_of(bake.charts.triangles) + bytes_of(bake.charts.places->chart_of);
}

size_t vertex_bytes(const Bake& bake) {
  return bake.direct.nodes() *
         (2 * sizeof(vec3) + 2 * sizeof(uvec3) + sizeof(uint32_t) * size_t(bake.direct.layers));
}

Bake begin_bake(const World& world, std::span<const vec3> places, const BakeSettings& settings) {
  Bake bake;
  bake.settings = settings;
  double area = charted_area(world);
  double tiles = std::max(double(settings.gather_nodes) / tile_nodes, 1.0);
  bake.tile = float(std::max(std::sqrt(area / tiles), 1e-20));
  bake.shards_done = {settings.shard};
  bake.charts = make_charts(world, bake.tile);
  check_cancelled();
  bake.places = tile_places(bake.charts);
  std::vector<TileCells> cells = choose_cells(world, bake.charts, places, settings.gather_nodes);
  check_cancelled();
  bake.gather = make_field(world, bake.charts, cells, int(layer_count(world.scene())),
                           has_mapped_normals(world.scene()));
  bake.direct = bake.gather;
  return bake;
}

void go_on(const BakeScene& scene, Bake& bake, const std::function<bool()>& stop) {
  if (bake.charts.tiles == 0) return;
  do {
    bake.cursor = do_step(scene, bake);
    if (bake.cursor < bake.charts.tiles) continue;
    bake.cursor = 0;
    if (!bake.pilot()) bake.passes++;
    else if (bake.refined++ < refine_rounds) refine(scene, bake);
  } while (!stop());
}

std::vector<uint32_t> find_tiles(const World& world, const Bake& bake, std::span<const Ray> rays) {
  const IlluminationCharts& places = *bake.charts.places;
  std::vector<uint32_t> tiles;
  for (const Ray& ray : rays) {
    const Hit hit = world.intersect(ray);
    if (!hit.valid()) continue;
    const bool front = dot(eval_face(world, hit.instance, hit.triangle), ray.direction) < 0;
    const uint32_t found = places.find(hit.instance, hit.triangle, front);
    if (found == no_chart) continue;
    const IlluminationChart& chart = places.charts[found];
    const vec2 at = place_in_chart(chart, ray.origin + hit.t * ray.direction);
    const int column = glm::clamp(int(at.x), 0, chart.columns - 1),
              row = glm::clamp(int(at.y), 0, chart.rows - 1);
    const uint32_t tile = chart.first_tile + uint32_t(row * chart.columns + column);
    if (bake.gather.tiles[tile].first != no_tile) tiles.push_back(tile);
  }
  std::sort(tiles.begin(), tiles.end());
  tiles.erase(std::unique(tiles.begin(), tiles.end()), tiles.end());
  return tiles;
}

bool go_ahead(const BakeScene& scene, Bake& bake, std::span<const uint32_t> tiles, uint32_t ahead) {
  if (bake.pilot()) return false;
  const uint64_t most = uint64_t(gathers_a_pass) * (bake.passes + ahead);
  std::vector<uint32_t> behind;
  for (uint32_t tile : tiles)
    if (bake.gather.asked[tile] < most) behind.push_back(tile);
  parallel_for(int(behind.size()), [&](int i) { pass_tile(scene, bake, behind[size_t(i)]); });
  return !behind.empty();
}

void sample_fields(const BakeScene& scene, Bake& bake, int direct, int gather) {
  parallel_for(int(bake.charts.tiles), [&](int tile) {
    if (bake.gather.tiles[size_t(tile)].first == no_tile) return;
    LayerLight light(scene.layers());
    for (int k = 0; k < direct; k++) sample_direct(scene, bake, uint32_t(tile), light);
    for (int k = 0; k < gather; k++) sample_gather(scene, bake, uint32_t(tile), light);
  });
}

float bake_error(const Bake& bake) {
  double sums[2] = {0, 0}, variances[2] = {0, 0};
  const BakeField* fields[2] = {&bake.direct, &bake.gather};
  for (int f = 0; f < 2; f++) {
    const BakeField& field = *fields[f];
    double sum = 0, variance = 0, count = 0;
    for (size_t i = 0; i < field.nodes(); i++) {
      double n = double(field.count[i]);
      if (n < 2) continue;
      sum += field.mean_of(i), count++;
      variance += field.variance_of(i) / (n - 1);
    }
    if (count > 0) sums[f] = sum / count, variances[f] = variance / count;
  }
  double mean = sums[0] + sums[1];
  return mean > 0 ? float(std::sqrt(variances[0] + variances[1]) / mean) : 0.0f;
}

}  // namespace wellspring
