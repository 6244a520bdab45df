// SPDX-License-Identifier: Apache-2.0
// Finds objects that are nearly equal, and the marks in which they differ.
#pragma once
#include <optional>
#include <vector>

#include "kiosk/station/learn_view.h"
#include "kiosk/station/sight.h"
#include "kiosk/station/twins.h"

namespace wellspring::kiosk {

// Returns what takes places of view `a` to those of `b`, if both show nearly the same; else
// nothing.
std::optional<mat3> align_views(const View& a, const View& b);

// Is a side that all objects of a class have: one object's view, and everybody's photograph as if
// it were that view.
struct SharedSide {
  View view;
  std::vector<std::vector<uint8_t>> pictures;  // by object: blue, green, red
};
// Takes a photograph of a view that `pose` takes the other view's places to.
std::vector<uint8_t> align_photo(const Photo& photo, const View& own, const mat3& pose,
                                 const View& to);

struct ClassMarks {
  MarkKind kind = MarkKind::edges;
  std::vector<std::vector<Mark>> marks;  // by object
  std::vector<float> apart;              // [a * objects + b]: how well the two can be told apart
};
// Chooses places where any two of the objects differ most.
ClassMarks choose_marks(const std::vector<SharedSide>& sides, size_t objects);
Mark cut_mark(const std::vector<uint8_t>& bgr, const View& view, int index, int x, int y, int width,
              int height);

}  // namespace wellspring::kiosk
