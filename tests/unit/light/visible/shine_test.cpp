// SPDX-License-Identifier: Apache-2.0
// Catch lights: what smooth gloss of what moves mirrors.
#include <gtest/gtest.h>

#include <cmath>

#include "light/kept/skin/skin_light.h"
#include "light/visible/visibility.h"
#include "scenes/scenes.h"
#include "unit/light/kept/bake_cases.h"

namespace wellspring::test {
namespace {

constexpr float radius = 0.1f;
constexpr int size = 128;
constexpr float lamp_side = 0.12f;

// A black, smooth ball that moves, and a lamp beside the eye.
struct Eyeball {
  Scene scene = scenes::empty_scene();
  std::vector<Mesh> moving;
  std::unique_ptr<World> world;
  Lights lights;
  SkinLight skin;

  void begin(float roughness) {
    Material eye = scenes::diffuse(vec3(0));
    eye.roughness = roughness;
    eye.specular = 1;
    eye.ior = 1.5f;
    moving.push_back(scenes::sphere_mesh(scenes::add_material(scene, eye), radius, 48));
    scene.objects.push_back("eye");
    world = std::make_unique<World>(scene, moving,
                                    std::vector<uint32_t>{uint32_t(scene.objects.size() - 1)});
    world->commit();
    lights = make_lights(*world);
    skin = make_skin_light(*world);
  }
  View view_from(vec3 eye) const {
    return make_view_towards(scene, dvec3(eye), dvec3(0), {0, 1, 0}, 0.25f, size, size);
  }
  // The middle of what the ball shows, weighed by its radiance; and that summed up.
  vec3 highlight(const View& view) const {
    VisibilityPass visibility(*world, lights);
    std::vector<float> radiance(size_t(size) * size, 0);
    visibility.see(view, vec2(0.5f), [&](const VisibleRun& run) {
      RunSurface surface;
      RunSkin light;
      run.describe(~uint64_t(0), surface);
      const uint64_t moves = run.light(skin, lights, surface, light);
      for (int i = 0; i < run.count; i++)
        if (moves >> i & 1)
          radiance[size_t(run.y) * size + size_t(run.x + i)] = light.shine_red[i] * light.gloss[i];
    });
    double x = 0, y = 0, all = 0;
    for (int k = 0; k < size * size; k++) {
      x += double(radiance[size_t(k)]) * (k % size + 0.5);
      y += double(radiance[size_t(k)]) * (k / size + 0.5), all += double(radiance[size_t(k)]);
    }
    return {float(x / all), float(y / all), float(all)};
  }
  // A ball mirrors the lamp there: its normal about halves the angle.
  static vec2 expected(const View& view, vec3 lamp) {
    vec3 place = normalize(view.position) * radius;
    for (int i = 0; i < 20; i++)
      place = radius * normalize(normalize(view.position - place) + normalize(lamp - place));
    const Projected at = project_point(view, place);
    return {at.x, at.y};
  }
};

constexpr vec3 lamp_place(0.7f, 0.8f, 1);

void expect_follows(const Eyeball& eye) {
  vec2 before(0);
  for (vec3 from : {vec3(0, 0, 1.2f), vec3(-0.5f, 0.1f, 1.1f)}) {
    const View view = eye.view_from(from);
    const vec3 found = eye.highlight(view);
    const vec2 wanted = Eyeball::expected(view, lamp_place);
    EXPECT_NEAR(found.x, wanted.x, 1.5f);
    EXPECT_NEAR(found.y, wanted.y, 1.5f);
    EXPECT_GT(found.z, 0);
    if (before != vec2(0)) {
      EXPECT_GT(glm::length(vec2(found) - before), 4);
    }
    before = vec2(found);
  }
}

TEST(Shine, ALampThatIsSeenGlintsWhereItIsMirrored) {
  Eyeball eye;
  const vec3 up = normalize(cross(lamp_place, vec3(1, 0, 0))),
             side = normalize(cross(up, lamp_place));
  Material lamp = scenes::emitter(vec3(50));
  lamp.double_sided = true;
  scenes::add_quad(eye.scene, lamp, lamp_place - 0.5f * lamp_side * (up + side), lamp_side * up,
                   lamp_side * side, "lamp");
  eye.begin(0.05f);
  expect_follows(eye);
}

TEST(Shine, ALampWithoutSizeGlintsToo) {
  Eyeball eye;
  eye.scene.lights.push_back(test::point_light(lamp_place, vec3(3)));
  eye.begin(0.05f);
  expect_follows(eye);
  // Its energy: a ball mirrors F r^2 / 4 of the irradiance into each direction, whatever size
  // pixels have.
  const View view = eye.view_from({0, 0, 1.2f});
  const float pixel = 2 * view.tan_half_fov / size * 1.2f;
  const float shown = eye.highlight(view).z * pixel * pixel;
  const float distance2 = dot(lamp_place, lamp_place);
  EXPECT_NEAR(shown, 0.04f * radius * radius / 4 * 3 / distance2,
              0.35f * 0.04f * radius * radius / 4 * 3 / distance2);
}

// Rougher gloss shows the light that is kept, and no lamp.
TEST(Shine, RoughGlossHasNoGlint) {
  Eyeball eye;
  eye.scene.lights.push_back(test::point_light(lamp_place, vec3(3)));
  eye.begin(0.5f);
  EXPECT_FALSE(eye.highlight(eye.view_from({0, 0, 1.2f})).z > 0);  // nothing is kept yet
}

}  // namespace
}  // namespace wellspring::test
