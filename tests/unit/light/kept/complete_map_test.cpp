// SPDX-License-Identifier: Apache-2.0
#include "light/kept/complete_map.h"

#include <gtest/gtest.h>

#include "light/kept/map_file.h"
#include "unit/folder.h"
#include "unit/light/kept/bake_cases.h"

namespace wellspring::test {
namespace {

using namespace scenes;

// A floor of 12 x 2 m with lamps above both of its ends.
Scene make_corridor() {
  Scene scene = empty_scene();
  add_fan(scene, add_material(scene, diffuse(vec3(0.5f))), {0, 0, 0}, {0, 0, 2}, {12, 0, 0});
  for (float x : {1.0f, 11.0f}) scene.lights.push_back(point_light({x, 2, 1}, vec3(4)));
  return scene;
}

BakeSettings small() {
  BakeSettings settings;
  settings.gather_nodes = 600, settings.direct_nodes = 2000;
  return settings;
}

// Bakes the corridor, puts a screen at its beginning, and adds that to the map.
struct Added {
  Folder folder;
  const std::string file = folder.file("corridor.maps");
  Scene before = make_corridor(), after = before;
  std::unique_ptr<World> world;
  LoadedMap known;
  Bake bake;
  std::vector<char> is_new;
  std::shared_ptr<const IlluminationMap> fresh, whole;

  Added() {
    const World old(before);
    Bake first = begin_bake(old, std::vector{vec3(6, 1.6f, 1)}, small());
    bake_passes(make_bake_scene(old, {}), first, 4);
    EXPECT_TRUE(save_map(old, *finish_map(first), file, 1));
    add_fan(after, add_material(after, diffuse(vec3(0.7f))), {0.5f, 0, 0.5f}, {0, 0, 1}, {0, 1, 0});
    world = std::make_unique<World>(after);
    known = load_map(*world, file, 2);
    BakeSettings alike = small();
    alike.tile = known.map->places->tile;
    bake = begin_bake(*world, std::vector{vec3(6, 1.6f, 1)}, alike);
    bake.sampled = find_new_tiles(*world, bake, known, reach_of_neighbours);
    bake_passes(make_bake_scene(*world, {}), bake, 3);
    is_new = find_new_tiles(*world, bake, known);
    fresh = finish_map(bake);
    whole = complete_map(*world, bake, *known.map, *fresh, is_new);
  }
  uint32_t instance_of(uint32_t tile) const {
    return bake.charts.surfaces[bake.places[tile].chart].instance;
  }
};

// Returns the light of a tile's nodes.
std::vector<uint32_t> light_of(const IlluminationMap& map, uint32_t tile) {
  const IlluminationTile& t = map.tiles[tile];
  const auto first = map.nodes.light.begin() + ptrdiff_t(t.first);
  return {first, first + ptrdiff_t(t.nodes())};
}

TEST(CompleteMap, OnlyNewThingsAndTheirSurroundingsAreFoundAnew) {
  const Added added;
  ASSERT_EQ(added.known.found, KeyedFile::another_key);
  int on_floor = 0, on_screen = 0, floor = 0;
  for (uint32_t t = 0; t < added.bake.charts.tiles; t++)
    floor += added.instance_of(t) == 0 && added.bake.gather.tiles[t].first != no_tile;
  for (uint32_t t = 0; t < added.is_new.size(); t++)
    if (added.is_new[t]) (added.instance_of(t) == 0 ? on_floor : on_screen)++;
  EXPECT_GT(on_screen, 0);
  EXPECT_GT(on_floor, 0);
  EXPECT_LT(on_floor, floor / 2) << "the corridor's other end lies far away";
}

TEST(CompleteMap, TilesFarAwayAreNotSampled) {
  const Added added;
  for (uint32_t t = 0; t < added.is_new.size(); t++) {
    const bool sampled = added.bake.gather.asked[t] > 0;
    EXPECT_EQ(sampled, added.bake.sampled[t] != 0) << t;
    EXPECT_TRUE(!added.is_new[t] || sampled) << t;
  }
}

TEST(CompleteMap, EachTileHasTheLightOfOneOfBothMaps) {
  const Added added;
  const std::vector<char>& is_new = added.is_new;
  int kept = 0, found = 0;
  for (uint32_t t = 0; t < is_new.size(); t++) {
    if (added.whole->tiles[t].first == no_tile) continue;
    const IlluminationMap& from = is_new[t] ? *added.fresh : *added.known.map;
    ASSERT_EQ(light_of(*added.whole, t), light_of(from, t)) << t;
    (is_new[t] ? found : kept)++;
  }
  EXPECT_GT(kept, 0);
  EXPECT_GT(found, 0);
  EXPECT_EQ(added.whole->error, added.known.map->error);
}

TEST(CompleteMap, TheResultIsAMapOfItsScene) {
  const Added added;
  ASSERT_TRUE(save_map(*added.world, *added.whole, added.file, 2));
  const LoadedMap loaded = load_map(*added.world, added.file, 2);
  EXPECT_EQ(loaded.found, KeyedFile::read);
  ASSERT_TRUE(loaded.map);
  for (uint32_t t = 0; t < added.bake.charts.tiles; t++)
    EXPECT_EQ(loaded.map->tiles[t].nodes() > 0, added.bake.gather.tiles[t].first != no_tile) << t;
}

}  // namespace
}  // namespace wellspring::test
