// SPDX-License-Identifier: Apache-2.0
// Technique `gather`: path tracing whose walks end where a wide ray meets light that is already
// known (RadianceGrid). Static light and geometry make that light worth keeping; one gathering
// bounce hides its cells. Without a grid it is `path`.
#include "light/known/fill_radiance_grid.h"
#include "light/known/lamps.h"
#include "light/sample/finish_samples.h"
#include "light/sample/light_tables.h"
#include "light/sample/radiance_grid.h"
#include "light/technique/technique_list.h"
#include "light/walk/walk.h"

namespace wellspring {
namespace {

// So that what a Lambertian surface's rays meet has an alpha of 1/4, a roughness of 1/2.
constexpr float blunt = 0.14f;

}  // namespace

void trace_many_gather(const World& world, const Lights& lights, const TransportSettings& settings,
                       std::span<const Request> requests, std::span<Sample> samples) {
  WalkRules rules;
  rules.max_depth = settings.max_depth;
  if (lights.grid) rules.blunt = blunt;
  rules.reads_maps = true;
  const LampsSeen* lamps = lights.grid ? lights.grid->lamps.get() : nullptr;
  trace_samples({world, *lights.tables, lights.grid.get(), lamps, lights.maps.get()}, rules,
                requests, samples);
  finish_samples(lights, settings, samples);
}

Sample trace_gather(const World& world, const Lights& lights, const TransportSettings& settings,
                    const Request& request) {
  Sample sample;
  trace_many_gather(world, lights, settings, std::span(&request, 1), std::span(&sample, 1));
  return sample;
}

void prepare_gather(const World& world, std::span<const vec3> places, Lights& lights) {
  if (!lights.tables->plan.uses(TransportPart::cached_radiance)) return;
  std::vector<std::shared_ptr<const LightTables>> parts;
  if (!world.scene().lamps.empty()) parts = make_lamp_tables(*lights.tables, world.scene());
  lights.grid = make_radiance_grid({world, *lights.tables}, places, {}, parts);
}

}  // namespace wellspring
