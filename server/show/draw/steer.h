// SPDX-License-Identifier: Apache-2.0
// Steers where samples go by attention (Haber et al. 2001, section 3): the newest picture that was
// drawn for a visitor, its objects, and hints where the visitor looks, become a factor of the
// priority of each object's pixels.
//
//   draw_step --note_seen()--> finish_picture --steer()--> analysis --steer()--> the next job
//
// The analysis goes on beside drawing, on a thread of its own. It runs at most analysis_rate times
// a second, when its cause is another, and not while nothing asks for samples.
#pragma once
#include "show/state/renderer.h"
#include "show/state/show.h"

namespace wellspring::show {

inline constexpr double analysis_rate = 25;  // times a second for each visitor, at most
inline constexpr int widest_seen = 320;      // pixels of the analysed picture, at most
// seconds without news, after which it counts no more
inline constexpr double pointer_lifetime = 5;

// Returns whether a job's picture is to be noted. By the tick.
bool wants_seen(const Show& show, const Visitor& visitor);
// Returns the picture in `image`, of job.view, made small, with the objects of the points in the
// visitor's cache, projected for it. By the renderer.
std::shared_ptr<const SeenPicture> note_seen(const PictureJob& job, const Image8& image,
                                             const RenderCache& cache);
// Takes what is finished and begins what is due, for one visitor a call. By the tick; never waits.
void steer(Show& show);

// Finds an analysis's weights and seconds: from its cause alone, the same for any number of
// threads.
void analyse(AttentionAnalysis& analysis);
// Returns the hints where the visitor looks, in pixels of that picture: the pointer or finger, the
// head of whoever stands before a kiosk, what the storyteller shows. Hints that are not in the
// picture, or no numbers, are left out.
std::vector<AttentionHint> find_hints(const Show& show, const Visitor& visitor,
                                      const SeenPicture& seen);

}  // namespace wellspring::show
