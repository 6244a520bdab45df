// SPDX-License-Identifier: Apache-2.0
// Finds by bounds alone what a picture may show.
#pragma once
#include <string_view>

#include "show/state/show.h"

namespace wellspring::show {

// Returns whether a sphere touches the cone around the view's pyramid; says yes rather too often
// than too seldom.
bool in_view(const View& view, vec3 centre, float radius);

// Returns the view from where the visitor stands; for a kiosk's page, from its viewpoint.
View rest_view(const ExhibitStage& stage, const Visitor& visitor);
// Returns the visitor's present view; for a kiosk's page, through the screen from where the guest's
// head is.
View view_of(const Show& show, const Visitor& visitor);

// Return whether the storyteller's head, or any part of it, may be in that picture. False while the
// storyteller is hidden.
bool sees_head(const ShowCast& cast, const Teller& teller, const View& view);
bool sees_figure(const ShowCast& cast, const Teller& teller, const View& view);

// Returns the visitor whose narration moves the storyteller's lips besides its own voice: of its
// visitors on a tour that is narrated now, who may see its face, the nearest; null: nobody.
const Visitor* heard_on_tour(const Show& show, const Teller& teller);
// Returns what one of the storyteller's visitors, who has the storyteller in view, went to look at
// closer; null: nothing.
const PointOfInterest* looked_at_beside_her(const Show& show, const Teller& teller);

// Returns metres from the storyteller's head to the nearest of its visitors who may see it; a large
// number if nobody may.
float viewer_distance(const Show& show, const Teller& teller);

// Tells how visitors see the exhibit's animations. An animation that is started by touch is the
// visitor's own, or their leader's, unless the exhibit says that it is shared.

// Returns whose own animations the visitor sees: the visitor or their leader; null: that one has
// touched none.
const Visitor* who_touched(const ShowVisits& visits, const Visitor& visitor);
// Returns the present time of each animation, in seconds.
std::vector<double> animation_times(const Show& show, const Visitor& visitor);
// Returns whether the animation has been started, and not been sent back, by touch; `animation`:
// its index.
bool is_on(const Show& show, const Visitor& visitor, size_t animation);
// Returns whether that picture may show anything that can move: a dynamic light, the visitor's
// storyteller, a lawn that moves, what a kiosk's guest holds up, or what an animation moves, at
// rest or not.
bool sees_moving(const ShowCast& cast, const ShowVisits& visits, const Visitor& visitor,
                 const View& view);
// Return whether any of these moves now, with lawns or without; the storyteller always does.
bool sees_others_move(const Show& show, const Visitor& visitor, const View& view);
bool sees_motion(const Show& show, const Visitor& visitor, const View& view);

// Starts the animation, or sends it back, for the visitor or for everybody. Returns false if no
// animation of that name is started by touch.
bool play_animation(Show& show, Visitor& visitor, std::string_view id, bool on);
// Starts or sends back the animations that touching this object starts.
void touch_object(Show& show, Visitor& visitor, int point);

}  // namespace wellspring::show
