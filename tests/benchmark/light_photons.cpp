// SPDX-License-Identifier: Apache-2.0
#include "light_photons.h"

#include <algorithm>

#include "base/clock.h"
#include "base/parallel.h"
#include "light/caustic_photons.h"
#include "light/first_surface.h"
#include "light_scenes.h"

namespace wellspring {
namespace {

constexpr int sets = 9, wanted = 100'000, width = 640, height = 480;

}  // namespace

void bench_light_photons(BenchReport& report, const BenchOptions& options) {
  BenchScene bench = load_bench_scene(options, "caustics");
  World world(bench.scene);
  Lights lights = make_lights(world);
  Transport transport{world, *lights.tables};
  View view = bench_view(bench, width, height);

  // The radius that the technique chooses for the scene.
  TransportSettings few;
  few.instant.photons = 1000;
  InstantPass pass = draw_instant_pass(transport, few, width, 1, 0);
  float radius = pass.photons.empty() ? 0.01f : pass.photons[0].radius;

  double began = seconds_now();
  std::vector<std::vector<Photon>> photons(sets);
  parallel_for(sets, [&](int set) {
    uint32_t first = 0;
    while (photons[size_t(set)].size() * sets < wanted) {
      std::vector<Photon> more = shoot_caustic_photons(
          transport, lights.tables->casters, 8, uint64_t(set), first, 1000, 1e-3f);
      if (more.empty() && first > 100'000) break;  // nothing arrives
      photons[size_t(set)].insert(photons[size_t(set)].end(), more.begin(), more.end());
      first += 1000;
    }
    photons[size_t(set)].resize(std::min<size_t>(photons[size_t(set)].size(), wanted / sets + 1));
  });
  double shot = seconds_now() - began;

  struct Seen {
    FirstSurface first;
    int set;
  };
  std::vector<Seen> seen(size_t(width) * height);
  parallel_ranges(height, 4, [&](int top, int bottom) {
    for (int y = top; y < bottom; y++)
      for (int x = 0; x < width; x++) {
        Request request = pixel_request(view, 1, x, y, 0);
        Sampler sampler(request.seed);
        Sample sample;
        seen[request.pixel] = {find_first_surface(transport, 8, request, sampler, sample),
                               y % 3 * 3 + x % 3};
      }
  });

  std::vector<double> store, query;
  std::vector<PhotonGrid> grids(sets);
  std::vector<vec3> light(seen.size());
  for (int run = 0; run < (options.quick ? 5 : 15); run++) {
    double at = seconds_now();
    parallel_for(sets, [&](int set) {
      grids[size_t(set)] = make_photon_grid(photons[size_t(set)], radius);
    });
    double stored = seconds_now();
    parallel_ranges(height, 4, [&](int top, int bottom) {
      for (size_t i = size_t(top) * width; i < size_t(bottom) * width; i++) {
        const Seen& s = seen[i];
        if (!s.first.scatters) continue;
        PlaceLight sum;
        shade_by_photons(grids[size_t(s.set)], 8, {&s.first.surface, &s.first.bsdf}, sum);
        light[i] = sum.sum();
      }
    });
    store.push_back(1000 * (stored - at));
    query.push_back(1000 * (seconds_now() - stored));
  }
  size_t kept = 0, lit = 0;
  for (const PhotonGrid& grid : grids) kept += grid.size();
  for (vec3 l : light) lit += max_component(l) > 0;
  double store_ms = quantile(store, 0.5), query_ms = quantile(query, 0.5);
  report.add("light.caustics.photons_ms", store_ms + query_ms, "ms",
             {{"scene", bench.name},
              {"photons", kept},
              {"width", width},
              {"height", height},
              {"pixels_lit", lit},
              {"radius", radius},
              {"store_ms", store_ms},
              {"query_ms", query_ms},
              {"shoot_ms", 1000 * shot}});
}

}  // namespace wellspring
