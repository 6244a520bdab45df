// SPDX-License-Identifier: Apache-2.0
// volume.march: what a picture of a scan costs by steps of several lengths, and by rays that are
// tracked at random, against what it lacks (server/volume/draw).
#include <algorithm>
#include <cmath>

#include "base/clock.h"
#include "base/parallel.h"
#include "base/rng.h"
#include "judge/flip.h"
#include "reports.h"
#include "volume/draw/preview.h"
#include "volume/draw/track.h"

namespace wellspring::test {
namespace {

constexpr float reference_step = 0.1f;  // samples
constexpr vec3 behind(0.1f);            // linear light

Frame frame_of(const VolumePicture& picture) {
  Frame frame;
  fit_frame(picture.width, picture.height, frame);
  for (size_t i = 0; i < frame.color.size(); i++)
    frame.color[i] = picture.color[i] + picture.clear[i] * behind;
  return frame;
}

// Measures how much two pictures differ from each other as they are shown.
double difference(const VolumePicture& picture, const VolumePicture& reference) {
  return flip(frame_of(picture), frame_of(reference));
}

// Draws a picture by so many tracked rays a pixel.
VolumePicture track_picture(const ShownVolume& volume, const DrawnPreset& preset,
                            const PreviewView& view, int rays) {
  const PreviewEye eye(volume, view);
  const Tracker tracker(volume, preset, {.level = eye.level});
  VolumePicture picture{view.side, view.side, {}, {}};
  picture.color.resize(size_t(view.side) * size_t(view.side));
  picture.clear.resize(picture.color.size());
  parallel_each(view.side, [&](int y) {
    for (int x = 0; x < view.side; x++) {
      const size_t at = size_t(y) * size_t(view.side) + size_t(x);
      Rng random(sample_seed(1, uint32_t(x), uint32_t(y), 0));
      const vec3 way = eye.way(float(x) + 0.5f, float(y) + 0.5f);
      for (int i = 0; i < rays; i++) {
        const TrackedRay found = tracker.track({eye.eye, way}, random);
        picture.color[at] += found.color / float(rays);
        picture.clear[at] += found.is_stopped() ? 0 : 1 / float(rays);
      }
    }
  });
  return picture;
}

void measure(BenchReport& report, const BenchOptions& options, const ShownVolume& volume,
             const Preset& of) {
  const DrawnPreset preset(volume, of, preview_light());
  PreviewView view;
  view.side = options.quick ? 240 : 480;
  view.step = reference_step;
  const VolumePicture reference = draw_volume(volume, preset, view);
  auto add = [&](const std::string& technique, const auto& draw) {
    double best = INFINITY;
    VolumePicture picture;
    for (int i = 0; i < (options.quick ? 2 : 5); i++) {
      const double begin = seconds_now();
      picture = draw();
      best = std::min(best, 1000 * (seconds_now() - begin));
    }
    const nlohmann::json where = {{"technique", technique}, {"preset", of.name}};
    report.add("volume.march.ms", best, "ms", where);
    report.add("volume.march.flip", difference(picture, reference), "", where);
  };
  for (const float step : {4.0f, 2.0f, 1.0f, 0.7f, 0.5f, 0.25f}) {
    char name[32];
    std::snprintf(name, sizeof name, "steps of %g", double(step));
    view.step = step;
    add(name, [&] { return draw_volume(volume, preset, view); });
  }
  for (const int rays : {1, 16, 64})
    add("tracked, " + std::to_string(rays) + " rays",
        [&] { return track_picture(volume, preset, view, rays); });
}

}  // namespace

void bench_volume_march(BenchReport& report, const BenchOptions& options) {
  const ShownVolume volume = open_shown_volume(options.content + "/castle/volumes/falcon.nrrd");
  for (const Preset& preset : find_presets(volume))
    if (preset.name == "outside" || preset.name == "inside" || preset.name == "x-ray")
      measure(report, options, volume, preset);
}

ReportPage volume_march_page() {
  return {
      "volume.march",
      "What does a picture of a scan cost by steps of several lengths, and by rays that are "
      "stopped at random, and how much does it lack?",
      {"The castle's falcon, 155 x 150 x 479 samples, from its front: the surface of its "
       "wrapping, through the wrapping, and the largest value along each ray. 480 x 480 pixels "
       "(240 x 240 in a quick run), all cores. Steps count in samples.",
       "FLIP is against steps of 0.1. Pictures in motion take steps of 1, those at rest many of "
       "0.5 at other places of the pixels; tracking is what rays of light do in the room, and "
       "has no error but noise."},
      {{.caption = "Pictures",
        .rows = {{"preset", "what is seen"}, {"technique", "technique"}},
        .columns = {{"volume.march.ms", "a picture", 1, "ms"},
                    {"volume.march.flip", "FLIP", 1, ""}},
        .most_rows = 27}}};
}

}  // namespace wellspring::test
