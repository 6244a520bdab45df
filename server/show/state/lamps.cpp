// SPDX-License-Identifier: Apache-2.0
#include "show/state/lamps.h"

#include <algorithm>

#include "show/exhibit/exhibit_lamps.h"

namespace wellspring {
namespace {

constexpr double least_between = 0.2;  // seconds from one change of the light to the next

const LightChange& change_since(Show& show, const std::vector<char>& before) {
  Switches& switches = show.switches;
  for (const LightStep& step : switches.steps)
    if (step.before == before) return step.change;
  switches.steps.push_back(
      {before, LightChange(show.exhibit.scene, switches.all, before, switches.lit)});
  return switches.steps.back().change;
}

}  // namespace

void use_maps(Show& show, std::shared_ptr<const IlluminationMap> maps) {
  const bool first = !show.lights.maps;
  show.mapped = mapped_objects(show.exhibit.scene, *maps);
  show.lights.maps = maps;
  if (!show.exhibit.lamps.empty()) {
    show.switches.all.maps = std::move(maps);
    light_lamps(show);
  }
  // Points know their light by itself, not in multiples of what maps know.
  if (first)
    for (Visitor& visitor : show.visitors) visitor.picture.cache.clear();
}

void begin_lamps(Show& show) {
  show.switches.lit.assign(show.exhibit.lamps.size(), 1);
  show.switches.wanted = first_lamps(show.exhibit);
  if (show.exhibit.lamps.empty()) return;
  show.switches.all = show.lights;
  light_lamps(show);
}

bool switch_lamp(Show& show, std::string_view name, bool on) {
  int lamp = find_lamp(show.exhibit, name);
  if (lamp < 0) return false;
  if (bool(show.switches.wanted[size_t(lamp)]) == on) return true;
  show.switches.wanted[size_t(lamp)] = on;
  show.totals.lamps_switched++;
  for (Visitor& visitor : show.visitors) visitor.state_sent_at = -1e9;
  return true;
}

bool lamps_wait(const Show& show) {
  const Switches& switches = show.switches;
  return switches.wanted != switches.lit && show.time - switches.lit_at >= least_between;
}

void light_lamps(Show& show) {
  Switches& switches = show.switches;
  const std::vector<char> before = switches.lit;
  for (size_t lamp = 0; lamp < switches.wanted.size(); lamp++)
    show.world->switch_lamp(int(lamp), switches.wanted[lamp]);
  show.lights = relit(switches.all, *show.world);
  switches.lit = switches.wanted;
  switches.lit_at = show.time;
  switches.steps.clear();
  if (before != switches.lit && !show.skin.places.empty()) {
    const LightChange& change = change_since(show, before);
    auto changes = [&](vec3 place, vec3 normal, vec3& kept, vec3& added) {
      return change.changes(place, normal, kept, added);
    };
    relight_skin(*show.world, changes, show.skin);
  }
  for (Visitor& visitor : show.visitors) {
    visitor.picture.around.keyframe = {}, visitor.picture.fade = {};  // they show another light
    visitor.picture.rest = {};
    visitor.picture.stats.converged = 0;  // who rests looks again,
    visitor.picture.job.settled = false;  // and first at what is soon to be known
  }
}

void follow_lamps(Show& show, Visitor& visitor) {
  VisitorPicture& picture = visitor.picture;
  picture.compositor.set_maps(show.lights.maps);
  const std::vector<char>& lit = show.switches.lit;
  if (picture.lamps == lit) return;
  if (picture.lamps.size() == lit.size()) {
    const LightChange& change = change_since(show, picture.lamps);
    picture.cache.relight([&](const RenderCache::Surface& at, vec3& kept, vec3& added) {
      if (!change.changes(at.place, at.normal, kept, added)) return false;
      // What counts in multiples of a map's light changes with the map.
      if (at.object < show.mapped.size() && show.mapped[at.object]) kept = vec3(1), added = vec3(0);
      return true;
    });
  }
  picture.broker.forget();
  picture.compositor.invalidate_samples();
  picture.lamps = lit;
}

void invalidate_light_steps(Show& show) {
  Switches& switches = show.switches;
  std::erase_if(switches.steps, [&](const LightStep& step) {
    auto needs = [&](const Visitor& visitor) { return visitor.picture.lamps == step.before; };
    return std::none_of(show.visitors.begin(), show.visitors.end(), needs);
  });
}

}  // namespace wellspring
