// SPDX-License-Identifier: Apache-2.0
// Grass is shaded by what moves, and lit by lights that move.
#include <gtest/gtest.h>

#include <memory>

#include "picture/laid_view.h"
#include "scenes/build.h"
#include "unit/lawn/made.h"
#include "unit/light/kept/bake_cases.h"

namespace wellspring::test {
namespace {

using namespace scenes;

constexpr int side = 128;

// A meadow of 4 x 4 m on black ground, evenly lit, in which a pillar stands that moves.
struct Field {
  Scene scene = empty_scene();
  std::unique_ptr<World> world;
  Lights lights;
  std::unique_ptr<VisibilityPass> visibility;
  Lawn lawn;
  LawnState state;
  ShownLawn shown;
  LaidWork work;
  View view = make_view_towards(scene, {0, 4, 2.5f}, {0, 0, 0}, vec3(0, 1, 0), 0.9f, side, side);

  Field() {
    add_quad(scene, diffuse(vec3(0)), {-4, 0, 4}, {8, 0, 0}, {0, 0, -8}, "ground");
    Mesh pillar = box_mesh(add_material(scene, diffuse(vec3(0.5f))), {0.4f, 1.6f, 0.4f});
    for (vec3& p : pillar.positions) p.y += 0.8f;
    scene.objects.push_back("pillar");
    world = std::make_unique<World>(scene, std::vector<Mesh>{pillar}, std::vector<uint32_t>{2});
    lights = make_lights(*world);
    visibility = std::make_unique<VisibilityPass>(*world, lights);
    LawnDescription description = small_meadow();
    description.density = 3000;
    lawn = make_lawn(description);
    state = make_lawn_state(lawn);
    shown.lawn = &lawn, shown.state = &state;
    shown.wind.strength = 0;
    for (const LawnTile& tile : lawn.tile)
      shown.bounds.low = min(shown.bounds.low, tile.low),
      shown.bounds.high = max(shown.bounds.high, tile.high);
    light({vec3(1), vec3(0), vec3(0, 1, 0), true});
  }
  void light(const LawnLight::Node& node) {
    shown.light = std::make_shared<LawnLight>(LawnLight{{1, 1}, {node}});
  }
  void show_pillar(bool on) {
    world->show(0, on);
    world->commit();
  }
  // The mean light that is seen around a place.
  float at_place(vec3 place, const DynamicImage* dynamic = nullptr) {
    const LaidView laid(laid_things(*world, &lights, nullptr, 1, {&shown, 1}), view, vec2(0.5f),
                        false, 0, work, {}, dynamic);
    const Projected to = project_point(view, place);
    float sum = 0;
    for (int y = int(to.y) - 4; y < int(to.y) + 4; y++)
      sum += lanes_sum(laid.look(int(to.x) - 4, y, all_lanes(INFINITY)).light.y);
    return sum / 64;
  }
};

TEST(GrassShade, AFigureDarkensTheGrassAtItsFeetAndNothingFarOff) {
  Field field;
  const vec3 beside(0.35f, 0.1f, 0), far(-1.7f, 0.1f, 1.2f);
  const float shaded = field.at_place(beside), lit = field.at_place(far);
  EXPECT_GT(lit, 0);
  field.show_pillar(false);
  EXPECT_LT(shaded, 0.9f * field.at_place(beside));
  EXPECT_NEAR(lit, field.at_place(far), 0.005f * lit);
}

TEST(GrassShade, AFigureCastsItsShadowFromTheLampOfTheLawn) {
  Field field;
  const vec3 to_lamp = normalize(vec3(1, 1, 0)), behind(-0.9f, 0.1f, 0), before(0.9f, 0.1f, 0);
  field.light({vec3(0), vec3(1), to_lamp, true});
  const float shaded = field.at_place(behind), lit = field.at_place(before);
  field.show_pillar(false);
  EXPECT_LT(shaded, 0.3f * field.at_place(behind));
  EXPECT_NEAR(lit, field.at_place(before), 0.005f * lit);
  // A lamp between the pillar and the grass goes on shining there.
  field.show_pillar(true);
  field.light({vec3(0), vec3(1), to_lamp, true, 0.4f});
  EXPECT_GT(field.at_place(behind), 2 * shaded);
}

TEST(GrassShade, AMovingLampLightsItAndThePillarCastsItsShadow) {
  Field field;
  field.light({vec3(0), vec3(0), vec3(0, 1, 0), true});
  const DynamicLights torch{{point_light({1.2f, 0.8f, 0}, vec3(4)), 1, 0}};
  DynamicImage image;
  compute_dynamic_light(*field.world, field.lights, *field.visibility, field.view, torch,
                        dynamic_splat_settings(), image);
  const vec3 under(1.2f, 0.1f, 0.1f), behind(-0.8f, 0.1f, 0), free(-0.8f, 0.1f, 1.5f);
  EXPECT_EQ(field.at_place(under), 0);
  EXPECT_GT(field.at_place(under, &image), 0.02f);
  EXPECT_GT(field.at_place(free, &image), 3 * field.at_place(behind, &image));
}

TEST(GrassShade, TheSunIsInTheLawnsOwnLight) {
  Field field;
  PunctualLight sun = point_light(vec3(0), vec3(2));
  sun.type = PunctualType::directional, sun.direction = {0, -1, 0};
  DynamicImage image;
  compute_dynamic_light(*field.world, field.lights, *field.visibility, field.view,
                        DynamicLights{{sun, 1, 0}}, dynamic_splat_settings(), image);
  const vec3 place(-1.5f, 0.1f, 1);
  EXPECT_NEAR(field.at_place(place, &image), field.at_place(place), 0.05f * field.at_place(place));
}

TEST(GrassShade, AtRestTheMeanBeginsAnewWhenTheFigureHasGone) {
  Field field;
  LaidLayer layer;
  const Projected to = project_point(field.view, {0.35f, 0.1f, 0});
  auto draw = [&] {
    Frame frame;
    fit_frame(side, side, frame);
    std::fill(frame.color.begin(), frame.color.end(), vec3(0));
    std::fill(frame.depth.begin(), frame.depth.end(), INFINITY);
    layer.lay_over(laid_things(*field.world, &field.lights, nullptr, 1, {&field.shown, 1}),
                   field.view, 4, field.work, frame);
    float sum = 0;
    for (int y = int(to.y) - 4; y < int(to.y) + 4; y++)
      for (int x = int(to.x) - 4; x < int(to.x) + 4; x++)
        sum += frame.color[size_t(y) * side + size_t(x)].y;
    return sum;
  };
  const float shaded = draw();
  field.show_pillar(false);
  EXPECT_GT(draw(), 1.1f * shaded);
}

}  // namespace
}  // namespace wellspring::test
