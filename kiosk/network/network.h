// SPDX-License-Identifier: Apache-2.0
// Runs three networks of @vladmandic/face-api 1.7.15, layer by layer in OpenCV's module dnn. They
// compute what the package computes, within 1e-3 (tests/unit/kiosk/network).
//   face detector    a convolution and five depthwise separable ones (Howard et al. 2017), each
//                    halved by max pooling but the last; boxes as YOLO 9000 (Redmon, Farhadi 2017)
//   landmarks,       four blocks of convolutions whose sums go on (after DenseNet, Huang et al.
//   expression       2017), the mean over the picture, and one full layer
#pragma once
#include <memory>
#include <string>
#include <vector>

namespace wellspring::kiosk {

// Holds planes of red, green and blue, each row by row from the top; levels 0 to 255.
struct NetworkInput {
  int width = 0, height = 0;
  std::vector<float> planes;
};

class Network {
 public:
  Network(Network&&) noexcept;
  ~Network();
  // Runs the network. `input` has the size that the network asks for (below), or
  // std::invalid_argument is thrown. The first run at a size is slower. One thread at a time.
  std::vector<float> run(const NetworkInput& input);

  struct Impl;
  explicit Network(std::unique_ptr<Impl> impl);

 private:
  std::unique_ptr<Impl> impl_;
};

// Each reads its own files in `folder` and throws LoadError naming the file and the tensor when one
// is missing, damaged or of another shape, or when a tensor is left over.

inline constexpr int detector_cell = 32, detector_anchors = 5;
// Loads the detector. Sides: multiples of 32. Output: 25 planes of height/32 rows and width/32
// columns; those of anchor a begin at 5a: x, y, logarithms of width and height, score, all before
// the sigmoid (face_marks.h).
Network load_face_detector(const std::string& folder);

inline constexpr int marks_side = 112, landmark_count = 68;
// Loads the landmark network, 112x112. Output: x and y of 68 points in shares of the picture, in
// the order of 300-W (Sagonas et al. 2013).
Network load_face_landmarks(const std::string& folder);
// Loads the expression network, 112x112. Output: probabilities of neutral, happy, sad, angry,
// fearful, disgusted, surprised.
Network load_face_expression(const std::string& folder);

}  // namespace wellspring::kiosk
