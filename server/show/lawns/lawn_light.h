// SPDX-License-Identifier: Apache-2.0
// Finds the light on a lawn, in the form in which blades are lit (picture/grass_view.h).
#pragma once
#include <memory>
#include <span>

#include "lawn/lawn.h"
#include "light/sample/lights.h"
#include "light/technique/technique.h"
#include "picture/grass_view.h"

namespace wellspring::show {

// Returns the light at nodes about 15 cm from one another, at most 64 a side. Illumination maps say
// what falls on the ground; shadow rays say which part of it comes from the brightest lamp, and
// from where. Without maps the technique traces a few samples for each node, lamps aside. `more`:
// lamps that belong to neither, as the sun of another hour. Takes some tens of milliseconds, or
// without maps tenths of a second.
std::shared_ptr<const LawnLight> make_lawn_light(const World& world, const Lights& lights,
                                                 const Technique& technique, const Lawn& lawn,
                                                 std::span<const PunctualLight> more);

}  // namespace wellspring::show
