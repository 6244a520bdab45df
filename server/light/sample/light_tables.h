// SPDX-License-Identifier: Apache-2.0
// Holds what make_lights() gathers from a world: the plan of what matters there, and only what that
// plan uses: every emitting triangle in world space with its chance of being picked, punctual
// lights, the environment, and the traits of each material that the shading loop needs.
#pragma once
#include <span>
#include <vector>

#include "base/simd.h"
#include "base/vec.h"
#include "light/material/spectral_tables.h"
#include "light/random/warp.h"
#include "light/sample/environment_light.h"
#include "light/sample/light_tree.h"
#include "light/sample/pane_boxes.h"
#include "light/transport_plan.h"
#include "world/scene.h"
#include "world/world.h"

namespace wellspring::light {

// Chooses the source that a ray of light leaves (light/sample/emission.h), by power.

// Sources are numbered: emitting triangles, then punctual lights, then the environment.
struct EmissionChoice {
  AliasTable rays;      // all sources, by power
  AliasTable places;    // sources that light only a share of the pixels each: see exact_punctual
  AliasTable caustics;  // sources of photons: without a sky that is the same all over
  bool exact_punctual = true;  // few punctual lights: every pixel asks each of them
  vec3 centre{0};              // centre of a sphere around the scene
  float radius = 1;
};
inline constexpr size_t most_exact_punctual = 4;

// Keeps few punctual lights side by side as vector units want them, so that the effects of all on a
// place are computed at once. glTF KHR_lights_punctual.

// Holds a spot light's fall-off: clamp((cosine - outer) * scale), squared.
struct SpotCone {
  float outer = 0, scale = 1;
};
SpotCone make_spot_cone(const PunctualLight& light);

struct FewLights {
  static constexpr int most = 16, groups = most / lane_count;
  // Position of a near light; for a distant one the direction towards it, and `near` is 0.
  Lanes x[groups], y[groups], z[groups], near[groups];
  Lanes axis_x[groups], axis_y[groups], axis_z[groups];
  Lanes outer[groups], scale[groups];  // a light that is no spot has all directions in its cone
  Lanes range2_inverse[groups];        // 0: its light reaches everywhere
  Lanes strength[groups];              // luminance; 0 beyond the last light
  bool is_near[most];
  int count = 0;  // 0: there are none, or more than `most`
};
FewLights make_few_lights(std::span<const PunctualLight> lights, std::span<const SpotCone> cones);

// Holds the lights' effects on a surface at a place, without shadows, and their sums over near and
// distant lights. The floor keeps a chance for glossy lobes at grazing angles.
struct LightEffects {
  alignas(Lanes) float effect[FewLights::most];
  float near_sum = 0, distant_sum = 0;
};
// Describes how a surface scatters light, as far as the choice among lights needs it: a Lambertian
// part and a GGX lobe of reflection. A highlight whose lamp is rarely chosen is a firefly.
struct LobeHint {
  float diffuse = 1, specular = 0;  // reflectances; specular 0: the rest is not set
  vec3 view{0};                     // towards the viewer, unit
  float alpha = 1;                  // squared perceptual roughness, > 0
};
// Computes the effects. `through`: light from behind the surface counts too.
void eval_effects(const FewLights& lights, vec3 place, vec3 normal, bool through,
                  const LobeHint& lobe, LightEffects& effects);

}  // namespace wellspring::light

namespace wellspring::world {
struct Surface;
}

namespace wellspring::light {

inline constexpr uint32_t no_emitter = 0xffffffffu;

struct EmitterTriangle {
  uint32_t instance = 0, triangle = 0;
  vec3 corner{0}, edge1{0}, edge2{0};  // world space; p = corner + b1 edge1 + b2 edge2
  vec3 normal{0, 1, 0};                // towards the side that emits light
  float area = 0, extent = 0;
  vec3 emission{0};     // emission if uniform
  bool uniform = true;  // neither texture nor alpha: emission is the same all over
  bool double_sided = false;
  int picture = -1;  // index into LightTables::pictures if its brightness varies much
};

// Encloses a part of what scatters sharply; `weight`: about the share of light that is
// scattered so.
struct CasterSphere {
  vec3 center{0};
  float radius = 0, weight = 0;
};

struct LightTables {
  TransportPlan plan;
  std::vector<EmitterTriangle> emitters;  // whole instances, in order of their triangles
  std::vector<float> emitter_power;       // power of each emitter
  std::vector<EmissionPicture> pictures;
  size_t picture_cells = 0;             // cells of all pictures together
  LightTree emitter_choice;             // by power and place
  std::vector<uint32_t> first_emitter;  // first emitter of each instance, or no_emitter
  EnvironmentLight environment;
  std::vector<PunctualLight> punctual;  // lights of any power
  std::vector<SpotCone> cones;          // cone of each punctual light
  // Index of each punctual light in the list with all lamps full
  std::vector<uint32_t> punctual_index;
  FewLights few_punctual;  // all punctual lights if they are few
  // If they are many: the near ones (point, spot) by power and place, the distant ones by power.
  LightTree near_choice, distant_choice;
  Bounds bounds;      // bounds of what stands still
  Bounds lit_bounds;  // bounds of the part of it that reflects light
  // Share of samples spent on emitters; the rest of area light is environment
  float emitter_share = 0;
  // If one light is sampled: share of emitters and environment against punctual lights
  float area_share = 1;
  EmissionChoice emission;            // for techniques that follow light from its sources
  std::vector<CasterSphere> casters;  // casters of caustics that stand still
  std::vector<MaterialTraits> materials;
  bool any_lambertian = false;  // false: no sample asks whether it may take the shortest way
  bool any_pane = false;        // false: shadow rays only ask whether anything is in between
  PaneBoxes pane_boxes;         // outside these boxes shadow rays only ask that, too
  bool any_solid = false;       // false: walks do not ask what medium they run in
  bool any_tint = false;        // false: no medium absorbs light
  SolidBounds solids;
  // Null: no walk asks for wavelengths
  std::shared_ptr<const SpectralTables> spectral;
};

// Returns the radiance a hit surface shows towards the ray: its emission, or its base colour if it
// is unlit.
vec3 surface_emission(const Surface& surface, const Material& material);

}  // namespace wellspring::light
