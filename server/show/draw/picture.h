// SPDX-License-Identifier: Apache-2.0
// Draws one picture for one visitor, in three steps: make_picture_job()
// (show/draw/make_picture_job.h) decides what and how, draw_step() does it without looking at
// anything that the tick may change (view -> project -> attend -> plan -> trace -> remember ->
// draw), finish_picture() takes it over. The middle runs on the renderer (show/state/renderer.h),
// for a view predicted for when it will be seen; show/draw/present.h shows
// it. The time that is left of the visitor's share goes to samples; those of a walking visitor are
// traced when its picture is done, and land in the next (show/draw/late_samples.h).
#pragma once
#include "show/state/renderer.h"
#include "show/state/show.h"

namespace wellspring::show {

// Does one step of drawing; between the steps of a picture at rest the world may move, and nothing
// but still_pass.h may draw. Changes nothing but the renderer's part of the visitor, and what
// techniques keep in show.stage.lights. Returns the next step; DrawingStep::done: none. Ends early,
// with costs.given_up and all samples traced by then, once renderer.given_up is set.
DrawingStep draw_step(Show& show, const PictureJob& job, DrawingStep step, Visitor& visitor);
void finish_picture(Show& show, const PictureJob& job, Visitor& visitor);
// Draws surroundings before the picture, if the job has some; they are shown as soon as they are
// there.
void draw_surroundings(Show& show, const PictureJob& job, Visitor& visitor);
void finish_surroundings(ShowDrawing& drawing, ShowTotals& totals, const PictureJob& job,
                         Visitor& visitor);

}  // namespace wellspring::show
