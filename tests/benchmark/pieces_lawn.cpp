// SPDX-License-Identifier: Apache-2.0
// pieces.lawn: what a tick of grass costs that walkers part, and a picture of it, by the number of
// blades (server/lawn).
#include <algorithm>
#include <cmath>

#include "base/clock.h"
#include "base/rng.h"
#include "judge/flip.h"
#include "lawn/draw_lawn.h"
#include "lawn/lawn.h"
#include "lawn/response.h"
#include "lawn/wind.h"
#include "picture/grass_view.h"
#include "report.h"
#include "reports.h"

namespace wellspring::test {
namespace {

using lawn::Capsule;
using lawn::Lawn;
using lawn::LawnState;

constexpr float meadow_side = 16;  // metres
constexpr int walker_count = 5;
constexpr double tick = 1 / 60.0;
constexpr int meadow_width = 1280, meadow_height = 720;

// Returns walkers on circles around the middle: two feet and a body each.
lawn::Walkers walkers_at(double time) {
  lawn::Walkers walkers;
  for (int i = 0; i < walker_count; i++) {
    const float angle = float(0.4 * time) + 2 * pi * float(i) / float(walker_count);
    const float radius = 2 + float(i);
    const vec3 place(radius * std::cos(angle), 0, radius * std::sin(angle));
    for (const float side : {-0.12f, 0.12f}) {
      const vec3 foot = place + vec3(side, 0.04f, 0);
      walkers.capsules.push_back({foot, foot + vec3(0, 0, 0.24f), 0.05f});
      walkers.capsules.push_back({foot, foot + vec3(0, 0.6f, 0), 0.06f});
    }
  }
  return walkers;
}

lawn::LawnView meadow_view() {
  lawn::LawnView view;
  view.eye = vec3(0, 1.6f, 7);
  view.forward = normalize(vec3(0, -0.35f, -1));
  view.up = cross(view.right, view.forward);
  view.tan_half_fov = 0.5f;
  view.width = meadow_width, view.height = meadow_height;
  view.axis = vec2(0.5f * float(meadow_width), 0.5f * float(meadow_height));
  return view;
}

// Lays a picture of grass over soil in the light of an even sky.
void add(const lawn::LawnPicture& picture, float share, Frame& frame) {
  constexpr vec3 soil(0.04f, 0.03f, 0.02f);
  for (size_t i = 0; i < frame.color.size(); i++) {
    const float lit = 0.35f + 0.65f * picture.height_share[i];
    frame.color[i] += share * glm::mix(soil, lit * picture.color[i], picture.coverage[i]);
  }
}

// Returns the milliseconds of the same picture as a piece of an exhibit, lit and ready to be laid
// over another; the best of so many.
double time_piece(const Lawn& meadow, const LawnState& state, int pictures) {
  constexpr int nodes = 64;
  ShownLawn shown;
  shown.lawn = &meadow, shown.state = &state;
  shown.bounds = {vec3(-0.5f * meadow_side, 0, -0.5f * meadow_side),
                  vec3(0.5f * meadow_side, meadow.tallest, 0.5f * meadow_side)};
  LawnLight light{ivec2(nodes), {}};
  light.node.assign(nodes * nodes, {vec3(0.3f), vec3(1), normalize(vec3(1, 2, 1)), true});
  shown.light = std::make_shared<LawnLight>(std::move(light));
  const lawn::LawnView from = meadow_view();
  View view;
  view.position = from.eye;
  view.right = from.right, view.up = from.up, view.forward = from.forward;
  view.tan_half_fov = from.tan_half_fov;
  view.width = from.width, view.height = from.height;
  LawnWork work;
  double best = INFINITY;
  for (int i = 0; i < pictures; i++) {
    const double began = seconds_now();
    const GrassView grass({&shown, 1}, {}, view, vec2(0.5f), {}, work);
    if (grass.any()) best = std::min(best, 1000 * (seconds_now() - began));
  }
  return best;
}

void measure(BenchReport& report, const BenchOptions& options, int blades) {
  lawn::LawnDescription description;
  description.low = vec2(-0.5f * meadow_side), description.high = vec2(0.5f * meadow_side);
  description.density = float(blades) / (meadow_side * meadow_side);
  const Lawn meadow = make_lawn(description);
  LawnState state = make_lawn_state(meadow);
  const lawn::Wind wind;
  std::vector<double> ticks;
  const int count = options.quick ? 120 : 600;
  for (int i = 0; i < count; i++) {
    const double time = double(i) * tick, began = seconds_now();
    step_lawn(state, meadow, wind, walkers_at(time), time);
    ticks.push_back(1000 * (seconds_now() - began));
  }
  std::ranges::sort(ticks);
  const nlohmann::json where = {{"blades", meadow.blades}};
  report.add("pieces.lawn.tick_ms", ticks[ticks.size() / 2], "ms", where);
  report.add("pieces.lawn.tick_p95_ms", ticks[ticks.size() * 95 / 100], "ms", where);

  lawn::LawnDrawer drawer;
  lawn::LawnPicture picture;
  lawn::LawnView view = meadow_view();
  double best = INFINITY;
  for (int i = 0; i < (options.quick ? 3 : 9); i++) {
    const double began = seconds_now();
    drawer.draw(meadow, state, wind, view, {}, picture);
    best = std::min(best, 1000 * (seconds_now() - began));
  }
  report.add("pieces.lawn.piece_ms", time_piece(meadow, state, options.quick ? 3 : 9), "ms", where);
  Frame moving, mean;
  fit_frame(meadow_width, meadow_height, moving), fit_frame(meadow_width, meadow_height, mean);
  add(picture, 1, moving);
  const int places = options.quick ? 16 : 64;
  for (int i = 0; i < places; i++) {
    view.offset = spread_in_pixel(i);
    drawer.draw(meadow, state, wind, view, {.coverage = false, .least_width = 0}, picture);
    add(picture, 1 / float(places), mean);
  }
  report.add("pieces.lawn.draw_ms", best, "ms", where);
  report.add("pieces.lawn.flip", flip(moving, mean), "", where);
}

}  // namespace

void bench_pieces_lawn(BenchReport& report, const BenchOptions& options) {
  for (const int blades : {20'000, 60'000, 200'000}) measure(report, options, blades);
}

ReportPage pieces_lawn_page() {
  return {
      "pieces.lawn",
      "What does a tick of grass cost that walkers part, and a picture of it?",
      {"A meadow of 16 x 16 m in which five walk in circles, two feet and two shins each, at 60 "
       "ticks a second; the picture is 1280 x 720, from eye height at its edge, all cores. The "
       "paper has 60,000 billboards.",
       "FLIP is against the mean of 64 pictures (16 in a quick run) that are sampled at other "
       "places of the pixels, with all blades."},
      {{.caption = "Grass",
        .rows = {{"blades", "blades"}},
        .columns = {{"pieces.lawn.tick_ms", "a tick", 1, "ms"},
                    {"pieces.lawn.tick_p95_ms", "95 of 100 ticks", 1, "ms"},
                    {"pieces.lawn.draw_ms", "a picture", 1, "ms"},
                    {"pieces.lawn.piece_ms", "the same, lit", 1, "ms"},
                    {"pieces.lawn.flip", "FLIP", 1, ""}}}}};
}

}  // namespace wellspring::test
