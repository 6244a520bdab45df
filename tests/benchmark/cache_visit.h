// SPDX-License-Identifier: Apache-2.0
// Error as the visitor has it. Recorded visits are simulated at 60 displayed frames a second; every
// way of keeping the picture up (cache_visit_method.h) gets the same number of samples a frame, and
// what it displays is compared with the converged picture of the view wanted at that instant, so
// that lag counts. The clock is simulated: results do not depend on the machine's speed.
#pragma once
#include <string>
#include <vector>

#include "cache_visit_method.h"
#include "cache_visit_trace.h"

namespace wellspring::test {

struct VisitSettings {
  int width = 192, height = 108;
  std::vector<int> mismatches{4, 8, 16, 32, 64, 128};  // pixels over samples a frame
  int instants = 8;       // judged against a converged picture, evenly spread over each trace
  int truth_spp = 128;    // samples a pixel of each of a converged picture's two halves
  int jpeg_quality = 82;  // as a visitor's pictures while it moves, 4:2:0
  std::string technique = "gather";
  std::string exhibit, traces, truths;  // folders: package, traces, kept converged pictures
  std::vector<std::string> methods;     // names of the methods to run; empty: all
  std::string only;                     // one trace's name; empty: all
  std::string pictures;                 // folder for what was judged, as PNG; empty: none
};

// Every displayed frame.
struct VisitFrame {
  float temporal = 0;       // motion-compensated change; NaN: nothing compares
  float wrong_surface = 0;  // shares of the picture's pixels
  float empty = 0;
  CacheStats stats;  // the cache's; empty for other methods
};

// A judged one. FLIP at 67 pixels a degree; rmse of display values, 0 to 1, free of the converged
// picture's own noise; each after JPEG too.
struct VisitInstant {
  double time = 0;
  double flip = 0, flip_jpeg = 0, rmse = 0, rmse_jpeg = 0;
};

struct VisitRun {
  std::string trace, method;
  int mismatch = 0;
  std::vector<VisitFrame> frames;
  std::vector<VisitInstant> instants;
};

// Says how far the converged pictures themselves can be trusted: their halves against each other
// (the mean of both has half of that rmse).
struct TruthNoise {
  std::string trace;
  double flip = 0, rmse = 0;
};

struct VisitResult {
  std::vector<VisitRun> runs;
  std::vector<TruthNoise> noise;
};

inline constexpr double visit_rate = 60;  // displayed frames a second

// Minutes. Throws LoadError, ExhibitError.
VisitResult simulate_visits(const VisitSettings& settings);

// Return a run's means: over its judged instants, and over its frames from `from` seconds on.
VisitInstant mean_instant(const VisitRun& run);
VisitFrame mean_frame(const VisitRun& run, double from);
// Mean of the traces' means; the runs of one method at one mismatch ratio.
double mean_flip(const VisitResult& result, const std::string& method, int mismatch);

}  // namespace wellspring::test
