// SPDX-License-Identifier: Apache-2.0
// cache.turns.unknown: who turns by keys starts and stops at once, while pictures to warp are drawn for
// where the view is expected to be. How much of the pictures shown lies outside of what was drawn, and so
// repeats its border, for machines that take so long for a drawn picture; without prediction, predicted with
// margins of the same width for all, and as the show does, with margins as wide as turns are quick.
#include <cmath>

#include "base/rng.h"
#include "cache/warp_picture.h"
#include "report.h"
#include "show/heading.h"

namespace wellspring {
namespace {

constexpr double rate = 60, turn_speed = 1.5, ease = 0.07;  // as the page's keys (web/controls.js)
constexpr int width = 320, height = 180;                    // margins are shares of them

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
  for (int i = 0; i < int(seconds * rate); i++) {
    if (i / rate >= until) {
      until += span();
      key = key != 0 ? 0 : rng.next() & 1 ? 1 : -1;
    }
    turning += (key - turning) * (1 - std::exp(-1 / (rate * ease)));
    if (std::abs(turning) < 0.01) turning = 0;
    yaws.push_back(yaw += turning * turn_speed / rate);
  }
  return yaws;
}

using Expect = View (*)(const Heading&, const View& now, double seconds);
View stay(const Heading&, const View& now, double) { return now; }
View plain(const Heading& heading, const View& now, double seconds) { return expected_view(heading, now, seconds); }

// Shares of pixels, one a tick.
std::vector<double> unknown_shares(const std::vector<double>& yaws, double drawing, Expect expect) {
  std::vector<double> shares;
  Heading heading;
  Keyframe shown, drawn;
  WarpScratch scratch;
  Image8 blank, out;
  double finished = -1;
  for (size_t i = 0; i < yaws.size(); i++) {
    double time = double(i) / rate;
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
}

}  // namespace wellspring
