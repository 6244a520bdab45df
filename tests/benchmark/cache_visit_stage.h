// SPDX-License-Identifier: Apache-2.0
// The exhibit during a simulated visit: its storyteller moves by a clock of its own, its lamps, all
// but daylight, can be switched, and rays tell exactly what a view shows.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cache_visit_judge.h"
#include "cache_visit_trace.h"
#include "show/state/show.h"

namespace wellspring::test {

class VisitStage {
 public:
  // Loads the exhibit (throws ExhibitError); technique `gather`'s preparation takes seconds.
  VisitStage(const std::string& folder, const std::string& technique);

  const Exhibit& exhibit() const { return show_->stage.exhibit; }
  const ShowSettings& settings() const { return show_->settings; }
  const Technique& moving_technique() const { return *show_->stage.technique; }
  const Technique& still_technique() const { return *show_->stage.still_technique; }

  // Back to the beginning of a visit: the storyteller as it first stands.
  void begin(const VisitTrace& trace);
  // The next frame, `dt` after the last. Times must be visited in order.
  void advance(const VisitTrace& trace, double time, float dt);

  const World& world() const { return *show_->stage.world; }
  const Lights& lights() const { return show_->stage.lights; }
  // The change of light where lamps were switched in the last advance; null: they were not.
  const LightChange* change() const { return change_ ? &*change_ : nullptr; }
  View view(const VisitTrace& trace, double time, int width, int height) const;

  void see(const View& view, TrueView& seen) const;
  // A place on a moving mesh in the frame before the last advance().
  vec3 moved_back(const Hit& hit) const;

 private:
  void light(bool on);
  std::unique_ptr<Show> show_;
  LampLevels lit_, dark_;
  std::optional<LightChange> change_;
  StorytellerState mind_;  // at a visit's beginning
  Pose pose_;
  std::vector<std::vector<vec3>> before_;  // vertices of the moving meshes, a frame ago
};

}  // namespace wellspring::test
