// SPDX-License-Identifier: Apache-2.0
#include "show_truth.h"

#include <algorithm>
#include <stdexcept>

#include "judge/flip.h"
#include "light/visible/guides.h"
#include "show/exhibit/exhibit_lights.h"
#include "show/exhibit/load/exhibit_load.h"

namespace wellspring::test {
namespace {

constexpr int flip_margin = 12;  // pixels that FLIP looks beyond one, at its 67 a degree, and more

Window grown(const Window& window, const View& whole) {
  const int left = std::max(window.x - flip_margin, 0), top = std::max(window.y - flip_margin, 0);
  const int right = std::min(window.x + window.width + flip_margin, whole.width);
  const int bottom = std::min(window.y + window.height + flip_margin, whole.height);
  return {left, top, right - left, bottom - top};
}

double mean_flip_within(const Image8& test, const Image8& reference, const Converged& truth) {
  const FlipMap map = eval_flip(test, reference);
  const int left = truth.window.x - truth.around.x, top = truth.window.y - truth.around.y;
  double sum = 0;
  for (int y = top; y < top + truth.window.height; y++)
    for (int x = left; x < left + truth.window.width; x++)
      sum += double(map.error[size_t(y) * size_t(map.width) + size_t(x)]);
  return sum / (double(truth.window.width) * truth.window.height);
}

// Returns changing lights as show/http/still.cpp takes them for a still picture, but for flicker.
std::vector<PunctualLight> mean_changing_lights(const Exhibit& exhibit, const LampLevels& levels) {
  const std::vector<vec3> factors = lamp_factors(exhibit.scene, levels);
  std::vector<PunctualLight> lights;
  for (ChangingLight light : exhibit.lights) {
    light.flicker.depth = 0;
    lights.push_back(eval_light(light, 0));
    if (light.lamp >= 0) lights.back().intensity *= factors[size_t(light.lamp)];
  }
  return lights;
}

Lights light_first(const Exhibit& exhibit, World& world) {
  world.commit();
  const LampLevels levels = first_levels(exhibit);
  for (size_t i = 0; i < levels.size(); i++) world.set_lamp(int(i), levels[i]);
  return make_lights(world, mean_changing_lights(exhibit, levels));
}

}  // namespace

View window_view(const View& whole, const Window& window) {
  const float pixel = 2 * whole.tan_half_fov / float(whole.height);
  View view = whole;
  view.width = window.width, view.height = window.height;
  view.tan_half_fov = 0.5f * pixel * float(window.height);
  view.middle.x += pixel * (float(window.x) + 0.5f * float(window.width - whole.width));
  view.middle.y -= pixel * (float(window.y) + 0.5f * float(window.height - whole.height));
  return view;
}

Image8 cut(const Image8& picture, const Window& window) {
  Image8 part{window.width, window.height, {}};
  for (int y = window.y; y < window.y + window.height; y++) {
    const auto from = picture.rgb.begin() + 3 * (ptrdiff_t(y) * picture.width + window.x);
    part.rgb.insert(part.rgb.end(), from, from + 3 * window.width);
  }
  return part;
}

double judge(const Image8& shown, const Converged& truth) {
  return mean_flip_within(cut(shown, truth.around), truth.picture, truth);
}

double judge_halves(const Converged& truth) {
  return mean_flip_within(truth.half[0], truth.half[1], truth);
}

ShowTruth::ShowTruth(const BenchOptions& options, const std::string& exhibit, int spp)
    : exhibit_(load_exhibit(options.content + "/" + exhibit)),
      world_(exhibit_.scene),
      lights_(light_first(exhibit_, world_)) {
  settings_.spp = spp;
  settings_.folder = truths_folder(options);
  std::string problem;
  denoiser_ = load_denoiser(NetSize::large, problem);
  if (!denoiser_) throw std::runtime_error(problem);
}

View ShowTruth::view(const Viewpoint& at, int width, int height) const {
  return make_view(exhibit_.scene, at.position, at.yaw, at.pitch, at.fov, width, height);
}

Converged ShowTruth::converge(const View& whole, const Window& window) const {
  Converged converged{window, grown(window, whole), {}, {}};
  const View view = window_view(whole, converged.around);
  Truth truth = find_truth(world_, lights_, view, settings_);
  const GuidePlanes guides = make_guides(world_, lights_, view);
  auto show = [&](const Frame& noisy, Image8& shown) {
    Frame clean = noisy;
    denoiser_->run({view.width, view.height, noisy.color, guides.albedo, guides.normal},
                   clean.color);
    tonemap(clean, Tonemap{exhibit_.exposure}, shown);
  };
  show(truth.picture, converged.picture);
  for (int i = 0; i < 2; i++) show(truth.half[i], converged.half[i]);
  return converged;
}

}  // namespace wellspring::test
