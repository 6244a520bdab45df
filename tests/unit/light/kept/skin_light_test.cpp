// SPDX-License-Identifier: Apache-2.0
// Light on what moves, kept at its vertices.
#include "light/kept/skin/skin_light.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>

#include "base/rng.h"
#include "unit/light/kept/skin_stage.h"
#include "unit/light/statistics.h"

namespace wellspring::test {
namespace {

vec3 eval_skin(const SkinTriangle& light, vec2 barycentric) {
  return light.corner + light.edge1 * barycentric.x + light.edge2 * barycentric.y;
}

// A lamp of some size above, so that samples are noisy.
void add_panel(Scene& scene, float radiance = 20) {
  scenes::add_quad(scene, scenes::add_material(scene, scenes::emitter(vec3(radiance))),
                   {-0.2f, 0.5f, -0.2f}, {0.4f, 0, 0}, {0, 0, 0.4f}, "panel");
}
// Light that comes by a ceiling alone, by chance.
void add_ceiling(Scene& scene) {
  scenes::add_quad(scene, scenes::add_material(scene, scenes::emitter(vec3(100))),
                   {0.4f, 0.4f, 0.1f}, {0.1f, 0, 0}, {0, 0, -0.1f}, "lamp");
  scenes::add_quad(scene, scenes::add_material(scene, scenes::diffuse(vec3(0.8f))), {-1, 0.6f, -1},
                   {2, 0, 0}, {0, 0, 2}, "ceiling");
}
// Returns the ball's light after very many samples.
std::vector<vec3> converged(SkinStage& stage) {
  SkinLight kept = stage.skin;
  std::vector<dvec3> sum(stage.skin.places.size(), dvec3(0));
  constexpr int rounds = 48;
  for (int i = 0; i < rounds; i++) {
    stage.skin = make_skin_light(*stage.world);
    stage.update.seed = 1000 + uint64_t(i);
    stage.look(16 * int(sum.size()), 1, 0);
    for (size_t p = 0; p < sum.size(); p++) {
      const SkinHistory& h = stage.skin.history[p];
      sum[p] += dvec3(h.older.mean) / double(rounds);
    }
  }
  stage.skin = kept;
  stage.update.seed = 1;
  return {sum.begin(), sum.end()};
}
double rms_error(const SkinLight& skin, const std::vector<vec3>& truth, bool smoothed) {
  double squares = 0, whole = 0;
  for (size_t i = 0; i < truth.size(); i++) {
    vec3 light = smoothed ? vec3(skin.light[i]) : skin.history[i].newer.mean;
    double error = double(luminance(light - truth[i])), level = double(luminance(truth[i]));
    squares += error * error, whole += level * level;
  }
  return std::sqrt(squares / whole);
}

TEST(SkinLight, WhiteFurnace) {
  SkinStage stage = make_sphere_stage();
  stage.scene.environment.radiance = vec3(1, 0.5f, 0.25f);
  stage.begin();
  stage.look(4 * int(stage.skin.places.size()), 8);
  for (const vec4& light : stage.skin.light) {
    // Rays of a smooth normal that a flat triangle cuts off are all that is lost.
    EXPECT_NEAR(light.x, 1, 0.01f);
    EXPECT_NEAR(light.y, 0.5f, 0.005f);
    EXPECT_NEAR(light.z, 0.25f, 0.003f);
  }
}

// A panel's light has chance in it: its mean over independent seeds is the integral's.
TEST(SkinLight, HasNoBiasUnderALampOfSomeSize) {
  SkinStage stage;
  stage.moving.emplace_back();
  stage.moving[0].material = stage.add_lambert();
  scenes::append_quad(stage.moving[0], {-0.02f, 0, 0.02f}, {0.04f, 0, 0}, {0, 0, -0.04f});
  Scene lamp = scenes::make_plane_with_rect_light(3);  // as its formula wants it
  stage.scene.materials.push_back(scenes::emitter(vec3(3)));
  scenes::add_quad(stage.scene, int(stage.scene.materials.size()) - 1, {-0.5f, 1, -0.5f},
                   {1.5f, 0, 0}, {0, 0, 1}, "light");
  stage.begin();
  test::Mean mean;
  for (int i = 0; i < 400; i++) {
    stage.update.seed = mix64(uint64_t(i));
    stage.skin = make_skin_light(*stage.world);
    stage.look(4, 1, 0);
    for (const SkinHistory& h : stage.skin.history) mean.add(double(h.newer.mean.x));
  }
  // The square is so small that its middle stands for all of it.
  test::expect_mean(mean, scenes::rect_light_irradiance({0, 0, 0}, 3) / double(pi), "under a lamp");
}

TEST(SkinLight, CosineUnderASun) {
  SkinStage stage = make_sphere_stage();
  stage.scene.lights.push_back(make_sun());
  stage.begin();
  stage.look(4 * int(stage.skin.places.size()), 8);
  int lit = 0, dark = 0;
  for (uint32_t v = 0; v < uint32_t(stage.moving[0].positions.size()); v++) {
    float cosine = stage.normal_at(v).y;
    if (std::abs(cosine) < 0.2f) continue;  // such a place is partly in the shadow
    EXPECT_NEAR(stage.light_at(v).x, std::max(cosine, 0.0f), 0.02f);
    (cosine > 0 ? lit : dark)++;
  }
  EXPECT_GT(lit, 100);
  EXPECT_GT(dark, 100);
}

TEST(SkinLight, FollowsTheMeshThatMoves) {
  SkinStage stage = make_sphere_stage();
  add_panel(stage.scene);
  stage.begin();
  stage.look(int(stage.skin.places.size()), 16);
  std::vector<vec4> before = stage.skin.light;
  std::vector<vec3> positions = stage.moving[0].positions;
  for (vec3& p : positions) p += vec3(0.01f, 0, 0.02f);
  stage.world->move(0, positions, stage.moving[0].normals);
  stage.world->commit();
  // Nothing is sampled: what is known goes along.
  smooth_skin(*stage.world, stage.skin, 0);
  uvec3 t = stage.moving[0].triangles[100];
  SkinTriangle light = find_skin(stage.skin, stage.skin.first_instance, t, false);
  EXPECT_EQ(eval_skin(light, {0, 0}), vec3(before[stage.place_of(t.x)]));
  EXPECT_NEAR(eval_skin(light, {1, 0}).x, before[stage.place_of(t.y)].x, 1e-5f);
  EXPECT_NEAR(eval_skin(light, {0, 1}).x, before[stage.place_of(t.z)].x, 1e-5f);
  vec3 third = (vec3(before[stage.place_of(t.x)]) + vec3(before[stage.place_of(t.y)]) +
                vec3(before[stage.place_of(t.z)])) /
               3.0f;
  EXPECT_NEAR(eval_skin(light, vec2(1 / 3.0f)).x, third.x, 1e-4f);
}

TEST(SkinLight, OneSampleAPlaceIsCalmOnceSmoothed) {
  SkinStage stage = make_sphere_stage(0.08f);
  stage.scene.environment.radiance = vec3(0.05f);
  add_ceiling(stage.scene);
  stage.begin();
  std::vector<vec3> truth = converged(stage);
  stage.look(int(stage.skin.places.size()));
  double raw = rms_error(stage.skin, truth, false), smooth = rms_error(stage.skin, truth, true);
  EXPECT_GT(raw, 0.2);
  EXPECT_LT(smooth, 0.5 * raw);
  // With more samples it converges.
  stage.look(int(stage.skin.places.size()), 24);
  EXPECT_LT(rms_error(stage.skin, truth, true), 0.6 * smooth);
}

TEST(SkinLight, VerticesAtOnePositionShareLight) {
  SkinStage stage = make_sphere_stage();
  add_panel(stage.scene);
  stage.begin();
  stage.look(int(stage.skin.places.size()), 2);
  const uint32_t across = 2 * sphere_rings + 1;
  for (uint32_t y = 0; y <= uint32_t(sphere_rings); y++)
    EXPECT_EQ(stage.place_of(y * across), stage.place_of(y * across + across - 1)) << y;
  EXPECT_EQ(stage.place_of(0), stage.place_of(1));  // the pole
  EXPECT_LT(stage.skin.places.size(), stage.moving[0].positions.size());
  // A box's corners do not: its sides face elsewhere.
  SkinStage box;
  box.moving.push_back(scenes::box_mesh(box.add_lambert(), vec3(0.1f)));
  box.begin();
  EXPECT_EQ(box.skin.places.size(), 24u);
}

TEST(SkinLight, TwoSidesOfAThinThingAreLitEachByItself) {
  SkinStage stage;
  stage.moving.emplace_back();
  stage.moving[0].material = stage.add_lambert(true);
  scenes::append_quad(stage.moving[0], {-0.1f, 0, 0.1f}, {0.2f, 0, 0}, {0, 0, -0.2f});
  stage.scene.lights.push_back(make_sun());
  stage.begin();
  EXPECT_EQ(stage.skin.places.size(), 8u);
  stage.look(64, 4);
  uvec3 t = stage.moving[0].triangles[0];
  EXPECT_NEAR(eval_skin(find_skin(stage.skin, 0, t, false), vec2(0.3f)).x, 1, 1e-3f);
  EXPECT_NEAR(eval_skin(find_skin(stage.skin, 0, t, true), vec2(0.3f)).x, 0, 1e-3f);
}

TEST(SkinLight, HiddenVerticesDoNotDarkenVisibleOnes) {
  // A strip that runs under a cover a millimetre above it.
  SkinStage stage;
  stage.moving.resize(2);
  stage.moving[0].material = stage.moving[1].material = stage.add_lambert();
  constexpr int columns = 20;
  Mesh& strip = stage.moving[0];
  for (int x = 0; x <= columns; x++)
    for (float z : {0.05f, -0.05f}) {
      strip.positions.push_back({0.02f * float(x), 0, z});
      strip.normals.push_back({0, 1, 0});
    }
  for (uint32_t x = 0; x < columns; x++) {
    strip.triangles.push_back({2 * x, 2 * x + 2, 2 * x + 3});
    strip.triangles.push_back({2 * x, 2 * x + 3, 2 * x + 1});
  }
  scenes::append_quad(stage.moving[1], {0.211f, 0.001f, 0.2f}, {0.4f, 0, 0}, {0, 0, -0.4f});
  stage.scene.environment.radiance = vec3(1);
  stage.begin();
  stage.look(4 * int(stage.skin.places.size()), 30);
  for (uint32_t v = 0; v < uint32_t(strip.positions.size()); v++) {
    // The nearest under the cover is as light as its edge, where half of the sky is seen, at least;
    // the rest nobody sees.
    if (strip.positions[v].x < 0.21f) {
      EXPECT_NEAR(stage.light_at(v).x, 1, 0.03f) << v;
    } else if (strip.positions[v].x < 0.23f) {
      EXPECT_GT(stage.light_at(v).x, 0.45f) << v;
    }
  }
}

TEST(SkinLight, SwitchedLightIsFollowed) {
  SkinStage stage = make_sphere_stage();
  add_panel(stage.scene);
  stage.begin();
  const int places = int(stage.skin.places.size());
  stage.look(places, 40);
  const uint32_t top = stage.place_of(5 * (2 * sphere_rings + 1));
  auto light = [&] { return stage.skin.light[top].x; };
  const float bright = light();
  // Nobody says that it changed: three in four of its light are gone.
  Scene dimmed = stage.scene;
  dimmed.materials.back().emission *= 0.25f;
  World dim(dimmed, stage.moving, {1});
  dim.commit();
  Lights dim_lights = make_lights(dim);
  stage.update.samples = places;
  for (int i = 0; i < 20; i++) {
    update_skin(dim, dim_lights, stage.update, stage.skin);
    smooth_skin(dim, stage.skin);
  }
  EXPECT_NEAR(light(), 0.25f * bright, 0.08f * bright);
  // A switch that is told of shows at once, and the rest soon.
  auto brighter = [](vec3, vec3, vec3& kept, vec3&) {
    kept = vec3(4);
    return true;
  };
  const float before = light();
  relight_skin(dim, brighter, stage.skin);
  EXPECT_FLOAT_EQ(light(), 4 * before);
  stage.look(places, 3);
  EXPECT_NEAR(light(), bright, 0.15f * bright);
}

TEST(SkinLight, NoiseAloneIsNoChange) {
  SkinStage stage = make_sphere_stage();
  add_panel(stage.scene);
  stage.begin();
  const int places = int(stage.skin.places.size());
  stage.look(places, 16);  // two windows: every place has older samples from now on
  int dropped = 0, looks = 60;
  for (int i = 0; i < looks; i++) {
    stage.look(places);
    for (const SkinHistory& h : stage.skin.history) dropped += h.older.count == 0;
  }
  // Four standard errors are passed by 6 in 100,000 where differences are normal; few samples have
  // heavier tails. A dropped place stays so for a window.
  EXPECT_LT(dropped, 0.005 * looks * places);
}

TEST(SkinLight, SamplesGoWhereNoneWereAndThenToAllInTurn) {
  SkinStage stage = make_sphere_stage();
  add_panel(stage.scene);
  stage.begin();
  const size_t places = stage.skin.places.size();
  EXPECT_EQ(stage.look(100, int(places / 100)), int(places / 100) * 100);
  size_t unasked = 0;
  for (const SkinHistory& h : stage.skin.history) {
    EXPECT_LE(h.asked, 1u);
    unasked += h.asked == 0;
  }
  EXPECT_EQ(unasked, places % 100);
  // From above the lower half is seen seldom.
  const View view = stage.view_from({0, 3, 0});
  stage.update.views = std::span(&view, 1);
  stage.look(int(places), 16);
  double above = 0, below = 0, above_count = 0, below_count = 0;
  for (size_t i = 0; i < places; i++) {
    float y = stage.normal_at(stage.skin.places[i].vertex).y;
    if (y > 0.3f) above += stage.skin.history[i].asked, above_count++;
    if (y < -0.3f) below += stage.skin.history[i].asked, below_count++;
  }
  EXPECT_GT(above / above_count, 4 * below / below_count);
  EXPECT_GT(below / below_count, 1);
}

std::vector<vec4> run_on(size_t threads) {
  oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, threads);
  SkinStage stage = make_sphere_stage();
  stage.scene.environment.radiance = vec3(0.1f);
  add_panel(stage.scene);
  stage.begin();
  stage.look(700, 6);
  return stage.skin.light;
}
TEST(SkinLight, SameBitsForAnyNumberOfThreads) {
  std::vector<vec4> one = run_on(1), many = run_on(4);
  ASSERT_EQ(one.size(), many.size());
  EXPECT_TRUE(one == many);
}

TEST(SkinLight, OddMeshesAreLitFinitely) {
  const float nan = std::nanf(""), huge = 3e7f;
  std::vector<Mesh> odd(5);
  odd[0].positions = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};      // no area
  odd[1].positions = {{0, 0, 0}, {1, 0, 0}, {0, 0, -1}};     // one triangle
  odd[2].positions = {{nan, 0, 0}, {1, nan, 0}, {0, 0, 1}};  // nowhere
  odd[3].positions = {{huge, 0, 0}, {huge + 100, 0, 0}, {huge, 0, -100}};
  odd[4].positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};  // a line
  for (Mesh& mesh : odd) {
    mesh.normals.assign(3, vec3(0, 1, 0));
    mesh.triangles = {{0, 1, 2}};
  }
  odd[2].normals[1] = vec3(nan), odd[4].normals[0] = vec3(0);
  for (bool all : {false, true})
    for (size_t i = 0; i < odd.size(); i++) {
      SkinStage stage;
      stage.moving = all ? odd : std::vector{odd[i]};
      int material = stage.add_lambert(i % 2);
      for (Mesh& mesh : stage.moving) mesh.material = material;
      stage.scene.lights.push_back(make_sun());
      stage.scene.environment.radiance = vec3(0.5f);
      stage.begin();
      stage.look(50, 10);
      EXPECT_TRUE(stage.is_finite_everywhere()) << i << all;
      EXPECT_EQ(stage.lights.bad_samples->load(), 0u) << i << all;
      // Then they go where they should not.
      std::vector<vec3> positions = stage.moving[0].positions, normals(3, vec3(nan));
      for (vec3& p : positions) p *= 1e20f;
      stage.world->move(0, positions, normals);
      stage.world->commit();
      stage.look(50, 10);
      EXPECT_TRUE(stage.is_finite_everywhere()) << i << all;
      if (all) break;
    }
  SkinStage one;
  one.moving = {odd[1]};
  one.moving[0].material = one.add_lambert();
  one.scene.environment.radiance = vec3(0.5f);
  one.begin();
  one.look(3, 4);
  EXPECT_NEAR(one.light_at(0).x, 0.5f, 1e-4f);
}

TEST(SkinLight, NothingToDo) {
  SkinStage still;
  scenes::add_quad(still.scene, 0, {0, 0, 0}, {1, 0, 0}, {0, 0, -1});
  still.begin();
  EXPECT_EQ(still.look(100, 2), 0);
  EXPECT_TRUE(still.skin.places.empty());

  SkinStage dark = make_sphere_stage();
  dark.begin();
  EXPECT_EQ(dark.look(0), 0);
  EXPECT_EQ(dark.look(-5), 0);
  EXPECT_GT(dark.look(500, 4), 0);
  EXPECT_TRUE(dark.is_finite_everywhere());
  EXPECT_EQ(dark.light_at(5), vec3(0));

  dark.world->show(0, false);
  dark.world->commit();
  EXPECT_EQ(dark.look(500), 0);
  EXPECT_GT(memory_bytes(dark.skin), 100 * dark.skin.places.size());
  EXPECT_LT(memory_bytes(dark.skin), 400 * dark.skin.places.size());
}

// Places that were not sampled yet have the light of sampled ones, and are not black.
TEST(SkinLight, WhatIsUnknownIsNotBlack) {
  SkinStage stage;
  int lambertian = stage.add_lambert();
  stage.moving = {scenes::sphere_mesh(lambertian, 0.1f, 8),
                  scenes::sphere_mesh(lambertian, 0.1f, 8)};
  for (vec3& p : stage.moving[1].positions) p.x += 1;
  stage.scene.environment.radiance = vec3(1);
  stage.begin();
  stage.look(3);
  for (const vec4& light : stage.skin.light) EXPECT_NEAR(light.x, 1, 0.1f);
}

}  // namespace
}  // namespace wellspring::test
