// SPDX-License-Identifier: Apache-2.0
// A visitor would be shown these if no sample were missing: pictures of `path` in two halves with
// samples of their own, each through the largest network, kept on disk (cache_visit_truth.h). No
// storyteller is in them, and lights that flicker have their mean brightness. Since whole pictures
// of a long walk would take days, one window of each is enough: if windows of neighbouring pictures
// lie elsewhere, the mean of all is that of whole pictures.
#pragma once
#include <memory>
#include <string>

#include "cache_visit_truth.h"
#include "denoise/denoise.h"
#include "frame/tonemap.h"
#include "report.h"
#include "show/exhibit/exhibit.h"

namespace wellspring::test {

// Part of a picture, in its pixels.
struct Window {
  int x = 0, y = 0, width = 0, height = 0;
};

// The same eye; the rays through the window's pixels are those of the whole view.
View window_view(const View& whole, const Window& window);
Image8 cut(const Image8& picture, const Window& window);

struct Converged {
  Window window, around;    // around: what the pictures show; an edge wider, as FLIP sees that, too
  Image8 picture, half[2];  // cut to `around`
};
// Mean FLIP of the window. `shown`: the whole picture.
double judge(const Image8& shown, const Converged& truth);
// The same between the halves.
double judge_halves(const Converged& truth);

class ShowTruth {
 public:
  // Loads an exhibit of options.content; spp: of each half. Throws ExhibitError; std::runtime_error
  // without the network's weights.
  ShowTruth(const BenchOptions& options, const std::string& exhibit, int spp);
  // `fov` as Viewpoint.
  View view(const Viewpoint& at, int width, int height) const;
  // All cores; seconds, where it is not kept.
  Converged converge(const View& whole, const Window& window) const;
  Converged converge(const View& whole) const { return converge(whole, all_of(whole)); }
  const Exhibit& exhibit() const { return exhibit_; }
  int spp() const { return 2 * settings_.spp; }  // samples a pixel of both halves together

 private:
  static Window all_of(const View& view) { return {0, 0, view.width, view.height}; }
  Exhibit exhibit_;
  World world_;
  Lights lights_;
  TruthSettings settings_;
  std::unique_ptr<Denoiser> denoiser_;
};

}  // namespace wellspring::test
