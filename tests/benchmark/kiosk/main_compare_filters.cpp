// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <fmt/core.h>
#include <functional>

#include "kiosk/face/face_finder.h"
#include "kiosk/face/head_pose.h"
#include "kiosk/figure.h"
#include "kiosk/frame/head.h"
#include "kiosk/observe.h"
#include "main_compare.h"

namespace wellspring::test {
namespace {

constexpr float degree = pi / 180;
constexpr double rate = 30;

// A Kalman filter for each of three angles that turn at a constant velocity but for a random
// acceleration (Bar-Shalom, Li, Kirubarajan 2001, section 6.2.2).
struct Kalman {
  bool started = false;
  double time = 0;
  vec3 value{0}, speed{0};
  float vv = 0, vs = 0, ss = 0;  // covariance, the same for the three

  // `noise`: radians^2/s^3, how much the speed changes; `error`: radians, of a raw angle.
  vec3 step(float noise, float error, double now, vec3 raw) {
    if (!started) {
      *this = {true, now, raw, vec3(0), error * error, 0, 1};
      return raw;
    }
    const float dt = float(now - time);
    time = now;
    value += speed * dt;
    vv += dt * (2 * vs + dt * ss) + noise * dt * dt * dt / 3;
    vs += dt * ss + noise * dt * dt / 2;
    ss += noise * dt;
    const float sum = vv + error * error, gain = vv / sum, speed_gain = vs / sum;
    const vec3 off = raw - value;
    value += gain * off;
    speed += speed_gain * off;
    ss -= speed_gain * vs;
    vs -= gain * vs;
    vv -= gain * vv;
    return value;
  }
};

struct Angles {
  double time;
  vec3 truth, raw;  // radians
};

// Returns the rotations that networks and pose find in each picture, before any filter.
std::vector<Angles> watch_head(FaceFinder& finder, double seconds,
                               const std::function<vec3(double)>& rotation) {
  std::vector<Angles> all;
  std::optional<Face> face;
  FigurePose pose;
  pose.visible = true;
  for (int k = 0; k < int(seconds * rate); k++) {
    const double time = k / rate;
    pose.rotation = rotation(time);
    const GrayFrame frame = draw_figure({640, 480, 1, 2.5f, uint64_t(k)}, {}, pose, time);
    if (face) face = finder.follow(frame, *face);
    if (!face)
      if (auto found = finder.search(frame); !found.empty()) face = found[0];
    if (!face || !face->marks) continue;
    const auto head = solve_head_pose(*face->marks, focal_length({}, frame.width, frame.height),
                                      frame.width, frame.height);
    if (head) all.push_back({time, pose.rotation, rotation_on_screen({}, head->rotation)});
  }
  return all;
}

using Filter = std::function<vec3(double time, vec3 raw)>;

std::vector<float> yaws(const std::vector<Angles>& head, const Filter& filter) {
  std::vector<float> out;
  for (const Angles& one : head) out.push_back(filter(one.time, one.raw).x);
  return out;
}

// Root mean square about the mean; the first second is left out.
double spread(const std::vector<float>& values) {
  double sum = 0, squares = 0, count = 0;
  for (size_t i = size_t(rate); i < values.size(); i++)
    sum += values[i], squares += double(values[i]) * values[i], count++;
  return std::sqrt(std::max(0.0, squares / count - (sum / count) * (sum / count)));
}

// Root mean square of what `values` differ from the truth `late` seconds ago, without its mean.
double error_at(const std::vector<Angles>& head, const std::vector<float>& values, double late,
                const std::function<vec3(double)>& rotation) {
  std::vector<float> off(values.size());
  for (size_t i = 0; i < values.size(); i++) off[i] = values[i] - rotation(head[i].time - late).x;
  return spread(off);
}

}  // namespace

void compare_filters(const CompareOptions& options) {
  ObserverSettings settings;
  settings.face.weights = options.weights;
  const auto finder = make_face_finder(settings.face);
  const double seconds = options.quick ? 6 : 20;
  // 25 degrees to both sides in 2.5 s: 63 degrees a second at most.
  auto turns = [](double time) {
    return vec3(25 * degree * float(std::sin(2 * double(pi) * 0.4 * time)), 0, 0);
  };
  const auto rest = watch_head(*finder, seconds, [](double) { return vec3(0.1f, 0, 0); });
  const auto moving = watch_head(*finder, seconds, turns);
  if (rest.size() < size_t(3 * rate) || moving.size() < size_t(3 * rate))
    throw std::runtime_error("filters: the synthetic head was not followed");
  auto measure = [&](const std::string& name, const std::string& setting,
                     const std::function<Filter()>& make) {
    const auto resting = yaws(rest, make()), following = yaws(moving, make());
    double least = 1e9, lag = 0;
    for (int ms = -50; ms <= 400; ms++)
      if (double error = error_at(moving, following, 0.001 * ms, turns); error < least)
        least = error, lag = ms;
    const nlohmann::json fields{{"filter", name}, {"setting", setting}};
    tell("kiosk.filter.lag_ms", lag, "ms", fields);
    tell("kiosk.filter.jitter_deg", spread(resting) / double(degree), "degrees", fields);
    tell("kiosk.filter.error_deg", error_at(moving, following, 0, turns) / double(degree),
         "degrees", fields);
  };
  measure("none", "raw", [] { return [](double, vec3 raw) { return raw; }; });
  auto one_euro = [](OneEuroSettings with) {
    return [with]() -> Filter {
      return [with, state = OneEuro{}](double time, vec3 raw) mutable {
        return step_one_euro(state, with, time, raw);
      };
    };
  };
  for (float cutoff : {rotation_filter.min_cutoff, 2 * rotation_filter.min_cutoff})
    for (float beta : {0.25f * rotation_filter.beta, rotation_filter.beta})
      measure("one euro", fmt::format("{:.1f} Hz, {:.1f}", cutoff, beta),
              one_euro({cutoff, beta, rotation_filter.speed_cutoff}));
  const float error = 0.3f * degree;
  for (float noise : {0.01f, 0.03f, 0.1f, 0.3f, 1.f, 10.f})
    measure("kalman", fmt::format("{:g}", noise), [=]() -> Filter {
      return [=, state = Kalman{}](double time, vec3 raw) mutable {
        return state.step(noise, error, time, raw);
      };
    });
}

}  // namespace wellspring::test
