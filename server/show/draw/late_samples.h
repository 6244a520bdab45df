// SPDX-License-Identifier: Apache-2.0
// Traces what pictures of walking visitors have asked for, in turn, in the time that was left for
// it: the answers appear in their next pictures. It takes three steps, as in show/draw/picture.h.
#pragma once
#include "show/state/renderer.h"
#include "show/state/show.h"

namespace wellspring::show {

// Begins a turn, by the tick, while the renderer is idle. Returns the brokers whose requests are to
// be traced.
std::vector<Broker*> request_samples(Show& show);
// Traces them, on the renderer.
void trace_samples(const ExhibitStage& stage, const ShowCast& cast,
                   std::span<Broker* const> brokers, Renderer& renderer);
// Ends the turn, by the tick, when tracing is done.
void finish_samples(Show& show);

// Plans, traces in slices and remembers the samples of one picture (show/draw/picture.h). On the
// renderer.

// Plans the light that is missing for the picture, and for the next: fills work.requests. Says by
// costs.late whether answers may come after the picture.
void plan_samples(Show& show, const PictureJob& job, const Technique& technique, DrawingWork& work,
                  Visitor& visitor);
// Asks for what was planned, or begins to trace it. Returns whether it is traced here; work.samples
// is empty if answers may be late.
bool begin_samples(Show& show, const PictureJob& job, const Technique& technique, DrawingWork& work,
                   Visitor& visitor);
// Traces a slice of the requests. Returns whether some are left.
bool trace_slice(Show& show, const PictureJob& job, const Technique& technique, DrawingWork& work);
// Puts traced samples into the visitor's cache and, at rest, into each pixel's own.
void remember_traced(const Show& show, const PictureJob& job, const Technique& technique,
                     DrawingWork& work, Visitor& visitor);
// Puts answers into the cache that came after the picture they were asked for.
void take_answers(const ExhibitStage& stage, const ShowCast& cast, VisitorPicture& picture);

}  // namespace wellspring::show
