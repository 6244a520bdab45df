// SPDX-License-Identifier: Apache-2.0
// Reads the pieces of exhibit.json that are scanned places and things: points and splats.
#pragma once
#include <vector>

#include "show/exhibit/exhibit.h"
#include "show/exhibit/json_fields.h"
#include "show/exhibit/pieces/piece_choice.h"
#include "world/placed_scan.h"
#include "world/world.h"

namespace wellspring::show {

// Reads `colors` of a look.
void read_scan_colors(FieldReader& fields, PieceLayer& layer);

// Reads `source` or `times`, and what says how they look and lie: piece.sets or piece.splats, and a
// layer for each look or time. Returns the mesh that rays meet in place of the scan, of the first
// time if there are several. A scan that cannot be read is a problem. `cache`: as for
// read_exhibit().
Mesh read_scan(const Exhibit& exhibit, FieldReader& fields, const std::string& cache,
               ExhibitPiece& piece, std::vector<Problem>& problems);

// Returns the bounds of a scan where it stands, relative to the scene's origin.
Bounds bounds_of_scan(const Exhibit& exhibit, const ExhibitPiece& piece);
// Adds that mesh to the exhibit's scene, as part of the scan's object.
void add_stand_in(Exhibit& exhibit, const ExhibitPiece& piece, Mesh mesh);
// Puts all scans into the world, each with its first look.
void place_scans(const Exhibit& exhibit, World& world);
// Returns what is seen of a scan when that is chosen.
ScanLook look_of(const Exhibit& exhibit, const ExhibitPiece& piece, const PieceChoice& choice);
// Returns a scan's width, height and depth where it stands, metres.
vec3 scan_size(const ExhibitPiece& piece);
// Leads from the coordinates of a scan's file, those of a survey perhaps, to the world. A tree of
// points has them as surveys do: east, north, height.
glm::dmat4 file_to_world(const ExhibitPiece& piece);
// Cuts away all of a scan that is nearer than `depth` metres along the ray (scene coordinates) of
// an eye, counted from where the scan begins if the eye is outside.
void cut_scan_ahead(const Exhibit& exhibit, const ExhibitPiece& piece, const Ray& ray, float depth,
                    PieceChoice& choice);

}  // namespace wellspring::show
