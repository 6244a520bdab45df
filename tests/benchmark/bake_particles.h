// SPDX-License-Identifier: Apache-2.0
// The other way to bake, which is compared with light/kept/bake.h: density estimation of particles
// (Walter 1998; Haber et al. 2001, section 4.1).
#pragma once
#include "light/kept/bake.h"

namespace wellspring::test {

// `count` particles leave the sources and are counted at the nodes of `field` that they hit: flux
// over area, whose part outside the surface is left out, so that borders are not too dark. All
// light goes to the first layer. Numbers of `first` on are another part of one sequence.
void trace_particles(const BakeScene& scene, const Bake& bake, uint64_t first, uint64_t count,
                     BakeField& field);
// Light of the nodes after so many particles, as means of `field`: to be finished like any other.
void finish_particles(const World& world, const Bake& bake, uint64_t count, BakeField& field);

}  // namespace wellspring::test
