// SPDX-License-Identifier: Apache-2.0
// Reads the pieces of exhibit.json that are scanned volumes: mummies, violins, clouds of light.
#pragma once
#include <vector>

#include "show/exhibit/exhibit.h"
#include "show/exhibit/json_fields.h"
#include "show/exhibit/pieces/piece_choices.h"
#include "world/placed_volume.h"
#include "world/world.h"

namespace wellspring::show {

// Reads `source`, `size_m` and `presets`: piece.volume, piece.scale and a layer for each preset. A
// volume that cannot be read is a problem.
void read_volume(const Exhibit& exhibit, FieldReader& fields, ExhibitPiece& piece,
                 std::vector<Problem>& problems);

// Returns the volume of a nebula whose axis is tilted so, radians. Takes some tenths of a second.
std::shared_ptr<const ShownVolume> solve_nebula(const PieceNebula& nebula, float tilt);
// Returns a volume's width, height and depth where it stands, metres.
vec3 size_of(const ExhibitPiece& piece);
// Returns where a volume stands, with nothing seen of it.
PlacedVolume place_volume(const Exhibit& exhibit, const ExhibitPiece& piece);
// Puts all volumes into the world with their first presets, in no light: as a bake wants them, for
// which they throw shadows.
void place_volumes(const Exhibit& exhibit, World& world);
// Cuts away of the volume or scan that a glass names, or of all, as much as its order says of the
// side that an eye sees. `ray`: the eye's (scene coordinates), through the middle of the glass.
void cut_ahead(const Exhibit& exhibit, const LensOrder& order, const Ray& ray,
               PieceChoices& choices);

}  // namespace wellspring::show
