// SPDX-License-Identifier: Apache-2.0
// Reads the pieces of exhibit.json that are scanned places and things: points and splats.
#pragma once
#include <vector>

#include "show/exhibit/exhibit.h"
#include "show/exhibit/json_fields.h"
#include "world/placed_scan.h"
#include "world/world.h"

namespace wellspring::show {

// Reads `source`, `up`, `unit_m`, `brightness` and `looks`: piece.points or piece.splats, where
// they lie, and a layer for each look. Returns the mesh that rays meet in place of the scan. A scan
// that cannot be read is a problem.
Mesh read_scan(const Exhibit& exhibit, FieldReader& fields, ExhibitPiece& piece,
               std::vector<Problem>& problems);

// Returns the bounds of a scan where it stands, relative to the scene's origin.
Bounds bounds_of_scan(const Exhibit& exhibit, const ExhibitPiece& piece);
// Adds that mesh to the exhibit's scene, as part of the scan's object.
void add_stand_in(Exhibit& exhibit, const ExhibitPiece& piece, Mesh mesh);
// Puts all scans into the world, each with its first look.
void place_scans(const Exhibit& exhibit, World& world);
// Returns what is seen of a scan when its layer of that number is chosen.
ScanLook look_of(const Exhibit& exhibit, const ExhibitPiece& piece, int layer);

}  // namespace wellspring::show
