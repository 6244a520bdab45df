// SPDX-License-Identifier: Apache-2.0
// Learned reconstruction of pictures at rest (picture/still/reconstruct_still.h), of one visitor at
// a time, while nobody waits for a picture. A picture's order says that it is to become one
// (PictureJob::reconstruct): it is drawn and its guides are found step by step, but it is not
// shown; then the network computes in slices, between which what moves may be drawn and the world
// may change; what it has found is shown instead. From then on the visitor's time goes to samples
// alone, and the next pass comes when there are so many more of them that it pays
// (show/draw/decide.h).
#pragma once
#include "show/state/show.h"

namespace wellspring::show {

// By the tick, while the renderer is idle: the job's picture is drawn, and `pass` begins with it.
void begin_pass(Show& show, const PictureJob& job, Visitor& visitor);
// On the renderer: one slice.
void go_on_with_pass(Show& show);
// By the tick, when a slice is done: takes over what is finished, lets go what was given up.
void take_pass(Show& show);
// By the tick: notes that nobody needs it any more.
void watch_pass(Show& show);

// Of pictures at rest what moves is drawn by itself (picture/keyframe.h), several times as
// often as the rest, and between that one's steps. In three steps as in show/draw/picture.h.

// What is laid over a picture is kept of each visitor: it may be a third of it.
bool may_be_laid_over(const PictureWindow& window, const View& view);

// Light on what moves (light/known/skin_light.h), that all visitors share. By the tick, while the
// renderer is idle and the world is in that visitor's state, then on the renderer, as the world is
// then, then by the tick.
void begin_skin_light(Show& show, const Visitor& visitor);
void compute_skin_light(Show& show);
void finish_skin_light(Show& show);
// Reads the visitor's keyframe, which may not change meanwhile.
void draw_moving(Show& show, Visitor& visitor);
void finish_moving(Show& show, Visitor& visitor);

// A picture was drawn: what moves is in it, or is to be laid over it.
void finish_backdrop(VisitorPicture& picture);
// For warps, the keyframe shows what was last laid over it from now on.
void merge_moving(VisitorPicture& picture);

}  // namespace wellspring::show
