// SPDX-License-Identifier: Apache-2.0
// What pictures of walking visitors have asked for, in turn, in the time that was left for it: the
// answers are in the next ones. Likewise in three steps (show/draw/picture.h).
#pragma once
#include "show/state/show.h"

namespace wellspring::show {

// By the tick, while the renderer is idle. Says whether there is anything.
bool request_samples(Show& show);
// On the renderer.
void trace_samples(const Show& show, Renderer& renderer);
// By the tick, when that is done.
void finish_samples(Show& show);

// The samples of one picture (show/draw/picture.h): planned, traced in slices, remembered. On the
// renderer.

// The light that is missing for the picture, and for the next: fills work.requests. Says by
// costs.late whether answers may come after it.
void plan_samples(Show& show, const PictureJob& job, const Technique& technique, DrawingWork& work,
                  Visitor& visitor);
// Asks for what was planned, or begins to trace it. Returns whether it is traced here: work.samples
// is empty where answers may be late.
bool begin_samples(Show& show, const PictureJob& job, const Technique& technique, DrawingWork& work,
                   Visitor& visitor);
// A slice of them. Returns whether some are left.
bool trace_slice(Show& show, const PictureJob& job, const Technique& technique, DrawingWork& work);
// Those traced, for the visitor's cache and, at rest, for each pixel by itself.
void remember_traced(const Show& show, const PictureJob& job, const Technique& technique,
                     DrawingWork& work, Visitor& visitor);
// Answers that came after the picture they were asked for.
void take_answers(const Show& show, VisitorPicture& picture);

}  // namespace wellspring::show
