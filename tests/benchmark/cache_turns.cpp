// SPDX-License-Identifier: Apache-2.0
// cache.turns.unknown: who turns by keys starts and stops at once, while pictures to warp are drawn
// for where the view is expected to be. How much of the pictures shown lies outside of what was
// drawn, and so repeats its border, for machines that take so long for a drawn picture; without
// prediction, predicted with margins of the same width for all, and as the show does, with margins
// as wide as turns are quick.
#include <cmath>
#include <fmt/core.h>

#include "base/rng.h"
#include "cache_visit_stage.h"
#include "drawn_picture.h"
#include "frame/picture_file.h"
#include "judge/flip.h"
#include "picture/warp_picture.h"
#include "report.h"
#include "show/visit/place.h"

namespace wellspring::test {
namespace {

constexpr double turn_rate = 60, turn_speed = 1.5,
                 key_ease = 0.07;         // as the page's keys (web/controls.js)
constexpr int width = 320, height = 180;  // margins are shares of them

View facing(double yaw) {
  View view;
  view.width = width, view.height = height;
  view.tan_half_fov = 0.52f;
  view.forward = vec3(float(-std::sin(yaw)), 0, float(-std::cos(yaw)));
  view.right = vec3(float(std::cos(yaw)), 0, float(-std::sin(yaw)));
  view.up = vec3(0, 1, 0);
  return view;
}

// The yaw at every tick: keys held for 0.1 to 2 s, most of them briefly, with pauses as long.
std::vector<double> turn_by_keys(double seconds, uint64_t seed) {
  Rng rng(seed);
  auto span = [&] { return 0.1 * std::exp2(4.3 * double(rng.next()) * 0x1p-32); };
  std::vector<double> yaws;
  double yaw = 0, turning = 0, key = 0, until = span();
  for (int i = 0; i < int(seconds * turn_rate); i++) {
    if (i / turn_rate >= until) {
      until += span();
      key = key != 0 ? 0 : rng.next() & 1 ? 1 : -1;
    }
    turning += (key - turning) * (1 - std::exp(-1 / (turn_rate * key_ease)));
    if (std::abs(turning) < 0.01) turning = 0;
    yaws.push_back(yaw += turning * turn_speed / turn_rate);
  }
  return yaws;
}

using Expect = View (*)(const Heading&, const View& now, double seconds);
View stay(const Heading&, const View& now, double) { return now; }
View plain(const Heading& heading, const View& now, double seconds) {
  return expected_view(heading, now, seconds);
}

// Shares of pixels, one a tick.
std::vector<double> unknown_shares(const std::vector<double>& yaws, double drawing, Expect expect) {
  std::vector<double> shares;
  Heading heading;
  Keyframe shown, drawn;
  WarpScratch scratch;
  Image8 blank, out;
  double finished = -1;
  for (size_t i = 0; i < yaws.size(); i++) {
    double time = double(i) / turn_rate;
    View view = facing(yaws[i]);
    note_view(heading, time, view);
    if (time + 1e-9 >= finished) {
      std::swap(shown, drawn);
      float turn = expect == expected_view ? expected_turn(heading, view, 0.5 * drawing) : 0.0f;
      View wanted = keyframe_view(expect(heading, view, drawing + 0.5 * drawing), turn);
      blank.width = wanted.width, blank.height = wanted.height;
      blank.rgb.assign(3 * size_t(wanted.width) * size_t(wanted.height), 128);
      std::vector<float> depth(size_t(wanted.width) * size_t(wanted.height), INFINITY);
      make_keyframe(wanted, blank, depth, drawn);
      finished = time + drawing;
    }
    if (!shown.empty()) shares.push_back(double(warp_picture(shown, view, 1, scratch, out)));
  }
  return shares;
}

// ---- the same in the castle's hall, against true pictures ----

constexpr int hall_width = 640, hall_height = 360;
constexpr double surroundings_time = 0.2;  // share of a keyframe's drawing time, as in the castle

struct TurnErrors {
  double flip = 0, unknown = 0, drawn = 0;  // means; pictures of surroundings a keyframe
  std::vector<double> flips;
};

struct DrawnKeyframes {
  const VisibilityPass& visibility;
  Keyframe shown, drawn, around;
  DrawnPicture picture;
  void draw(const View& view, Keyframe& to) {
    draw_picture(visibility, view, picture);
    make_keyframe(view, picture.image, picture.depth, to);
  }
};

// One picture judged in `stride` ticks.
TurnErrors judge_turns(const VisitStage& stage, const VisibilityPass& visibility,
                       const std::vector<double>& yaws, double drawing, bool surrounded,
                       size_t stride, const std::string& pictures) {
  const Viewpoint& at = stage.exhibit().viewpoints[0].view;
  TurnErrors errors;
  Heading heading;
  DrawnKeyframes frames{visibility, {}, {}, {}, {}};
  WarpScratch scratch;
  Image8 out;
  DrawnPicture truth;
  double finished = -1, surrounded_at = -1;
  int keyframes = 0, surroundings_drawn = 0;
  std::optional<View> wide;
  for (size_t i = 0; i < yaws.size(); i++) {
    double time = double(i) / turn_rate;
    View view = make_view(stage.exhibit().scene, at.position, at.yaw + float(yaws[i]), at.pitch,
                          at.fov, hall_width, hall_height);
    note_view(heading, time, view);
    if (wide && time + 1e-9 >= surrounded_at) {
      frames.draw(*wide, frames.around);
      wide.reset();
    }
    if (time + 1e-9 >= finished) {
      std::swap(frames.shown, frames.drawn);
      auto keyframe = [&](double before) {
        float turn = expected_turn(heading, view, 0.5 * drawing);
        return keyframe_view(expected_view(heading, view, before + 1.5 * drawing), turn);
      };
      finished = time + drawing;
      const View soon = expected_view(heading, view, 2 * drawing);
      if (surrounded && (frames.around.empty() || is_elsewhere(frames.around.view, soon)))
        wide = wide_view(soon);
      if (wide)
        finished += surroundings_time * drawing, surrounded_at = time + surroundings_time * drawing;
      frames.draw(keyframe(wide ? surroundings_time * drawing : 0), frames.drawn);
      keyframes++, surroundings_drawn += wide.has_value();
    }
    if (frames.shown.empty() || i % stride != 0) continue;
    double unknown = double(warp_picture(frames.shown, frames.around, view, 1, scratch, out));
    draw_picture(visibility, view, truth);
    errors.flips.push_back(double(eval_flip(out, truth.image).mean));
    errors.flip += errors.flips.back(), errors.unknown += unknown;
    if (pictures.empty()) continue;
    std::string name = fmt::format("{}/turn_{:.0f}ms_{:04}_{}.png", pictures, 1000 * drawing, i,
                                   surrounded ? "with" : "without");
    save_image8(name, out);
  }
  errors.flip /= double(errors.flips.size()), errors.unknown /= double(errors.flips.size());
  errors.drawn = double(surroundings_drawn) / keyframes;
  return errors;
}

void bench_hall(BenchReport& report, const BenchOptions& options) {
  VisitStage stage(options.content + "/castle", "direct");
  VisibilityPass visibility(stage.world(), stage.lights());
  std::vector<double> yaws = turn_by_keys(options.quick ? 10 : 60, 11);
  for (double drawing : {1 / 30.0, 0.1, 0.2})
    for (bool surrounded : {false, true}) {
      TurnErrors errors = judge_turns(stage, visibility, yaws, drawing, surrounded,
                                      options.quick ? 11 : 7, options.visit_pictures);
      nlohmann::json fields = {{"scene", "castle"},
                               {"size", fmt::format("{}x{}", hall_width, hall_height)},
                               {"surroundings", surrounded},
                               {"drawing_ms", std::round(1000 * drawing)}};
      report.add("cache.turns.flip", errors.flip, "", fields);
      report.add("cache.turns.flip_p95", quantile(errors.flips, 0.95), "", fields);
      report.add("cache.turns.hall_unknown", 100 * errors.unknown, "%", fields);
      report.add("cache.turns.surroundings_drawn", 100 * errors.drawn, "%", fields);
    }
}

}  // namespace

void bench_cache_turns(BenchReport& report, const BenchOptions& options) {
  const std::pair<const char*, Expect> methods[] = {
      {"none", stay}, {"plain", plain}, {"widened", expected_view}};
  std::vector<double> yaws = turn_by_keys(options.quick ? 60 : 240, 11);
  for (double drawing : {1 / 30.0, 0.1, 0.2})
    for (auto [name, expect] : methods) {
      std::vector<double> shares = unknown_shares(yaws, drawing, expect);
      double sum = 0;
      for (double share : shares) sum += share;
      nlohmann::json fields = {{"prediction", name}, {"drawing_ms", std::round(1000 * drawing)}};
      report.add("cache.turns.unknown", 100 * sum / double(shares.size()), "%", fields);
      report.add("cache.turns.unknown_p95", 100 * quantile(shares, 0.95), "%", fields);
    }
  bench_hall(report, options);
}

}  // namespace wellspring::test
