// SPDX-License-Identifier: Apache-2.0
// The choice among few punctual lights by what a glossy surface does with each.
#include <gtest/gtest.h>

#include "light/material/bsdf_types.h"
#include "light/sample/sample_light.h"
#include "scenes/lit_world.h"
#include "unit/light/statistics.h"

namespace wellspring::test {
namespace {

constexpr int lamp_count = 12;

// A ring of equal lamps over the origin; `only` >= 0: that one alone.
Scene ring(int only = -1) {
  Scene scene;
  scene.materials.resize(1);
  scene.objects = {""};
  for (int i = 0; i < lamp_count; i++) {
    if (only >= 0 && i != only) continue;
    PunctualLight light;
    float angle = 2 * pi * float(i) / lamp_count;
    light.position = {2 * std::cos(angle), 1, 2 * std::sin(angle)};
    light.intensity = vec3(1);
    scene.lights.push_back(light);
  }
  Mesh mesh;  // lights matter where something is lit
  mesh.positions = {{-1, 0, -1}, {0, 0, 1}, {1, 0, -1}};
  mesh.normals.assign(3, vec3(0, 1, 0));
  mesh.triangles = {{0, 1, 2}};
  scene.meshes.push_back(mesh);
  scene.instances.resize(1);
  return scene;
}

struct Floor {
  Material material;
  SurfacePlace place;
  Bsdf bsdf;
};

// Seen in the direction that mirrors the third lamp, a little beside it.
Floor glossy_floor(float roughness, float metallic) {
  Floor floor;
  floor.material.roughness = roughness;
  floor.material.metallic = metallic;
  Surface surface;
  surface.geometric_normal = surface.normal = {0, 1, 0};
  surface.base_color = vec3(0.5f);
  surface.metallic = metallic;
  surface.roughness = roughness;
  vec3 lamp = ring().lights[2].position;
  vec3 direction = -normalize(vec3(-lamp.x + 0.02f, lamp.y, -lamp.z));
  floor.bsdf = make_bsdf(surface, floor.material, direction, dielectric_albedo(1.5f));
  floor.place.geometric_normal = {0, 1, 0};
  floor.place.extent = 1;
  return floor;
}

float reflected(const Floor& floor, const LightSample& light) {
  if (!(light.pdf > 0)) return 0;
  BsdfValue value = eval_bsdf(floor.bsdf, light.direction);
  return luminance((value.diffuse + value.specular) * light.radiance);
}

Mean estimate(const Transport& transport, const Floor& floor, const LobeHint& lobe) {
  Mean mean;
  Sampler sampler(3);
  for (int i = 0; i < 20000; i++)
    mean.add(double(reflected(
        floor, sample_punctual_light(transport, floor.place, {0, 1, 0}, false, sampler, lobe))));
  return mean;
}

TEST(LightChoice, HighlightsAreFoundAndCountOnce) {
  for (float roughness : {0.15f, 0.3f, 0.6f})
    for (float metallic : {0.0f, 1.0f}) {
      Floor floor = glossy_floor(roughness, metallic);
      double exact = 0;
      for (int i = 0; i < lamp_count; i++) {
        auto [alone, world, lights] = scenes::LitWorld(ring(i));
        Sampler sampler(1);
        exact += double(reflected(floor, sample_punctual_light({world, *lights.tables}, floor.place,
                                                               {0, 1, 0}, false, sampler)));
      }
      auto [scene, world, lights] = scenes::LitWorld(ring());
      LobeHint lobe{.diffuse = luminance(floor.bsdf.diffuse),
                    .specular = metallic > 0 ? 0.5f : 1 - floor.bsdf.coat_passes,
                    .view = to_world(floor.bsdf, floor.bsdf.view),
                    .alpha = floor.bsdf.alpha};
      Mean known = estimate({world, *lights.tables}, floor, lobe);
      Mean unknown = estimate({world, *lights.tables}, floor, {});
      EXPECT_LE(std::abs(known.mean() - exact), significance_z * known.error() + 1e-5 * exact)
          << roughness << " " << metallic;
      EXPECT_LE(std::abs(unknown.mean() - exact), significance_z * unknown.error() + 1e-5 * exact)
          << roughness << " " << metallic;
      // Sharp ones gain most: there one lamp of twelve brings nearly all of the light.
      EXPECT_LT(known.error(), (roughness < 0.5f ? 0.5 : 0.9) * unknown.error())
          << roughness << " " << metallic;
    }
}

}  // namespace
}  // namespace wellspring::test
