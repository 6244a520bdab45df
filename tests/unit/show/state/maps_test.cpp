// SPDX-License-Identifier: Apache-2.0
// Illumination maps of a running exhibit: where they come from, and what lamps make of them.
#include <gtest/gtest.h>

#include "light/kept/map_file.h"
#include "show/http/answer.h"
#include "show/state/lamps.h"
#include "show/state/visitor_picture.h"
#include "unit/folder.h"
#include "unit/light/kept/bake_cases.h"
#include "unit/show/show_stage.h"
#include "scenes/scenes.h"
#include "world/load/lamp.h"

namespace wellspring::test {
namespace {

vec3 daylight(vec3) { return {0.25f, 0.5f, 0.75f}; }
vec3 lamplight(vec3 place) { return vec3(1 + 0.1f * place.y); }

struct Maps : testing::Test, ShowStage {
  test::Folder folder;
  Exhibit exhibit = make_tiny_exhibit();
  std::shared_ptr<const IlluminationMap> saved;

  void add_switch(bool on) {
    add_lamp({"ceiling", {"light"}, {}}, exhibit.scene);
    exhibit.lamps = {{"ceiling", {{"en", "Ceiling"}}, on}};
  }
  // Keeps a map for the next start.
  void keep_map(std::vector<test::PaintedLight> layers = {daylight}) {
    World world(exhibit.scene);
    saved = test::paint_map(world, 0.5f, layers);
    const std::string file = folder.file("tiny.maps");
    ASSERT_TRUE(save_map(world, *saved, file, hash_scene(exhibit.scene)));
    saved = load_map(world, file, hash_scene(exhibit.scene)).map;
    ASSERT_TRUE(saved);
  }
  // Opens a show that draws by paths, which need no preparation.
  void open(Display display = Display::automatic, const std::string& technique = "path") {
    ShowSettings settings = settings_for(technique);
    settings.cache = folder.path.string();
    settings.display = display;
    settings.bakes = false;
    begin(std::move(exhibit), settings);
  }
  bool says(const char* line) {
    return write_metrics(make_report(*show)).find(line) != std::string::npos;
  }
};

TEST_F(Maps, KeptOnesAreUsedFromTheStart) {
  keep_map();
  add_storyteller(exhibit, "guide", {0, 0, 2});  // whose materials and pictures make no difference
  open();
  ASSERT_TRUE(show->stage.lights.maps);
  EXPECT_EQ(show->stage.lights.maps->nodes.light, saved->nodes.light);
  EXPECT_FALSE(show->stage.baker) << "nothing is baked";
  ASSERT_GT(show->stage.mapped.size(), 2u);
  EXPECT_TRUE(show->stage.mapped[1]);
  EXPECT_TRUE(says("wellspring_display{method=\"maps\"} 1\n"));
  EXPECT_TRUE(says("wellspring_display{method=\"points\"} 0\n"));
}

// The first picture is lit everywhere.
TEST_F(Maps, LightTheFirstPicture) {
  keep_map();
  open();
  join(96, 64);
  ASSERT_TRUE(step_until([&] { return !pictures().empty(); }));
  Image8 first = image(0);
  int dark = 0;
  for (size_t i = 0; i < first.rgb.size(); i += 3)
    dark += first.rgb[i] + first.rgb[i + 1] + first.rgb[i + 2] < 60;
  EXPECT_LT(dark, 96 * 64 / 100);
}

TEST_F(Maps, WithoutAnyFileCoarseLightIsThereFromTheStart) {
  begin(std::move(exhibit), settings_for("gather"));
  ASSERT_TRUE(show->stage.lights.maps);
  EXPECT_EQ(show->stage.lights.maps, show->stage.lights.known);
  EXPECT_EQ(show->stage.lights.maps->error, 1) << "nobody knows how good it is";
  EXPECT_GT(show->stage.lights.maps->mean, 0.01f);
}

// Things stand where they stood, only a colour is another: better than nothing.
TEST_F(Maps, ThoseOfAnotherSceneServeUntilThereAreBetterOnes) {
  keep_map();
  exhibit.scene.materials[0].base_color.x = 0.5f;
  open();
  ASSERT_TRUE(show->stage.lights.maps);
  EXPECT_EQ(show->stage.lights.maps->nodes.light, saved->nodes.light);
}

TEST_F(Maps, ThePackagesOwnServeWithoutACache) {
  keep_map();
  exhibit.folder = folder.path.string();
  std::filesystem::rename(folder.file("tiny.maps"), shipped_light(exhibit.folder));
  begin(std::move(exhibit), settings_for("path"));
  ASSERT_TRUE(show->stage.lights.maps);
  EXPECT_EQ(show->stage.lights.maps->nodes.light, saved->nodes.light);
  EXPECT_TRUE(says("wellspring_display{method=\"maps\"} 1\n"));
}

TEST_F(Maps, OfTwoTheBetterIsShown) {
  for (float cached : {0.005f, 0.02f}) {
    exhibit = make_tiny_exhibit();
    keep_map();
    exhibit.folder = folder.path.string();
    const World world(exhibit.scene);
    IlluminationMap other = *test::paint_map(world, 0.5f, {lamplight});
    other.error = cached;  // paint_map() says 0.01
    const uint64_t key = hash_scene(exhibit.scene);
    std::filesystem::rename(folder.file("tiny.maps"), shipped_light(exhibit.folder));
    ASSERT_TRUE(save_map(world, other, folder.file("tiny.maps"), key));
    open();
    ASSERT_TRUE(show->stage.lights.maps);
    EXPECT_EQ(show->stage.lights.maps->nodes.light == saved->nodes.light, cached > 0.01f) << cached;
  }
}

TEST_F(Maps, DamagedOnesAreNotUsed) {
  keep_map();
  std::string bytes = folder.read("tiny.maps");
  bytes[bytes.size() / 2] ^= 1;
  folder.write("tiny.maps", bytes);
  open();
  EXPECT_FALSE(show->stage.lights.maps);
}

// The render cache as published, not shapes in its light.
TEST_F(Maps, WhoWantsPointsGetsThem) {
  keep_map();
  open(Display::points, "gather");
  EXPECT_FALSE(show->stage.lights.maps);
  EXPECT_TRUE(show->stage.lights.known) << "on which walks end";
  EXPECT_FALSE(show->stage.baker);
  join(96, 64);
  ASSERT_TRUE(step_until([&] { return !pictures().empty(); }));
  Frame points;
  visitor().picture->cache.reconstruct(visitor().picture->job.view, points);
  Image8 wanted, shown = image(pictures().size() - 1);
  tonemap(points, Tonemap{show->stage.exhibit.exposure}, wanted);
  ASSERT_EQ(shown.rgb.size(), wanted.rgb.size());
  double difference = 0, light = 0;
  for (size_t i = 0; i < shown.rgb.size(); i++) {
    difference += std::abs(int(shown.rgb[i]) - int(wanted.rgb[i]));
    light += wanted.rgb[i];
  }
  EXPECT_GT(light / double(shown.rgb.size()), 20);
  EXPECT_LT(difference / double(shown.rgb.size()), 8) << "but for JPEG's";
}

TEST_F(Maps, TechniquesThatKnowNothingOfThemGetNone) {
  keep_map();
  open(Display::maps, "direct");
  EXPECT_FALSE(show->stage.lights.maps);
}

TEST_F(Maps, WithoutACacheThereAreNone) {
  keep_map();
  ShowSettings settings = settings_for("path");
  begin(std::move(exhibit), settings);
  EXPECT_FALSE(show->stage.lights.maps);
  EXPECT_FALSE(show->stage.baker);
}

TEST_F(Maps, FollowTheLampsAtOnce) {
  add_switch(true);
  keep_map({daylight, lamplight});
  open();
  join(96, 64);
  run(0.5);
  ASSERT_TRUE(show->stage.lights.maps);
  const auto& layers = *saved->layers;
  auto expect = [&](bool lamp) {
    const std::vector<uint32_t>& light = show->stage.lights.maps->nodes.light;
    ASSERT_EQ(light.size(), layers[0].light.size());
    for (size_t i = 0; i < light.size(); i++) {
      vec3 wanted = unpack_rgb9e5(layers[0].light[i]);
      if (lamp) wanted += unpack_rgb9e5(layers[1].light[i]);
      ASSERT_LT(length(unpack_rgb9e5(light[i]) - wanted), 0.005f * length(wanted));
    }
  };
  expect(true);
  for (bool on : {false, true}) {
    light_world(show->stage, {LampLevel(on ? lamp_full : 0)});
    expect(on);
  }
  // A visitor's order switches a lamp, too.
  say(R"({"type":"lamp","name":"ceiling","on":false})");
  ASSERT_TRUE(step_until([&] { return show->stage.world->lamp_levels()[0] == 0; }));
  expect(false);
}

TEST_F(Maps, OfLampsThatAreOffAtFirstAreDark) {
  add_switch(false);
  keep_map({daylight, lamplight});
  open();
  ASSERT_TRUE(show->stage.lights.maps);
  for (size_t i = 0; i < saved->nodes.light.size(); i++) {
    vec3 light = unpack_rgb9e5(show->stage.lights.maps->nodes.light[i]);
    ASSERT_LT(length(light - daylight({})), 0.02f);
  }
}

// New ones come while it runs: caches begin anew once, when light begins to count in their units.
TEST_F(Maps, AreTakenOverWhileItRuns) {
  keep_map();
  folder.write("tiny.maps", "");
  open();
  join(96, 64);
  run(0.5);
  ASSERT_FALSE(show->stage.lights.maps);
  ASSERT_GT(visitor().picture->cache.stats().points, 100);
  use_maps(show->stage, show->visits, saved);
  EXPECT_EQ(show->stage.lights.maps, saved);
  EXPECT_TRUE(says("wellspring_display{method=\"maps\"} 1\n"));
  run(0.5);
  EXPECT_EQ(make_report(*show).bad_samples, 0u);
  EXPECT_GT(visitor().picture->cache.stats().points, 100);
}

// A visitor who stands still sees better light fade in.
TEST_F(Maps, BetterOnesFadeIn) {
  keep_map();
  ShowSettings settings = settings_for("path");
  settings.cache = folder.path.string();
  settings.bakes = false;
  begin(std::move(exhibit), settings);
  join(96, 64);
  ASSERT_TRUE(step_until([&] { return !visitor().picture->keyframe.empty(); }));
  ASSERT_TRUE(step_until([&] { return visitor().picture->fade.from.rgb.empty(); }));
  World world(show->stage.exhibit.scene);
  use_better_maps(show->stage, show->visits, test::paint_map(world, 0.5f, {lamplight}));
  EXPECT_EQ(show->stage.lights.known, show->stage.lights.maps);
  ASSERT_TRUE(step_until([&] { return !visitor().picture->fade.from.rgb.empty(); }));
}

// A ball of bronze before the visitor of the first viewpoint.
void add_bronze(Exhibit& exhibit) {
  exhibit.scene.materials.push_back({.metallic = 1, .roughness = 0.1f});
  Mesh ball = scenes::sphere_mesh(int(exhibit.scene.materials.size()) - 1, 0.5f);
  for (vec3& p : ball.positions) p += vec3(-2, 1.4f, 1);
  exhibit.scene.meshes.push_back(ball);
  exhibit.scene.objects.push_back("ball");
  exhibit.scene.instances.push_back({2, mat4(1), 3});
}

TEST_F(Maps, WhatShinesIsNotKnown) {
  add_bronze(exhibit);
  keep_map();
  open();
  ASSERT_EQ(show->stage.known.size(), 4u);
  EXPECT_EQ(show->stage.known[3], 0);
  EXPECT_EQ(show->stage.known[1], 1);
}

}  // namespace
}  // namespace wellspring::test
