// SPDX-License-Identifier: Apache-2.0
// Reads the pieces of exhibit.json that are lawns, and lets them grow.
#pragma once
#include <memory>
#include <vector>

#include "show/exhibit/exhibit.h"
#include "show/exhibit/json_fields.h"
#include "world/world.h"

namespace wellspring::show {

inline constexpr int most_lawn_blades = 500'000;

// Reads all fields of a lawn but its place. A picture that cannot be read is a problem.
void read_lawn(const Exhibit& exhibit, FieldReader& fields, ExhibitLawn& lawn,
               std::vector<Problem>& problems);
// Adds the lawn to the exhibit, around the place of `piece`, which has been read.
void place_lawn(Exhibit& exhibit, FieldReader& fields, const ExhibitPiece& piece, ExhibitLawn lawn);
// Lets it grow wherever rays from above meet ground that faces up, of its materials. Things that
// move are no ground. Takes some tenths of a second for 100,000 blades.
std::shared_ptr<const Lawn> grow_lawn(const ExhibitLawn& lawn, const World& world);

}  // namespace wellspring::show
