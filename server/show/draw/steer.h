// SPDX-License-Identifier: Apache-2.0
// Attention steers where samples go (Haber et al. 2001, section 3): the newest picture that was
// drawn for a visitor, its objects, and what tells where the visitor looks, become a factor of the
// priority of each object's pixels.
//
//   draw_step --note_seen()--> finish_picture --steer()--> analysis --steer()--> the next job
//
// The analysis goes on beside drawing, on a thread of its own; without a background, within the
// tick. It runs at most analysis_rate times a second, when its cause is another, and not while
// nothing asks for samples.
#pragma once
#include "show/state/show.h"

namespace wellspring::show {

inline constexpr double analysis_rate = 25;    // a second and visitor, at most
inline constexpr int widest_seen = 320;        // pixels of the analysed picture, at most
inline constexpr double pointer_lifetime = 5;  // seconds without news, after which it is let lie

// Is a job's picture to be noted? By the tick.
bool wants_seen(const Show& show, const Visitor& visitor);
// The picture in `image`, of job.view, and the points in the visitor's cache, projected for it. By
// the renderer.
std::shared_ptr<const SeenPicture> note_seen(const PictureJob& job, const Image8& image,
                                             const RenderCache& cache);
// Takes what is finished and begins what is due, for one visitor a call. By the tick; never waits
// but without a background.
void steer(Show& show);

// Its weights and seconds: of its cause alone, the same for any number of threads.
void analyse(AttentionAnalysis& analysis);
// What tells where the visitor looks, in pixels of that picture: the pointer or finger, the head of
// who stands before a kiosk, what the storyteller shows. What is not in it, or no number, is left
// out.
std::vector<AttentionHint> find_hints(const Show& show, const Visitor& visitor,
                                      const SeenPicture& seen);

}  // namespace wellspring::show
