// SPDX-License-Identifier: Apache-2.0
// Reads a face whose place is known, finely: 468 points of its surface and five of each iris, by
// the graphs facemesh and iris of @vladmandic/human. They learnt from colours; here they get levels
// of grey.
#pragma once
#include <array>
#include <optional>
#include <string>

#include "base/vec.h"
#include "kiosk/network/face_marks.h"
#include "kiosk/network/graph/graph_network.h"

namespace wellspring::kiosk {

inline constexpr size_t mesh_points = 468, iris_points = 5;

struct FaceMesh {
  // Pixels of the picture in the order of MediaPipe's face mesh; z in pixels, too, less towards
  // the camera.
  std::array<vec3, mesh_points> points{};
  // Pixels: the middle of the iris, then its rim at image right, above, image left and below. The
  // eye at image left, then at image right; nothing if there is no face.
  std::optional<std::array<std::array<vec2, iris_points>, 2>> irises;
  std::array<float, 2> lids{};  // height of the opening of each eye over its width, with irises
  float confidence = 0;         // whether there is a face, 0..1
};

// Returns the square in which the mesh of a face is read, from its 68 landmarks or from the mesh
// of the picture before.
Cut mesh_cut_of_marks(const FaceMarks& marks);
Cut mesh_cut_of_mesh(const FaceMesh& mesh);

// Returns the points of the mesh that stand for the 68 landmarks.
FaceMarks marks_of_mesh(const FaceMesh& mesh);

// `folder` has facemesh and iris (WELLSPRING_WEIGHTS/human). Readers throw LoadError as open_graph
// does.
class MeshReader {
 public:
  explicit MeshReader(const std::string& folder);
  FaceMesh read(const GrayView& picture, const Cut& square);  // in about 5 ms, without irises

 private:
  GraphNetwork network_;
};

class IrisReader {
 public:
  explicit IrisReader(const std::string& folder);
  // Adds irises and lids to the mesh of this picture, in about 5 ms an eye.
  void read(const GrayView& picture, FaceMesh& mesh);

 private:
  void read_eye(const GrayView& picture, float angle, size_t eye, FaceMesh& mesh);

  GraphNetwork network_;
};

}  // namespace wellspring::kiosk
