// SPDX-License-Identifier: Apache-2.0
#include "light/splat/splat_technique.h"

#include <cmath>

#include "base/parallel.h"
#include "light/random/sampler.h"
#include "light/sample/light_tables.h"
#include "light/visible/see_through.h"

namespace wellspring::light {
namespace {

constexpr int probe_count = 64;
constexpr int least_depth = 3;  // of edges: eye, surface, surface, light

// Places that the view shows, at random.
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
  // Ever smaller, but more slowly than the passes' noise: the mean loses its bias.
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
