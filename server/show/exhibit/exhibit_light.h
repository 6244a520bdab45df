// SPDX-License-Identifier: Apache-2.0
// How bright an exhibit is, as a light meter at its viewpoints has it.
#pragma once
#include <optional>

#include "show/exhibit/exhibit.h"
#include "world/world.h"

namespace wellspring::show {

// The exposure with which what is seen from the viewpoints (each counts the same) is well lit: the
// light that falls on it, not what it reflects, so that a black statue stays black. From a coarse
// picture of each of the first 16 viewpoints, lamps as they are at first. The same bits each time.
// Nothing where no light is found. Tenths of a second, on all cores. `world` is of exhibit.scene.
std::optional<float> measure_exposure(const Exhibit& exhibit, World& world);
// The same with a world of its own; 1 where no light is found.
float measure_exposure(const Exhibit& exhibit);

}  // namespace wellspring::show
