// SPDX-License-Identifier: Apache-2.0
#include "show/state/lamps.h"

#include <algorithm>
#include <cmath>

#include "light/visible/facet.h"
#include "show/exhibit/exhibit_lights.h"
#include "show/state/in_view.h"
#include "show/state/visitor_picture.h"

namespace wellspring::show {
namespace {

constexpr double least_between = 0.2;  // seconds from one change of the light to the next

const LightChange& change_between(ExhibitStage& stage, const LampLevels& before,
                                  const LampLevels& after) {
  Switches& switches = stage.switches;
  for (const LightStep& step : switches.steps)
    if (step.before == before && step.after == after) return step.change;
  switches.steps.push_back(
      {before, after,
       LightChange(stage.exhibit.scene, switches.all, switches.cells, before, after)});
  return switches.steps.back().change;
}

// Returns the light on moving things, guessed from another state's until there are samples.
SkinLight changed_skin(ExhibitStage& stage, const LampLevels& before, const LampLevels& after) {
  SkinLight skin = stage.skin;
  if (skin.places.empty()) return skin;
  const LightChange& change = change_between(stage, before, after);
  auto changes = [&](vec3 place, vec3 normal, vec3& kept, vec3& added) {
    return change.changes(place, normal, kept, added);
  };
  relight_skin(*stage.world, changes, skin);
  return skin;
}

void switch_world(ExhibitStage& stage, const LampLevels& lamps) {
  for (size_t lamp = 0; lamp < lamps.size(); lamp++) stage.world->set_lamp(int(lamp), lamps[lamp]);
  stage.switches.lit = lamps;
}

}  // namespace

void look_anew(VisitorPicture& picture) {
  picture.rest = {};
  picture.stats.converged = 0;  // a visitor at rest needs samples again,
  picture.job.settled = false;  // first by the quicker technique
}

std::vector<char> shining_objects(const Scene& scene) {
  std::vector<char> shining(scene.objects.size(), 0);
  TextureRanges ranges(scene);
  for (const Instance& instance : scene.instances) {
    if (instance.object >= shining.size()) continue;
    const int material = scene.meshes[size_t(instance.mesh)].material;
    shining[instance.object] |= may_shine(scene.materials[size_t(material)], ranges);
  }
  return shining;
}

void use_maps(ExhibitStage& stage, ShowVisits& visits,
              std::shared_ptr<const IlluminationMap> maps) {
  const bool first = !stage.lights.maps;
  const Scene& scene = stage.exhibit.scene;
  stage.mapped = mapped_objects(scene, *maps);
  if (first) stage.shining = shining_objects(scene);
  stage.known = stage.mapped;
  for (size_t i = 0; i < stage.known.size(); i++)
    if (stage.shining[i] || !(maps->error < most_sure_error)) stage.known[i] = 0;
  stage.lights.maps = maps;
  if (!stage.exhibit.lamps.empty()) {
    stage.switches.all.maps = std::move(maps);
    stage.switches.others.clear();
    stage.lights = relit(stage.switches.all, *stage.world);
  }
  for (Visitor& visitor : visits.visitors) {
    look_anew(*visitor.picture);
    visitor.picture->fades_next = true;
    if (!first) continue;
    // So far points hold the light itself, not multiples of a map's light.
    visitor.picture->cache.clear();
  }
}

void use_better_maps(ExhibitStage& stage, ShowVisits& visits,
                     std::shared_ptr<const IlluminationMap> maps) {
  (stage.exhibit.lamps.empty() ? stage.lights : stage.switches.all).known = maps;
  use_maps(stage, visits, std::move(maps));
}

void begin_lamps(ExhibitStage& stage) {
  stage.switches.wanted = first_lamps(stage.exhibit);
  if (stage.exhibit.lamps.empty()) return;
  stage.switches.all = stage.lights;
  if (stage.lights.known)
    stage.switches.cells =
        std::make_shared<LampCells>(make_lamp_cells(*stage.world, *stage.lights.known));
  switch_world(stage, first_levels(stage.exhibit));
  stage.lights = relit(stage.switches.all, *stage.world);
}

namespace {
// Returns the lamps of the visitor whose wishes count: the leader's, if there is one.
const VisitorLamps& wishes_of(const ShowVisits& visits, const Visitor& visitor) {
  const Visitor* leader = leader_of(visits, visitor);
  return (leader ? *leader : visitor).lamps;
}
}  // namespace

std::vector<LampSwitch> switches_of(const ExhibitStage& stage, const ShowVisits& visits,
                                    const Visitor& visitor) {
  std::vector<LampSwitch> on = stage.switches.wanted;
  const VisitorLamps& wishes = wishes_of(visits, visitor);
  for (size_t i = 0; i < wishes.own.size(); i++)
    if (wishes.own[i]) on[i] = wishes.wish[i];
  return on;
}

std::optional<double> hour_of(const Show& show, const Visitor& visitor) {
  return wishes_of(show.visits, visitor).hour;
}

LampLevels lamps_of(const Show& show, const Visitor& visitor) {
  return lamp_levels(show.stage.exhibit.day, switches_of(show.stage, show.visits, visitor),
                     hour_of(show, visitor));
}

bool set_hour(const ExhibitStage& stage, Visitor& visitor, std::optional<double> hour) {
  if (!stage.exhibit.day) return false;
  visitor.lamps.hour = hour ? hour_of_day(*stage.exhibit.day, *hour) : hour;
  visitor.state_sent_at = -1e9;
  return true;
}

bool switch_lamp(Show& show, Visitor& visitor, std::string_view name, LampSwitch to) {
  const int found = find_lamp(show.stage.exhibit, name);
  if (found < 0) return false;
  const size_t lamp = size_t(found);
  if (size_t(to) > 1 + show.stage.exhibit.lamps[lamp].dial.size()) return false;
  if (switches_of(show.stage, show.visits, visitor)[lamp] == to) return true;
  show.totals.lamps_switched++;
  if (show.stage.exhibit.lamps[lamp].shared) {
    show.stage.switches.wanted[lamp] = to;
    for (Visitor& other : show.visits.visitors) other.state_sent_at = -1e9;
    return true;
  }
  VisitorLamps& own = visitor.lamps;
  own.own.resize(show.stage.exhibit.lamps.size());
  own.wish.resize(own.own.size());
  own.own[lamp] = true;
  own.wish[lamp] = to;
  visitor.state_sent_at = -1e9;
  return true;
}

bool lamps_wait(const Show& show, const Visitor& visitor) {
  const VisitorLamps& lamps = visitor.lamps;
  const bool differs =
      lamps.lit_hour != hour_of(show, visitor) || lamps.lit != lamps_of(show, visitor);
  return differs && show.time - lamps.lit_at >= least_between;
}

void light_lamps(Show& show, Visitor& visitor) {
  VisitorLamps& lamps = visitor.lamps;
  const bool first = lamps.lit.empty();
  lamps.lit = lamps_of(show, visitor);
  lamps.lit_hour = hour_of(show, visitor);
  if (first) return;
  lamps.lit_at = show.time;
  visitor.picture->around = {}, visitor.picture->fade = {};  // both show another light
  look_anew(*visitor.picture);
}

void light_world(ExhibitStage& stage, const LampLevels& lamps) {
  Switches& switches = stage.switches;
  if (lamps == switches.lit) return;
  const LampLevels before = switches.lit;
  auto known = switches.others.extract(lamps);
  KnownLight next;
  if (known) {
    next = std::move(known.mapped());
    switch_world(stage, lamps);
  } else {
    next.skin = changed_skin(stage, before, lamps);
    switch_world(stage, lamps);
    next.lights = relit(switches.all, *stage.world);
  }
  switches.others[before] = {std::exchange(stage.lights, std::move(next.lights)),
                             std::exchange(stage.skin, std::move(next.skin))};
}

void follow_lamps(ExhibitStage& stage, Visitor& visitor) {
  VisitorPicture& picture = *visitor.picture;
  picture.compositor.set_maps(stage.lights.maps);
  picture.compositor.set_laid(laid_things(*stage.world, &stage.lights, stage.lights.maps,
                                          stage.exhibit.exposure, stage.lawns.shown()));
  picture.hour = visitor.lamps.lit_hour;
  const LampLevels& lit = stage.switches.lit;
  if (picture.lamps == lit) return;
  if (picture.lamps.size() == lit.size()) {
    const LightChange& change = change_between(stage, picture.lamps, lit);
    picture.cache.relight([&](const RenderCache::Surface& at, vec3& kept, vec3& added) {
      if (!change.changes(at.place, at.normal, kept, added)) return false;
      // Light that counts in multiples of a map's light changes with the map.
      if (at.object < stage.mapped.size() && stage.mapped[at.object])
        kept = vec3(1), added = vec3(0);
      return true;
    });
  }
  picture.broker.forget();
  picture.away.forget();
  picture.compositor.invalidate_samples();
  picture.lamps = lit;
}

void forget_lights(ExhibitStage& stage, const ShowVisits& visits) {
  Switches& switches = stage.switches;
  auto anybody = [&](const auto& needs) {
    return std::any_of(visits.visitors.begin(), visits.visitors.end(), needs);
  };
  std::erase_if(switches.steps, [&](const LightStep& step) {
    return !anybody([&](const Visitor& visitor) {
      return visitor.picture->lamps == step.before && visitor.lamps.lit == step.after;
    });
  });
  std::erase_if(switches.others, [&](const auto& other) {
    return !anybody([&](const Visitor& visitor) { return visitor.lamps.lit == other.first; });
  });
}

namespace {

void add(const PunctualLight& light, uint32_t id, DynamicLights& lights) {
  if (max_component(light.intensity) > 0) lights.push_back({light, id});
}

void add_changing(const ExhibitStage& stage, const LampLevels& lit, double time,
                  DynamicLights& lights) {
  const std::vector<ChangingLight>& all = stage.exhibit.lights;
  const std::vector<vec3> factors = lamp_factors(stage.exhibit.scene, lit);
  for (size_t i = 0; i < all.size(); i++) {
    PunctualLight light = eval_light(all[i], time);
    if (all[i].lamp >= 0) light.intensity *= factors[size_t(all[i].lamp)];
    add(light, first_changing_light + uint32_t(i), lights);
  }
}

}  // namespace

DynamicLights dynamic_lights_of(const Show& show, const Visitor& visitor, double time) {
  DynamicLights lights;
  add_held_lights(show.stage.exhibit, teller_of(show.cast, show.visits, visitor).held, time,
                  first_carried, lights);
  // Lamps and hour are as pictures show them; they follow the visitor's wishes.
  const VisitorLamps& now = visitor.lamps;
  const std::optional<Day>& day = show.stage.exhibit.day;
  if (!now.lit.empty() && day && now.lit_hour && now.lit[size_t(day->lamp)] > 0)
    add(eval_sun(*day, *now.lit_hour), sun_of_the_day, lights);
  if (!show.stage.exhibit.lights.empty())
    add_changing(show.stage, now.lit.empty() ? lamps_of(show, visitor) : now.lit, time, lights);
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
