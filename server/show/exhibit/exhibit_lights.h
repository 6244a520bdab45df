// SPDX-License-Identifier: Apache-2.0
// The lights of a package that move or change, out of its exhibit.json: see content/README.md.
#pragma once
#include "show/exhibit/json_fields.h"

namespace wellspring {

// What the object "flicker" says; nothing: the light is steady.
Flicker read_flicker(Fields& fields);

// Fills exhibit.lights; what of them are lights of the scene stay there. Call when lamps are read.
void read_lights(Exhibit& exhibit, Fields& root);

// Takes them out of the scene: what stands still is lit without them.
void take_lights(Exhibit& exhibit);
// Puts all of them into the scene, as they are at `time`: for pictures of one moment.
void put_lights(const std::vector<ChangingLight>& lights, double time, Scene& scene);

}  // namespace wellspring
