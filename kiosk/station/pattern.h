// SPDX-License-Identifier: Apache-2.0
// Recognises flat patterns (the paper's pattern solver): features that agree with one homography,
// and parts of the picture that then look like the view. Groups that only divide are told by the
// number of features that are like those of their members.
#pragma once
#include "kiosk/station/sight.h"
#include "kiosk/station/traversal.h"

namespace wellspring::kiosk {

// Name values of the context store that solvers share.
inline constexpr const char* pose_value = "pose";      // matrix, sight.h
inline constexpr const char* view_value = "view";      // index of a view of the node; -1: a child's
inline constexpr const char* side_value = "side";      // name of the view's side
inline constexpr const char* scale_value = "scale";    // pixels of the picture a pixel of the view
inline constexpr const char* shared_value = "shared";  // "yes": all objects of the class have it
inline constexpr const char* turns_value = "turns";    // ways to turn an outline on itself; 2 or 4
inline constexpr const char* light_value = "light";    // mean brightness of the picture, 0..255

class PatternSolver : public Solver {
 public:
  // Borrows both.
  PatternSolver(const RecognitionTree& tree, Sight& sight);
  Answer match(int node, int child, ContextStore& context) override;
  bool verifies() const override { return true; }
  bool verify(int node, ContextStore& context) override;
  std::vector<std::string> gives() const override {
    return {pose_value, view_value, side_value, scale_value, shared_value};
  }
  // Returns the view that is seen, or null.
  const View* seen() const { return view_; }

 private:
  struct OwnedView {
    int node, index;
  };
  struct Pool {  // features of a group, and to which view each belongs
    std::vector<Feature> features;
    std::vector<int> owners;
    int views = 0;
  };
  Answer match_group(int child);
  Answer match_views(int child, ContextStore& context);
  void tell(int node, ContextStore& context, const mat3& pose);

  const RecognitionTree& tree_;
  Sight& sight_;
  std::vector<std::vector<OwnedView>> views_;  // at or below each node
  std::vector<Pool> pools_;                    // for each node that only divides
  const View* view_ = nullptr;
  OwnedView owner_{-1, -1};
};

// Says that a child matches likely: the searches behind it are asked one after the other.
class AlwaysSolver : public Solver {
 public:
  Answer match(int, int child, ContextStore&) override { return {Verdict::likely, -double(child)}; }
};

}  // namespace wellspring::kiosk
