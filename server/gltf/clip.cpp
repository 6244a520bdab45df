// SPDX-License-Identifier: Apache-2.0
#include "gltf/clip.h"

#include <algorithm>

namespace wellspring::gltf {
namespace {

// Appendix C.3 to C.5. Cubic keys are laid out in-tangent, value, out-tangent.
std::vector<double> eval_track(const Track& track, double time) {
  size_t width = track.width, keys = track.times.size();
  bool cubic = track.curve == Curve::cubic;
  auto value = [&](size_t key, size_t part, size_t i) {
    return double(track.values[(cubic ? (key * 3 + part) : key) * width + i]);
  };
  size_t next = size_t(std::upper_bound(track.times.begin(), track.times.end(), float(time)) -
                       track.times.begin());
  size_t first = next == 0 ? 0 : next - 1;
  next = std::min(next, keys - 1);
  double span = double(track.times[next]) - track.times[first];
  double t = span > 0 ? glm::clamp((time - track.times[first]) / span, 0.0, 1.0) : 0.0;
  std::vector<double> result(width);
  if (track.curve == Curve::step || span <= 0) {
    for (size_t i = 0; i < width; i++) result[i] = value(first, 1, i);
  } else if (cubic) {
    double t2 = t * t, t3 = t2 * t;
    for (size_t i = 0; i < width; i++)
      result[i] = (2 * t3 - 3 * t2 + 1) * value(first, 1, i) +
                  span * (t3 - 2 * t2 + t) * value(first, 2, i) +
                  (-2 * t3 + 3 * t2) * value(next, 1, i) + span * (t3 - t2) * value(next, 0, i);
  } else if (track.path == Path::rotation) {
    auto key = [&](size_t k) {
      return glm::dquat(value(k, 1, 3), value(k, 1, 0), value(k, 1, 1), value(k, 1, 2));
    };
    glm::dquat q = glm::slerp(key(first), key(next), t);
    result = {q.x, q.y, q.z, q.w};
  } else {
    for (size_t i = 0; i < width; i++)
      result[i] = value(first, 1, i) * (1 - t) + value(next, 1, i) * t;
  }
  return result;
}

void apply(const Track& track, double time, Node& node) {
  std::vector<double> v = eval_track(track, time);
  switch (track.path) {
    case Path::translation: node.translation = {v[0], v[1], v[2]}; break;
    case Path::scale: node.scale = {v[0], v[1], v[2]}; break;
    case Path::rotation: node.rotation = glm::dquat(v[3], v[0], v[1], v[2]); break;
    case Path::weights: node.weights = v; break;
    case Path::none: break;
  }
}

}  // namespace

double length_of(const Clip& clip) {
  float end = 0;
  for (const Track& track : clip.tracks)
    if (!track.times.empty()) end = std::max(end, track.times.back());
  return double(end);
}

void move_nodes(const Clip& clip, double time, std::vector<Node>& nodes) {
  for (const Track& track : clip.tracks) apply(track, time, nodes[track.node]);
}

}  // namespace wellspring::gltf
