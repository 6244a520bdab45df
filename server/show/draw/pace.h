// SPDX-License-Identifier: Apache-2.0
// How often each visitor is shown a picture, drawn one, and drawn what moves in it; and the values
// that the decision what is drawn next (show/draw/decide.h) is made from. Nothing here changes the
// show but watch().
#pragma once
#include <vector>

#include "show/draw/decide.h"
#include "show/state/show.h"

namespace wellspring::show {

// Light on what moves (light/known/skin_light.h) gets few samples where it is small in all
// pictures, and none where nobody sees it.

inline constexpr double least_interval = 0.2;  // seconds: it is found no more often

// How often and by how much light on what moves is found.
struct SkinPace {
  int samples = 0;      // each time; 0: nothing is traced, and nothing smoothed
  double interval = 0;  // seconds from one time to the next
  bool operator==(const SkinPace&) const = default;
};
// `pixels`: of whoever sees most of it. `known`: samples that a place has already, on average.
SkinPace plan_skin(float pixels, double samples_per_second, float known);

inline constexpr double still_after = 0.25;  // seconds without motion until a picture is a still

// Once a tick for every visitor, after it was moved: notices motion and camera cuts.
void watch(const Show& show, Visitor& visitor);
// Nothing moves for a moment, so that pictures become better instead of following.
bool stands(const Show& show, const Visitor& visitor);
// Nothing in the picture changes any more.
bool rests(const Show& show, const Visitor& visitor);
// More samples would make the picture of what stands still better.
bool asks_for_samples(const Show& show, const Visitor& visitor);
// Visitors who do not stand: the time is divided among them.
int count_moving(const Show& show);
// Returns how much a second of the renderer's time counts in VisitorPicture::served: more for who
// stands; for who walks, so much that all get as many keyframes, whatever theirs cost.
double charge_weight(const Show& show, const Visitor& visitor);
// The visitor's browser and socket can take a picture.
bool may_take(const Show& show, const Visitor& visitor);

// Pictures a second this visitor should get.
double picture_rate(const Show& show, const Visitor& visitor);
// Pictures a second that should be drawn for this visitor.
double drawing_rate(const Show& show, const Visitor& visitor);
// The share of the time that goes to what moves in pictures at rest, of all visitors.
double moving_share(const Show& show);
// Until it will be due for anybody, at most a second.
double seconds_to_moving(const Show& show);

// What drawing for this visitor took of late, and the keyframe that this allows.
DrawingCosts drawing_costs(const Show& show, const Visitor& visitor);
KeyframePlan plan_next_keyframe(const Show& show, const Visitor& visitor);

// For the decision: of one visitor, of all in their order, and of the renderer. `waiting` is the
// caller's to fill.
VisitorDrawState draw_state(const Show& show, const Visitor& visitor);
std::vector<VisitorDrawState> draw_states(const Show& show);
RendererState renderer_state(const Show& show);

}  // namespace wellspring::show
