// SPDX-License-Identifier: Apache-2.0
// Finds the light of a room that falls on a volume, in the form in which volumes are lit
// (volume/draw/light_grid.h): a lamp far away, and light that is the same all around.
#pragma once
#include "light/sample/lights.h"
#include "light/technique/technique.h"
#include "world/placed_volume.h"
#include "world/world.h"

namespace wellspring::show {

// Returns the light at the volume's middle, directions in the volume's own frame. Both parts
// together bring as much light, and push as much to one side, as the room does: the lamp stands
// where the vector irradiance comes from (Gershun 1939, "The Light Field"). Traces a few hundred
// rays by the technique, which ends them on illumination maps where there are any. The volume's own
// matter stops light, too, unless it is hidden.
VolumeLight room_light(const World& world, const Lights& lights, const Technique& technique,
                       const PlacedVolume& placed);

}  // namespace wellspring::show
