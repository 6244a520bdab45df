// SPDX-License-Identifier: Apache-2.0
// Error over time of every technique: a converged `path` is the reference, each point a number of samples.
#include <filesystem>

#include "base/clock.h"
#include "frame/compare.h"
#include "light/technique.h"
#include "report.h"
#include "scenes/scenes.h"
#include "show/exhibit_load.h"
#include "world/surface.h"

namespace wellspring {

namespace {

void bench_scene(BenchReport& report, const BenchOptions& options, const std::string& name, const Scene& scene,
                 const View& view, int max_depth) {
  World world(scene);
  Lights lights = make_lights(world);
  StillSettings settings;
  settings.transport.max_depth = max_depth;
  settings.seed = 77;
  settings.spp = options.quick ? 128 : 512;
  Frame reference = render_still(*find_technique("path"), world, lights, view, settings);
  for (const Technique& technique : techniques()) {
    double began = seconds_now();
    if (technique.prepare) technique.prepare(world, std::span(&view.position, 1), lights);
    double preparation = seconds_now() - began;
    for (int spp : {1, 4, 16, 64}) {
      if (options.quick && spp > 16) continue;
      settings.seed = uint64_t(spp);
      settings.spp = spp;
      began = seconds_now();
      Frame frame = render_still(technique, world, lights, view, settings);
      double seconds = seconds_now() - began;
      nlohmann::json fields = {{"scene", name}, {"technique", technique.name}, {"spp", spp},
                               {"seconds", seconds}, {"preparation_seconds", preparation}};
      std::string prefix = std::string("light.") + technique.name;
      report.add(prefix + ".rmse", rmse(frame, reference), "radiance", fields);
      report.add(prefix + ".relative_mse", relative_mse(frame, reference), "1", fields);
      report.add(prefix + ".samples_per_second", double(spp) * view.width * view.height / seconds, "1/s", fields);
    }
  }
}

}  // namespace

void bench_light(BenchReport& report, const BenchOptions& options) {
  Scene box = scenes::make_cornell_box();
  bench_scene(report, options, "cornell_box", box, scenes::cornell_view(box, 160, 160), 8);
  Exhibit castle = load_exhibit((std::filesystem::path(options.content) / "castle").string());
  const Viewpoint& hall = castle.viewpoints[size_t(castle.start)].view;
  View view = make_view(castle.scene, hall.position, hall.yaw, hall.pitch, hall.fov, 256, 144);
  bench_scene(report, options, "castle", castle.scene, view, 6);
}

}  // namespace wellspring
