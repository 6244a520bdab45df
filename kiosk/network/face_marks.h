// SPDX-License-Identifier: Apache-2.0
// What the networks read off a face whose place is known: 68 landmarks, seven classes of
// expression.
#pragma once
#include <array>
#include <string>

#include "kiosk/network/gray_view.h"

namespace wellspring::kiosk {

// Pixels of the picture, in the order of 300-W (Sagonas et al. 2013), from image left to right:
// 0-16 outline of cheeks and chin, 17-21 and 22-26 brows, 27-30 bridge of the nose, 31-35 its lower
// edge, 36-41 and 42-47 eyes, 48-59 outer and 60-67 inner edge of the lips.
using FaceMarks = std::array<vec2, landmark_count>;

// The square that the networks know faces in: a fourth larger than what the landmarks span, its
// upper side along the line between the eyes.
Cut cut_of_marks(const FaceMarks& marks);

class MarkReader {
 public:
  explicit MarkReader(const std::string& folder);  // throws LoadError as load_face_landmarks does
  // About 5 ms. Not finite numbers only if the picture's are.
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

}  // namespace wellspring::kiosk
