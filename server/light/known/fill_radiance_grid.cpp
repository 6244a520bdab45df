// SPDX-License-Identifier: Apache-2.0
#include "light/known/fill_radiance_grid.h"

#include <algorithm>
#include <cmath>

#include "base/cancel.h"
#include "base/parallel.h"
#include "light/random/place_key.h"
#include "light/random/warp.h"
#include "light/sample/lights.h"
#include "light/sample/medium.h"
#include "light/walk/light_walk.h"
#include "light/walk/walk.h"

namespace wellspring {
namespace {

constexpr int batch_paths = 1 << 14;
constexpr int most_vertices = 12;        // of a walk that are remembered
constexpr float lamp_cells = 2;          // times as wide as cells of light are those of lamps seen
constexpr float clear_roughness = 0.3f;  // surfaces smoother than this mirror too clearly

// What walks have learnt: of each vertex a key, 0 for none, the reflectance, and the light of each
// part.
struct Entries {
  std::vector<uint64_t> keys;
  std::vector<vec3> albedo;
  std::vector<vec3> light;
};

bool keeps_light(const Material& m) {
  return m.alpha_mode == AlphaMode::opaque && !m.unlit && m.transmission == 0 &&
         m.emission == vec3(0) && m.roughness >= clear_roughness;
}

// What multiplies light that neighbours share: the diffuse colour, or without a diffuse layer that
// of a rough metal.
vec3 shared_reflectance(const Bsdf& bsdf) {
  if (max_component(bsdf.diffuse) > 1e-4f) return bsdf.diffuse;
  vec3 metal = bsdf.metallic * bsdf.metal;
  bool soft = !has_sharp(bsdf, mirror_alpha) && !(max_component(bsdf.transmit) > 0) &&
              std::min({metal.x, metal.y, metal.z}) > 0.02f;
  return soft ? metal : vec3(0);
}

// A walk's surfaces, first to last, until their light is known. Of each part of the light:
struct VertexLight {
  vec3 direct{0};   // sampled here
  vec3 arrives{0};  // emission the next ray met
};
struct Vertex {
  uint64_t key = 0;  // 0: too late in the walk
  vec3 weight{0};    // of what the next ray brings
  vec3 albedo{0};
};

// Walks in light that is made of parts, each of which only a vertex tells from the others: what
// scatters is the same for all.
struct Walker {
  const RadianceGridSettings& settings;
  const RadianceGrid& grid;  // whose cells and materials these are
  std::vector<Transport> parts;
  std::vector<uint8_t> part_of;  // each material's own light is of this part

  // Fills up to most_vertices entries from `first` on.
  void walk(vec3 origin, Sampler& sampler, std::vector<VertexLight>& scratch, Entries& entries,
            size_t first) const;
};

void Walker::walk(vec3 origin, Sampler& sampler, std::vector<VertexLight>& scratch,
                  Entries& entries, size_t first) const {
  const Transport& transport = parts.front();  // the sky is of the first part
  const World& world = transport.world;
  const size_t n = parts.size();
  Vertex vertices[most_vertices];
  int count = 0;
  auto light_of = [&](int vertex) { return &scratch[size_t(vertex) * n]; };
  Walk walk;
  walk.ray.origin = origin;
  walk.ray.direction = sample_sphere(sampler.next2());
  bool sampled = false;  // area light, where the ray left
  if (transport.tables.any_solid) walk.media.here = find_media(transport, origin);
  auto weigh_for = [&](size_t part) {
    walk.area_share = sampled ? parts[part].tables.area_share : 0;
  };
  for (int steps = 0; count < most_vertices && walk.depth <= settings.max_depth && steps < 64;
       steps++) {
    Hit hit = world.intersect(walk.ray);
    VertexLight* before = count > 0 ? light_of(count - 1) : nullptr;
    if (!hit.valid()) {
      weigh_for(0);
      if (before) before[0].arrives += walk.throughput * walk_met_sky(transport, walk);
      break;
    }
    Surface surface = meet_surface(transport, walk.ray, hit, walk.media);
    const Material& material = world.material_of(hit.instance);
    walk.throughput *= eval_absorption(transport, walk.media.here.innermost(), hit.t);
    if (before) {
      size_t part = part_of[size_t(world.mesh_of(hit.instance).material)];
      weigh_for(part);
      before[part].arrives +=
          walk.throughput * walk_met_emission(parts[part], walk, surface, material);
    }
    if (material.unlit) break;
    Bsdf bsdf = make_bsdf_in(transport, walk.media, surface, material, walk.ray.direction);
    bool keep = grid.keeps[size_t(world.mesh_of(hit.instance).material)] &&
                !world.is_moving(hit.instance) && walk.media.here.count == 0;
    if (keep) {
      // From here on light is counted for this surface; what the way back dims is its weight.
      if (before) vertices[count - 1].weight = walk.throughput;
      Vertex& vertex = vertices[count++];
      vertex = Vertex{};
      if (walk.depth <= settings.kept_depth)
        vertex.key = place_key(surface.position, surface.geometric_normal, grid.cell);
      vertex.albedo = shared_reflectance(bsdf);
      walk.throughput = vec3(1);
      for (size_t p = 0; p < n; p++)
        light_of(count - 1)[p] = {
            sample_direct_light(parts[p], walk, surface, bsdf, false, sampler).sum(), vec3(0)};
    } else if (before && !is_smooth(bsdf)) {
      for (size_t p = 0; p < n; p++)
        before[p].arrives +=
            walk.throughput *
            sample_direct_light(parts[p], walk, surface, bsdf, false, sampler).sum();
    }
    BsdfSample scattered = sample_bsdf(bsdf, Lobes::all, sampler);
    if (!advance(walk, surface, scattered)) break;
    if (scattered.bounce != Bounce::pass) sampled = scattered.pdf > 0;
  }
  for (size_t p = 0; p < n; p++) {
    vec3 light(0);
    for (int i = count - 1; i >= 0; i--) {
      const VertexLight& here = light_of(i)[p];
      light = here.direct + here.arrives + vertices[i].weight * light;
      size_t entry = first + size_t(i);
      if (!is_finite(light)) continue;
      entries.keys[entry] = vertices[i].key;
      entries.albedo[entry] = vertices[i].albedo;
      entries.light[entry * n + p] = glm::max(light, vec3(0));
    }
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
bool add_entries(RadianceGrid& grid, const Entries& entries, std::vector<uint32_t>& number_of,
                 RadianceGrid::Parts& parts) {
  const size_t n = parts.light.size();
  for (size_t e = 0; e < entries.keys.size(); e++) {
    if (entries.keys[e] == 0) continue;
    uint32_t slot = find_place_slot(grid.keys, entries.keys[e]);
    if (grid.keys[slot] == 0) {
      if (2 * (parts.slots.size() + 1) > grid.keys.size()) return false;
      grid.keys[slot] = entries.keys[e];
      number_of[slot] = uint32_t(parts.slots.size());
      parts.slots.push_back(slot);
      parts.albedo.push_back(vec3(0));
      for (auto& light : parts.light) light.push_back(vec3(0));
    }
    grid.count[slot] += 1;
    vec3& albedo = parts.albedo[number_of[slot]];
    albedo += (entries.albedo[e] - albedo) / grid.count[slot];
    for (size_t p = 0; p < n; p++) {
      vec3& mean = parts.light[p][number_of[slot]];
      mean += (entries.light[e * n + p] - mean) / grid.count[slot];
    }
  }
  return true;
}

Walker make_walker(const Transport& transport,
                   std::span<const std::shared_ptr<const LightTables>> parts,
                   const RadianceGridSettings& settings, const RadianceGrid& grid) {
  const Scene& scene = transport.world.scene();
  Walker walker{settings, grid, {}, std::vector<uint8_t>(scene.materials.size(), 0)};
  for (const auto& tables : parts) walker.parts.push_back({transport.world, *tables});
  if (parts.empty()) walker.parts.push_back(transport);
  if (parts.size() > 1) walker.part_of = find_lamp_parts(scene);
  return walker;
}

}  // namespace

std::shared_ptr<const RadianceGrid> make_radiance_grid(
    const Transport& transport, std::span<const vec3> places, const RadianceGridSettings& settings,
    std::span<const std::shared_ptr<const LightTables>> parts) {
  auto grid = std::make_shared<RadianceGrid>();
  grid->cell = settings.cell > 0 ? settings.cell : choose_cell(transport, places, settings.seed);
  grid->lamps =
      learn_lamps_seen(transport, places, lamp_cells * grid->cell, {.seed = settings.seed});
  size_t size = 1 << 19;
  grid->keys.assign(size, 0);
  grid->light.assign(size, vec3(0));
  grid->count.assign(size, 0);
  for (const Material& material : transport.world.scene().materials)
    grid->keeps.push_back(keeps_light(material));
  const Walker walker = make_walker(transport, parts, settings, *grid);
  auto found = std::make_shared<RadianceGrid::Parts>();
  const size_t n = walker.parts.size();
  found->light.resize(n);
  std::vector<uint32_t> number_of(size, 0);
  Entries entries;
  const int batch = std::max(batch_paths / int(n), 1);
  for (int first = 0; first < settings.paths && !places.empty(); first += batch) {
    check_cancelled();
    int count = std::min(batch, settings.paths - first);
    entries.keys.assign(size_t(count) * most_vertices, 0);
    entries.albedo.assign(entries.keys.size(), vec3(0));
    entries.light.assign(entries.keys.size() * n, vec3(0));
    parallel_ranges(count, 64, [&](int begin, int end) {
      std::vector<VertexLight> scratch(most_vertices * n);
      for (int i = begin; i < end; i++) {
        int path = first + i;
        Sampler sampler(sample_seed(settings.seed, uint32_t(path), 1, 0));
        walker.walk(places[size_t(path) % places.size()], sampler, scratch, entries,
                    size_t(i) * most_vertices);
      }
    });
    if (!add_entries(*grid, entries, number_of, *found))
      break;  // as much as the table is meant to hold
  }
  if (!parts.empty()) grid->parts = found;
  for (size_t i = 0; i < found->slots.size(); i++)
    for (const std::vector<vec3>& light : found->light) grid->light[found->slots[i]] += light[i];
  return grid;
}

}  // namespace wellspring
