// SPDX-License-Identifier: Apache-2.0
// cache.visit.*: see cache_visit.h for what is measured. Every run's means, the means over all
// traces, ours against the best baseline, and the plots.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "cache_visit.h"
#include "cache_visit_plot.h"
#include "report.h"

namespace wellspring::test {
namespace {

constexpr double first_second = 1;

void add_run(BenchReport& report, const VisitRun& run, const std::string& technique) {
  nlohmann::json fields = {{"scene", "castle"},
                           {"trace", run.trace},
                           {"technique", technique},
                           {"method", run.method},
                           {"mismatch", run.mismatch}};
  VisitInstant mean = mean_instant(run);
  VisitFrame frame = mean_frame(run, first_second);
  report.add("cache.visit.flip", mean.flip, "FLIP", fields);
  report.add("cache.visit.flip_jpeg", mean.flip_jpeg, "FLIP", fields);
  report.add("cache.visit.rmse", mean.rmse, "display", fields);
  report.add("cache.visit.rmse_jpeg", mean.rmse_jpeg, "display", fields);
  report.add("cache.visit.temporal", frame.temporal, "display", fields);
  report.add("cache.visit.wrong_surface", frame.wrong_surface, "share", fields);
  report.add("cache.visit.empty", frame.empty, "share", fields);
  for (const VisitMethodEntry& entry : visit_methods())
    if (entry.baseline && run.method == entry.name) return;
  report.add("cache.visit.fresh", frame.stats.fresh, "share", fields);
  report.add("cache.visit.reprojected", frame.stats.reprojected, "share", fields);
  report.add("cache.visit.filtered", frame.stats.filled, "share", fields);
  report.add("cache.visit.mean_age", frame.stats.mean_age, "age", fields);
}

double best_baseline(const VisitResult& result, int mismatch) {
  double best = INFINITY;
  for (const VisitMethodEntry& entry : visit_methods())
    if (entry.baseline) best = std::fmin(best, mean_flip(result, entry.name, mismatch));
  return best;
}

}  // namespace

void bench_cache_visit(BenchReport& report, const BenchOptions& options) {
  namespace fs = std::filesystem;
  VisitSettings settings;
  settings.exhibit = (fs::path(options.content) / "castle").string();
  settings.traces = (fs::path(options.scenes).parent_path() / "traces").string();
  settings.truths = truths_folder(options);
  settings.only = options.visit_trace;
  settings.technique = options.visit_technique;
  settings.pictures = options.visit_pictures;
  if (options.quick) {
    settings.width = 96;
    settings.mismatches = {16, 64};
    settings.instants = 3;
    settings.truth_spp = 64;
  }
  if (options.visit_width > 0) settings.width = options.visit_width;
  if (options.visit_instants > 0) settings.instants = options.visit_instants;
  if (options.visit_spp > 0) settings.truth_spp = options.visit_spp;
  if (!options.visit_mismatches.empty()) settings.mismatches = options.visit_mismatches;
  settings.methods = options.visit_methods;
  settings.height = (settings.width * 9 + 8) / 16;
  VisitResult result = simulate_visits(settings);
  for (const VisitRun& run : result.runs) add_run(report, run, settings.technique);
  for (const TruthNoise& noise : result.noise) {
    nlohmann::json fields = {{"scene", "castle"}, {"trace", noise.trace}};
    report.add("cache.visit.truth_halves_flip", noise.flip, "FLIP", fields);
    report.add("cache.visit.truth_halves_rmse", noise.rmse, "display", fields);
  }
  for (int mismatch : settings.mismatches) {
    nlohmann::json fields = {{"scene", "castle"}, {"mismatch", mismatch}};
    double baseline = best_baseline(result, mismatch);
    for (const VisitMethodEntry& entry : visit_methods()) {
      double mean = mean_flip(result, entry.name, mismatch);
      if (std::isnan(mean)) continue;  // not asked for
      fields["method"] = entry.name;
      report.add("cache.visit.mean_flip", mean, "FLIP", fields);
      if (!entry.baseline && std::isfinite(baseline))
        report.add("cache.visit.flip_ratio", mean / baseline, "ratio", fields);
    }
  }
  // A quarter of the samples: still better?
  double ratio = mean_flip(result, "primary", 64) / best_baseline(result, 16);
  if (ratio > 0)
    report.add("cache.visit.flip_ratio_64_to_16", ratio, "ratio", {{"scene", "castle"}});
  save_budget_plot(options.plots + "visit_budget.svg", result, settings.mismatches);
  save_time_plot(options.plots + "visit_time.svg", result, 16);
}

}  // namespace wellspring::test
