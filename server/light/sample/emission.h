// SPDX-License-Identifier: Apache-2.0
// Starts light at its sources: places on emitters, and rays that leave them, chosen by power.
// sample_light.h goes the other way round and starts where light arrives.
#pragma once
#include <span>

#include "light/random/sampler.h"
#include "light/sample/environment_light.h"
#include "light/sample/light_tables.h"
#include "world/surface.h"

namespace wellspring::light {

struct LightTables;
struct Transport;

// Takes the `power` of each triangle and of each punctual light of `tables`.
EmissionChoice make_emission_choice(const LightTables& tables, std::span<const float> emitter_power,
                                    std::span<const float> punctual_power, float environment_power,
                                    const Bounds& bounds);

// Holds a place on an emitting triangle, and the radiance it shows on its bright side.
struct EmitterPlace {
  Surface surface;  // position, geometric normal (bright side) and extent only
  vec3 radiance{0};
  bool double_sided = false;
};
EmitterPlace eval_emitter_place(const Transport& transport, uint32_t triangle, vec2 barycentric);
// Draws such a place, by brightness if the triangle has an emission picture; its radiance is
// divided by the density of the choice, the triangle's area taken as 1.
EmitterPlace sample_emitter_place(const Transport& transport, uint32_t triangle, vec2 u);

// Holds a ray of light. The sum over many, each divided by their number, is the light of the scene.
struct EmittedRay {
  Ray ray;
  vec3 flux{0};                                          // zero: nothing leaves this way
  float range = std::numeric_limits<float>::infinity();  // KHR_lights_punctual: light ends here
};
EmittedRay sample_emitted_ray(const Transport& transport, Sampler& sampler);

// Draws a direction of the sky by brightness, or uniformly if the sky is the same all over.
EnvironmentSample sample_whole_sky(const EnvironmentLight& environment, vec2 u);

// Returns the share of a punctual light's intensity left at a distance by its range
// (KHR_lights_punctual).
float range_window(float distance, float range);
// Returns the radiant intensity of a punctual light towards a direction (point and spot), without
// its range.
vec3 eval_intensity(const LightTables& tables, size_t punctual, vec3 direction);

}  // namespace wellspring::light
