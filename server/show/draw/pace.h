// SPDX-License-Identifier: Apache-2.0
// Finds how often each visitor is shown a picture, drawn one, and drawn its moving things; and the
// values from which it is decided what is drawn next (show/draw/decide.h). Nothing here changes the
// show but watch().
#pragma once
#include <vector>

#include "show/draw/decide.h"
#include "show/state/show.h"

namespace wellspring::show {

// Paces the search for light on moving things (light/kept/skin/skin_light.h): few samples if they
// are small in all pictures, and none if nobody sees them.

inline constexpr double least_interval = 0.2;  // seconds; skin light is found no more often

// Says how often and with how many samples light on moving things is found.
struct SkinPace {
  int samples = 0;      // number each time; 0: nothing is traced, and nothing smoothed
  double interval = 0;  // seconds from one time to the next
  bool operator==(const SkinPace&) const = default;
};
// Plans the pace. `pixels`: those of the visitor who sees most of it. `known`: samples that a place
// has already, on average.
SkinPace plan_skin(float pixels, double samples_per_second, float known);

inline constexpr double still_after = 0.25;  // seconds without motion until a picture is a still

// Notices motion and camera cuts. Call it once a tick for every visitor, after the visitor was
// moved.
void watch(const Show& show, Visitor& visitor);
// Returns whether nothing has moved for a moment, so that pictures become better instead of
// following.
bool stands(double time, const Visitor& visitor);
// Returns whether nothing in the picture changes any more.
bool rests(const Show& show, const Visitor& visitor);
// Returns whether more samples would make the still part of the picture better.
bool asks_for_samples(const Show& show, const Visitor& visitor);
// Returns the number of visitors who do not stand: the time is divided among them.
int count_moving(const ShowVisits& visits, double time);
// Returns how much a second of the renderer's time counts in VisitorPicture::served: more for
// visitors who stand; for walkers, so much that all get as many keyframes, whatever theirs cost.
double charge_weight(const ShowVisits& visits, double time, const Visitor& visitor);
// Returns whether the visitor's browser and socket can take a picture.
bool may_take(double time, const Visitor& visitor);

// Returns the pictures a second that this visitor should get.
double picture_rate(const Show& show, const Visitor& visitor);
// Returns the pictures a second that should be drawn for this visitor.
double drawing_rate(const Show& show, const Visitor& visitor);
// Returns the share of the time that goes to moving things in pictures at rest, of all visitors.
double moving_share(const Show& show);
// Returns the seconds until moving things will be due for anybody, at most one.
double seconds_to_moving(const Show& show);

// Return what drawing for this visitor has cost of late, and the keyframe that this allows.
DrawingCosts drawing_costs(const ShowVisits& visits, const ShowDrawing& drawing,
                           const Visitor& visitor);
KeyframePlan plan_next_keyframe(const ShowVisits& visits, const ShowDrawing& drawing, double time,
                                const Visitor& visitor);

// Return the values for the decision: of all visitors in their order, and of the renderer. The
// caller fills `waiting`.
std::vector<VisitorDrawState> draw_states(const Show& show);
RendererState renderer_state(const Show& show);

}  // namespace wellspring::show
