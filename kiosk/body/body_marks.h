// SPDX-License-Identifier: Apache-2.0
// Reads 17 points of people's bodies in a part of a picture, by the graph movenet-lightning of
// @vladmandic/human: MoveNet (Votel, Li, "Next-Generation Pose Detection with MoveNet and
// TensorFlow.js", 2021), a centre net (Zhou, Wang, Krähenbühl 2019) over four maps.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "base/vec.h"
#include "kiosk/network/face_marks.h"
#include "kiosk/network/graph/graph_network.h"

namespace wellspring::kiosk {

// Names the points in the order of COCO (Lin et al. 2014). Sides are the person's own.
enum class BodyPoint : uint8_t {
  nose,
  left_eye,
  right_eye,
  left_ear,
  right_ear,
  left_shoulder,
  right_shoulder,
  left_elbow,
  right_elbow,
  left_wrist,
  right_wrist,
  left_hip,
  right_hip,
  left_knee,
  right_knee,
  left_ankle,
  right_ankle,
};
inline constexpr size_t body_points = 17;

struct BodyMark {
  vec2 pixel{0};    // place in the picture
  float score = 0;  // how sure it is that the point is seen there, 0..1
};

struct BodyMarks {
  std::array<BodyMark, body_points> points;
  float score = 0;  // how sure it is that a body is there, 0..1
  const BodyMark& at(BodyPoint point) const { return points[size_t(point)]; }
  BodyMark& at(BodyPoint point) { return points[size_t(point)]; }
};

// Points of less than this score are taken for unseen.
inline constexpr float least_point_score = 0.3f;

class BodyReader {
 public:
  // `folder` has movenet-lightning (WELLSPRING_WEIGHTS/human). Throws LoadError as open_graph does,
  // and if a map has another shape than the published network's.
  explicit BodyReader(const std::string& folder);
  // Reads the bodies whose centres stand out in the cut, at most `most`, in about 10 ms. The first
  // is the one that the network's own decoding returns: the surest near the middle of the cut.
  std::vector<BodyMarks> read(const GrayView& picture, const TintView& tint, const Cut& square,
                              size_t most = 1);

 private:
  GraphNetwork network_;
};

// Returns the square in which the network knows such a body best, by the published rule: round the
// middle of the hips, as large as torso or all points need; without hips round what is seen.
Cut body_cut(const BodyMarks& marks);
// Returns the box round the points that are seen; empty if fewer than two are.
struct BodyBox {
  vec2 low{0}, high{0};  // pixels
};
BodyBox body_box(const BodyMarks& marks);

}  // namespace wellspring::kiosk
