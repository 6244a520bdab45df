// SPDX-License-Identifier: Apache-2.0
// Drawing one picture for one visitor, in three steps: order_picture() decides what and how,
// draw_picture() does it without looking at anything that the tick may change (view -> project ->
// attend -> plan -> trace -> remember -> draw), finish_picture() takes it
// over. In the background the middle one runs on the easel (show/state/renderer.h), for a view predicted for
// when it will be seen; show/draw/present.h shows it. The time that is left of the visitor's share goes
// to samples; those of a walking visitor are traced when its picture is done, and land in the next.
#pragma once
#include "show/state/show.h"

namespace wellspring {

// Once a tick for every visitor, after it was moved: notices motion and leaps.
void watch(const Show& show, Visitor& visitor);
// Nothing moves for a moment, so that pictures become better instead of following.
bool stands(const Show& show, const Visitor& visitor);
// Nothing in the picture changes any more.
bool rests(const Show& show, const Visitor& visitor);

// Visitors who do not stand: the time is divided among them.
int count_moving(const Show& show);
// Pictures a second that should be drawn for this visitor.
double drawing_rate(const Show& show, const Visitor& visitor);
// One is due, and the visitor's browser and socket could take it.
bool wants_drawing(const Show& show, const Visitor& visitor);

// `busy` visitors share the time.
PictureOrder order_picture(const Show& show, const Visitor& visitor, int busy);
// The picture of this order would not be shown, since the visitor is somewhere else by now or has
// left; or one at rest would wait for samples of what is no longer so: its visitor moves on, lamps
// were switched, the storyteller came or went.
bool is_outdated(const Show& show, const PictureOrder& order, const Visitor& visitor);
// Changes nothing but what of the visitor is the easel's, and what techniques keep in show.lights.
// Ends early, with costs.given_up and all samples traced by then, once easel.given_up is set.
void draw_picture(Show& show, const PictureOrder& order, Visitor& visitor);
// The same step by step, between which the world may move and nothing but moving.h may be drawn.
// Returns the next one; DrawingStep::done: none.
bool in_steps(const PictureOrder& order);
// It may become a reconstruction (show/draw/still_pass.h).
bool may_reconstruct(const Show& show, const PictureOrder& order);
DrawingStep draw_step(Show& show, const PictureOrder& order, DrawingStep step, Visitor& visitor);
void finish_picture(Show& show, const PictureOrder& order, Visitor& visitor);
// Before that, where the order has something around: it is shown as soon as it is there.
void draw_surroundings(Show& show, const PictureOrder& order, Visitor& visitor);
void finish_surroundings(Show& show, const PictureOrder& order, Visitor& visitor);

// What pictures of walking visitors have asked for, in turn, in the time that was left for it: the
// answers are in the next ones. Likewise in three steps; the first says whether there is anything.
bool order_samples(Show& show);
void trace_samples(const Show& show, Easel& easel);
void finish_samples(Show& show);

}  // namespace wellspring
