// SPDX-License-Identifier: Apache-2.0
// Leads from the spaces of scanners to the frame of Volume::to_metres. A space is named by the
// letters to which its axes run: R and L, A and P, S and I are the patient's right and left, front
// (anterior) and back (posterior), top (superior) and bottom (inferior). NIfTI has RAS, DICOM LPS.
#pragma once
#include <glm/glm.hpp>
#include <string>

#include "base/layers.h"

namespace wellspring::volume {

// A file that states no orientation: x to the visitor's right, which is the patient's left, y to
// the back, z up, so that it stands upright and keeps its handedness.
inline constexpr const char* unstated_axes = "LPS";

// Says whether these are three letters, one of each pair.
bool are_axes(const std::string& axes);
// Leads from the space, in any unit, to the frame, in the same unit. `axes` must be axes.
glm::dmat4 to_patient_frame(const std::string& axes);

// Returns the letters to which the index axes run most.
std::string axes_of(const glm::dmat4& to_metres);
// Tells that in words: "x runs to the patient's left, ...", with the largest angle between an
// index axis and its letter if it is above a tenth of a degree, and whether the grid is
// left-handed.
std::string describe_axes(const glm::dmat4& to_metres);

}  // namespace wellspring::volume
