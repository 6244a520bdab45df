// SPDX-License-Identifier: Apache-2.0
// Reads a face whose place is known, by networks: 68 landmarks, seven classes of expression.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/vec.h"
#include "kiosk/network/network.h"

namespace wellspring::kiosk {

// Holds a borrowed picture of grey levels, and cuts squares out of it for a network.

struct GrayView {
  const uint8_t* pixels = nullptr;  // row by row, top row first
  int width = 0, height = 0;
};

// This is a rectangle of the picture, turned about its middle: a positive angle (radians) turns its
// upper side towards image left, as a head with that roll.
struct Cut {
  vec2 middle{0};  // pixels of the picture
  float width = 0, height = 0, angle = 0;
};

// Returns the cut at `columns` by `rows` pixels, alike in all three colours; smoothed before it
// gets smaller. Beyond the picture its rim goes on.
NetworkInput cut_out(const GrayView& picture, const Cut& cut, int columns, int rows);

// Holds a borrowed picture of the same view in colour, which may be smaller: rows of blue, green
// and red bytes. Without pixels there is no colour.
struct TintView {
  const uint8_t* bgr = nullptr;
  int width = 0, height = 0;
};

// Does the same with the colours of `tint`: levels are those of the picture, so that it is as
// sharp.
NetworkInput cut_out(const GrayView& picture, const TintView& tint, const Cut& cut, int columns,
                     int rows);

// Returns a point of the cut (shares 0..1 from its upper left) in pixels of the picture.
vec2 cut_to_picture(const Cut& cut, vec2 share);

// Holds pixels of the picture, in the order of 300-W (Sagonas et al. 2013), from image left to
// right: 0-16 outline of cheeks and chin, 17-21 and 22-26 brows, 27-30 bridge of the nose, 31-35
// its lower edge, 36-41 and 42-47 eyes, 48-59 outer and 60-67 inner edge of the lips.
using FaceMarks = std::array<vec2, landmark_count>;

// Returns the square that the networks know faces in: a fourth larger than what the landmarks span,
// its upper side along the line between the eyes.
Cut cut_of_marks(const FaceMarks& marks);

class MarkReader {
 public:
  explicit MarkReader(const std::string& folder);  // throws LoadError as load_face_landmarks does
  // Reads landmarks in about 5 ms. They are finite if the numbers of `square` are.
  FaceMarks read(const GrayView& picture, const Cut& square);

 private:
  Network network_;
};

enum class FaceClass : uint8_t { neutral, happy, sad, angry, fearful, disgusted, surprised };
using FaceClasses = std::array<float, 7>;  // by FaceClass; they add up to 1

class ClassReader {
 public:
  explicit ClassReader(const std::string& folder);  // throws LoadError as load_face_expression does
  FaceClasses read(const GrayView& picture, const Cut& square);  // about 5 ms

 private:
  Network network_;
};

// Finds faces in a part of a picture, by the face detector of network.h: boxes from its cells
// (Redmon, Farhadi 2017, section 2), and among overlapping ones the surest (non-maximum
// suppression).

struct FaceBox {
  vec2 middle{0};               // pixels of the picture
  float width = 0, height = 0;  // about a fourth larger than what the 68 landmarks span
  float score = 0;              // 0..1
};

// Faces narrower than this in the network's picture are missed (brow to brow; measured).
inline constexpr float least_face = 40;

class FaceBoxes {
 public:
  explicit FaceBoxes(const std::string& folder);  // throws LoadError as load_face_detector does
  // Returns boxes, the surest first, none below `least_score`. The cut is upright and seen at
  // columns x rows pixels, multiples of 32: 2.5 ms for 128x128, 12 ms for 320x256.
  std::vector<FaceBox> find(const GrayView& picture, const Cut& cut, int columns, int rows,
                            float least_score);

 private:
  Network network_;
};

}  // namespace wellspring::kiosk
