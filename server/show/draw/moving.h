// SPDX-License-Identifier: Apache-2.0
// Of pictures at rest what moves is drawn by itself (picture/moving_picture.h), several times as
// often as the rest, and between that one's steps. In three steps as in show/draw/picture.h.
#pragma once
#include "show/state/show.h"

namespace wellspring::show {

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
