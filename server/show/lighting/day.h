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

#include "world/emitter.h"
#include "world/lamp_level.h"
#include "world/sky.h"

namespace wellspring::show {

inline constexpr double least_sun = 10;  // degrees that the scene's sun stands high, at least

struct DaySettings {
  double from = 5, to = 22;  // hours that visitors may choose
  double at = 12;            // the exhibit's own
  double latitude = 49;      // degrees, -66 to 66
};

struct Day {
  DaySettings settings;
  PunctualLight sun;  // of the scene, at its own hour
  int lamp = -1;      // of Scene::lamps: all daylight but the sun
  int sun_lamp = -1;  // likewise: the sun alone
  // Radians.
  double declination = 0;  // of the sun: the season
  double turn = 0;         // from north to -Z, clockwise seen from above
  // By the sun's height, rising.
  std::vector<double> elevations;  // degrees
  std::vector<Daylight> daylight;
};

// Why the sun of the scene cannot stand so at that hour; empty: it can.
std::string day_problem(const DaySettings& settings, const PunctualLight& sun);
// Of settings without a problem. A tenth of a second.
Day make_day(const DaySettings& settings, const PunctualLight& sun);

// The hour as one of the day's, whole minutes. Nothing: the exhibit's own hour.
std::optional<double> hour_of_day(const Day& day, double hour);

// Towards the sun, unit.
dvec3 eval_sun_place(const Day& day, double hour);
PunctualLight eval_sun(const Day& day, double hour);
// Of the sky, times that of the exhibit's own hour, at most 1.
float eval_sky(const Day& day, double hour);

// Of the scene's lamps, where `on` says which of the exhibit's are on, at an hour of the day
// (nothing: the exhibit's own). At another one the scene's sun is off: it stands elsewhere then.
LampLevels lamp_levels(const std::optional<Day>& day, std::span<const char> on,
                       std::optional<double> hour);

}  // namespace wellspring::show
