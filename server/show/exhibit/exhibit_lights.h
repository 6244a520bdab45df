// SPDX-License-Identifier: Apache-2.0
// The lights of a package that move or change, and its hour of the day, out of its exhibit.json:
// see content/README.md.
#pragma once
#include "show/exhibit/json_fields.h"

namespace wellspring::show {

// What the object "flicker" says; nothing: the light is steady.
Flicker read_flicker(Fields& fields);

// Fills exhibit.lights; what of them are lights of the scene stay there. Call when lamps are read.
void read_lights(Exhibit& exhibit, Fields& root);

// Fills exhibit.day. Call when lights are read.
void read_day(Exhibit& exhibit, Fields& root);
// A day of which nothing is a problem; `lamp` and `light`: of the exhibit's scene, its daylight and
// its sun. The sun gets a lamp of its own, behind all the others.
void set_day(const DaySettings& settings, int lamp, int light, Exhibit& exhibit);

// Takes exhibit.lights out of the scene: what stands still is lit without them.
void take_lights(Exhibit& exhibit);
// Puts all of them into the scene, as they are at `time`: for pictures of one moment.
void put_lights(const std::vector<ChangingLight>& lights, double time, Scene& scene);
// Likewise the sun of that hour in place of the scene's.
void put_sun(const Day& day, double hour, Scene& scene);

}  // namespace wellspring::show
