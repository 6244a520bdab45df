// SPDX-License-Identifier: Apache-2.0
// Measures eyes and mouth of a mesh: how far away the face is, by its irises, which are 11.7 mm
// wide in children and adults alike (Hashemi et al., "White-to-white corneal diameter", 2010: 11.4
// to 12.0); where it looks; how far lids and lips are open.
#pragma once
#include <optional>

#include "kiosk/face/face_mesh.h"
#include "kiosk/face/head_pose.h"

namespace wellspring::kiosk {

inline constexpr float iris_metres = 0.0117f;

// Returns the width of the irises in pixels, mean of both eyes; each the longer of its axes, as a
// turned one is foreshortened. Nothing without irises.
std::optional<float> iris_width(const FaceMesh& mesh);

// Returns how far lids (mean of both eyes) and lips are open, 0 closed to 1; nothing without
// irises.
std::optional<float> open_lids(const FaceMesh& mesh);
float open_mouth(const FaceMesh& mesh);

// Returns the direction in which the eyes look, in camera axes, 1 long: from the middle of each
// eyeball, which lies behind its corners in the face's model, to where the ray through the iris
// meets it. `pose` is that of the same picture, `focal` in pixels. Nothing without irises.
std::optional<vec3> look_direction(const FaceMesh& mesh, const HeadPose& pose, float focal,
                                   int width, int height);

// Learns how large a face is against an adult's, from irises of faces that look about into the
// lens.
struct FaceSize {
  double looks = 0, sum = 0;  // weights, and logarithms times weights
};
// Takes a look: `iris` in pixels, `pose` as an adult's face would have it. Irises below 6 pixels
// and faces turned by more than 20 degrees tell nothing.
void add_look(FaceSize& size, float iris, float focal, const HeadPose& pose);
// Returns the factor by which the face, and with it its distance, differs from an adult's. Most
// faces are adults' (their logarithms spread by 0.045), one in five a child's (about 0.84, by 0.08;
// after Farkas 1994): what irises say is weighed against both, so that their error does not move
// adults.
float size_of(const FaceSize& size);

}  // namespace wellspring::kiosk
