// SPDX-License-Identifier: Apache-2.0
// corrective.error.*: what the pixels of non-diffuse objects err by, over time, with samples in the
// order of corrective splatting, in even order and as the render cache plans them. A camera follows
// a recorded visit of the castle for a second, then it rests.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "cache_visit_trace.h"
#include "cache_visit_truth.h"
#include "corrective/corrected_visit.h"
#include "judge/flip.h"
#include "report.h"
#include "show/exhibit/load/exhibit_load.h"

namespace wellspring::test {
namespace {

constexpr double rate = 60, walked = 1;  // pictures a second; seconds
constexpr int mismatch = 64;             // pixels over samples of a picture

using Order = CorrectedWay::Order;
constexpr CorrectedWay ways[] = {
    {.name = "none"},
    {.name = "even", .order = Order::uniform, .share = 0.5f, .at_rest = true},
    {.name = "objects", .order = Order::corrective, .share = 0.2f},
    {.name = "groups", .order = Order::corrective, .share = 0.5f, .groups = true, .at_rest = true},
    {.name = "weighed", .weight = 4},
};

// Visits are joined and judged here: pictures of the walk, then of the rest.
struct Place {
  const char* trace;
  double from;  // seconds
};
constexpr Place places[] = {{"stroll", 1}, {"orbit", 2}, {"approach", 3}};
constexpr int judged[] = {30, 45, 60, 66, 72, 90, 120, 180};

struct Error {
  double flip = 0, rmse = 0, share = 0;  // display values; of the picture's pixels
};

// The error counts the marked pixels; what both halves of the truth differ by does not count in
// `rmse`.
Error eval_error(const Frame& shown, const Truth& truth, Tonemap curve,
                 const std::vector<uint8_t>& marked) {
  Image8 image, wanted, half[2];
  tonemap(shown, curve, image), tonemap(truth.picture, curve, wanted);
  for (int i = 0; i < 2; i++) tonemap(truth.half[i], curve, half[i]);
  const FlipMap flip = eval_flip(image, wanted);
  Error error;
  double count = 0;
  for (size_t i = 0; i < marked.size(); i++) {
    if (!marked[i]) continue;
    count++;
    error.flip += flip.error[i];
    for (size_t k = 3 * i; k < 3 * i + 3; k++)
      error.rmse += (image.rgb[k] - double(half[0].rgb[k])) *
                    (image.rgb[k] - double(half[1].rgb[k])) / (3 * 255.0 * 255.0);
  }
  return {error.flip / count, std::sqrt(std::max(error.rmse, 0.0) / count),
          count / double(marked.size())};
}

}  // namespace

void bench_corrective_error(BenchReport& report, const BenchOptions& options) {
  const CorrectedStage stage(load_exhibit(options.content + "/castle"));
  const Tonemap curve{stage.exhibit.exposure};
  const int width = options.visit_width > 0 ? options.visit_width : 192,
            height = (width * 9 + 8) / 16;
  TruthSettings truths;
  truths.spp = options.visit_spp > 0 ? options.visit_spp : options.quick ? 48 : 128;
  truths.max_depth = 8;
  truths.folder = truths_folder(options);
  const std::filesystem::path folder =
      std::filesystem::path(options.scenes).parent_path() / "traces";
  for (const Place& place : places) {
    if (!options.visit_trace.empty() && options.visit_trace != place.trace) continue;
    const VisitTrace trace = load_visit_trace((folder / place.trace).string() + ".json");
    std::vector<std::unique_ptr<CorrectedVisit>> visits;
    for (const CorrectedWay& way : ways)
      visits.push_back(std::make_unique<CorrectedVisit>(stage, way));
    Frame shown;
    for (int frame = 0; frame <= *std::rbegin(judged); frame++) {
      const Viewpoint at = eval_trace(trace, place.from + std::min(frame / rate, walked));
      const View view =
          make_view(stage.exhibit.scene, at.position, at.yaw, at.pitch, at.fov, width, height);
      const bool judges =
          std::find(std::begin(judged), std::end(judged), frame) != std::end(judged);
      Truth truth;
      if (judges) truth = find_truth(stage.world, stage.lights, view, truths);
      for (size_t i = 0; i < visits.size(); i++) {
        visits[i]->show(view, width * height / mismatch, frame, shown);
        if (!judges) continue;
        const Error error = eval_error(shown, truth, curve, find_shining_pixels(stage, view));
        const nlohmann::json fields = {{"visit", place.trace},
                                       {"order", ways[i].name},
                                       {"seconds", frame / rate},
                                       {"share", error.share}};
        report.add("corrective.error.flip", error.flip, "FLIP", fields);
        report.add("corrective.error.rmse", error.rmse, "display", fields);
      }
    }
  }
}

}  // namespace wellspring::test
