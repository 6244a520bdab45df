// SPDX-License-Identifier: Apache-2.0
// What techniques know of their samples' noise, and what the cache makes of it.
#include <gtest/gtest.h>

#include "frame/flip.h"
#include "light/technique/technique.h"
#include "picture/compositor.h"
#include "scenes/scenes.h"

namespace wellspring {
namespace {

using namespace scenes;

// A picture after five times one sample for 25 pixels. `told`: hints reach the cache.
Frame show(const World& world, const Lights& lights, const View& view, bool told) {
  VisibilityPass visibility(world, lights);
  RenderCache cache;
  Compositor compositor;
  std::vector<Request> requests;
  std::vector<Sample> samples;
  Frame frame;
  for (uint64_t tick = 1; tick <= 5; tick++) {
    cache.resize(view.width, view.height);
    cache.move_points(world);
    cache.project(view);
    cache.attend();
    cache.plan(view, view.width * view.height / 25, tick, requests);
    samples.resize(requests.size());
    trace(*find_technique("gather"), world, lights, {}, requests, samples);
    for (Sample& sample : samples)
      if (!told) sample.flags &= uint8_t(~sample_sure);
    cache.remember(view, requests, samples);
    compositor.draw(cache, view, visibility, frame);
  }
  return frame;
}

// Shadows of a lamp without a size are shadows, not noise; with a sample for five pixels no place
// was seen twice, and only the hint tells.
TEST(Hint, ShadowsOfALampWithoutASizeAreSure) {
  Scene scene = make_cornell_box();
  for (Material& material : scene.materials) material.emission = vec3(0);
  PunctualLight lamp;
  lamp.position = {0, 0.54f, -0.28f};
  lamp.intensity = {0.25f, 0.2f, 0.12f};
  scene.lights.push_back(lamp);
  World world(scene);
  world.commit();
  Lights lights = make_lights(world);
  View view = make_view(scene, {0, 0.275, 0.8}, 0, 0, 0.7f, 160, 120);
  StillSettings settings;
  settings.spp = 64;
  Frame truth = render_still(*find_technique("path"), world, lights, view, settings);
  double told = flip(show(world, lights, view, true), truth),
         untold = flip(show(world, lights, view, false), truth);
  EXPECT_LT(told, 0.97 * untold);
}

}  // namespace
}  // namespace wellspring
