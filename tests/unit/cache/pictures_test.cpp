// SPDX-License-Identifier: Apache-2.0
// For the eye: with WELLSPRING_PICTURES=folder set, writes what a visitor sees of the analytic room while
// strolling, turning and standing, beside the converged picture, and prints how far apart they are.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#include "base/clock.h"
#include "cache/cache.h"
#include "frame/compare.h"
#include "frame/picture_file.h"
#include "unit/cache/room.h"
#include "world/bvh.h"

namespace wellspring {
namespace {

struct Visit {
  Room room;
  RenderCache cache;
  std::vector<Request> requests;
  std::vector<Sample> samples;
  Frame frame;
  uint64_t tick = 1;
  double display = 0;

  void step(const World& world, const View& view, int budget) {
    double a = seconds_now();
    cache.resize(view.width, view.height);
    cache.move_points(world);
    cache.project(view);
    cache.attend();
    cache.plan(view, budget, tick++, requests);
    double b = seconds_now();
    trace_room(room, requests, samples);
    double c = seconds_now();
    cache.remember(view, requests, samples);
    cache.reconstruct(view, frame);
    display = seconds_now() - c + b - a;
  }
};

TEST(Pictures, RoomWalkTurnAndRest) {
  const char* folder = std::getenv("WELLSPRING_PICTURES");
  if (!folder) GTEST_SKIP() << "WELLSPRING_PICTURES names no folder to write to";
  int width = 1280, height = 720, budget = width * height / 50;
  Scene scene;
  World world(scene);
  Visit visit;
  Tonemap tone{0.6f};
  auto look = [&](const View& view, const std::string& name, bool reference) {
    save_picture(std::string(folder) + "/" + name + ".png", visit.frame, tone);
    CacheStats s = visit.cache.stats();
    std::printf("%-10s display %.1f ms  points %d fresh %.3f reprojected %.3f filled %.3f empty %.3f age %.0f",
                name.c_str(), visit.display * 1000, s.points, s.fresh, s.reprojected, s.filled, s.empty, s.mean_age);
    if (reference) {
      Frame truth = render_room(visit.room, view, 48);
      save_picture(std::string(folder) + "/" + name + "_truth.png", truth, tone);
      std::printf("  rmse %.4f relmse %.4f", rmse(visit.frame, truth), relative_mse(visit.frame, truth));
    }
    std::printf("\n");
  };
  // Stroll: 1.4 m/s at 30 pictures a second, turning slowly.
  for (int i = 0; i < 60; i++) {
    float s = float(i) / 30;
    View view = look_at(vec3(-2 + 1.2f * s, 1.6f, 4 - 0.7f * s), vec3(-0.5f + 0.5f * s, 0.9f, -2), 60, width, height);
    visit.step(world, view, budget);
    if (i == 0 || i == 1 || i == 4 || i == 29 || i == 59) look(view, "walk" + std::to_string(i + 1), i == 59);
  }
  // A turn of 90 degrees in half a second, then rest.
  View view;
  for (int i = 0; i <= 15; i++) {
    float angle = float(i) / 15 * pi / 2;
    vec3 eye(0.4f, 1.6f, 2.6f);
    view = look_at(eye, eye + vec3(-std::sin(angle), -0.2f, -std::cos(angle)), 60, width, height);
    visit.step(world, view, budget);
    if (i == 8 || i == 15) look(view, "turn" + std::to_string(i), false);
  }
  for (int i = 1; i <= 150; i++) {
    visit.step(world, view, budget);
    if (i == 5 || i == 30 || i == 90 || i == 150) look(view, "rest" + std::to_string(i), i == 150);
  }
  std::printf("memory %.1f MB\n", double(visit.cache.memory_bytes()) / 1e6);
}

}  // namespace
}  // namespace wellspring
