// SPDX-License-Identifier: Apache-2.0
// Light where it starts: places on what emits, and rays that leave it, chosen by power. The other
// way round from sample_light.h, which starts where light arrives.
#pragma once
#include <span>

#include "light/random/sampler.h"
#include "light/sample/environment_light.h"
#include "light/sample/light_tables.h"
#include "world/surface.h"

namespace wellspring::light {

struct LightTables;
struct Transport;

// `power` of each triangle and of each punctual light of `tables`.
EmissionChoice make_emission_choice(const LightTables& tables, std::span<const float> emitter_power,
                                    std::span<const float> punctual_power, float environment_power,
                                    const Bounds& bounds);

// A place on an emitting triangle, and the radiance it shows on its bright side.
struct EmitterPlace {
  Surface surface;  // position, geometric normal (bright side) and extent only
  vec3 radiance{0};
  bool double_sided = false;
};
EmitterPlace eval_emitter_place(const Transport& transport, uint32_t triangle, vec2 barycentric);
// One of them, where its picture is bright if it has one; its radiance is divided by the density of
// the choice, the triangle's area taken as 1.
EmitterPlace sample_emitter_place(const Transport& transport, uint32_t triangle, vec2 u);

// A ray of light. Sums over many, each divided by their number, are the light of the scene.
struct EmittedRay {
  Ray ray;
  vec3 flux{0};                                          // zero: nothing leaves this way
  float range = std::numeric_limits<float>::infinity();  // KHR_lights_punctual: light ends here
};
EmittedRay sample_emitted_ray(const Transport& transport, Sampler& sampler);

// A direction of the sky by brightness, all around where it is the same all over.
EnvironmentSample sample_whole_sky(const EnvironmentLight& environment, vec2 u);

// Share of a punctual light's intensity left at a distance by its range (KHR_lights_punctual).
float range_window(float distance, float range);
// Radiant intensity of a punctual light towards a direction (point and spot), without its range.
vec3 eval_intensity(const LightTables& tables, size_t punctual, vec3 direction);

}  // namespace wellspring::light
