// SPDX-License-Identifier: Apache-2.0
// Makes detectors, and chooses the one that runs.
#pragma once
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/vec.h"
#include "kiosk/face/face_mesh.h"
#include "kiosk/frame/head.h"
#include "kiosk/network/face_marks.h"

namespace wellspring::kiosk {

// Finds faces in a picture, and is all that the rest of the kiosk sees of detection: trained
// networks find faces with their landmarks (face_network.cpp), cascades replace them if the
// networks' weights are not installed (face_cascade.cpp).

enum class FaceView : uint8_t {
  frontal,
  image_left,
  image_right
};  // a profile looks to that side of the image

struct Face {
  Box box;  // the frontal cascade's square, or a similar one about the landmarks
  FaceView view = FaceView::frontal;
  float confidence = 0;                     // clearness of the detector's answer, 0..1
  std::optional<std::array<vec2, 2>> eyes;  // pixels: the eye at image left, then at image right
  std::optional<FaceMarks> marks{};         // found by networks only
  std::optional<FaceMesh> mesh{};  // a large face that is followed has one; marks are its points
  // These concern the detector's looks at landmarks that are followed: its last score, how often it
  // agreed, when it was asked last and when it last agreed.
  float score = 0;
  int agreed = 0;
  double asked_time = -1e9, agreed_time = -1e9;
};

// Boxes of faces narrower than this, in pixels, have no mesh: it is unsure there.
inline constexpr float least_mesh_face = 40;

struct FaceSettings {
  std::string cascades = "/usr/share/opencv4";
  // Folder with the networks' weights; empty: WELLSPRING_WEIGHTS/face. Without weights, cascades
  // run.
  std::string weights;
  // Folder with graphs for faces that are followed; empty: `human` beside the weights. Without
  // them faces have no mesh.
  std::string graphs;
  int search_width = 320;     // cascades search whole frames at this width
  float smallest = 1 / 13.f;  // least box side over frame width for cascades
};

class FaceFinder {
 public:
  virtual ~FaceFinder() = default;
  // Finds faces of the whole frame, or of the part of it whose turn it is. Largest first, at most
  // 8.
  virtual std::vector<Face> search(const GrayFrame& frame) = 0;
  // Does the same within `zone`, slower and for smaller or less clear faces.
  virtual std::vector<Face> search_thoroughly(const GrayFrame& frame, const Box& zone) = 0;
  // Finds the face near `last` (one frame to half a second later). `roll` is how far the head was
  // tilted (positive: its top towards image left).
  virtual std::optional<Face> follow(const GrayFrame& frame, const Face& last, float roll = 0) = 0;
  // Returns whether faces come with landmarks, from which the head's pose follows.
  virtual bool finds_landmarks() const = 0;
  virtual bool reads_meshes() const { return false; }
};

// Returns the folder of the networks' weights; empty: it is set nowhere.
std::string weights_folder(const FaceSettings& settings);
std::string graphs_folder(const FaceSettings& settings);

// Makes a finder by networks if all their weights can be read, else by cascades. The log says
// which, and why. Throws LoadError when a cascade is missing too.
std::unique_ptr<FaceFinder> make_face_finder(const FaceSettings& settings);

// Makes one by networks, with meshes if it gets a reader of them. Throws LoadError naming the file
// with its fault.
std::unique_ptr<FaceFinder> make_network_finder(const std::string& folder,
                                                std::optional<MeshReader> meshes = {});
// Makes one by cascades. Throws LoadError naming the cascade's path and the package that brings it.
std::unique_ptr<FaceFinder> make_cascade_finder(const FaceSettings& settings = {});

}  // namespace wellspring::kiosk
