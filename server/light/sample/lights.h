// SPDX-License-Identifier: Apache-2.0
// All light sources of a world, ready to be sampled: emissive triangles, punctual lights,
// environment. Built once per scene (moving meshes do not emit).
#pragma once
#include <atomic>
#include <memory>
#include <span>
#include <vector>

#include "light/sample/light_tables.h"
#include "world/world.h"

namespace wellspring::light {

struct IlluminationMap;  // light/sample/illumination_map.h
struct InstantPass;      // light/instant/instant_pass.h
struct LampsSeen;        // light/sample/lamps_seen.h
struct LightTables;      // light/sample/light_tables.h
struct SplatPass;        // light/splat/splatter.h
struct EmittingSources;  // light/sample/emitting.h
struct TransportPlan;    // light/transport_plan.h

struct Lights {
  std::shared_ptr<const LightTables> tables;
  // NaN, infinite or negative samples that were dropped instead of reaching a Frame.
  std::shared_ptr<std::atomic<uint64_t>> bad_samples;
  // Diffuse light of what stands still. Walks of techniques that keep light end on `known`, which
  // they prepare where there is none; samples of techniques with `uses_maps` tell the diffuse light
  // of a first surface in multiples of `maps`. Null: none is known.
  std::shared_ptr<const IlluminationMap> known = nullptr, maps = nullptr;
  // Which of few lamps places see; null where nobody has learned it.
  std::shared_ptr<const LampsSeen> lamps_seen = nullptr;
  // Of techniques that draw light anew for each pass; null until one begins.
  std::shared_ptr<const InstantPass> pass = nullptr;
  std::shared_ptr<const SplatPass> splat_pass = nullptr;
};

// `more`: lights beside the scene's, as they are at a moment.
Lights make_lights(const World& world, std::span<const PunctualLight> more = {});
// By another plan than the scene's own: tests force parts on to prove that leaving them out changes
// nothing. Leaving out what matters is what one would expect it to be.
Lights make_lights(const World& world, const TransportPlan& plan,
                   std::span<const PunctualLight> more = {});
TransportPlan make_plan(const World& world);  // of its scene and what moves in it

// The tables of fewer or darker sources than those of `all`, which was made while all lamps were
// full.
std::shared_ptr<const LightTables> relit(const LightTables& all, const Scene& scene,
                                         const EmittingSources& emitting);

// Those of what belongs to no lamp, then of each lamp alone.
std::vector<std::shared_ptr<const LightTables>> make_lamp_tables(const LightTables& all,
                                                                 const Scene& scene);
// Of each of the scene's materials, which of those its own light belongs to.
std::vector<uint8_t> find_lamp_parts(const Scene& scene);

// What a choice among lights needs to know of emitting triangles and punctual lights.

// `power[i]` of emitters[i], both sides counted; those without are never picked.
LightTree make_emitter_tree(std::span<const EmitterTriangle> emitters, std::span<const float> power,
                            LightChoice choice);

// Few punctual lights are asked one by one for what they send to a place, which knows each better
// than a tree does; more are chosen from near_choice and distant_choice.
void add_punctual_choice(LightTables& tables);

// Makes `emitter.picture` where its emission varies much; `texels`: of the picture on the triangle.
void add_emission_picture(const World& world, float texels, EmitterTriangle& emitter,
                          LightTables& tables);

// How brightly the sources of a scene emit light while its lamps are switched or dimmed.

// How brightly it does, times the scene's own light: 0 to 1.
struct EmittingSources {
  std::vector<float> materials, lights;  // of each of the scene's
  bool sky = true;
};
EmittingSources find_emitting(const World& world);  // as its lamps are
// That lamp alone; -1: all that belongs to no lamp.
EmittingSources find_emitting_of(const Scene& scene, int lamp);

}  // namespace wellspring::light
