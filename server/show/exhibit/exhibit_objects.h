// SPDX-License-Identifier: Apache-2.0
// The objects that a package names, out of its exhibit.json: see content/README.md.
#pragma once
#include <vector>

#include "show/exhibit/exhibit.h"
#include "show/exhibit/json_fields.h"

namespace wellspring::show {

// Fills exhibit.points. Call when the scene and the stories are there; without a scene no name is
// missed.
void read_objects(Exhibit& exhibit, FieldReader& root);

// Returns the bounds of objects, relative to the scene's origin; empty: low above high.
Bounds object_bounds(const Scene& scene, const std::vector<uint32_t>& objects);
// Reads what pages say of an object: `title` names the field of its title.
void read_label(const Exhibit& exhibit, FieldReader& fields, const char* title,
                PointOfInterest& point);

// The fifteen elements of the Dublin Core (ISO 15836-1), in the order in which they are shown.
inline constexpr const char* provenance_elements[] = {
    "title",    "creator",     "contributor", "date",     "type",
    "format",   "description", "subject",     "source",   "publisher",
    "language", "coverage",    "identifier",  "relation", "rights"};

// Things that storytellers can hold, out of exhibit.json and their glTF files: see
// content/README.md.

// Bounds of what a hand holds: triangles, texels of its pictures, metres from the hand, lights.
inline constexpr size_t most_prop_triangles = 20'000, most_prop_texels = size_t(1) << 22,
                        most_prop_lights = 4;
inline constexpr float farthest_prop = 1.5f;

// Fills exhibit.props. Called when the storytellers are there. A thing that is too large, or cannot
// be read or held, is a problem.
void read_props(Exhibit& exhibit, FieldReader& root, std::vector<Problem>& problems);

// Says where visitors' eyes are likely to be.

// The viewpoints, and places on the way between them, in scene coordinates.
std::vector<vec3> eye_places(const Exhibit& exhibit);
// These, and an even choice of where visitors may walk.
std::vector<vec3> all_eye_places(const Exhibit& exhibit);

// Which animations of its scene an exhibit plays, and what they move.

// `animations` of exhibit.json; after its objects.
void read_animations(Exhibit& exhibit, FieldReader& root);

// Takes what the exhibit's animations move out of its scene, and forgets all other animations.
void take_movers(Exhibit& exhibit);

}  // namespace wellspring::show
