// SPDX-License-Identifier: Apache-2.0
// The exhibit during a simulated visit: its storyteller moves by a clock of its own, its lamps can
// be switched, and rays tell exactly what a view shows.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "cache_visit_judge.h"
#include "cache_visit_trace.h"
#include "show/state/show.h"

namespace wellspring {

class VisitStage {
 public:
  // Loads the exhibit (throws ExhibitError); technique `gather`'s preparation takes seconds.
  VisitStage(const std::string& folder, const std::string& technique);

  const Exhibit& exhibit() const { return lit_->exhibit; }
  const ShowSettings& settings() const { return lit_->settings; }
  const Technique& moving_technique() const { return *lit_->technique; }
  const Technique& still_technique() const { return *lit_->still_technique; }

  // Back to the beginning of a visit: the storyteller as it first stands.
  void begin(const VisitTrace& trace);
  // The next frame, `dt` after the last. Times must be visited in order.
  void advance(const VisitTrace& trace, double time, float dt);

  const World& world() const { return *now_->world; }
  const Lights& lights() const { return now_->lights; }
  // maps() are those of `folder` from now on, baked for so long where it keeps none.
  void use_maps(const std::string& folder, double seconds);
  // Of the lights there are; null without use_maps().
  std::shared_ptr<const IlluminationMap> maps();
  bool switched() const { return switched_; }  // the lamps, in the last advance
  View view(const VisitTrace& trace, double time, int width, int height) const;

  void see(const View& view, TrueView& seen) const;
  // A place on a moving mesh in the frame before the last advance().
  vec3 moved_back(const Hit& hit) const;

 private:
  Show& dark();
  std::string folder_, technique_;
  std::unique_ptr<Show> lit_, dark_;
  std::string maps_folder_;
  double bake_seconds_ = 0;
  Show* now_ = nullptr;
  bool switched_ = false;
  std::shared_ptr<const IlluminationMap> lit_maps_, dark_maps_;
  StorytellerState mind_;  // at a visit's beginning
  Pose pose_;
  std::vector<std::vector<vec3>> before_;  // vertices of the moving meshes, a frame ago
};

}  // namespace wellspring
