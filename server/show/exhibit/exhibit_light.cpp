// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/exhibit_light.h"

#include <algorithm>
#include <cmath>

#include "base/cancel.h"
#include "light/known/lamps.h"
#include "light/technique/technique.h"
#include "light/visible/guides.h"
#include "show/exhibit/exhibit_lamps.h"

namespace wellspring::show {
namespace {

constexpr int width = 48, height = 27, samples = 16, bounces = 6;
constexpr size_t most_viewpoints = 16;
constexpr float least_albedo = 0.04f;  // of less, little is known about the light
constexpr float well_lit = 0.55f;      // mean light of a room that looks right, white wall: 1
constexpr float brightest = 2.5f;      // the lightest tenth of a picture is at most so bright
constexpr float least = 1e-6f, most = 1e6f;

// Exposure of one picture: the geometric mean of the light on what is seen, but not so much that a
// tenth of it is white.
std::optional<float> exposure_of(const Frame& frame, const GuidePlanes& guides) {
  std::vector<float> lights;
  double sum = 0;
  for (size_t i = 0; i < frame.color.size(); i++) {
    if (frame.object[i] == 0) continue;  // the sky
    float light = luminance(frame.color[i]) / std::max(luminance(guides.albedo[i]), least_albedo);
    if (!(light > 0) || !std::isfinite(light)) continue;
    lights.push_back(light);
    sum += std::log(double(light));
  }
  if (lights.empty()) return {};
  float mean = float(std::exp(sum / double(lights.size())));
  auto tenth = lights.begin() + std::ptrdiff_t(lights.size() * 9 / 10);
  std::nth_element(lights.begin(), tenth, lights.end());
  return std::min(well_lit / mean, brightest / *tenth);
}

}  // namespace

std::optional<float> measure_exposure(const Exhibit& exhibit, World& world) {
  const Lights all = make_lights(world);  // while all lamps are full
  const LampLevels levels = first_levels(exhibit);
  for (size_t i = 0; i < levels.size(); i++) world.set_lamp(int(i), levels[i]);
  const Lights lights = levels.empty() ? all : relit(all, world);
  StillSettings settings;
  settings.spp = samples;
  settings.transport.max_depth = bounces;
  double sum = 0;
  int count = 0;
  for (size_t i = 0; i < std::min(exhibit.viewpoints.size(), most_viewpoints); i++) {
    check_cancelled();
    const Viewpoint& at = exhibit.viewpoints[i].view;
    View view = make_view(exhibit.scene, at, width, height);
    Frame frame = render_still(*find_technique("path"), world, lights, view, settings);
    std::optional<float> exposure = exposure_of(frame, make_guides(world, lights, view, 4));
    if (exposure) sum += std::log(double(*exposure)), count++;
  }
  for (size_t i = 0; i < levels.size(); i++) world.set_lamp(int(i), lamp_full);
  if (count == 0) return {};
  return std::clamp(float(std::exp(sum / count)), least, most);
}

float measure_exposure(const Exhibit& exhibit) {
  World world(exhibit.scene);
  return measure_exposure(exhibit, world).value_or(1.0f);
}

}  // namespace wellspring::show
