// SPDX-License-Identifier: Apache-2.0
#include "light/kept/bake_file.h"

#include <gtest/gtest.h>

#include "light/kept/map_file.h"
#include "unit/folder.h"
#include "unit/light/kept/bake_cases.h"

namespace wellspring::test {
namespace {

using namespace scenes;

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

// Steps of three hundredths, and what colour adds, below a thousandth of the mean even ones.
void expect_alike(const IlluminationNodes& loaded, const IlluminationNodes& saved, float mean) {
  ASSERT_EQ(loaded.light.size(), saved.light.size());
  ASSERT_EQ(loaded.slope.size(), saved.slope.size());
  for (size_t i = 0; i < saved.light.size(); i++) {
    const vec3 a = unpack_rgb9e5(loaded.light[i]), b = unpack_rgb9e5(saved.light[i]);
    ASSERT_LT(max_component(abs(a - b)), 0.05f * max_component(b) + 1e-3f * mean) << i;
  }
  for (size_t i = 0; i < saved.slope.size(); i++) {
    if (luminance(unpack_rgb9e5(saved.light[i])) < 0.02f * mean) continue;
    ASSERT_LT(length(unpack_slope(loaded.slope[i]) - unpack_slope(saved.slope[i])), 0.2f) << i;
  }
}

TEST_F(BakeFiles, AMapIsLoadedAsItWasSaved) {
  auto map = baked.map(2);
  ASSERT_TRUE(map);
  ASSERT_TRUE(save_map(baked.world, *map, map_file, 1));
  const LoadedMap loaded = load_map(baked.world, map_file, 1);
  EXPECT_EQ(loaded.found, KeyedFile::read);
  ASSERT_TRUE(loaded.map);
  expect_alike(loaded.map->nodes, map->nodes, map->mean);
  ASSERT_EQ(loaded.map->layers->size(), map->layers->size());
  for (size_t l = 0; l < map->layers->size(); l++)
    expect_alike((*loaded.map->layers)[l], (*map->layers)[l], map->mean);
  EXPECT_EQ(loaded.map->error, map->error);
  EXPECT_NEAR(loaded.map->mean, map->mean, 0.01f * map->mean);
  EXPECT_EQ(loaded.map->places->chart_of, map->places->chart_of);
  EXPECT_EQ(loaded.map->places->first_triangle, map->places->first_triangle);
  ASSERT_EQ(loaded.map->tiles.size(), map->tiles.size());
  for (size_t t = 0; t < map->tiles.size(); t++)
    EXPECT_EQ(loaded.map->tiles[t].first, map->tiles[t].first);
}

// Saved again it is the same file: what is quantised stays.
TEST_F(BakeFiles, ALoadedMapIsSavedAsTheSameBytes) {
  ASSERT_TRUE(save_map(baked.world, *baked.map(2), map_file, 1));
  const std::string once = folder.read("square.maps");
  ASSERT_TRUE(save_map(baked.world, *load_map(baked.world, map_file, 1).map, map_file, 1));
  const LoadedMap twice = load_map(baked.world, map_file, 1);
  ASSERT_TRUE(twice.map);
  EXPECT_NEAR(double(folder.read("square.maps").size()), double(once.size()),
              0.1 * double(once.size()));
}

TEST_F(BakeFiles, DamagedMapsAreNeitherLoadedNorFatal) {
  auto load = [&] { return load_map(baked.world, map_file, 1); };
  EXPECT_EQ(load().found, KeyedFile::missing);
  ASSERT_TRUE(save_map(baked.world, *baked.map(1), map_file, 1));
  EXPECT_EQ(find_map(map_file, 1), KeyedFile::read);
  EXPECT_EQ(find_map(map_file, 2), KeyedFile::another_key);
  const std::string whole = folder.read("square.maps");
  for (size_t i = 0; i < whole.size(); i += i < 200 ? 1 : 5) {
    std::string damaged = whole;
    damaged[i] = char(damaged[i] ^ 0x41);
    folder.write("square.maps", damaged);
    ASSERT_NE(load().found, KeyedFile::read) << i;
  }
  for (size_t size = 0; size < whole.size(); size += 31) {
    folder.write("square.maps", whole.substr(0, size));
    ASSERT_FALSE(load().map) << size;
  }
  std::string noise(5000, '\0');
  for (size_t i = 0; i < noise.size(); i++) noise[i] = char(mix64(i));
  folder.write("square.maps", noise);
  EXPECT_FALSE(load().map);
}

// Anyone who makes such a file knows how its sum is made, so its content is checked, too.
TEST_F(BakeFiles, WhatAMapSaysOfItselfIsNotTrusted) {
  ASSERT_TRUE(save_map(baked.world, *baked.map(1), map_file, 1));
  std::string head = folder.read("square.maps").substr(0, 24), bytes;
  uint64_t format = 0;
  std::memcpy(&format, head.data(), sizeof format);
  ASSERT_EQ(read_keyed(map_file, format, 1, bytes), KeyedFile::read);
  for (size_t i = 0; i < bytes.size(); i += i < 160 ? 1 : 3)
    for (char change : {char(0x80), char(0xff), char(1)}) {
      std::string other = bytes;
      other[i] = char(other[i] ^ change);
      ASSERT_TRUE(write_keyed(map_file, format, 1, other));
      const LoadedMap loaded = load_map(baked.world, map_file, 1);
      if (!loaded.map) continue;
      for (uint32_t light : loaded.map->nodes.light)
        ASSERT_TRUE(is_finite(unpack_rgb9e5(light))) << i;
    }
}

// The same key, but a scene that is not the map's: nothing is looked up where nothing lies.
TEST_F(BakeFiles, MapsThatDoNotFitTheirSceneAreNotLoaded) {
  ASSERT_TRUE(save_map(baked.world, *baked.map(1), map_file, 1));
  Scene more_instances = baked.scene, more_triangles = baked.scene, more_lamps = baked.scene;
  more_instances.instances.push_back(more_instances.instances[0]);
  more_triangles.meshes[0].triangles.push_back({0, 1, 2});
  more_lamps.lamps.push_back({"other", {}, {}});
  for (const Scene& scene : {more_instances, more_triangles, more_lamps, make_cornell_box()})
    EXPECT_FALSE(load_map(World(scene), map_file, 1).map);
}

// A chair was moved: the room keeps its light, the chair has none.
TEST_F(BakeFiles, LightOfAnotherSceneServesWhereThingsStandAsTheyStood) {
  Scene scene = make_cornell_box();
  test::Baked box(scene);
  auto map = box.map(1);
  ASSERT_TRUE(map);
  ASSERT_TRUE(save_map(box.world, *map, map_file, 1));
  Scene changed = scene;
  changed.instances.back().to_world[3].x += 0.05f;
  const World world(changed);
  const LoadedMap loaded = load_map(world, map_file, 2);
  EXPECT_EQ(loaded.found, KeyedFile::another_key);
  ASSERT_TRUE(loaded.map);
  const size_t last = changed.instances.size() - 1;
  EXPECT_EQ(loaded.map->places->first_triangle[2 * last], no_chart);
  for (size_t i = 0; i < last; i++)
    EXPECT_EQ(loaded.map->places->first_triangle[2 * i], map->places->first_triangle[2 * i]) << i;
  for (size_t t = 0; t < map->tiles.size(); t++) {
    const uint32_t first = loaded.map->tiles[t].first;
    EXPECT_TRUE(first == no_tile || first == map->tiles[t].first);
  }
}

}  // namespace
}  // namespace wellspring::test
