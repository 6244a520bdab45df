// SPDX-License-Identifier: Apache-2.0
#include "show/state/dynamic_lights.h"

#include <cmath>

#include "show/state/in_view.h"
#include "show/state/lamps.h"

namespace wellspring::show {
namespace {

void add(const PunctualLight& light, uint32_t id, DynamicLights& lights) {
  if (max_component(light.intensity) > 0) lights.push_back({light, id});
}

void add_changing(const Show& show, const LampLevels& lit, double time, DynamicLights& lights) {
  const std::vector<ChangingLight>& all = show.exhibit.lights;
  for (size_t i = 0; i < all.size(); i++) {
    PunctualLight light = eval_light(all[i], time);
    if (all[i].lamp >= 0) light.intensity *= brightness_of(lit[size_t(all[i].lamp)]);
    add(light, first_changing_light + uint32_t(i), lights);
  }
}

}  // namespace

DynamicLights dynamic_lights_of(const Show& show, const Visitor& visitor, double time) {
  DynamicLights lights;
  add_held_lights(show.exhibit, teller_of(show, visitor).held, time, first_carried, lights);
  // Lamps and hour as pictures show them, which follow what is wanted.
  const VisitorLamps& now = visitor.lamps;
  const std::optional<Day>& day = show.exhibit.day;
  if (!now.lit.empty() && day && now.lit_hour && now.lit[size_t(day->lamp)] > 0)
    add(eval_sun(*day, *now.lit_hour), sun_of_the_day, lights);
  if (!show.exhibit.lights.empty())
    add_changing(show, now.lit.empty() ? lamps_of(show, visitor) : now.lit, time, lights);
  return lights;
}

DynamicLights dynamic_lights_in(const View& view, DynamicLights lights) {
  std::erase_if(lights, [&](const DynamicLight& one) {
    const PunctualLight& light = one.light;
    const bool ends = light.type != PunctualType::directional && std::isfinite(light.range);
    return ends && !in_view(view, light.position, light.range);
  });
  return lights;
}

}  // namespace wellspring::show
