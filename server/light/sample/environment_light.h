// SPDX-License-Identifier: Apache-2.0
// Holds light from infinity: its radiance by direction, and for pictures a choice of direction by
// brightness (a grid over the latitude-longitude picture, uniform in solid angle within a cell).
// The sun's disc is chosen apart, uniform in solid angle.
#pragma once
#include <functional>

#include "base/vec.h"
#include "light/random/sampler.h"
#include "light/random/warp.h"
#include "world/scene.h"

namespace wellspring::light {

// An environment light borrows the scene's image.
struct EnvironmentLight {
  vec3 radiance{0};
  const Image* image = nullptr;  // null: `radiance` from everywhere
  int columns = 0, rows = 0;     // cells of the grid; 0 for a constant environment
  AliasTable cells;
  float mean_luminance = 0;  // mean over the sphere, without the sun
  vec3 sun_direction{0, 1, 0}, sun_radiance{0};
  float sun_chord2 = 0;  // squared chord from the disc's centre to its rim
  float sun_share = 0;   // share of samples; 0: there is no sun to sample
  bool is_sampled() const { return sun_share > 0 || !cells.cells.empty(); }
};

// Makes it. `importance`: with a choice of direction; else the light is found by scattering alone.
EnvironmentLight make_environment_light(const Scene& scene, bool importance = true);

// Returns the radiance from a `direction`, which is unit.
vec3 eval_environment(const EnvironmentLight& light, vec3 direction);

struct EnvironmentSample {
  vec3 direction{0};
  float pdf = 0;  // over solid angle
};
// Draw a direction, only if is_sampled(); constant light is found by scattering, which no choice of
// ours can better.
EnvironmentSample sample_environment(const EnvironmentLight& light, vec2 u);
EnvironmentSample sample_environment(const EnvironmentLight& light, Sampler& sampler);
float sample_environment_pdf(const EnvironmentLight& light, vec3 direction);

// Tells how an emission picture's brightness is spread over a triangle: the triangle is cut into n
// * n equal ones by its barycentric weights, each with its chance by mean brightness. It is made
// only where the picture varies enough over the triangle to pay for the look-up.

struct EmissionPicture {
  int n = 0;
  AliasTable cells;  // empty: brightness varies too little
};

inline constexpr int most_emission_rows = 64;

// Makes it. `eval(barycentric)` returns the luminance there, by weights of the second and third
// corner. `texels`: number of the picture's texels on the triangle that matter. Every cell keeps a
// chance, since a few look-ups may miss a bright texel.
EmissionPicture make_emission_picture(float texels, const std::function<float(vec2)>& eval);

struct PicturePlace {
  vec2 barycentric{0};
  float density = 0;  // over the triangle, its area taken as 1
};
PicturePlace sample_emission_picture(const EmissionPicture& picture, vec2 u);
float sample_emission_picture_pdf(const EmissionPicture& picture, vec2 barycentric);

}  // namespace wellspring::light
