// SPDX-License-Identifier: Apache-2.0
// picture.*: what a drawn picture of the castle costs while it has no samples to trace.
#include <oneapi/tbb/global_control.h>

#include <algorithm>

#include "base/clock.h"
#include "frame/picture_file.h"
#include "light/bake/bake_file.h"
#include "light/bake/map_file.h"
#include "picture/compositor.h"
#include "report.h"
#include "show/exhibit/exhibit_load.h"

namespace wellspring {
namespace {

constexpr int width = 1280, height = 720, pictures = 15;

// In the light of maps, where there are some, else of points that there are none of. `shown`: the
// last picture. Time is told by `now`.
double time_picture(const VisibilityPass& visibility, const View& view, const Exhibit& exhibit,
                    std::shared_ptr<const IlluminationMap> maps, double (*now)(), Image8& shown) {
  RenderCache cache;
  Compositor compositor;
  if (maps) compositor.set_maps(std::move(maps));
  cache.resize(view.width, view.height);
  cache.project(light_view(view));
  std::vector<float> depth;
  std::vector<double> times;
  for (int i = 0; i < pictures; i++) {
    const double start = now();
    compositor.draw(cache, view, visibility, Tonemap{exhibit.exposure}, shown, &depth);
    times.push_back(1e3 * (now() - start));
  }
  return quantile(times, 0.5);
}

}  // namespace

void bench_picture(BenchReport& report, const BenchOptions& options) {
  const Exhibit castle = load_exhibit(options.content + "/castle");
  const World world(castle.scene);
  const Lights lights = make_lights(world);
  const VisibilityPass visibility(world, lights);
  const auto maps = load_map(world, shipped_light(castle.folder), hash_scene(castle.scene)).map;
  for (int cores : {1, oneapi::tbb::this_task_arena::max_concurrency()}) {
    if (cores > 1 && options.quick) continue;
    oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism,
                                      size_t(cores));
    for (const char* name : {"hall", "crown"}) {
      if (!options.visit_trace.empty() && options.visit_trace != name) continue;
      const Viewpoint& at = castle.viewpoints[size_t(find_viewpoint(castle, name))].view;
      const View view =
          make_view(castle.scene, at.position, at.yaw, at.pitch, at.fov, width, height);
      for (bool mapped : {false, true}) {
        if (mapped && !maps) continue;
        const char* metric = cores == 1 ? "picture.drawn.ms_one_core" : "picture.drawn.ms";
        const std::string light = mapped ? "maps" : "points";
        Image8 shown;
        report.add(metric,
                   time_picture(visibility, view, castle, mapped ? maps : nullptr,
                                cores == 1 ? thread_seconds_now : seconds_now, shown),
                   "ms", {{"scene", "castle"}, {"view", name}, {"light", light}, {"cores", cores}});
        if (!options.visit_pictures.empty())
          save_image8(options.visit_pictures + "/" + name + "_" + light + ".png", shown);
      }
    }
  }
}

}  // namespace wellspring
