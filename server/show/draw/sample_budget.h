// SPDX-License-Identifier: Apache-2.0
// How many samples a picture is given, and how large a keyframe is drawn, decided by what was
// measured.
#pragma once
#include <cstddef>

namespace wellspring::show {

struct DrawingCosts {
  double samples_per_second = 0;  // all cores
  double drawing_seconds = 0;     // visibility and shading of a picture, all cores
  double display_seconds = 0;     // what a picture takes besides: reprojection, tone mapping
  double light_seconds = 0;       // the same of one drawn for who moves; 0: never measured
};

// `seconds`: what there is for all. Of a picture for who `stands` at least a quarter of the time
// goes to light.
int sample_budget(double seconds, size_t pixels, const DrawingCosts& costs, bool stands);

// Of so many samples at rest, those that are to find changes of the light.
int samples_to_watch(int samples);

// A keyframe for who moves: the sides that it is drawn with, over those of the visitor's picture,
// and the seconds until the next one, in which samples have the time that drawing leaves.
struct KeyframePlan {
  float scale = 1;
  double period = 0;
};
// Resolution falls where keyframes would come late, since what a warp does not know is worse than
// what it shows softly. `seconds`: what drawing one of scale `before` took, as often as there are
// visitors who move; it climbs back only where there is time to spare. longest_period: seconds,
// beyond which they come late.
KeyframePlan plan_keyframe(double seconds, float before, double longest_period);

// A page that draws by itself shows more and more wrong, the longer a keyframe has to do. These are
// shares of the picture, a second.
struct Ageing {
  float uncovered = 0;  // appear beside what is nearer, and nothing knows them
  float turned_to = 0;  // come in from the side, and the wide keyframe has them in few pixels
};
// Seconds that one may be used for until that shows. Who passes near things needs many; who turns
// within the wide keyframe's reach, few.
double longest_period(const Ageing& ageing);
// For pictures that are finished by the server.
inline constexpr double finished_period = 1 / 10.0;  // beyond, turns and near things uncover much
// What drawing a keyframe of that scale takes, over one of scale 1. Points and triangles do not get
// fewer with the pixels: 0.52 at a half and 0.36 at 3/8 (castle, one core).
double keyframe_cost(float scale);

// How much of its pace a tour's camera keeps, 0 to 1, so that keyframes follow its turns: `turn`
// radians of a picture `fov` radians wide from one keyframe to the next.
float tour_pace(float turn, float fov);

// Whether the reference (`path`) answers: who has stood for a while, when most places have so many
// answers of the quicker technique, whose single samples tell more, that those of the reference are
// no noise to speak of. `before`: it did for the picture before. `guessed`: share of its light that
// no point told; `known`: share of the pixels with that many (CacheStats::converged).
bool wants_reference(double seconds_at_rest, bool before, float guessed, float known);

}  // namespace wellspring::show
