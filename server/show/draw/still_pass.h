// SPDX-License-Identifier: Apache-2.0
// Reconstructs pictures at rest with a trained network (picture/still/reconstruct_still.h), of one
// visitor at a time, while nobody waits for a picture. A picture's order says that it is to become
// a reconstruction (PictureKind::reconstruction): it is drawn and its guides are found step by
// step, but it is not shown; then the network computes in slices, between which moving things may
// be drawn and the world may change; its result is shown instead. From then on the visitor's time
// goes to samples alone, and the next pass comes when there are so many more of them that it pays
// (show/draw/decide.h).
#pragma once
#include "show/state/renderer.h"
#include "show/state/show.h"

namespace wellspring::show {

// Begins `pass` with the job's picture, which is drawn. By the tick, while the renderer is idle.
void begin_pass(ShowDrawing& drawing, const PictureJob& job, Visitor& visitor);
// Computes one slice of the pass of that visitor, on the renderer.
void go_on_with_pass(ShowDrawing& drawing, const ExhibitStage& stage, Visitor& visitor);
// Takes over what is finished and drops what was given up. By the tick, when a slice is done.
void take_pass(Show& show);
// Notes that nobody needs the pass any more. By the tick.
void watch_pass(Show& show);

// Draws the moving things in pictures at rest by themselves (picture/keyframe.h), several
// times as often as the rest, and between the steps of the rest's drawing. It takes three steps, as
// in show/draw/picture.h.

// Returns whether a layer of this size may be laid over a picture; it is kept for each visitor, so
// it may be a third of the picture.
bool may_be_laid_over(const PictureWindow& window, const View& view);

// These find the light on moving things (light/kept/skin/skin_light.h), which all visitors share.
// First by the tick, while the renderer is idle and the world is in that visitor's state, then on
// the renderer, as the world is then, then by the tick.
void begin_skin_light(Show& show, const Visitor& visitor);
void compute_skin_light(ExhibitStage& stage, ShowDrawing& drawing);
void finish_skin_light(ShowDrawing& drawing, ShowTotals& totals);
// Draws the moving things. Reads the visitor's keyframe, which may not change meanwhile.
void draw_moving(ShowDrawing& drawing, ExhibitStage& stage, Visitor& visitor);
void finish_moving(ShowDrawing& drawing, ShowTotals& totals, Visitor& visitor);

// Notes, when a picture was drawn, whether moving things are in it or are to be laid over it.
void finish_backdrop(VisitorPicture& picture);
// Puts what was last laid over the keyframe into it, for warps from now on.
void merge_moving(VisitorPicture& picture);

}  // namespace wellspring::show
