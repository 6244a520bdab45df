// SPDX-License-Identifier: Apache-2.0
// The hour of the day of an exhibit (`day` of exhibit.json, content/README.md). At the exhibit's
// own hour the sun of its scene stands as the scene has it. At another hour it stands where the sun
// would by then, and it and the sky are as much brighter or darker, and the sun as much redder, as
// a model of the air says (world/sky.h). Hours are solar time: at 12 the sun is highest.
//
// The season follows from the scene: it is the one in which the sun stands so high at the
// exhibit's hour.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "world/scene.h"
#include "world/sky.h"
#include "world/world.h"

namespace wellspring::show {

// A light that moves or changes by itself, as `lights` of exhibit.json has it (content/README.md).
// It is a function of time alone, the same for everybody and at every start.
//
// Nothing here makes a light flash more than three times a second (WCAG 2.2, success criterion
// 2.3.1: a flash is a rise and a fall of brightness). Brightness turns round only at the knots of a
// flicker or of a track, and there are at most `most_turns` of these a second.

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
  std::string name;     // its own name, which makes its flicker another than that of others
  PunctualLight light;  // without flicker and track
  int lamp = -1;        // index into Scene::lamps: it shines while that is on; -1: always
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

inline constexpr double least_sun = 10;  // degrees that the scene's sun stands high, at least

struct DaySettings {
  double from = 5, to = 22;  // hours that visitors may choose
  double at = 12;            // the exhibit's own
  double latitude = 49;      // degrees, -66 to 66
};

struct Day {
  DaySettings settings;
  PunctualLight sun;  // the scene's, at its own hour
  int lamp = -1;      // index into Scene::lamps: all daylight but the sun
  int sun_lamp = -1;  // likewise: the sun alone
  // Radians.
  double declination = 0;  // declination of the sun: the season
  double turn = 0;         // from north to -Z, clockwise seen from above
  // By the sun's height, rising.
  std::vector<double> elevations;  // degrees
  std::vector<Daylight> daylight;
};

// Why the sun of the scene cannot stand so at that hour; empty: it can.
std::string day_problem(const DaySettings& settings, const PunctualLight& sun);
// Makes the day from settings without a problem. This takes a tenth of a second.
Day make_day(const DaySettings& settings, const PunctualLight& sun);

// The hour as one of the day's, whole minutes. Nothing: the exhibit's own hour.
std::optional<double> hour_of_day(const Day& day, double hour);

// Towards the sun, unit.
dvec3 eval_sun_place(const Day& day, double hour);
PunctualLight eval_sun(const Day& day, double hour);
// Returns the light of the sky, times that of the exhibit's own hour, at most 1.
float eval_sky(const Day& day, double hour);

// Returns the levels of the scene's lamps, if `on` says which of the exhibit's are on, at an hour
// of the day (nothing: the exhibit's own). At another one the scene's sun is off: it stands
// elsewhere then.
LampLevels lamp_levels(const std::optional<Day>& day, std::span<const LampSwitch> on,
                       std::optional<double> hour);

}  // namespace wellspring::show
