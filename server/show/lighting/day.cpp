// SPDX-License-Identifier: Apache-2.0
#include "show/lighting/day.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/rng.h"

namespace wellspring::show {
namespace {

// FNV-1a (Fowler, Noll, Vo), the same on every machine.
uint64_t hash_of(const std::string& name) {
  uint64_t hash = 0xcbf29ce484222325ull;
  for (unsigned char c : name) hash = (hash ^ c) * 0x100000001b3ull;
  return hash;
}

float smooth_step(float t) { return t * t * (3 - 2 * t); }

// -1 to 1.
float noise_at(uint64_t seed, int64_t knot) {
  return float(mix64(seed ^ mix64(uint64_t(knot))) >> 40) * 0x1p-23f - 1;
}

// Between two keys, of which `before` and `after` are the neighbours; `t`: 0 to 1 from one to two.
vec3 eval_cubic(const TrackKey* keys[4], vec3 TrackKey::*value, float t) {
  const TrackKey &before = *keys[0], &one = *keys[1], &two = *keys[2], &after = *keys[3];
  const float step = float(two.time - one.time);
  auto slope = [&](const TrackKey& from, const TrackKey& to) {
    const float seconds = float(to.time - from.time);
    return seconds > step ? (to.*value - from.*value) * (step / seconds) : vec3(0);
  };
  const vec3 begins = slope(before, two), ends = slope(one, after);
  const float t2 = t * t, t3 = t2 * t;
  return (2 * t3 - 3 * t2 + 1) * (one.*value) + (t3 - 2 * t2 + t) * begins +
         (3 * t2 - 2 * t3) * (two.*value) + (t3 - t2) * ends;
}

}  // namespace

float eval_flicker(const Flicker& flicker, uint64_t seed, double time) {
  if (!(flicker.depth > 0)) return 1;
  const double at = std::max(time, 0.0) * double(flicker.hz), knot = std::floor(at);
  const float from = noise_at(seed, int64_t(knot)), to = noise_at(seed, int64_t(knot) + 1);
  return 1 + flicker.depth * glm::mix(from, to, smooth_step(float(at - knot)));
}

TrackKey eval_track(const ChangingLight& light, double time) {
  const std::vector<TrackKey>& track = light.track;
  if (track.empty()) return {0, light.light.position, light.light.direction, 1};
  const double end = track.back().time;
  double at = std::max(time, 0.0);
  if (light.loop && end > 0) at = std::fmod(at, end);
  if (at >= end) return track.back();
  const auto next = std::upper_bound(track.begin(), track.end(), at,
                                     [](double t, const TrackKey& key) { return t < key.time; });
  const size_t i = size_t(next - track.begin()) - 1, last = track.size() - 1;
  // Beyond its ends a track comes to rest, or is what it is at the other end.
  TrackKey before = track[i > 0 ? i - 1 : 0], after = track[std::min(i + 2, last)];
  if (light.loop && i == 0) before = track[last - 1], before.time -= end;
  if (light.loop && i + 1 == last) after = track[1], after.time += end;
  const TrackKey* keys[4] = {&before, &track[i], &track[i + 1], &after};
  const float t = float((at - track[i].time) / (track[i + 1].time - track[i].time));
  TrackKey key{at, eval_cubic(keys, &TrackKey::position, t),
               eval_cubic(keys, &TrackKey::direction, t),
               glm::mix(track[i].intensity, track[i + 1].intensity, smooth_step(t))};
  key.direction = normalize(key.direction);
  return key;
}

PunctualLight eval_light(const ChangingLight& light, double time) {
  const TrackKey key = eval_track(light, time);
  PunctualLight now = light.light;
  now.position = key.position, now.direction = key.direction;
  now.intensity *= key.intensity * eval_flicker(light.flicker, hash_of(light.name), time);
  return now;
}

namespace {

constexpr double pi_ = 3.14159265358979323846;
constexpr double tropic =
    23.44 * pi_ / 180;  // Tropic of Cancer: no season has the sun farther from 0
constexpr double tropic_slack = 0.1 * pi_ / 180;
constexpr double minutes = 60;  // minutes of an hour

double hour_angle(double hour) { return (hour - 12) * pi_ / 12; }

struct Height {
  double elevation = 0, azimuth = 0;  // radians; azimuth clockwise from north
};
// Meeus 1998, "Astronomical Algorithms", chapter 13.
Height height_of(double latitude, double declination, double hour) {
  const double h = hour_angle(hour), sl = std::sin(latitude), cl = std::cos(latitude),
               sd = std::sin(declination), cd = std::cos(declination);
  return {std::asin(std::clamp(sl * sd + cl * cd * std::cos(h), -1.0, 1.0)),
          std::atan2(-cd * std::sin(h), cl * sd - sl * cd * std::cos(h))};
}

// Returns the height of the scene's sun; azimuth clockwise from -Z.
Height height_of(const PunctualLight& sun) {
  const dvec3 to = -dvec3(sun.direction);
  return {std::asin(std::clamp(to.y, -1.0, 1.0)), std::atan2(to.x, -to.z)};
}

// sin(elevation) = a sin(declination) + b cos(declination), solved; of two that which is less far
// from 0. NaN: none.
double declination_for(const DaySettings& s, double elevation) {
  const double latitude = glm::radians(s.latitude);
  const double a = std::sin(latitude), b = std::cos(latitude) * std::cos(hour_angle(s.at));
  const double middle = std::atan2(a, b), reach = std::acos(std::sin(elevation) / std::hypot(a, b));
  const double one = std::remainder(middle - reach, 2 * pi_),
               other = std::remainder(middle + reach, 2 * pi_);
  return std::abs(one) < std::abs(other) ? one : other;
}

double most_elevation(const DaySettings& s) {
  const double latitude = glm::radians(s.latitude);
  double most = -pi_;
  for (int i = -20; i <= 20; i++)
    most = std::max(most, height_of(latitude, tropic * i / 20, s.at).elevation);
  return glm::degrees(most);
}

Daylight eval_daylight(const Day& day, double elevation) {
  const std::vector<double>& rows = day.elevations;
  const double at = std::clamp(elevation, rows.front(), rows.back());
  const auto next = std::upper_bound(rows.begin() + 1, rows.end() - 1, at);
  const size_t i = size_t(next - rows.begin());
  const float t = float((at - rows[i - 1]) / (rows[i] - rows[i - 1]));
  const Daylight &low = day.daylight[i - 1], &high = day.daylight[i];
  // The sky's brightness falls by orders of magnitude after sunset.
  auto between = [&](vec3 a, vec3 b) {
    const vec3 least(1e-12f);
    return glm::exp(glm::mix(glm::log(glm::max(a, least)), glm::log(glm::max(b, least)), t));
  };
  return {glm::mix(low.sun, high.sun, t), between(low.sky, high.sky)};
}

double elevation_at(const Day& day, double hour) {
  return glm::degrees(
      height_of(glm::radians(day.settings.latitude), day.declination, hour).elevation);
}

}  // namespace

std::string day_problem(const DaySettings& s, const PunctualLight& sun) {
  const double elevation = height_of(sun).elevation, degrees = glm::degrees(elevation);
  if (degrees < least_sun)
    return fmt::format("the sun stands {:.0f} degrees high in the scene: {} at least", degrees,
                       least_sun);
  const double declination = declination_for(s, elevation);
  if (std::abs(declination) <= tropic + tropic_slack) return "";
  const double most = most_elevation(s);
  return fmt::format(
      "at the hour {} the sun never stands as the scene has it, {:.0f} degrees high: {}", s.at,
      degrees,
      most < degrees ? fmt::format("at most {:.0f}", most) : "it stands higher then all year");
}

Day make_day(const DaySettings& settings, const PunctualLight& sun) {
  Day day{.settings = settings, .sun = sun};
  const Height scene = height_of(sun);
  day.declination = declination_for(settings, scene.elevation);
  day.turn = scene.azimuth -
             height_of(glm::radians(settings.latitude), day.declination, settings.at).azimuth;
  day.elevations = {-18, -15, -12, -9, -6,  -4, -3, -2, -1, -0.5, -0.3, 0,  0.3, 0.5, 1,
                    2,   3,   4,   6,  8.5, 12, 16, 20, 25, 30,   40,   50, 60,  75,  90};
  day.daylight = eval_daylight(SkySettings{}, day.elevations);
  return day;
}

std::optional<double> hour_of_day(const Day& day, double hour) {
  const DaySettings& s = day.settings;
  const double minute = std::round(std::clamp(hour, s.from, s.to) * minutes);
  if (minute == std::round(s.at * minutes)) return {};
  return minute / minutes;
}

dvec3 eval_sun_place(const Day& day, double hour) {
  const Height height = height_of(glm::radians(day.settings.latitude), day.declination, hour);
  const double azimuth = height.azimuth + day.turn, flat = std::cos(height.elevation);
  return {std::sin(azimuth) * flat, std::sin(height.elevation), -std::cos(azimuth) * flat};
}

PunctualLight eval_sun(const Day& day, double hour) {
  PunctualLight sun = day.sun;
  const vec3 own = eval_daylight(day, elevation_at(day, day.settings.at)).sun;
  sun.direction = -vec3(eval_sun_place(day, hour));
  sun.intensity *= eval_daylight(day, elevation_at(day, hour)).sun / own;
  return sun;
}

float eval_sky(const Day& day, double hour) {
  const float own = luminance(eval_daylight(day, elevation_at(day, day.settings.at)).sky);
  return std::min(luminance(eval_daylight(day, elevation_at(day, hour)).sky) / own, 1.0f);
}

LampLevels lamp_levels(const std::optional<Day>& day, std::span<const LampSwitch> on,
                       std::optional<double> hour) {
  LampLevels levels;
  for (LampSwitch one : on) levels.push_back({one ? lamp_full : 0, uint8_t(one > 1 ? one - 1 : 0)});
  if (!day) return levels;
  LampLevel& sky = levels[size_t(day->lamp)];
  const LampLevel sun = hour ? LampLevel(0) : sky;
  if (hour && sky.level > 0) sky.level = level_of(eval_sky(*day, *hour));
  levels.push_back(sun);  // day->sun_lamp
  return levels;
}

}  // namespace wellspring::show
