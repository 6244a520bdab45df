// SPDX-License-Identifier: Apache-2.0
// Technique `gather`: path tracing whose walks end where light is known (IlluminationMap). One
// gathering bounce hides the map's nodes. Where nothing is known it is `path`.
#include <optional>

#include "light/bake/coarse_light.h"
#include "light/sample/finish_samples.h"
#include "light/sample/lamps_seen.h"
#include "light/sample/light_tables.h"
#include "light/technique/technique_list.h"
#include "light/walk/walk.h"

namespace wellspring::light {
namespace {

// So that what a Lambertian surface's rays meet has an alpha of 1/4, a roughness of 1/2.
constexpr float blunt = 0.14f;

}  // namespace

void trace_many_gather(const World& world, const Lights& lights, const TransportSettings& settings,
                       std::span<const Request> requests, std::span<Sample> samples) {
  WalkRules rules;
  rules.max_depth = settings.max_depth;
  if (lights.known) rules.blunt = blunt;
  rules.reads_maps = true;
  trace_samples(
      {world, *lights.tables, lights.known.get(), lights.lamps_seen.get(), lights.maps.get()},
      rules, requests, samples);
  finish_samples(lights, settings, samples);
}

Sample trace_gather(const World& world, const Lights& lights, const TransportSettings& settings,
                    const Request& request) {
  Sample sample;
  trace_many_gather(world, lights, settings, std::span(&request, 1), std::span(&sample, 1));
  return sample;
}

void prepare_gather(const World& world, std::span<const vec3> places, Lights& lights) {
  if (!lights.tables->plan.uses(TransportPart::kept_light)) return;
  lights.lamps_seen = learn_lamps_seen({world, *lights.tables}, places);
  if (lights.known || places.empty()) return;
  // Moving meshes would leave their shadows in light that is kept.
  std::optional<World> still;
  if (size_t(world.instance_count()) > world.scene().instances.size()) still.emplace(world.scene());
  lights.known = make_bake_scene(still ? *still : world, places).known;
}

}  // namespace wellspring::light
