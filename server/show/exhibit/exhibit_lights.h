// SPDX-License-Identifier: Apache-2.0
// The lights of a package that move or change, and its hour of the day, out of its exhibit.json:
// see content/README.md.
#pragma once
#include <optional>

#include "show/exhibit/exhibit.h"
#include "show/exhibit/json_fields.h"
#include "world/world.h"

namespace wellspring::show {

// The lamps that a package names, out of its exhibit.json: see content/README.md.

// Fills exhibit.lamps, and exhibit.scene.lamps one for one. Call when the scene is there.
void read_lamps(Exhibit& exhibit, FieldReader& root);

// As the exhibit is at first: which of its lamps are on, and the scene's.
std::vector<LampSwitch> first_lamps(const Exhibit& exhibit);
LampLevels first_levels(const Exhibit& exhibit);

// Reads the object "flicker"; without one the light is steady.
Flicker read_flicker(FieldReader& fields);

// Fills exhibit.lights; what of them are lights of the scene stay there. Call when lamps are read.
void read_lights(Exhibit& exhibit, FieldReader& root);

// Fills exhibit.day. Call when lights are read.
void read_day(Exhibit& exhibit, FieldReader& root);
// A day of which nothing is a problem; `lamp` and `light`: of the exhibit's scene, its daylight and
// its sun. The sun gets a lamp of its own, behind all the others.
void set_day(const DaySettings& settings, int lamp, int light, Exhibit& exhibit);

// Takes exhibit.lights out of the scene: what stands still is lit without them.
void take_lights(Exhibit& exhibit);
// Puts all of them into the scene, as they are at `time`: for pictures of one moment.
void put_lights(const std::vector<ChangingLight>& lights, double time, Scene& scene);
// Likewise the sun of that hour in place of the scene's.
void put_sun(const Day& day, double hour, Scene& scene);

// How bright an exhibit is, as a light meter at its viewpoints has it.

// The exposure with which what is seen from the viewpoints (each counts the same) is well lit: the
// light that falls on it, not what it reflects, so that a black statue stays black. From a coarse
// picture of each of the first 16 viewpoints, lamps as they are at first. The same bits each time.
// Nothing where no light is found. Tenths of a second, on all cores. `world` is of exhibit.scene.
std::optional<float> measure_exposure(const Exhibit& exhibit, World& world);
// The same with a world of its own; 1 where no light is found.
float measure_exposure(const Exhibit& exhibit);

}  // namespace wellspring::show
