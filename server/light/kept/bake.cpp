// SPDX-License-Identifier: Apache-2.0
#include "light/kept/bake.h"

#include <algorithm>
#include <cmath>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/rng.h"
#include "base/worker.h"
#include "light/kept/held_out.h"
#include "light/walk/known_light.h"

namespace wellspring::light {
namespace {

// Pilot samples decide whether a tile's nodes become finer: samples of a tile, and least and most
// samples of each of its nodes.
constexpr uint32_t pilots_a_tile = 256, least_pilot_samples = 8, most_pilot_samples = 64;
constexpr uint32_t first_samples = 4;  // samples of a direct node in its first pass
// One place is held out of the bake for so many gathering nodes, within bounds, and each pass adds
// samples to it: a small part of the pass's own.
constexpr size_t nodes_a_held_out = 64, least_held_out = 64, most_held_out = 4096;
constexpr int held_out_samples = 8;
constexpr int refine_rounds = 3;
constexpr int gathers_a_pass = 8;  // samples of a gathering node for each one of a direct node
constexpr int tiles_a_step = 64;
constexpr double tile_nodes = 64;  // nodes of a tile, on average, before refinement
// A thing covers a place if it lies nearer than both of these: shares of the widths of a cell and a
// tile.
constexpr float cell_covering = 0.3f, tile_covering = 0.03f;
// A tile may be refined if its neighbouring nodes differ by more than rough_contrast of its light,
// root mean square, to which contrast_floor times the scene's mean light is added.
constexpr float rough_contrast = 0.05f, contrast_floor = 1;

uint64_t node_seed(const Bake& bake, int field, uint32_t tile, uint32_t node) {
  return mix64(bake.settings.seed + mix64(uint64_t(tile) << 32 | node << 1 | uint32_t(field)));
}

// Holds what one sample finds for each layer.
struct LayerLight {
  std::vector<vec3> light, slope;  // luminance times slope_of()
  explicit LayerLight(size_t layers) : light(layers), slope(layers) {}
};

void add_light(const BakeScene& scene, BakeField& field, size_t node, const LayerLight& found,
               float scale) {
  vec3 sum(0);
  add_color(scene.plain_colors(), found.light, sum);
  if (!is_finite(sum)) return;
  vec3 *to = field.light_of(node), *slope = field.slope_of(node);
  for (size_t p = 0; p < found.light.size(); p++) to[p] += scale * found.light[p];
  for (size_t p = 0; slope && p < found.slope.size(); p++) slope[p] += scale * found.slope[p];
  float whole = scale * luminance(sum);
  field.squares[node] += whole * whole;
  field.count[node] += 1;
}

// Returns whether something lies upon the surface there, or closely before it: no eye comes
// between, and the dark there must not bleed into visible places.
bool is_covered(const World& world, const SurfacePlace& place, float distance) {
  Ray up;
  up.origin = offset_origin(place, place.geometric_normal);
  up.direction = place.geometric_normal;
  up.t_max = distance;
  return world.occluded(up);
}

// Calls visit(node, place, sampler) for a place of each node of a tile, unless it is covered.
// `seed_of` gives each node's seed.
template <class Seed, class Visit>
void for_each_place(const BakeScene& scene, const Bake& bake, uint32_t tile, BakeField& field,
                    uint32_t number, const Seed& seed_of, const Visit& visit) {
  const IlluminationTile& grid = field.tiles[tile];
  const IlluminationChart& chart = bake.charts.places->charts[bake.places[tile].chart];
  const float cell = 1 / std::max(length(chart.along_u) * float(grid.columns),
                                  length(chart.along_v) * float(grid.rows)),
              covering = std::min(cell_covering * cell, tile_covering * bake.tile);
  for (uint32_t i = 0; i < grid.nodes(); i++) {
    Sampler sampler(seed_of(i), number);
    float choice = sampler.next();
    NodePlace place = sample_node(scene.world, bake.charts, field, bake.places[tile], tile, i,
                                  choice, sampler.next2());
    if (!place.valid) continue;
    const size_t node = size_t(grid.first) + i;
    const BakePlace lit = light_node_place(scene, place.ray, place.hit, field.normal_of(node));
    if (is_covered(scene.world, lit.surface, covering)) field.hidden[node] += 1;
    else visit(node, lit, sampler);
  }
}

// Takes one more sample of each node of a tile: visit(node, place, sampler).
template <class Visit>
void for_each_sample(const BakeScene& scene, const Bake& bake, uint32_t tile, BakeField& field,
                     const Visit& visit) {
  const int which = &field == &bake.gather;
  for_each_place(
      scene, bake, tile, field, field.asked[tile]++,
      [&](uint32_t i) { return node_seed(bake, which, tile, i); }, visit);
}

void sample_direct(const BakeScene& scene, Bake& bake, uint32_t tile, LayerLight& found) {
  BakeField& field = bake.direct;
  Walk arrives;
  arrives.wavelengths.tinted = true;  // the surface has no part in the light as it arrives
  auto sample = [&](size_t node, const BakePlace& lit, Sampler& sampler) {
    std::fill(found.light.begin(), found.light.end(), vec3(0));
    std::fill(found.slope.begin(), found.slope.end(), vec3(0));
    Walk walk;
    bool inside = false;
    if (leave(lit, sampler, walk)) add_met_light(scene, walk, sampler, found.light, inside);
    if (inside) {
      field.hidden[node] += 1;
      return;
    }
    for (size_t p = 0; p < found.light.size() && !field.slope.empty(); p++)
      if (const float l = luminance(found.light[p]); l > 0)
        found.slope[p] = l * slope_of(walk.ray.direction, lit.surface.normal);
    for (size_t p = 0; p < scene.parts.size(); p++) {
      sampler.seek(Dimensions::first_surface);
      DirectLight direct =
          sample_direct_light(scene.parts[p], arrives, lit.surface, lit.bsdf, true, sampler);
      for_each_layer(scene, p, direct.area_diffuse + direct.punctual_diffuse,
                     [&](size_t l, vec3 light) { found.light[l] += light; });
      auto add_slope = [&](vec3 light, vec3 direction) {
        const vec3 slope = slope_of(direction, lit.surface.normal);
        if (light != vec3(0))
          for_each_layer(scene, p, light, [&](size_t l, vec3 one) {
            if (luminance(one) > 0) found.slope[l] += luminance(one) * slope;
          });
      };
      if (field.slope.empty()) continue;
      add_slope(direct.area_diffuse, direct.area_direction);
      add_slope(direct.punctual_diffuse, direct.punctual_direction);
    }
    add_light(scene, field, node, found, lit.uncoated);
  };
  for_each_sample(scene, bake, tile, field, sample);
}

void sample_gather(const BakeScene& scene, Bake& bake, uint32_t tile, LayerLight& found) {
  BakeField& field = bake.gather;
  auto sample = [&](size_t node, const BakePlace& lit, Sampler& sampler) {
    Walk walk;
    std::fill(found.light.begin(), found.light.end(), vec3(0));
    std::fill(found.slope.begin(), found.slope.end(), vec3(0));
    bool inside = false;
    if (leave(lit, sampler, walk)) {
      gather_light(scene, walk, sampler, found.light, inside);
      // Coarse light has a mean only when it is complete.
      if (bake.refined > 0) cut_off(scene, found.light);
      if (!field.slope.empty()) {
        const vec3 slope = slope_of(walk.ray.direction, lit.surface.normal);
        for (size_t p = 0; p < found.light.size(); p++)
          found.slope[p] = luminance(found.light[p]) * slope;
      }
    }
    if (inside) field.hidden[node] += 1;
    else add_light(scene, field, node, found, lit.uncoated);
  };
  for_each_sample(scene, bake, tile, field, sample);
}

// Calls visit(a, b) for nodes of a tile side by side.
template <class Visit>
void for_each_pair(const IlluminationTile& tile, const Visit& visit) {
  const uint32_t stride = tile.columns + 1u;
  for (uint32_t j = 0; j <= tile.rows; j++)
    for (uint32_t i = 0; i <= tile.columns; i++) {
      if (i < tile.columns) visit(j * stride + i, j * stride + i + 1);
      if (j < tile.rows) visit(j * stride + i, (j + 1) * stride + i);
    }
}

// Samples a tile with the same random numbers at all its nodes, so that differences between nodes
// come from their places and not from chance.
PilotTile look_ahead(const BakeScene& scene, Bake& bake, uint32_t tile) {
  BakeField& field = bake.direct;
  const IlluminationTile& grid = field.tiles[tile];
  const Transport all{scene.world, *scene.lights.tables};
  // Small tiles have few pairs of nodes, so their nodes get more samples.
  const uint32_t samples =
      std::clamp(pilots_a_tile / grid.nodes(), least_pilot_samples, most_pilot_samples);
  std::vector<float> light(size_t(grid.nodes()) * samples, -1);  // node by node; below 0: no light
  const uint64_t seed = mix64(bake.settings.seed + mix64(~uint64_t(tile)));
  std::vector<vec3> met(scene.layers());
  double sum = 0, count = 0;
  for (uint32_t number = 0; number < samples; number++)
    for_each_place(
        scene, bake, tile, field, number, [&](uint32_t) { return seed; },
        [&](size_t node, const BakePlace& lit, Sampler& sampler) {
          std::fill(met.begin(), met.end(), vec3(0));
          Walk walk;
          bool inside = false;
          if (leave(lit, sampler, walk)) add_met_light(scene, walk, sampler, met, inside);
          if (inside) return;
          sampler.seek(Dimensions::first_surface);
          const DirectLight direct =
              sample_direct_light(all, Walk{}, lit.surface, lit.bsdf, true, sampler);
          vec3 arrived = direct.area_diffuse + direct.punctual_diffuse;
          add_color(scene.plain_colors(), met, arrived);
          const float found = lit.uncoated * luminance(arrived);
          if (!std::isfinite(found)) return;
          light[(node - grid.first) * samples + number] = found;
          sum += double(found), count++;
        });
  double unlike = 0, chance = 0, pairs = 0;
  for_each_pair(grid, [&](uint32_t a, uint32_t b) {
    double differ = 0, squares = 0, n = 0;
    for (uint32_t k = 0; k < samples; k++) {
      const float la = light[size_t(a) * samples + k], lb = light[size_t(b) * samples + k];
      if (la < 0 || lb < 0) continue;
      const double d = double(la) - double(lb);
      differ += d, squares += d * d, n++;
    }
    if (n < 2) return;
    // Adds the square of the mean difference without the part that chance adds, then that part.
    unlike += (differ * differ - squares) / (n * (n - 1)), pairs++;
    chance += (squares - differ * differ / n) / (n * (n - 1));
  });
  PilotTile pilot;
  if (count > 0) pilot.light = float(sum / count);
  // About a standard deviation is added: light near a source is noisy, and mostly uneven.
  if (pairs > 0)
    pilot.unlike = float(std::max(unlike / pairs + 2 * chance / (pairs * std::sqrt(pairs)), 0.0));
  return pilot;
}

float mean_light(const Bake& bake) {
  double sum = 0, count = 0;
  for (size_t t = 0; t < bake.pilots.size(); t++) {
    const double nodes = double(bake.direct.tiles[t].nodes());
    sum += nodes * double(bake.pilots[t].light), count += nodes;
  }
  return count > 0 ? float(sum / count) : 0;
}

// Gives nodes twice as close to the tiles whose light differs most from node to node, as long as
// the budget of nodes lasts; the samples of their coarser nodes are dropped.
void refine(const BakeScene& scene, Bake& bake) {
  const BakeField& old = bake.direct;
  const float floor = contrast_floor * mean_light(bake);
  std::vector<float> worth(old.tiles.size(), 0);
  std::vector<uint32_t> order;
  for (uint32_t t = 0; t < worth.size(); t++) {
    const PilotTile& pilot = bake.pilots[t];
    const IlluminationTile &now = old.tiles[t], &first = bake.gather.tiles[t];
    const float light = pilot.light + floor;
    if (!(pilot.unlike > rough_contrast * rough_contrast * light * light)) continue;
    // Smaller cells have less to gain.
    worth[t] = pilot.unlike / (light * light) * float(first.columns * first.rows) /
               float(now.columns * now.rows);
    order.push_back(t);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](uint32_t a, uint32_t b) { return worth[a] > worth[b]; });
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
  BakeField field = make_field(scene.world, bake.charts, cells, old.layers);
  for (uint32_t t = 0; t < cells.size(); t++) {
    const IlluminationTile &from = old.tiles[t], &to = field.tiles[t];
    if (from.nodes() != to.nodes() || from.columns != to.columns) continue;
    copy_tile(old, t, field, t);
  }
  bake.direct = std::move(field);
}

void pass_tile(const BakeScene& scene, Bake& bake, uint32_t tile) {
  LayerLight light(scene.layers());
  do sample_direct(scene, bake, tile, light);
  while (bake.direct.asked[tile] < first_samples);
  for (int k = 0; k < gathers_a_pass; k++) sample_gather(scene, bake, tile, light);
}

// Works on the tiles from `cursor` on; returns the next tile, or the number of tiles.
uint32_t do_step(const BakeScene& scene, Bake& bake) {
  const uint32_t tiles = bake.charts.tiles, first = bake.cursor;
  const bool pilot = bake.pilot();
  const uint32_t shards = pilot ? 1 : uint32_t(bake.settings.shards),
                 shard = pilot ? 0 : uint32_t(bake.settings.shard);
  const uint32_t end = uint32_t(std::min<uint64_t>(tiles, first + uint64_t(tiles_a_step) * shards));
  parallel_for(int(end - first), [&](int i) {
    const uint32_t tile = first + uint32_t(i);
    if (tile % shards != shard || bake.gather.tiles[tile].first == no_tile) return;
    if (!bake.sampled.empty() && !bake.sampled[tile]) return;
    if (!pilot) pass_tile(scene, bake, tile);
    else if (bake.direct.asked[tile]++ == 0) bake.pilots[tile] = look_ahead(scene, bake, tile);
  });
  return end;
}

}  // namespace

bool Bake::pilot() const { return refined <= refine_rounds; }

size_t memory_bytes(const Bake& bake) {
  return memory_bytes(bake.direct) + memory_bytes(bake.gather) + bytes_of(bake.places) +
         bytes_of(bake.held_out.places) + bytes_of(bake.charts.triangles) +
         bytes_of(bake.charts.places->chart_of);
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
  bake.tile = settings.tile > 0 ? settings.tile : float(std::max(std::sqrt(area / tiles), 1e-20));
  bake.shards_done = {settings.shard};
  bake.charts = make_charts(world, bake.tile);
  check_cancelled();
  bake.places = tile_places(bake.charts);
  std::vector<TileCells> cells = choose_cells(world, bake.charts, places, settings.gather_nodes);
  check_cancelled();
  bake.gather = make_field(world, bake.charts, cells, int(find_layers(world.scene()).size()));
  bake.colors = find_layer_colors(world.scene());
  bake.direct = bake.gather;
  bake.pilots.resize(bake.charts.tiles);
  bake.held_out =
      hold_out(world, bake.charts, places,
               std::clamp(settings.gather_nodes / nodes_a_held_out, least_held_out, most_held_out),
               settings.seed);
  return bake;
}

void go_on(const BakeScene& scene, Bake& bake, const std::function<bool()>& stop) {
  if (bake.charts.tiles == 0) return;
  do {
    bake.cursor = do_step(scene, bake);
    if (bake.cursor < bake.charts.tiles) continue;
    bake.cursor = 0;
    if (!bake.pilot()) {
      bake.passes++;
      if (bake.sampled.empty()) sample_held_out(scene, held_out_samples, bake.held_out);
    } else if (bake.refined++ < refine_rounds) {
      refine(scene, bake);
    } else {
      clear_samples(bake.direct);
      std::fill(bake.direct.asked.begin(), bake.direct.asked.end(), 0);
    }
  } while (!stop());
}

std::vector<uint32_t> find_tiles(const World& world, const Bake& bake, std::span<const Ray> rays) {
  const IlluminationCharts& places = *bake.charts.places;
  std::vector<uint32_t> tiles;
  for (const Ray& ray : rays) {
    const Hit hit = world.intersect(ray);
    if (!hit.valid()) continue;
    const uint32_t chart = find_chart(places, world, ray, hit);
    if (chart == no_chart) continue;
    const std::vector<IlluminationTile>& all = bake.gather.tiles;
    const vec3 place = ray.origin + hit.t * ray.direction;
    const IlluminationTile* tile = find_tile(places.charts[chart], all, place).tile;
    if (tile) tiles.push_back(uint32_t(tile - all.data()));
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

}  // namespace wellspring::light
