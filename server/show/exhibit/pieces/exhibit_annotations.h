// SPDX-License-Identifier: Apache-2.0
// Reads what others have noted on a picture or in a scan: an AnnotationPage of the W3C Web
// Annotation Data Model (as IIIF Presentation 3 has them), whose items say where they are.
#pragma once
#include "show/exhibit/exhibit.h"
#include "show/exhibit/json_fields.h"

namespace wellspring::show {

inline constexpr size_t most_annotations = 200;

// Adds a point of interest for each annotation of the file; they share the objects of `whole`, the
// piece's own. A target is the picture's address with a fragment `xywh=`, in texels of the first
// layer or in percent, or it has a FragmentSelector or a PointSelector. In a scan it is a
// PointSelector with x, y and z (as in the draft of IIIF Presentation 4), in the coordinates of the
// scan's file (file_to_world()). An annotation that cannot be used is a problem with file and
// place.
void read_annotations(Exhibit& exhibit, const ExhibitPiece& piece, const std::string& file,
                      const PointOfInterest& whole, std::vector<Problem>& problems);

}  // namespace wellspring::show
