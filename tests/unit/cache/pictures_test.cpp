// SPDX-License-Identifier: Apache-2.0
// For the eye: with WELLSPRING_PICTURES=folder set, writes what a visitor sees of the analytic room
// while strolling, turning and standing, beside the converged picture, and prints how far apart
// they are.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "cache/cache.h"
#include "frame/compare.h"
#include "frame/picture_file.h"
#include "light/technique.h"
#include "unit/cache/visit.h"
#include "world/scene_load.h"

namespace wellspring {
namespace {

TEST(Pictures, RoomWalkTurnAndRest) {
  const char* folder = std::getenv("WELLSPRING_PICTURES");
  if (!folder) GTEST_SKIP() << "WELLSPRING_PICTURES names no folder to write to";
  int width = 1280, height = 720, budget = width * height / 50;
  Visit visit;
  Tonemap tone{0.6f};
  auto look = [&](const View& view, const std::string& name, bool reference) {
    save_picture(std::string(folder) + "/" + name + ".png", visit.frame, tone);
    CacheStats s = visit.cache.stats();
    std::printf(
        "%-10s points %d fresh %.3f reprojected %.3f filled %.3f empty %.3f age "
        "%.0f",
        name.c_str(), s.points, s.fresh, s.reprojected, s.filled, s.empty,
        s.mean_age);
    if (reference) {
      Frame truth = render_room(visit.room, view, 48);
      save_picture(std::string(folder) + "/" + name + "_truth.png", truth, tone);
      std::printf("  rmse %.4f relmse %.4f", rmse(visit.frame, truth),
                  relative_mse(visit.frame, truth));
    }
    std::printf("\n");
  };
  // Stroll: 1.4 m/s at 30 pictures a second, turning slowly.
  for (int i = 0; i < 60; i++) {
    float s = float(i) / 30;
    View view = look_at(vec3(-2 + 1.2f * s, 1.6f, 4 - 0.7f * s), vec3(-0.5f + 0.5f * s, 0.9f, -2),
                        60, width, height);
    visit.step(view, budget);
    if (i == 0 || i == 1 || i == 4 || i == 29 || i == 59)
      look(view, "walk" + std::to_string(i + 1), i == 59);
  }
  // A turn of 90 degrees in half a second, then rest.
  View view;
  for (int i = 0; i <= 15; i++) {
    float angle = float(i) / 15 * pi / 2;
    vec3 eye(0.4f, 1.6f, 2.6f);
    view = look_at(eye, eye + vec3(-std::sin(angle), -0.2f, -std::cos(angle)), 60, width, height);
    visit.step(view, budget);
    if (i == 8 || i == 15) look(view, "turn" + std::to_string(i), false);
  }
  for (int i = 1; i <= 150; i++) {
    visit.step(view, budget);
    if (i == 5 || i == 30 || i == 90 || i == 150) look(view, "rest" + std::to_string(i), i == 150);
  }
  std::printf("memory %.1f MB\n", double(visit.cache.memory_bytes()) / 1e6);
}

// The same in the castle's hall with the real path tracer. WELLSPRING_PICTURES_TRUTH=samples a
// pixel of the references (none without).
TEST(Pictures, CastleWalkAndRest) {
  const char* folder = std::getenv("WELLSPRING_PICTURES");
  if (!folder) GTEST_SKIP() << "WELLSPRING_PICTURES names no folder to write to";
  const std::string file = std::string(WELLSPRING_SOURCE) + "/content/castle/scene.glb";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no " << file;
  const char* truth_text = std::getenv("WELLSPRING_PICTURES_TRUTH");
  int truth_spp = truth_text ? std::atoi(truth_text) : 0;
  int width = truth_spp > 0 ? 640 : 1280, height = width * 9 / 16, budget = width * height / 50;
  Scene scene = load_scene(file);
  World world(scene);
  Lights lights = make_lights(world);
  const Technique& path = *find_technique("path");
  RenderCache cache;
  std::vector<Request> requests;
  std::vector<Sample> samples;
  Frame frame;
  uint64_t tick = 1;
  TransportSettings transport;
  auto step = [&](const View& view) {
    cache.resize(view.width, view.height);
    cache.move_points(world);
    cache.project(view);
    cache.attend();
    cache.plan(view, budget, tick++, requests);
    samples.resize(requests.size());
    trace(path, world, lights, transport, requests, samples);
    cache.remember(view, requests, samples);
    cache.reconstruct(view, frame);
  };
  auto look = [&](const View& view, const std::string& name, bool reference) {
    save_picture(std::string(folder) + "/castle_" + name + ".png", frame, {});
    CacheStats s = cache.stats();
    std::printf("castle %-8s reprojected %.3f filled %.3f converged %.3f", name.c_str(),
                s.reprojected, s.filled, s.converged);
    if (reference && truth_spp > 0) {
      StillSettings still;
      still.spp = truth_spp;
      Frame truth = render_still(path, world, lights, view, still);
      save_picture(std::string(folder) + "/castle_" + name + "_truth.png", truth, {});
      std::printf("  rmse %.4f relmse %.4f", rmse(frame, truth), relative_mse(frame, truth));
    }
    std::printf("\n");
  };
  View view;
  for (int i = 0; i < 60; i++) {
    float s = float(i) / 30;
    view = make_view(scene, dvec3(6.3 - 1.2 * s, 1.65, 0.45), 1.55f + 0.08f * s, -0.05f, 0.96f,
                     width, height);
    step(view);
    if (i == 0 || i == 4 || i == 29 || i == 59) look(view, "walk" + std::to_string(i + 1), i == 59);
  }
  for (int i = 1; i <= 90; i++) {
    step(view);
    if (i == 30 || i == 90) look(view, "rest" + std::to_string(i), i == 90);
  }
}

}  // namespace
}  // namespace wellspring
