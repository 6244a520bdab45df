// SPDX-License-Identifier: Apache-2.0
// Places from which a scene that nobody has furnished yet can be seen: from inside where it is a
// room, from around where it is an object.
#pragma once
#include <string>
#include <vector>

#include "world/world.h"

namespace wellspring::show {

struct ProposedViews {
  bool is_room = false;
  std::vector<Viewpoint> views;  // 2 to 5, with names
};

// A scene with something to see. In rooms somebody's eye is `eye_height` above a floor. The same
// views each time; milliseconds to tenths of a second.
ProposedViews propose_views(const World& world, float eye_height);

}  // namespace wellspring::show
