// SPDX-License-Identifier: Apache-2.0
#include "show/state/visitor_world.h"

#include "show/state/lamps.h"

namespace wellspring {

void pose_world(Show& show, const Teller& teller) {
  for (size_t i = 0; i < show.figures.size(); i++)
    show_figure(*show.world, show.figures[i], i == teller.index && teller.visible);
  if (show.figures.empty()) return;
  if (teller.visible)
    pose_figure(*show.world, show.figures[teller.index], storyteller_of(show, teller)->character,
                teller.pose, teller.storyteller.placement, show.scratch);
  show.world->commit();
  show.posed_as = &teller;
  show.pose_number++;
}

void begin_world_of(Show& show, Visitor& visitor) {
  light_world(show, visitor.lamps.lit);
  pose_world(show, teller_of(show, visitor));
}

void go_on_in_world_of(Show& show, Visitor& visitor) {
  light_world(show, visitor.lamps.lit);
  const Teller& teller = teller_of(show, visitor);
  if (show.posed_as != &teller) pose_world(show, teller);
}

bool see_the_same(const Show& show, const Visitor& a, const Visitor& b) {
  return &teller_of(show, a) == &teller_of(show, b) && a.lamps.lit == b.lamps.lit;
}

}  // namespace wellspring
