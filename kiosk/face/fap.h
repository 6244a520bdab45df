// SPDX-License-Identifier: Apache-2.0
// Movements of a face in MPEG-4's terms (ISO/IEC 14496-2, annex C): landmarks are its feature
// points, what moves is a facial animation parameter (FAP), measured in units of the face's own
// distances (FAPU), so that they mean the same on any face.
#pragma once
#include <array>
#include <optional>

#include "kiosk/face/head_pose.h"

namespace wellspring::kiosk {

// Landmarks in the plane of the face, metres: x to the picture's right when the face looks into the
// lens, y down; each on its depth in the model, with the head's pose taken out.
using FacePlane = std::array<vec2, landmark_count>;
FacePlane face_plane(const FaceMarks& marks, const HeadPose& pose, float focal, int width,
                     int height);

// FAPs by their number in the standard (1 to 68); those that landmarks do not tell stay 0.
//   3 open jaw; 4, 5 inner lips up and down; 6, 7 stretch and 12, 13 raise their corners;
//   19-22 close the lids; 31-36 raise the brows; 37, 38 squeeze them; 53, 54 stretch and 59, 60
//   raise the outer corners of the lips
using Faps = std::array<float, 69>;

// FAPs of `now` against the same face at rest; 0 where nothing moves. What the whole face does is
// taken out by its eyes' corners and its nose. Nothing where `rest` is no face or a number is not
// finite.
std::optional<Faps> measure_faps(const FacePlane& rest, const FacePlane& now);

}  // namespace wellspring::kiosk
