// SPDX-License-Identifier: Apache-2.0
#include "avatar/figure/motion.h"

#include <algorithm>
#include <cmath>

namespace wellspring::avatar {
namespace {

size_t width_of(TrackKind kind) {
  return kind == TrackKind::rotation ? 4 : kind == TrackKind::displacer ? 1 : 3;
}

quat unit(quat q) {
  float length = glm::length(q);
  return length > 1e-6f && length < 1e6f ? q * (1 / length) : quat(1, 0, 0, 0);
}

// Interpolates between the two keys around `time`; glTF 2.0, appendix C, has the same three curves.
void eval_track(const MotionTrack& track, float time, float* out) {
  size_t width = width_of(track.kind), keys = track.times.size();
  bool cubic = track.curve == TrackCurve::cubic;
  auto key = [&](size_t k, size_t part) {
    return track.values.data() + (cubic ? k * 3 + part : k) * width;
  };
  size_t next =
      size_t(std::upper_bound(track.times.begin(), track.times.end(), time) - track.times.begin());
  size_t first = next == 0 ? 0 : next - 1;
  next = std::min(next, keys - 1);
  float span = track.times[next] - track.times[first];
  float t = span > 0 ? std::clamp((time - track.times[first]) / span, 0.0f, 1.0f) : 0.0f;
  const float *a = key(first, 1), *b = key(next, 1);
  if (track.curve == TrackCurve::step || !(span > 0)) {
    std::copy(a, a + width, out);
  } else if (cubic) {
    const float *leave = key(first, 2), *arrive = key(next, 0);
    float t2 = t * t, t3 = t2 * t;
    for (size_t i = 0; i < width; i++)
      out[i] = (2 * t3 - 3 * t2 + 1) * a[i] + span * (t3 - 2 * t2 + t) * leave[i] +
               (-2 * t3 + 3 * t2) * b[i] + span * (t3 - t2) * arrive[i];
  } else if (track.kind == TrackKind::rotation) {
    quat q = glm::slerp(unit(quat(a[3], a[0], a[1], a[2])), unit(quat(b[3], b[0], b[1], b[2])), t);
    out[0] = q.x, out[1] = q.y, out[2] = q.z, out[3] = q.w;
  } else {
    for (size_t i = 0; i < width; i++) out[i] = a[i] + (b[i] - a[i]) * t;
  }
}

}  // namespace

double motion_time(const Motion& motion, double time, bool loop) {
  double duration = double(motion.duration);
  if (!std::isfinite(time) || !(duration > 0)) return 0;
  if (!loop) return std::clamp(time, 0.0, duration);
  double rest = std::fmod(time, duration);
  return rest < 0 ? rest + duration : rest;
}

void eval_motion(const Motion& motion, double time, bool loop, MotionPose& pose) {
  pose.rotations.assign(motion.joints.size(), quat(1, 0, 0, 0));
  pose.translations.assign(motion.joints.size(), vec3(0));
  pose.stretches.clear();
  pose.displacers.assign(motion.displacers.size(), 0);
  float at = float(motion_time(motion, time, loop));
  for (const MotionTrack& track : motion.tracks) {
    float v[4];
    eval_track(track, at, v);
    size_t target = size_t(track.target);
    if (track.kind == TrackKind::rotation) {
      pose.rotations[target] = unit(quat(v[3], v[0], v[1], v[2]));
    } else if (track.kind == TrackKind::translation) {
      pose.translations[target] = {v[0], v[1], v[2]};
    } else if (track.kind == TrackKind::displacer) {
      pose.displacers[target] = v[0];
    } else {
      if (pose.stretches.empty()) pose.stretches.assign(motion.joints.size(), mat3(1));
      mat3 axes = glm::mat3_cast(track.frame), size(1);
      for (int i = 0; i < 3; i++) size[i][i] = v[i];
      pose.stretches[target] = axes * size * glm::transpose(axes);
    }
  }
}

}  // namespace wellspring::avatar
