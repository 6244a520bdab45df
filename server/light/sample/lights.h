// SPDX-License-Identifier: Apache-2.0
// Holds all light sources of a world, ready to be sampled: emissive triangles, punctual lights,
// environment. They are built once per scene (moving meshes do not emit).
#pragma once
#include <atomic>
#include <memory>
#include <span>
#include <vector>

#include "light/sample/light_tables.h"
#include "world/world.h"

namespace wellspring::light {

struct IlluminationMap;  // light/sample/illumination_map.h
struct InstantPass;      // light/virtual/instant_pass.h
struct LampsSeen;        // light/sample/lamps_seen.h
struct LightTables;      // light/sample/light_tables.h
struct SplatPass;        // light/virtual/splatter.h
struct EmittingSources;
struct TransportPlan;  // light/transport_plan.h

struct Lights {
  std::shared_ptr<const LightTables> tables;
  // Number of NaN, infinite or negative samples that were dropped instead of reaching a Frame.
  std::shared_ptr<std::atomic<uint64_t>> bad_samples;
  // Diffuse light of what stands still. Walks of techniques that keep light end on `known`, which
  // they prepare if it is null; samples of techniques with `uses_maps` give the diffuse light of a
  // first surface in multiples of `maps`. Null: there is no such map.
  std::shared_ptr<const IlluminationMap> known = nullptr, maps = nullptr;
  // Shares of few lamps' light that places see; null if they were not learned.
  std::shared_ptr<const LampsSeen> lamps_seen = nullptr;
  // Passes of techniques that draw light anew for each pass; null until one begins.
  std::shared_ptr<const InstantPass> pass = nullptr;
  std::shared_ptr<const SplatPass> splat_pass = nullptr;
};

// Makes the lights. `more`: lights beside the scene's, as they are at a moment.
Lights make_lights(const World& world, std::span<const PunctualLight> more = {});
// Makes them by another plan than the scene's own: tests force parts on to prove that leaving them
// out changes nothing. If a plan leaves out what matters, its light is missing.
Lights make_lights(const World& world, const TransportPlan& plan,
                   std::span<const PunctualLight> more = {});
TransportPlan make_plan(const World& world);  // makes the plan of its scene and of what moves in it

// Returns the tables of fewer or darker sources than those of `all`, which was made while all lamps
// were full.
std::shared_ptr<const LightTables> relit(const LightTables& all, const Scene& scene,
                                         const EmittingSources& emitting);

// Returns the tables of the light that belongs to no lamp, then of each lamp alone.
std::vector<std::shared_ptr<const LightTables>> make_lamp_tables(const LightTables& all,
                                                                 const Scene& scene);
// Returns for each of the scene's materials the layer that its own light belongs to: 0 for no lamp,
// else lamp + 1.
std::vector<uint8_t> find_lamp_parts(const Scene& scene);

// Makes the choices among emitting triangles and punctual lights from their bounds and powers.

// Makes the tree. `power[i]` belongs to emitters[i], both sides counted; emitters without power are
// never picked.
LightTree make_emitter_tree(std::span<const EmitterTriangle> emitters, std::span<const float> power,
                            LightChoice choice);

// Few punctual lights are asked one by one for what they send to a place, which is more exact than
// a tree; of more, one is chosen from near_choice and distant_choice.
void add_punctual_choice(LightTables& tables);

// Makes `emitter.picture` if its emission varies much; `texels`: number of the picture's texels on
// the triangle.
void add_emission_picture(const World& world, float texels, EmitterTriangle& emitter,
                          LightTables& tables);

// Finds how brightly the sources of a scene emit light while its lamps are switched or dimmed.

// Holds factors of the scene's own light.
struct EmittingSources {
  std::vector<vec3> materials, lights;  // one for each of the scene's materials and lights
  std::vector<int> light_spectra;       // PunctualLight::spectrum as it is now
  bool sky = true;
};
EmittingSources find_emitting(const World& world);  // with its lamps as they are
// Returns that lamp's sources alone; -1: all that belongs to no lamp.
EmittingSources find_emitting_of(const Scene& scene, int lamp);

}  // namespace wellspring::light
