// SPDX-License-Identifier: Apache-2.0
// Recognises the outline of a flat rectangle of known size, and its place in space (the paper's
// edge-model solver, for rectangles: a card, a tile, a face of a box). The four edges of a contour
// must agree with one pose of the rectangle.
#pragma once
#include "kiosk/station/sight.h"
#include "kiosk/station/traversal.h"

namespace wellspring::kiosk {

// Holds a pose in the camera's frame (kiosk/frame/head.h): x right, y down, z forward, metres.
struct SpacePose {
  vec3 position{0};  // the rectangle's centre
  mat3 rotation{1};  // its right, down and away to the camera's axes
  float error = 0;   // mean distance of the corners from where the pose has them, pixels
};
// Finds how a rectangle lies whose corners, clockwise from its upper left one, are seen there.
// `size`: width and height in metres. Nothing if no pose is possible.
std::optional<SpacePose> solve_rectangle(const std::array<vec2, 4>& corners, vec2 size, float focal,
                                         int width, int height);
// Finds quadrilaterals with straight edges, clockwise from the corner nearest to the upper left.
std::vector<std::array<vec2, 4>> find_quads(const GrayFrame& frame);

class OutlineSolver : public Solver {
 public:
  // Borrows both.
  OutlineSolver(const RecognitionTree& tree, Sight& sight) : tree_(tree), sight_(sight) {}
  Answer match(int node, int child, ContextStore& context) override;
  bool verifies() const override { return true; }
  bool verify(int node, ContextStore& context) override;
  std::vector<std::string> gives() const override;

 private:
  const std::vector<std::array<vec2, 4>>& quads();
  bool find(int node, const mat3* before, ContextStore& context);

  const RecognitionTree& tree_;
  Sight& sight_;
  uint64_t number_ = 0;  // Sight::number in which quads_ were found
  std::vector<std::array<vec2, 4>> quads_;
};

}  // namespace wellspring::kiosk
