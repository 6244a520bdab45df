// SPDX-License-Identifier: Apache-2.0
// What a picture may show, by bounds alone.
#pragma once
#include <string_view>

#include "show/state/show.h"

namespace wellspring::show {

// Whether a sphere touches the cone around the view's pyramid; says yes rather too often than too
// seldom.
bool in_view(const View& view, vec3 centre, float radius);

// Where the visitor looks from the place where it stands; a kiosk's page from its viewpoint.
View rest_view(const Show& show, const Visitor& visitor);
// Where the visitor looks now: through a kiosk's screen from where its guest's head is.
View view_of(const Show& show, const Visitor& visitor);

// The teller's head, or any of it, may be in that picture. False while it is hidden.
bool sees_head(const Show& show, const Teller& teller, const View& view);
bool sees_figure(const Show& show, const Teller& teller, const View& view);

// Who moves the teller's lips besides its own voice: of its visitors on a tour that is told aloud
// now and who may see its face, the nearest; null: nobody.
const Visitor* heard_on_tour(const Show& show, const Teller& teller);
// What one of the teller's visitors went to look at closer who has it in view; null: nothing.
const PointOfInterest* looked_at_beside_her(const Show& show, const Teller& teller);

// Metres from the teller's head to the nearest of its visitors who may see it; far where nobody
// may.
float viewer_distance(const Show& show, const Teller& teller);

// The exhibit's animations as visitors see them. One that is started by touch is the visitor's own,
// or their leader's, unless the exhibit says that it is shared.

// Whose own animations the visitor sees: theirs or their leader's; null: nobody has touched any.
const Visitor* who_touched(const Show& show, const Visitor& visitor);
// Of each animation, its seconds now.
std::vector<double> animation_times(const Show& show, const Visitor& visitor);
// Whether it has been started, and not been sent back, by touch; `animation`: its index.
bool is_on(const Show& show, const Visitor& visitor, size_t animation);
// Whether anything that can move may be in that picture: the visitor's storyteller, or what an
// animation moves, at rest or not.
bool sees_moving(const Show& show, const Visitor& visitor, const View& view);
// Whether any of it moves now: she always does.
bool sees_motion(const Show& show, const Visitor& visitor, const View& view);

// Starts it, or sends it back, for the visitor or for everybody. False: no animation of that name
// is started by touch.
bool play_animation(Show& show, Visitor& visitor, std::string_view id, bool on);
// The object was touched: what that starts, if anything, goes the other way.
void touch_object(Show& show, Visitor& visitor, int point);

}  // namespace wellspring::show
