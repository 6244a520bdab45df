// SPDX-License-Identifier: Apache-2.0
#include "light/radiance_grid.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "light/walk.h"
#include "light/warp.h"

namespace wellspring {
namespace {

constexpr int batch_paths = 1 << 16;
constexpr int most_vertices = 12;    // of a walk that are remembered
constexpr float enough_samples = 12;  // a cell with fewer is not asked
constexpr float clear_roughness = 0.3f;  // surfaces smoother than this mirror too clearly

struct Entry {
  uint64_t key = 0;  // 0: none
  vec3 light{0};
};

// Cell of space and main direction of the surface; never 0.
uint64_t cell_key(vec3 position, vec3 normal, float cell) {
  vec3 a = glm::abs(normal);
  int axis = a.x > a.y ? (a.x > a.z ? 0 : 2) : (a.y > a.z ? 1 : 2);
  uint64_t side = uint64_t(axis * 2 + (normal[axis] < 0));
  auto part = [&](float x) { return uint64_t(int64_t(std::floor(x / cell)) + (1 << 19)) & 0xfffff; };
  return ((side << 60 | part(position.x) << 40 | part(position.y) << 20 | part(position.z)) << 1) | 1;
}

uint32_t find_cell(const RadianceGrid& grid, uint64_t key) {
  uint32_t slot = uint32_t(mix64(key)) & grid.mask;
  while (grid.keys[slot] != 0 && grid.keys[slot] != key) slot = (slot + 1) & grid.mask;
  return slot;
}

bool keeps_light(const Material& m) {
  return m.alpha_mode == AlphaMode::opaque && !m.unlit && m.transmission == 0 && m.emission == vec3(0) &&
         m.roughness >= clear_roughness;
}

// A walk's surfaces, first to last, until their light is known.
struct Vertex {
  uint64_t key = 0;  // 0: too late in the walk
  vec3 direct{0};   // light sampled here
  vec3 weight{0};   // of what the next ray brings
  vec3 arrives{0};  // emission the next ray met
};

// One walk from `origin`; fills up to most_vertices entries.
void walk_once(const Transport& transport, vec3 origin, const RadianceGridSettings& settings, float cell,
               Sampler& sampler, Entry* entries) {
  const World& world = transport.world;
  Vertex vertices[most_vertices];
  int count = 0;
  Walk walk;
  walk.ray.origin = origin;
  walk.ray.direction = sample_sphere(sampler.next2());
  if (transport.tables.any_solid) walk.media.here = find_media(transport, origin);
  for (int steps = 0; count < most_vertices && walk.depth <= settings.max_depth && steps < 64; steps++) {
    Hit hit = world.intersect(walk.ray);
    Vertex* before = count > 0 ? &vertices[count - 1] : nullptr;
    if (!hit.valid()) {
      if (before) before->arrives += walk.throughput * walk_met_sky(transport, walk);
      break;
    }
    Surface surface = meet_surface(transport, walk.ray, hit, walk.media);
    const Material& material = world.material_of(hit.instance);
    walk.throughput *= eval_absorption(transport, walk.media.here.innermost(), hit.t);
    if (before) before->arrives += walk.throughput * walk_met_emission(transport, walk, surface, material);
    if (material.unlit) break;
    Bsdf bsdf = make_bsdf_in(transport, walk.media, surface, material, walk.ray.direction);
    bool keep = keeps_light(material) && !world.is_moving(hit.instance) && walk.media.here.count == 0;
    if (keep) {
      // From here on light is counted for this surface; what the way back dims is its weight.
      if (before) before->weight = walk.throughput;
      Vertex& vertex = vertices[count++];
      vertex = Vertex{};
      if (walk.depth <= settings.kept_depth) vertex.key = cell_key(surface.position, surface.geometric_normal, cell);
      walk.throughput = vec3(1);
      vertex.direct = sample_direct_light(transport, walk, surface, bsdf, false, sampler).sum();
    } else if (before && !is_smooth(bsdf)) {
      before->arrives += walk.throughput * sample_direct_light(transport, walk, surface, bsdf, false, sampler).sum();
    }
    BsdfSample scattered = sample_bsdf(bsdf, Lobes::all, sampler);
    if (!advance(walk, surface, scattered)) break;
    if (scattered.bounce != Bounce::pass) walk.area_share = scattered.pdf > 0 ? transport.tables.area_share : 0;
  }
  vec3 light(0);
  for (int i = count - 1; i >= 0; i--) {
    const Vertex& vertex = vertices[i];
    light = vertex.direct + vertex.arrives + vertex.weight * light;
    if (is_finite(light)) entries[i] = {vertex.key, glm::max(light, vec3(0))};
  }
}

float choose_cell(const Transport& transport, std::span<const vec3> places, uint64_t seed) {
  std::vector<float> lengths;
  for (size_t i = 0; i < places.size(); i++)
    for (int j = 0; j < 128; j++) {
      Sampler sampler(sample_seed(seed, uint32_t(i), uint32_t(j), 0));
      Ray ray;
      ray.origin = places[i];
      ray.direction = sample_sphere(sampler.next2());
      Hit hit = transport.world.intersect(ray);
      if (hit.valid()) lengths.push_back(hit.t);
    }
  if (lengths.empty()) return 1;
  std::nth_element(lengths.begin(), lengths.begin() + long(lengths.size() / 2), lengths.end());
  return std::max(lengths[lengths.size() / 2] / 24, 1e-6f);
}

// Adds entries in their order to the table; false when it would be more than half full.
bool add_entries(RadianceGrid& grid, const std::vector<Entry>& entries, size_t& used) {
  for (const Entry& entry : entries) {
    if (entry.key == 0) continue;
    uint32_t slot = find_cell(grid, entry.key);
    if (grid.keys[slot] == 0) {
      if (2 * (used + 1) > grid.keys.size()) return false;
      grid.keys[slot] = entry.key;
      used++;
    }
    grid.count[slot] += 1;
    grid.light[slot] += (entry.light - grid.light[slot]) / grid.count[slot];
  }
  return true;
}

}  // namespace

std::shared_ptr<const RadianceGrid> make_radiance_grid(const Transport& transport, std::span<const vec3> places,
                                                       const RadianceGridSettings& settings) {
  auto grid = std::make_shared<RadianceGrid>();
  grid->cell = settings.cell > 0 ? settings.cell : choose_cell(transport, places, settings.seed);
  size_t size = 1 << 19;
  grid->mask = uint32_t(size - 1);
  grid->keys.assign(size, 0);
  grid->light.assign(size, vec3(0));
  grid->count.assign(size, 0);
  for (const Material& material : transport.world.scene().materials) grid->keeps.push_back(keeps_light(material));
  if (places.empty()) return grid;
  std::vector<Entry> entries;
  size_t used = 0;
  for (int first = 0; first < settings.paths; first += batch_paths) {
    int count = std::min(batch_paths, settings.paths - first);
    entries.assign(size_t(count) * most_vertices, Entry{});
    parallel_ranges(count, 64, [&](int begin, int end) {
      for (int i = begin; i < end; i++) {
        int path = first + i;
        Sampler sampler(sample_seed(settings.seed, uint32_t(path), 1, 0));
        walk_once(transport, places[size_t(path) % places.size()], settings, grid->cell, sampler,
                  &entries[size_t(i) * most_vertices]);
      }
    });
    if (!add_entries(*grid, entries, used)) break;  // as much as the table is meant to hold
  }
  return grid;
}

bool eval_grid(const RadianceGrid& grid, const World& world, const Ray& ray, const Hit& hit, float footprint,
               vec3& radiance) {
  const PlacedMesh& placed = world.placed(hit.instance);
  if (footprint < 2 * grid.cell || placed.moving || !grid.keeps[size_t(placed.mesh->material)]) return false;
  vec3 normal = eval_face(world, hit.instance, hit.triangle);
  if (dot(normal, ray.direction) > 0) normal = -normal;
  uint32_t slot = find_cell(grid, cell_key(ray.origin + hit.t * ray.direction, normal, grid.cell));
  if (grid.count[slot] < enough_samples) return false;
  radiance = grid.light[slot];
  return true;
}

}  // namespace wellspring
