// SPDX-License-Identifier: Apache-2.0
// Light from infinity: its radiance by direction, and for pictures a choice of direction by
// brightness (a grid over the latitude-longitude picture, uniform in solid angle within a cell).
// The sun's disc is chosen apart, uniform in solid angle.
#pragma once
#include "light/random/alias_table.h"
#include "light/random/sampler.h"
#include "world/scene.h"

namespace wellspring::light {

// Borrows the scene's image.
struct EnvironmentLight {
  vec3 radiance{0};
  const Image* image = nullptr;  // none: `radiance` from everywhere
  int columns = 0, rows = 0;     // of the grid; none for a constant environment
  AliasTable cells;
  float mean_luminance = 0;  // over the sphere, without the sun
  vec3 sun_direction{0, 1, 0}, sun_radiance{0};
  float sun_chord2 = 0;  // squared chord from the disc's centre to its rim
  float sun_share = 0;   // of samples; 0: there is no sun to sample
  bool is_sampled() const { return sun_share > 0 || !cells.cells.empty(); }
};

// `importance`: with a choice of direction; else it is found by scattering alone.
EnvironmentLight make_environment_light(const Scene& scene, bool importance = true);

// `direction` unit.
vec3 eval_environment(const EnvironmentLight& light, vec3 direction);

struct EnvironmentSample {
  vec3 direction{0};
  float pdf = 0;  // over solid angle
};
// Only where is_sampled(); constant light is found by scattering, which no choice of ours can
// better.
EnvironmentSample sample_environment(const EnvironmentLight& light, vec2 u);
EnvironmentSample sample_environment(const EnvironmentLight& light, Sampler& sampler);
float sample_environment_pdf(const EnvironmentLight& light, vec3 direction);

}  // namespace wellspring::light
