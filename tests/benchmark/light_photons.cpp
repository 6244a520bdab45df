// SPDX-License-Identifier: Apache-2.0
#include "light_photons.h"

#include <algorithm>
#include <atomic>
#include <ctime>

#include "base/clock.h"
#include "base/parallel.h"
#include "light/virtual/caustic_photons.h"
#include "light/virtual/instant_radiosity.h"
#include "light/technique/technique.h"
#include "light/walk/first_surface.h"
#include "light_scenes.h"

namespace wellspring::test {
namespace {

// Returns the seconds of this thread alone: the machine may have other work.
double cpu_now() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

constexpr int cores = 4;
constexpr int sets = 9, wanted = 100'000, photons_width = 640, photons_height = 480;

}  // namespace

void bench_light_photons(BenchReport& report, const BenchOptions& options) {
  BenchScene bench = load_bench_scene(options, "caustics");
  World world(bench.scene);
  Lights lights = make_lights(world);
  Transport transport{world, *lights.tables};
  View view = bench_view(bench, photons_width, photons_height);

  // The radius that the technique chooses for the scene.
  TransportSettings few;
  few.instant.photons = 1000;
  InstantPass pass = draw_instant_pass(transport, few, photons_width, 1, 0);
  float radius = pass.photons.empty() ? 0.01f : pass.photons[0].radius;

  double began = seconds_now();
  std::vector<std::vector<Photon>> photons(sets);
  parallel_for(sets, [&](int set) {
    uint32_t first = 0;
    while (photons[size_t(set)].size() * sets < wanted) {
      std::vector<Photon> more = shoot_caustic_photons(transport, lights.tables->casters, 8,
                                                       uint64_t(set), first, 1000, 1e-3f);
      if (more.empty() && first > 100'000) break;  // nothing arrives
      photons[size_t(set)].insert(photons[size_t(set)].end(), more.begin(), more.end());
      first += 1000;
    }
    photons[size_t(set)].resize(std::min<size_t>(photons[size_t(set)].size(), wanted / sets + 1));
  });
  double shot = seconds_now() - began;

  std::vector<double> store, query;
  std::vector<PhotonGrid> grids(sets);
  std::atomic<size_t> lit = 0;
  for (int run = 0; run < (options.quick ? 5 : 15); run++) {
    double began_store = cpu_now();
    for (int set = 0; set < sets; set++)
      grids[size_t(set)] = make_photon_grid(photons[size_t(set)], radius);
    store.push_back(1000 * (cpu_now() - began_store));
    lit = 0;
    std::atomic<int64_t> nanoseconds = 0;
    constexpr int tile = 24;
    parallel_for((photons_width / tile + 1) * (photons_height / tile), [&](int t) {
      int left = t % (photons_width / tile + 1) * tile, top = t / (photons_width / tile + 1) * tile;
      std::vector<FirstSurface> seen[sets];
      for (int y = top; y < top + tile; y++)
        for (int x = left; x < std::min(left + tile, photons_width); x++) {
          Request request = pixel_request(view, 1, x, y, 0);
          Sampler sampler(request.seed);
          Sample sample;
          FirstSurface first = find_first_surface(transport, 8, request, sampler, sample);
          if (first.scatters) seen[y % 3 * 3 + x % 3].push_back(first);
        }
      double asked = cpu_now();
      size_t found = 0;
      for (int set = 0; set < sets; set++) {
        PhotonCells cells;
        for (const FirstSurface& first : seen[set]) {
          PlaceLight sum;
          shade_by_photons(transport, grids[size_t(set)], 8, {&first.surface, &first.bsdf}, cells,
                           sum);
          found += max_component(sum.sum()) > 0;
        }
      }
      nanoseconds += int64_t(1e9 * (cpu_now() - asked));
      lit += found;
    });
    query.push_back(1e-6 * double(nanoseconds.load()));
  }
  size_t kept = 0;
  for (const PhotonGrid& grid : grids) kept += grid.size();
  double cpu_ms = quantile(store, 0.5) + quantile(query, 0.5);
  report.add("light.caustics.photons_ms", cpu_ms / cores, "ms",
             {{"scene", bench.name},
              {"photons", kept},
              {"width", photons_width},
              {"height", photons_height},
              {"pixels_lit", lit.load()},
              {"radius", radius},
              {"store_cpu_ms", quantile(store, 0.5)},
              {"query_cpu_ms", quantile(query, 0.5)},
              {"cores", cores},
              {"shoot_ms", 1000 * shot}});
}

}  // namespace wellspring::test
