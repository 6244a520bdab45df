// SPDX-License-Identifier: Apache-2.0
// How much of the storyteller runs. Walls stand around it at two distances; the zone that the
// nearest viewer is in says what is needed, and what is not needed is not computed. A wall is
// crossed inwards and outwards at different distances, so that somebody standing on it does not
// make the figure flicker. Source: the storyteller and kiosk paper, "glass walls" (no expressions
// when very distant, voice and Perlin's face in the middle, all of MPEG-4 near); the distances are
// ours.
//
//                            none (beyond 8 m)   medium (3 to 8 m)         full (within 3 m)
//   body, gestures           yes, without fingers yes                      yes
//   head's gaze              yes                 yes                       yes
//   eyes                     -                   yes, no saccades          yes
//   blink, speech            -                   yes                       yes
//   face                     -                   Perlin's flexes           all expressions
//   noise                    -                   of the body               of face and body
//   hair and cloth (springs) -                   yes                       yes
//   lazy mirror, empathy     -                   -                         yes
#pragma once
#include <cstdint>

namespace wellspring::avatar {

enum class Detail : uint8_t { none, medium, full };
const char* to_string(Detail detail);

struct DetailWalls {
  float near = 3, far = 8;   // metres
  float hysteresis = 0.25f;  // to both sides of a wall
};

// The zone of a viewer at `distance` who was in zone `before`. NaN: no change.
Detail next_detail(Detail before, float distance, const DetailWalls& walls = {});

// What has been computed since the storyteller began; a figure far away shows it in what stands
// still.
struct StorytellerWork {
  uint64_t ticks = 0, fingers = 0, eyes = 0, saccades = 0, blinks = 0, visemes = 0, flexes = 0,
           flex_noise = 0, body_noise = 0, expressions = 0, mirror = 0, empathy = 0, springs = 0;
  bool operator==(const StorytellerWork&) const = default;
};

}  // namespace wellspring::avatar
