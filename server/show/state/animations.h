// SPDX-License-Identifier: Apache-2.0
// The exhibit's animations as visitors see them. One that is started by touch is the visitor's own,
// or their leader's, unless the exhibit says that it is shared.
#pragma once
#include <string_view>

#include "show/state/show.h"

namespace wellspring::show {

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
