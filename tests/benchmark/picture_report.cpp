// SPDX-License-Identifier: Apache-2.0
// picture.*: what a drawn picture of the castle costs while it has no samples to trace.
#include <oneapi/tbb/global_control.h>

#include <algorithm>

#include "base/clock.h"
#include "frame/disparity_code.h"
#include "frame/picture_file.h"
#include "image/image.h"
#include "light/kept/bake_file.h"
#include "light/kept/map_file.h"
#include "picture/compositor.h"
#include "picture/keyframe.h"
#include "report.h"
#include "show/exhibit/load/exhibit_load.h"

namespace wellspring::test {
namespace {

constexpr int width = 1280, height = 720, pictures = 15;

// In the light of maps, where there are some, else of points that there are none of. `shown`: the
// last picture. Time is told by `now`.
double time_picture(const VisibilityPass& visibility, const View& view, const Exhibit& exhibit,
                    std::shared_ptr<const IlluminationMap> maps, double (*now)(), Image8& shown,
                    std::vector<float>& depth) {
  RenderCache cache;
  Compositor compositor;
  if (maps) compositor.set_maps(std::move(maps));
  cache.resize(view.width, view.height);
  cache.project(view);
  std::vector<double> times;
  for (int i = 0; i < pictures; i++) {
    const double start = now();
    compositor.draw(cache, view, visibility, Tonemap{exhibit.exposure}, shown, &depth);
    times.push_back(1e3 * (now() - start));
  }
  return quantile(times, 0.5);
}

// Measures what a keyframe's depth takes beside its colours, in bytes and time, and how far off it
// is: in pixels of parallax when the eye moves by a metre.
void bench_depth(BenchReport& report, const View& view, const char* name, const Image8& shown,
                 std::span<const float> depth) {
  Keyframe keyframe;
  make_keyframe(view, shown, depth, keyframe);
  std::vector<uint8_t> jpeg, code;
  encode_jpeg(shown, 82, false, jpeg);
  const float unit = disparity_unit(view);
  std::vector<double> times;
  for (int i = 0; i < pictures; i++) {
    code.clear();
    const double start = thread_seconds_now();
    encode_disparity(keyframe.disparity, width, height, unit, code);
    times.push_back(1e3 * (thread_seconds_now() - start));
  }
  std::vector<float> decoded;
  const double start = thread_seconds_now();
  if (!decode_disparity(code, width, height, unit, decoded))
    throw std::runtime_error("the code of a picture's disparities is wrong");
  const double decoding = 1e3 * (thread_seconds_now() - start);
  const float focal = 0.5f * float(height) / view.tan_half_fov;
  float worst = 0;
  for (size_t i = 0; i < decoded.size(); i++)
    worst = std::max(worst, focal * std::abs(decoded[i] - keyframe.disparity[i]));
  const nlohmann::json fields{{"scene", "castle"}, {"view", name}};
  report.add("picture.depth.bytes", double(code.size()), "B", fields);
  report.add("picture.depth.share", double(code.size()) / double(jpeg.size()), "", fields);
  report.add("picture.depth.encode_ms", quantile(times, 0.5), "ms", fields);
  report.add("picture.depth.decode_ms", decoding, "ms", fields);
  report.add("picture.depth.parallax_px", double(worst), "px", fields);
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
        std::vector<float> depth;
        report.add(metric,
                   time_picture(visibility, view, castle, mapped ? maps : nullptr,
                                cores == 1 ? thread_seconds_now : seconds_now, shown, depth),
                   "ms", {{"scene", "castle"}, {"view", name}, {"light", light}, {"cores", cores}});
        if (!options.visit_pictures.empty())
          save_image8(options.visit_pictures + "/" + name + "_" + light + ".png", shown);
        if (mapped && cores == 1) bench_depth(report, view, name, shown, depth);
      }
    }
  }
}

}  // namespace wellspring::test
