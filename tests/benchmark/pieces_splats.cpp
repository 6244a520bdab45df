// SPDX-License-Identifier: Apache-2.0
// pieces.splats: what a picture of Gaussian splats costs by their number and order, and how much it
// differs from one in each pixel's own order.
#include <algorithm>
#include <cmath>

#include "base/clock.h"
#include "base/rng.h"
#include "judge/flip.h"
#include "made_site.h"
#include "report.h"
#include "reports.h"
#include "scan/splat_draw/draw_splats.h"

namespace wellspring::test {
namespace {

// Puts a flat, clear splat at each of so many points of the hall, as training leaves them.
SplatSet made_splats(size_t count) {
  SplatSet set;
  set.degree = 3;
  Rng random(7);
  const auto site = made_site(count);
  scan::PointBlock block;
  const float size = 0.9f * std::sqrt(1500 / float(count));
  while (site->read(block, 100'000))
    for (size_t i = 0; i < block.size(); i++) {
      set.place.push_back(vec3(block.place[i]));
      const float wide = size * (0.5f + random.uniform());
      set.scale.push_back({wide, 0.1f * wide, 0.6f * wide});
      set.turn.push_back(glm::normalize(
          quat(random.uniform() + 0.1f, random.uniform(), random.uniform(), random.uniform())));
      set.opacity.push_back(0.2f + 0.7f * random.uniform());
      set.color.push_back(vec3(block.color[i][0], block.color[i][1], block.color[i][2]) / 255.0f);
      for (int k = 0; k < splat_harmonics[3]; k++)
        set.harmonics.push_back(vec3(0.02f * (random.uniform() - 0.5f)));
    }
  return set;
}

Frame frame_of(const SplatPlanes& planes) {
  Frame frame;
  fit_frame(planes.width, planes.height, frame);
  std::fill(frame.color.begin(), frame.color.end(), vec3(0.1f));
  scan::lay_over(frame.color, planes, 1);
  return frame;
}

}  // namespace

void bench_pieces_splats(BenchReport& report, const BenchOptions& options) {
  std::vector<size_t> counts = {100'000, 300'000, 1'000'000};
  if (options.quick) counts.pop_back();
  const ScanCamera view = made_site_view();
  for (const size_t count : counts) {
    const ShownSplats shown = make_shown_splats(made_splats(count));
    const PlacedSplats placed{.splats = &shown};
    SplatDrawer drawer;
    SplatPlanes planes;
    auto draw = [&](const SplatDrawing& settings, int times) {
      double best = INFINITY;
      for (int i = 0; i < times; i++) {
        const double began = seconds_now();
        drawer.draw(planes, std::span(&placed, 1), view, settings);
        best = std::min(best, 1000 * (seconds_now() - began));
      }
      return best;
    };
    const double exact_ms = draw({.by_pixel = true}, 1);
    const Frame exact = frame_of(planes);
    auto add = [&](const char* order, double ms) {
      const nlohmann::json where = {{"splats", double(count) / 1e6}, {"order", order}};
      report.add("pieces.splats.ms", ms, "ms", where);
      report.add("pieces.splats.flip", flip(frame_of(planes), exact), "", where);
    };
    add("each pixel's", exact_ms);
    const int times = options.quick ? 2 : 5;
    add("middles'", draw({}, times));
    SplatDrawing coarse;
    coarse.project.cell_pixels = 2;
    add("middles', cells of 2 pixels", draw(coarse, times));
  }
}

ReportPage pieces_splats_page() {
  return {"pieces.splats",
          "What does a picture of Gaussian splats cost, and how much does it lack?",
          {"Splats of degree 3 at points of the hall of pieces.scan, from the same corner, 1280 x "
           "720, all cores; FLIP is against each pixel's own order.",
           "Pictures in motion have the order of middles, those at rest each pixel's own."},
          {{.caption = "Pictures",
            .rows = {{"splats", "splats, millions"}, {"order", "order"}},
            .columns = {{"pieces.splats.ms", "a picture", 1, "ms"},
                        {"pieces.splats.flip", "FLIP", 1, ""}}}}};
}

}  // namespace wellspring::test
