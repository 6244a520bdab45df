// SPDX-License-Identifier: Apache-2.0
// Recognises boxes without texture by their edges (the paper's edge-model solver, section 4.5):
// three straight edges that meet in the picture may be a corner of the box. Since a box's edges are
// square to one another, the corner's attitude follows in closed form, as Dhome's does for a
// three-line junction; edges of known length say which way round the box is and how far away. Each
// hypothesis is refined so that all edges that can be seen lie on edges of the picture (Lowe), and
// stands if nearly all do.
#pragma once
#include <memory>

#include "kiosk/station/outline.h"
#include "kiosk/station/sight.h"
#include "kiosk/station/traversal.h"

namespace wellspring::kiosk {

// Is a place in the picture from which three straight edges go; pixels.
struct Junction {
  vec2 at{0};
  std::array<vec2, 3> ends{};
};
// Finds junctions, at most 300. About 10 ms for 640x480.
std::vector<Junction> find_junctions(const GrayFrame& frame);

// How a box of that size (width, height, depth in metres) may lie whose corner that is: its middle,
// its right, down and away; error: share of the edges' lengths that do not fit.
std::vector<SpacePose> solve_corner(const Junction& corner, vec3 size, float focal, int width,
                                    int height);

class BoxSolver : public Solver {
 public:
  // Borrows both.
  BoxSolver(const RecognitionTree& tree, Sight& sight) : tree_(tree), sight_(sight) {}
  Answer match(int node, int child, ContextStore& context) override;
  bool verifies() const override { return true; }
  bool verify(int node, ContextStore& context) override;
  std::vector<std::string> gives() const override;
  // Returns where the box is, if it was found last.
  const std::optional<SpacePose>& pose() const { return pose_; }

 private:
  struct EdgePicture;
  const EdgePicture& edges();
  float refine(SpacePose& pose, vec3 size, int steps);
  void tell(int node, ContextStore& context);

  const RecognitionTree& tree_;
  Sight& sight_;
  uint64_t number_ = 0;  // Sight::number of what follows
  std::shared_ptr<EdgePicture> edges_;
  std::vector<Junction> junctions_;
  std::optional<SpacePose> pose_;
};

}  // namespace wellspring::kiosk
