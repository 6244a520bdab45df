// SPDX-License-Identifier: Apache-2.0
#include "show/lighting/changing_light.h"

#include <algorithm>
#include <cmath>

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

}  // namespace wellspring::show
