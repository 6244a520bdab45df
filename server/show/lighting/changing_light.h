// SPDX-License-Identifier: Apache-2.0
// A light that moves or changes by itself, as `lights` of exhibit.json has it (content/README.md).
// It is a function of time alone, the same for everybody and at every start.
//
// Nothing here makes a light flash more than three times a second (WCAG 2.2, success criterion
// 2.3.1: a flash is a rise and a fall of brightness). Brightness turns round only at the knots of a
// flicker or of a track, and there are at most `most_turns` of these a second.
#pragma once
#include <string>
#include <vector>

#include "world/emitter.h"

namespace wellspring::show {

inline constexpr double most_turns = 5;  // a second, of a light's brightness
inline constexpr size_t most_changing_lights = 16, most_track_keys = 1000;

// Brightness as smooth noise about 1: random values at `hz` knots a second, within `depth` of 1,
// and a smooth step from each to the next.
struct Flicker {
  float depth = 0;  // 0 to 1
  float hz = 4;     // 0.1 to most_turns
};

struct TrackKey {
  double time = 0;           // seconds; of the first key 0
  vec3 position{0};          // relative to Scene::origin
  vec3 direction{0, 0, -1};  // unit
  float intensity = 1;       // times the light's own
};

struct ChangingLight {
  std::string name;     // of no other one; makes its flicker another than that of others
  PunctualLight light;  // without flicker and track
  int lamp = -1;        // of Scene::lamps: it shines while that is on; -1: always
  int of_scene = -1;    // its place in Scene::lights; -1: it is not there (any more)
  Flicker flicker;
  std::vector<TrackKey> track;  // empty: it stands still; times rise by 1 / most_turns or more
  bool loop = true;             // the track begins again at its end; else the light stays there
};

// Times a light's mean brightness. `seed`: of the light.
float eval_flicker(const Flicker& flicker, uint64_t seed, double time);
// Position and direction run smoothly through all keys (cubic, Catmull and Rom 1974), intensity
// goes from key to key without passing beyond either.
TrackKey eval_track(const ChangingLight& light, double time);
// The light at `time`, seconds from 0 on.
PunctualLight eval_light(const ChangingLight& light, double time);

}  // namespace wellspring::show
