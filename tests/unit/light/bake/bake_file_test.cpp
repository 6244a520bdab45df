// SPDX-License-Identifier: Apache-2.0
#include "light/bake/bake_file.h"

#include <gtest/gtest.h>

#include "light/bake/map_file.h"
#include "unit/folder.h"
#include "unit/light/bake/bake_cases.h"

namespace wellspring {
namespace {

using namespace scenes;
using test::same_bits;

Scene make_lit_square() {
  Scene scene = empty_scene();
  test::add_fan(scene, add_material(scene, diffuse(vec3(0.5f))), {0, 0, 0}, {1, 0, 0}, {0, 0, -1});
  scene.lights.push_back(test::point_light({0.5f, 1, -0.5f}, vec3(1)));
  scene.lamps.push_back({"bulb", {0}, {}});
  return scene;
}

struct BakeFiles : testing::Test {
  test::Folder folder;
  test::Baked baked{make_lit_square(), {.gather_nodes = 9, .direct_nodes = 16}};
  std::string file = folder.file("square.bake"), map_file = folder.file("square.maps");
  Bake again;
  KeyedFile load(uint64_t key = 1) { return load_bake(baked.world, file, key, again); }
};

TEST_F(BakeFiles, ABakeIsLoadedAsItWasSaved) {
  baked.bake.source = "content/square";
  baked.bake.settings.seed = 77;
  bake_passes(baked.lit, baked.bake, 3);
  ASSERT_TRUE(save_bake(baked.bake, file, 1));
  ASSERT_EQ(load(), KeyedFile::read);
  EXPECT_TRUE(same_bits(again, baked.bake));
  EXPECT_EQ(again.source, "content/square");
  EXPECT_EQ(read_bake_source(file), "content/square");
  EXPECT_EQ(again.settings.seed, 77u);
  EXPECT_EQ(again.settings.direct_nodes, baked.bake.settings.direct_nodes);
  EXPECT_EQ(again.settings.gather_nodes, baked.bake.settings.gather_nodes);
  EXPECT_EQ(again.shards_done, baked.bake.shards_done);
  EXPECT_EQ(again.tile, baked.bake.tile);
  EXPECT_EQ(again.places.size(), baked.bake.places.size());
  EXPECT_EQ(again.direct.supports.size(), baked.bake.direct.supports.size());
}

TEST_F(BakeFiles, NothingIsLoadedOfAnotherSceneOrNone) {
  EXPECT_EQ(load(), KeyedFile::missing);
  EXPECT_EQ(read_bake_source(file), "");
  ASSERT_TRUE(save_bake(baked.bake, file, 1));
  EXPECT_EQ(load(2), KeyedFile::another_key);
  // Another scene, whatever its key says.
  Scene scene = make_cornell_box();
  World world(scene);
  EXPECT_EQ(load_bake(world, file, 1, again), KeyedFile::damaged);
  EXPECT_EQ(again.charts.tiles, 0u);
  folder.write("square.bake", "no bake");
  EXPECT_EQ(load(), KeyedFile::damaged);
  EXPECT_EQ(read_bake_source(file), "");
}

TEST_F(BakeFiles, DamagedBakesAreNeitherLoadedNorFatal) {
  bake_passes(baked.lit, baked.bake, 1);
  ASSERT_TRUE(save_bake(baked.bake, file, 1));
  const std::string whole = folder.read("square.bake");
  for (size_t i = 0; i < whole.size(); i += i < 200 ? 1 : 5) {
    std::string damaged = whole;
    damaged[i] = char(damaged[i] ^ 0x41);
    folder.write("square.bake", damaged);
    ASSERT_NE(load(), KeyedFile::read) << i;
  }
  for (size_t size = 0; size < whole.size(); size += 31) {
    folder.write("square.bake", whole.substr(0, size));
    ASSERT_EQ(load(), KeyedFile::damaged) << size;
  }
  EXPECT_EQ(again.charts.tiles, 0u);
}

TEST_F(BakeFiles, ABakeOfNothingIsLoadedToo) {
  Scene scene = empty_scene();
  World world(scene);
  Bake nothing = begin_bake(world, {});
  ASSERT_TRUE(save_bake(nothing, file, 1));
  EXPECT_EQ(load_bake(world, file, 1, again), KeyedFile::read);
  EXPECT_EQ(again.charts.tiles, 0u);
}

TEST_F(BakeFiles, AMapIsLoadedAsItWasSaved) {
  auto map = baked.map(2);
  ASSERT_TRUE(map);
  ASSERT_TRUE(save_map(*map, map_file, 1));
  auto loaded = load_map(baked.scene, map_file, 1);
  ASSERT_TRUE(loaded);
  EXPECT_EQ(loaded->light, map->light);
  EXPECT_EQ(*loaded->layers, *map->layers);
  EXPECT_EQ(loaded->error, map->error);
  EXPECT_EQ(loaded->mean, map->mean);
  EXPECT_EQ(loaded->places->chart_of, map->places->chart_of);
  EXPECT_EQ(loaded->places->first_triangle, map->places->first_triangle);
  ASSERT_EQ(loaded->tiles.size(), map->tiles.size());
  ASSERT_EQ(loaded->places->charts.size(), map->places->charts.size());
  for (float x = 0.05f; x < 1; x += 0.1f) {
    vec3 place(x, 0, -0.3f);
    EXPECT_EQ(eval_illumination(*loaded, loaded->places->charts[0], place),
              eval_illumination(*map, map->places->charts[0], place));
  }
}

TEST_F(BakeFiles, DamagedMapsAreNeitherLoadedNorFatal) {
  EXPECT_FALSE(load_map(baked.scene, map_file, 1));
  ASSERT_TRUE(save_map(*baked.map(1), map_file, 1));
  EXPECT_FALSE(load_map(baked.scene, map_file, 2));
  EXPECT_TRUE(load_map(baked.scene, map_file, 1));
  const std::string whole = folder.read("square.maps");
  for (size_t i = 0; i < whole.size(); i += i < 200 ? 1 : 5) {
    std::string damaged = whole;
    damaged[i] = char(damaged[i] ^ 0x41);
    folder.write("square.maps", damaged);
    ASSERT_FALSE(load_map(baked.scene, map_file, 1)) << i;
  }
  for (size_t size = 0; size < whole.size(); size += 31) {
    folder.write("square.maps", whole.substr(0, size));
    ASSERT_FALSE(load_map(baked.scene, map_file, 1)) << size;
  }
}

// The same key, but a scene that is not the map's: nothing is looked up where nothing lies.
TEST_F(BakeFiles, MapsThatDoNotFitTheirSceneAreNotLoaded) {
  ASSERT_TRUE(save_map(*baked.map(1), map_file, 1));
  Scene more_instances = baked.scene, more_triangles = baked.scene, more_lamps = baked.scene;
  more_instances.instances.push_back(more_instances.instances[0]);
  more_triangles.meshes[0].triangles.push_back({0, 1, 2});
  more_lamps.lamps.push_back({"other", {}, {}});
  for (const Scene& scene : {more_instances, more_triangles, more_lamps, make_cornell_box()})
    EXPECT_FALSE(load_map(scene, map_file, 1));
}

}  // namespace
}  // namespace wellspring
