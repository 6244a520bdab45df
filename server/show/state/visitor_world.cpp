// SPDX-License-Identifier: Apache-2.0
#include "show/state/visitor_world.h"

#include "show/state/in_view.h"
#include "show/state/lamps.h"

namespace wellspring::show {
namespace {

uint64_t number_who_touched(const Show& show, const Visitor& visitor) {
  const Visitor* who = who_touched(show, visitor);
  return who ? who->link->id : 0;
}

}  // namespace

void pose_world(Show& show, const Teller& teller, const std::vector<double>& times) {
  bool moved = pose_movers(show.stage.exhibit, times, show.cast.movers, *show.stage.world);
  show.cast.posed_as = teller.number;
  for (size_t i = 0; i < show.cast.figures.size(); i++)
    show_figure(*show.stage.world, show.cast.figures[i], i == teller.index && teller.visible);
  for (size_t i = 0; i < show.cast.props.size(); i++)
    moved |= pose_prop(*show.stage.world, show.cast.props[i],
                       pose_of(show.stage.exhibit, teller.held, int(i), show.time));
  if (show.cast.figures.empty() && !moved) return;
  if (teller.visible && !show.cast.figures.empty())
    pose_figure(*show.stage.world, show.cast.figures[teller.index],
                storyteller_of(show, teller)->character, teller.pose, teller.storyteller.placement,
                show.cast.scratch);
  show.stage.world->commit();
  show.cast.pose_number++;
}

void begin_world_of(Show& show, Visitor& visitor) {
  light_world(show, visitor.lamps.lit);
  pose_world(show, teller_of(show, visitor), animation_times(show, visitor));
  show.cast.posed_for = number_who_touched(show, visitor);
}

void go_on_in_world_of(Show& show, Visitor& visitor) {
  light_world(show, visitor.lamps.lit);
  if (show.cast.posed_as == teller_of(show, visitor).number &&
      show.cast.posed_for == number_who_touched(show, visitor))
    return;
  begin_world_of(show, visitor);
}

bool see_the_same(const Show& show, const Visitor& a, const Visitor& b) {
  return &teller_of(show, a) == &teller_of(show, b) && a.lamps.lit == b.lamps.lit &&
         a.lamps.lit_hour == b.lamps.lit_hour && who_touched(show, a) == who_touched(show, b);
}

}  // namespace wellspring::show
