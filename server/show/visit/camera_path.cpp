// SPDX-License-Identifier: Apache-2.0
#include "show/visit/camera_path.h"

#include <algorithm>
#include <cmath>

namespace wellspring::show {

namespace {

using Key = CameraPath::Key;

constexpr double key_spacing = 0.25;  // metres between control points
constexpr double key_turn = 0.14;     // radians
constexpr double look_ahead = 1.5;    // metres in which the gaze turns to the way, and from it
constexpr double least_walk = 3;  // metres; shorter ways are gone with the eyes on where they lead
constexpr double soften = 0.5;    // seconds over which the law of time is averaged
constexpr int pieces = 8;         // samples of the law of time between control points
constexpr double level_gaze = -0.04;  // pitch of somebody who looks where they go

Key operator+(const Key& a, const Key& b) {
  return {a.position + b.position, a.yaw + b.yaw, a.pitch + b.pitch, a.roll + b.roll,
          a.fov + b.fov};
}
Key operator*(const Key& a, double s) {
  return {a.position * s, a.yaw * s, a.pitch * s, a.roll * s, a.fov * s};
}

// Returns control point i of the spline that begins and ends at its first and last key, at rest
// there.
const Key& control(const std::vector<Key>& keys, long i) {
  return keys[size_t(std::clamp<long>(i - 2, 0, long(keys.size()) - 1))];
}
// Returns the end of the spline's parameter, which begins at 0.
double length_of(const std::vector<Key>& keys) { return double(keys.size()) + 1; }

struct SplinePoint {
  Key value, slope, bend;  // the value and its first and second derivative by the parameter
};

SplinePoint eval_spline(const std::vector<Key>& keys, double u) {
  u = std::clamp(u, 0.0, length_of(keys));
  long span = std::min(long(u), long(length_of(keys)) - 1);
  double t = u - double(span), t2 = t * t, t3 = t2 * t;
  const Key &a = control(keys, span), &b = control(keys, span + 1), &c = control(keys, span + 2),
            &d = control(keys, span + 3);
  SplinePoint point;
  point.value = a * ((1 - 3 * t + 3 * t2 - t3) / 6) + b * ((4 - 6 * t2 + 3 * t3) / 6) +
                c * ((1 + 3 * t + 3 * t2 - 3 * t3) / 6) + d * (t3 / 6);
  point.slope = a * ((-1 + 2 * t - t2) / 2) + b * ((-4 * t + 3 * t2) / 2) +
                c * ((1 + 2 * t - 3 * t2) / 2) + d * (t2 / 2);
  point.bend = a * (1 - t) + b * (3 * t - 2) + c * (1 - 3 * t) + d * t;
  return point;
}

double ease(double a, double b, double x) {
  double t = b > a ? std::clamp((x - a) / (b - a), 0.0, 1.0) : double(x >= b);
  return t * t * t * (t * (6 * t - 15) + 10);
}

double nearest_turn(double angle, double to) {
  return angle + 2 * double(pi) * std::round((to - angle) / (2 * double(pi)));
}

// Returns positions at equal distances along a way.
std::vector<dvec3> spread(const std::vector<dvec3>& eyes, size_t count) {
  std::vector<double> at{0};
  for (size_t i = 1; i < eyes.size(); i++)
    at.push_back(at.back() + glm::length(eyes[i] - eyes[i - 1]));
  std::vector<dvec3> points;
  size_t k = 0;
  for (size_t i = 0; i < count; i++) {
    double wanted = at.back() * double(i) / double(count - 1);
    while (k + 2 < eyes.size() && at[k + 1] < wanted) k++;
    double length = eyes.size() > 1 ? at[k + 1] - at[k] : 0;
    double t = length > 0 ? std::clamp((wanted - at[k]) / length, 0.0, 1.0) : 0;
    points.push_back(eyes.size() > 1 ? eyes[k] + (eyes[k + 1] - eyes[k]) * t : eyes.front());
  }
  return points;
}

std::vector<Key> make_keys(const std::vector<dvec3>& eyes, const Viewpoint& from,
                           const Viewpoint& to) {
  double length = 0;
  for (size_t i = 1; i < eyes.size(); i++) length += glm::length(eyes[i] - eyes[i - 1]);
  double turn = std::abs(std::remainder(double(to.yaw) - double(from.yaw), 2 * double(pi))) +
                std::abs(double(to.pitch) - double(from.pitch));
  const double tilt = std::remainder(double(to.roll) - double(from.roll), 2 * double(pi));
  turn += std::abs(tilt);
  size_t count = size_t(std::max({length / key_spacing, turn / key_turn, 6.0})) + 2;
  std::vector<dvec3> points = spread(eyes, count);
  bool walks = length >= least_walk;
  double reach = std::min(look_ahead, 0.4 * length);
  std::vector<Key> keys(count);
  double heading = double(from.yaw), last_heading = heading;
  for (size_t i = 0; i < count; i++) {
    double t = double(i) / double(count - 1), s = t * length;
    // The heading is the way from a bit behind to a bit ahead.
    dvec3 way = points[std::min(i + 2, count - 1)] - points[i >= 2 ? i - 2 : 0];
    if (glm::length(glm::dvec2(way.x, way.z)) > 1e-6)
      heading = nearest_turn(std::atan2(-way.x, -way.z), last_heading);
    last_heading = heading;
    keys[i].position = points[i];
    keys[i].yaw = heading;
    keys[i].pitch = from.pitch + (double(to.pitch) - from.pitch) * ease(0, 1, t);
    keys[i].roll = from.roll + tilt * ease(0, 1, t);
    keys[i].fov = from.fov + (double(to.fov) - from.fov) * ease(0, 1, t);
    if (walks) {
      double away = ease(0, reach, s) * (1 - ease(length - reach, length, s));
      keys[i].pitch += (level_gaze - keys[i].pitch) * away;
      keys[i].roll *= 1 - away;
    }
  }
  double first = double(from.yaw);
  double last = nearest_turn(to.yaw, walks ? keys.back().yaw : first);
  for (size_t i = 0; i < count; i++) {
    double t = double(i) / double(count - 1), s = t * length;
    if (!walks) {
      keys[i].yaw = first + (last - first) * ease(0, 1, t);
      continue;
    }
    double leaves = ease(0, reach, s), arrives = ease(length - reach, length, s);
    double yaw = first + (keys[i].yaw - first) * leaves;
    keys[i].yaw = yaw + (last - yaw) * arrives;
  }
  return keys;
}

// Holds the law of time: as fast as the limits allow everywhere.
struct Law {
  std::vector<double> speed;  // speed of the parameter, at each sample of it
  double du = 0;
};

Law make_law(const std::vector<Key>& keys, const CameraLimits& limits) {
  size_t count = size_t(length_of(keys)) * pieces + 1;
  Law law;
  law.du = length_of(keys) / double(count - 1);
  std::vector<double> most(count), push(count);
  for (size_t i = 0; i < count; i++) {
    SplinePoint at = eval_spline(keys, double(i) * law.du);
    const Key &slope = at.slope, &bend = at.bend;
    double move = std::max(glm::length(slope.position), 1e-9);
    double turn = std::max({std::abs(slope.yaw), std::abs(slope.pitch), std::abs(slope.roll),
                            std::abs(slope.fov), 1e-9});
    // In a bend the acceleration is the square of the speed times the second derivative.
    double swerve =
        std::sqrt(double(limits.acceleration) / std::max(glm::length(bend.position), 1e-9));
    double twist = std::max({std::abs(bend.yaw), std::abs(bend.pitch), std::abs(bend.roll), 1e-9});
    twist = std::sqrt(double(limits.turn_acceleration) / twist);
    most[i] =
        std::min({double(limits.speed) / move, double(limits.turn) / turn, swerve, twist, 20.0});
    push[i] = std::min(
        {double(limits.acceleration) / move, double(limits.turn_acceleration) / turn, 40.0});
  }
  // Each speed is the least one nearby: what is averaged over time later must not lend speed to its
  // neighbours.
  law.speed.resize(count);
  const size_t reach = pieces;
  for (size_t i = 0; i < count; i++)
    law.speed[i] = *std::min_element(most.begin() + long(i >= reach ? i - reach : 0),
                                     most.begin() + long(std::min(i + reach + 1, count)));
  law.speed.front() = law.speed.back() = 0;
  for (size_t i = 1; i < count; i++)
    law.speed[i] = std::min(law.speed[i],
                            std::sqrt(law.speed[i - 1] * law.speed[i - 1] + 2 * push[i] * law.du));
  for (size_t i = count - 1; i-- > 0;)
    law.speed[i] = std::min(law.speed[i],
                            std::sqrt(law.speed[i + 1] * law.speed[i + 1] + 2 * push[i] * law.du));
  return law;
}

// Returns the parameter at times i * step, averaged over `soften` seconds: changes of speed are
// eased.
std::vector<double> make_times(const std::vector<Key>& keys, const CameraLimits& limits,
                               double step) {
  Law law = make_law(keys, limits);
  std::vector<double> at{0};  // when each sample of the parameter is reached
  for (size_t i = 1; i < law.speed.size(); i++)
    at.push_back(at.back() + 2 * law.du / std::max(law.speed[i] + law.speed[i - 1], 1e-9));
  size_t window = size_t(soften / step), count = size_t(at.back() / step) + 2;
  std::vector<double> sum{0};  // integral of the parameter over time; before it 0, after it the end
  double end = length_of(keys);
  size_t k = 0;
  auto place = [&](double time) {
    if (time <= 0) return 0.0;
    if (time >= at.back()) return end;
    while (k + 2 < at.size() && at[k + 1] < time) k++;
    // The acceleration is constant between samples.
    double span = at[k + 1] - at[k], t = (time - at[k]) / span, v0 = law.speed[k],
           v1 = law.speed[k + 1];
    double moved = span * (v0 * t + 0.5 * (v1 - v0) * t * t);
    return double(k) * law.du + moved;
  };
  for (size_t i = 0; i < count + 2 * window; i++)
    sum.push_back(sum.back() + place((double(i) - double(window)) * step));
  std::vector<double> along;
  for (size_t i = 0; i + window < count + 2 * window; i++)
    along.push_back((sum[i + window] - sum[i]) / double(window));
  along.front() = 0;
  along.back() = end;
  return along;
}

double place_at(const CameraPath& path, double time) {
  double x = std::clamp(time / path.step, 0.0, double(path.along.size() - 1));
  size_t i = std::min(size_t(x), path.along.size() - 2);
  auto value = [&](long k) {
    return path.along[size_t(std::clamp<long>(k, 0, long(path.along.size()) - 1))];
  };
  double t = x - double(i), a = value(long(i)), b = value(long(i) + 1);
  double slope_a = 0.5 * (b - value(long(i) - 1)), slope_b = 0.5 * (value(long(i) + 2) - a);
  double t2 = t * t, t3 = t2 * t;
  return a * (2 * t3 - 3 * t2 + 1) + slope_a * (t3 - 2 * t2 + t) + b * (3 * t2 - 2 * t3) +
         slope_b * (t3 - t2);
}

// Returns how many times faster than allowed the camera is anywhere, at least 1.
double excess(const CameraPath& path, const CameraLimits& limits) {
  double most = 1;
  Key before = eval_spline(path.keys, path.along.front()).value;
  for (size_t i = 1; i < path.along.size(); i++) {
    Key now = eval_spline(path.keys, path.along[i]).value;
    double turn = std::max({std::abs(now.yaw - before.yaw), std::abs(now.pitch - before.pitch),
                            std::abs(now.roll - before.roll)});
    most = std::max({most,
                     glm::length(now.position - before.position) / path.step / double(limits.speed),
                     turn / path.step / double(limits.turn)});
    before = now;
  }
  return most;
}

}  // namespace

CameraPath make_camera_path(const std::vector<dvec3>& eyes, const Viewpoint& from,
                            const Viewpoint& to, const CameraLimits& limits, double least_seconds) {
  CameraPath path;
  std::vector<dvec3> points = eyes.empty() ? std::vector<dvec3>{from.position, to.position} : eyes;
  path.keys = make_keys(points, from, to);
  const Key &first = path.keys.front(), &last = path.keys.back();
  bool still = glm::length(first.position - last.position) < 1e-6 && points.size() <= 2 &&
               std::abs(first.yaw - last.yaw) < 1e-6 && std::abs(first.pitch - last.pitch) < 1e-6 &&
               std::abs(first.roll - last.roll) < 1e-6 && std::abs(first.fov - last.fov) < 1e-6;
  path.along = still ? std::vector<double>{0, length_of(path.keys)}
                     : make_times(path.keys, limits, path.step);
  path.seconds = path.step * double(path.along.size() - 1);
  double slower = still ? 1 : std::max(excess(path, limits), least_seconds / path.seconds);
  path.step *= slower;
  path.seconds *= slower;
  return path;
}

Viewpoint eval_camera_path(const CameraPath& path, double time) {
  Viewpoint view;
  if (path.keys.empty()) return view;
  Key at = eval_spline(path.keys, std::isfinite(time) ? place_at(path, time) : length_of(path.keys))
               .value;
  view.position = at.position;
  view.yaw = float(at.yaw);
  view.pitch = float(at.pitch);
  view.roll = float(at.roll);
  view.fov = float(at.fov);
  return view;
}

float turn_ahead(const CameraPath& path, double time, double seconds) {
  Viewpoint now = eval_camera_path(path, time), then = eval_camera_path(path, time + seconds);
  return std::hypot(then.yaw - now.yaw, then.pitch - now.pitch);
}

namespace {
constexpr float slow_seconds = 0.35f;  // seconds of lag with which it slows down
}

Viewpoint advance_glide(Glide& glide, bool leaps, float dt) {
  dt = std::clamp(dt, 0.0f, 0.25f);
  glide.pace += (glide.most_pace - glide.pace) * (1 - std::exp(-dt / slow_seconds));
  glide.time = leaps ? glide.path->seconds : glide.time + double(dt * glide.pace);
  Viewpoint view = eval_camera_path(*glide.path, glide.time);
  if (glide.time >= glide.path->seconds) glide = {};
  return view;
}

}  // namespace wellspring::show
