// SPDX-License-Identifier: Apache-2.0
// Decides what a picture is to be before it is drawn: for which view, how finely, with how many
// samples. Pure functions of the show.
#pragma once
#include "show/draw/decide.h"
#include "show/state/renderer.h"
#include "show/state/show.h"

namespace wellspring::show {

// Makes the job of the visitor's next picture; `busy` visitors share the time.
PictureJob make_picture_job(const Show& show, const Visitor& visitor, int busy,
                            PictureKind wanted = PictureKind::still);
// Returns whether the picture of this job would not be shown, since the visitor is somewhere else
// by now or has left; or whether one at rest would wait for samples of what is no longer so: its
// visitor moves on, lamps were switched, the storyteller came or went.
bool is_outdated(const Show& show, const PictureJob& job, const Visitor& visitor);

}  // namespace wellspring::show
