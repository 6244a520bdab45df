// SPDX-License-Identifier: Apache-2.0
// Reads a face whose place is known, finely: 468 points of its surface and five of each iris, by
// the graphs facemesh and iris of @vladmandic/human; and whether it is a living face or a picture
// of one, by antispoof and liveness. All of them learnt from colours; here they get levels of grey.
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
  float confidence = 0;  // whether there is a face, 0..1
};

// Returns the square in which the mesh of a face is read, from its 68 landmarks or from the mesh
// of the picture before.
Cut mesh_cut_of_marks(const FaceMarks& marks);
Cut mesh_cut_of_mesh(const FaceMesh& mesh);

class MeshReader {
 public:
  // `folder` has facemesh and iris (WELLSPRING_WEIGHTS/human). Throws LoadError as open_graph does.
  explicit MeshReader(const std::string& folder);
  // Reads the mesh in about 5 ms, and irises in twice that.
  FaceMesh read(const GrayView& picture, const Cut& square);

 private:
  std::array<vec2, iris_points> read_iris(const GrayView& picture, const Cut& eye, bool mirrored);

  GraphNetwork mesh_, iris_;
};

class LivenessReader {
 public:
  // `folder` has antispoof and liveness. Throws LoadError as open_graph does.
  explicit LivenessReader(const std::string& folder);
  // Returns how sure it is that a living face is seen, 0..1: the mean of what both graphs say. The
  // square is that of a mesh. It takes about 7 ms. Recorded faces get 0.6 to 0.8; how little
  // pictures of faces get has not been measured.
  float read(const GrayView& picture, const Cut& square);

 private:
  GraphNetwork real_, alive_;
};

}  // namespace wellspring::kiosk
