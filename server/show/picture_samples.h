// SPDX-License-Identifier: Apache-2.0
// The samples of one picture (show/picture.h): planned, traced in slices, remembered. On the easel.
#pragma once
#include "show/show.h"

namespace wellspring {

// Of so many samples at rest, those that are to find changes of the light.
int samples_to_watch(int samples);
// The light that is missing for the picture, and for the next: fills work.requests. Says by
// costs.late whether answers may come after it.
void plan_samples(Show& show, const PictureOrder& order, const Technique& technique,
                  const View& lit, DrawingWork& work, Visitor& visitor);
// Of a picture at rest the world moves on while it is traced: what lies on what moves comes first,
// and what is too much for then is left to the next picture. Returns how many do.
size_t put_moving_first(const RenderCache& cache, size_t most, std::vector<Request>& requests);
// So many are traced at a time.
size_t slice_of_samples(const Show& show);
// Asks for what was planned, or begins to trace it. Returns whether it is traced here: work.samples
// is empty where answers may be late.
bool begin_samples(Show& show, const PictureOrder& order, const Technique& technique,
                   const View& lit, DrawingWork& work, Visitor& visitor);
// At least `least` of them, if there are so many. Returns whether some are left.
bool trace_slice(Show& show, const PictureOrder& order, const Technique& technique, size_t least,
                 DrawingWork& work);
// Those traced, for the visitor's cache and, at rest, for each pixel by itself.
void remember_traced(const Show& show, const PictureOrder& order, const View& lit,
                     DrawingWork& work, Visitor& visitor);

}  // namespace wellspring
