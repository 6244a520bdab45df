// SPDX-License-Identifier: Apache-2.0
// The samples of one picture (show/draw/picture.h): planned, traced in slices, remembered. On the
// renderer.
#pragma once
#include "show/state/show.h"

namespace wellspring::show {

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
