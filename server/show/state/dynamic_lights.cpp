// SPDX-License-Identifier: Apache-2.0
#include "show/state/dynamic_lights.h"

#include "show/state/lamps.h"

namespace wellspring {
namespace {

void add(const PunctualLight& light, uint32_t id, DynamicLights& lights) {
  if (max_component(light.intensity) > 0) lights.push_back({light, id});
}

void add_changing(const Show& show, const std::vector<char>& lit, double time,
                  DynamicLights& lights) {
  const std::vector<ChangingLight>& all = show.exhibit.lights;
  for (size_t i = 0; i < all.size(); i++)
    if (all[i].lamp < 0 || lit[size_t(all[i].lamp)])
      add(eval_light(all[i], time), first_changing_light + uint32_t(i), lights);
}

}  // namespace

DynamicLights dynamic_lights_of(const Show& show, const Visitor& visitor, double time) {
  DynamicLights lights;
  add_held_lights(show.exhibit, teller_of(show, visitor).held, time, first_carried, lights);
  if (show.exhibit.lights.empty()) return lights;
  // Lamps as pictures show them, which follow what is wanted.
  const VisitorLamps& lamps = visitor.lamps;
  add_changing(show, lamps.lit.empty() ? lamps_of(show, visitor) : lamps.lit, time, lights);
  return lights;
}

}  // namespace wellspring
