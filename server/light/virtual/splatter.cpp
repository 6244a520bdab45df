// SPDX-License-Identifier: Apache-2.0
#include "light/virtual/splatter.h"

#include <algorithm>
#include <cmath>

#include "base/memory.h"
#include "base/parallel.h"
#include "light/random/sampler.h"
#include "light/sample/light_tables.h"
#include "light/virtual/splat_visibility.h"
#include "light/visible/guides.h"

namespace wellspring::light {

size_t memory_bytes(const SplatLights& drawn) {
  const ReflectiveShadowMap& map = drawn.map;
  const VirtualLights& l = drawn.lights;
  return bytes_of(map.texels, map.aims, map.shares) + bytes_of(l.groups, l.target);
}

size_t memory_bytes(const SplatPicture& picture) {
  const Subsplats& subsplats = picture.subsplats;
  const SplatShadowRoom& shadows = picture.shadows;
  size_t sum =
      bytes_of(picture.irradiance, picture.pyramid.levels, picture.pyramid.cells, subsplats.list,
               subsplats.first, subsplats.split, subsplats.parted, picture.room.joined) +
      bytes_of(shadows.shares, shadows.owner, shadows.first_owner, shadows.current, shadows.seen,
               shadows.weight);
  for (const IlluminationLevel& level : picture.illumination.levels) sum += bytes_of(level.texels);
  return sum;
}

void draw_virtual_lights(const Transport& transport, std::span<const SplatSource> sources,
                         const SplatSettings& settings, SplatSeed seed,
                         std::span<const LitProbe> probes, SplatLights& drawn) {
  make_reflective_shadow_map(transport, sources, settings, seed, drawn.map);
  choose_virtual_lights(drawn.map, settings, seed, drawn.lights);
  if (!settings.visibility) dim_hidden_lights(transport, probes, settings.light_rays, drawn.lights);
}

void splat_picture(const Transport& transport, const SplatLights& drawn, const SplatPixels& pixels,
                   const SplatSettings& settings, SplatSeed seed, SplatPicture& picture) {
  const int width = pixels.view.width, height = pixels.view.height;
  const size_t count = size_t(std::max(width, 0)) * size_t(std::max(height, 0));
  picture.irradiance.resize(count);
  picture.counters = {};
  if (drawn.lights.count == 0 || count == 0) {
    std::fill(picture.irradiance.begin(), picture.irradiance.end(), vec3(0));
    return;
  }
  make_min_max_pyramid(pixels, coarsest_level(settings, width, height), picture.pyramid);
  make_subsplats(pixels, picture.pyramid, settings, picture.subsplats);
  clear_illumination(picture.pyramid, picture.illumination);
  SplatCounters& counters = picture.counters;
  uint64_t lit = 0;  // number of lit places
  auto splat_without_shadows = [&] {
    splat_lights(pixels, drawn.lights, picture.subsplats.all(), picture.illumination);
    lit += picture.subsplats.count;
  };
  if (settings.convergence > 0) {
    splat_without_shadows();
    lit += refine_by_convergence(pixels, picture.pyramid, drawn.lights, settings, picture.subsplats,
                                 picture.illumination);
  }
  if (settings.visibility) {
    if (settings.convergence > 0) clear_illumination(picture.pyramid, picture.illumination);
    counters.probe_rays = refine_by_visibility(transport, pixels, picture.pyramid, drawn.lights,
                                               settings, picture.subsplats, picture.shadows);
    counters.shadow_rays =
        splat_shadowed_lights(transport, pixels, picture.pyramid, drawn.lights, settings, seed,
                              picture.subsplats, picture.shadows, picture.illumination);
    lit += picture.subsplats.count;
  } else if (!(settings.convergence > 0)) {
    splat_without_shadows();
  }
  for (const Subsplat& one : picture.subsplats.all()) picture.counters.subsplats[one.level]++;
  counters.evaluations = lit * uint64_t(drawn.lights.count);
  upsample(pixels, picture.pyramid, settings, picture.illumination, picture.room,
           picture.irradiance);
}

void find_splat_probes(const SplatPixels& pixels, int count, std::vector<LitProbe>& probes) {
  probes.clear();
  const int width = pixels.view.width, height = pixels.view.height;
  if (width < 1 || height < 1 || count < 1) return;
  const float side = std::sqrt(float(width) * float(height) / float(count));
  const PixelGrid grid = make_pixel_grid(pixels);
  for (float y = 0.5f * side; y < float(height); y += side)
    for (float x = 0.5f * side; x < float(width); x += side) {
      const size_t i = size_t(y) * size_t(width) + size_t(x);
      if (!is_lit(pixels, i)) continue;
      probes.push_back({pixels.view.position + place_from_eye(pixels, grid, int(x), int(y)),
                        {pixels.nx[i], pixels.ny[i], pixels.nz[i]},
                        pixels.depth[i]});
    }
}

namespace {

constexpr int probe_count = 64;
constexpr int least_depth = 3;  // edges: eye, surface, surface, light

// Returns places that the view shows, at random.
std::vector<LitProbe> probe_view(const World& world, const Lights& lights, const View& view,
                                 uint64_t seed, uint32_t pass) {
  std::vector<Ray> rays;
  for (uint32_t i = 0; i < probe_count; i++) {
    Sampler sampler(mix64(seed ^ 0x70726f6265ull), pass * probe_count + i);
    vec2 u = sampler.next2();
    rays.push_back(view_ray(view, u.x * float(view.width), u.y * float(view.height)));
  }
  std::vector<PrimaryHit> seen(rays.size());
  see(world, lights, rays, seen);
  std::vector<LitProbe> probes;
  for (size_t i = 0; i < rays.size(); i++)
    if (seen[i].scatters && std::isfinite(seen[i].distance))
      probes.push_back({rays[i].origin + rays[i].direction * seen[i].distance, seen[i].normal,
                        seen[i].distance});
  return probes;
}

}  // namespace

void begin_splat(const World& world, const TransportSettings& settings, const View& view,
                 uint64_t seed, uint32_t index, Lights& lights) {
  auto pass = std::make_shared<SplatPass>();
  pass->settings = settings.splat;
  pass->seed = {seed, index};
  // The bound shrinks, but more slowly than the passes' noise: the mean loses its bias.
  pass->settings.bound *= std::pow(float(index) + 1, -0.25f);
  if (settings.max_depth >= least_depth) {
    Transport transport{world, *lights.tables};
    draw_virtual_lights(transport, make_all_splat_sources(transport), pass->settings, pass->seed,
                        probe_view(world, lights, view, seed, index), pass->drawn);
  }
  lights.splat_pass = std::move(pass);
}

void finish_splat(const World& world, const Lights& lights, const View& view,
                  std::span<Sample> samples) {
  if (!lights.splat_pass || lights.splat_pass->drawn.lights.count == 0) return;
  const SplatPass& pass = *lights.splat_pass;
  const size_t count = samples.size();
  RawVector<float> depth(count), nx(count), ny(count), nz(count);
  RawVector<vec3> position(count);
  parallel_ranges(int(count), 4096, [&](int begin, int end) {
    for (size_t i = size_t(begin); i < size_t(end); i++) {
      const Sample& sample = samples[i];
      bool lit = (sample.flags & sample_hit) && max_component(sample.albedo) > 0;
      float z = dot(sample.position - view.position, view.forward);
      depth[i] = lit ? z : std::numeric_limits<float>::infinity();
      position[i] = sample.position;
      nx[i] = sample.normal.x, ny[i] = sample.normal.y, nz[i] = sample.normal.z;
    }
  });
  SplatPixels pixels;
  pixels.view = view;
  pixels.depth = depth.data();
  pixels.nx = nx.data(), pixels.ny = ny.data(), pixels.nz = nz.data();
  pixels.position = position.data();
  SplatPicture picture;
  splat_picture({world, *lights.tables}, pass.drawn, pixels, pass.settings, pass.seed, picture);
  parallel_ranges(int(count), 4096, [&](int begin, int end) {
    for (size_t i = size_t(begin); i < size_t(end); i++)
      if (is_finite(picture.irradiance[i])) samples[i].smooth += picture.irradiance[i] / pi;
  });
}

}  // namespace wellspring::light
