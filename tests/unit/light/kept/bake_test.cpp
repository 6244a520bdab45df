// SPDX-License-Identifier: Apache-2.0
#include "light/kept/bake.h"

#include <gtest/gtest.h>

#include <cmath>

#include "unit/light/kept/bake_cases.h"

namespace wellspring::test {
namespace {

using namespace scenes;
using test::Baked;

vec3 mean_of(const BakeField& field, size_t node) {
  vec3 sum(0);
  for (int layer = 0; layer < field.layers; layer++) sum += field.light_of(node)[layer];
  return sum / field.count[node];
}

// Calls visit(chart, tile, node's place, light) for the nodes of a map whose tile has some surface.
template <class Visit>
void for_each_node(const Baked& baked, const IlluminationMap& map, const Visit& visit) {
  for (uint32_t t = 0; t < baked.bake.charts.tiles; t++) {
    const TilePlace& at = baked.bake.places[t];
    const IlluminationTile& tile = map.tiles[t];
    for (uint32_t i = 0; i < tile.nodes(); i++)
      visit(at.chart, t, node_place(map.places->charts[at.chart], at, tile, i),
            unpack_rgb9e5(map.nodes.light[tile.first + i]));
  }
}

// A floor of 2 x 2 m about the origin, under a point light.
constexpr vec3 bulb(0.3f, 1, -0.2f);
Scene make_lit_floor() {
  Scene scene = empty_scene();
  add_fan(scene, add_material(scene, diffuse(vec3(0.5f))), {-1, 0, 1}, {2, 0, 0}, {0, 0, -2});
  scene.lights.push_back(point_light(bulb, vec3(4, 2, 1)));
  return scene;
}

// Irradiance over pi, of intensity 1, over the floor within half a cell of the place.
double light_around(vec3 place, float half_cell) {
  double sum = 0;
  int count = 0;
  constexpr int fine = 16;
  for (int k = 0; k < fine * fine; k++) {
    vec3 p =
        place +
        half_cell * ((vec3(float(k % fine), 0, float(k / fine)) + 0.5f) * (2.0f / fine) - 1.0f);
    p.y = 0;
    if (std::abs(p.x) > 1 || std::abs(p.z) > 1) continue;
    dvec3 to = dvec3(bulb) - dvec3(p);
    sum += to.y / std::pow(dot(to, to), 1.5) / double(pi), count++;
  }
  return sum / count;
}

TEST(Bake, DirectLightOfAPointIsThatOfTheFormula) {
  Baked baked(make_lit_floor(), {.gather_nodes = 128, .direct_nodes = 600});
  bake_passes(baked.lit, baked.bake, 64);
  const BakeField& field = baked.bake.direct;
  int nodes = 0;
  for (uint32_t t = 0; t < baked.bake.charts.tiles; t++) {
    const TilePlace& at = baked.bake.places[t];
    const IlluminationChart& chart = baked.bake.charts.places->charts[at.chart];
    const IlluminationTile& tile = field.tiles[t];
    float half_cell = 0.5f / (length(chart.along_u) * float(tile.columns));
    for (uint32_t i = 0; i < tile.nodes(); i++, nodes++) {
      size_t node = tile.first + i;
      double expected = light_around(node_place(chart, at, tile, i), half_cell);
      vec3 found = mean_of(field, node);
      double error = std::sqrt(std::max(field.squares[node] / field.count[node] -
                                            luminance(found) * luminance(found),
                                        0.0f) /
                               (field.count[node] - 1)) /
                     luminance(vec3(4, 2, 1));
      // Some 500 comparisons at a thousandth: 5 standard errors.
      EXPECT_NEAR(found.x / 4, expected, 5 * error + 2e-3 * expected) << t << ", node " << i;
      EXPECT_NEAR(found.y / 2, found.x / 4, 1e-4 * expected);
      EXPECT_NEAR(found.z, found.x / 4, 1e-4 * expected);
    }
  }
  EXPECT_GT(nodes, 100);
  // Nothing is scattered to a floor that stands alone.
  for (size_t i = 0; i < baked.bake.gather.nodes(); i++)
    EXPECT_EQ(mean_of(baked.bake.gather, i), vec3(0));
}

TEST(Bake, InAFurnaceLightIsTheSameEverywhere) {
  Baked baked(make_furnace(0.5f), {.gather_nodes = 300, .direct_nodes = 300});
  auto map = baked.map(100);
  ASSERT_TRUE(map);
  EXPECT_NEAR(map->mean, 2, 0.01);
  int nodes = 0;
  // Emission that arrives, 1 with little chance, and light scattered before, 1 / (1 - 0.5) - 1.
  for_each_node(baked, *map, [&](uint32_t, uint32_t, vec3 place, vec3 light) {
    EXPECT_NEAR(light.x, 2, 0.25) << place.x << ", " << place.y << ", " << place.z;
    nodes++;
  });
  EXPECT_GT(nodes, 100);
  EXPECT_GT(map->error, 1e-4);
  EXPECT_LT(map->error, 0.05);
}

TEST(Bake, UnderAnEvenSkyAConvexThingIsLitEvenly) {
  Scene scene = empty_scene();
  add_mesh(scene, box_mesh(add_material(scene, diffuse(vec3(0.8f))), vec3(1, 2, 3)), "box");
  scene.environment.radiance = vec3(0.5f, 1, 2);
  Baked baked(scene, {.gather_nodes = 300, .direct_nodes = 300});
  auto map = baked.map(100);
  ASSERT_TRUE(map);
  vec3 mean(0);
  float nodes = 0;
  for_each_node(baked, *map, [&](uint32_t, uint32_t, vec3, vec3 light) {
    EXPECT_NEAR(light.y, 1, 0.2);
    mean += light, nodes++;
  });
  mean /= nodes;
  EXPECT_NEAR(mean.x, 0.5, 0.01);
  EXPECT_NEAR(mean.y, 1, 0.02);
  EXPECT_NEAR(mean.z, 2, 0.04);
}

// A coat darkens a surface towards who looks at it, which the map leaves out: what is left is how
// much enters the coat from where the light comes.
TEST(Bake, LightIsThatOfASurfaceWithoutACoat) {
  Scene scene = make_lit_floor();
  Baked bare(scene, {.gather_nodes = 128, .direct_nodes = 128});
  scene.materials.back() = plastic(vec3(0.5f), 0.4f);
  Baked coated(scene, {.gather_nodes = 128, .direct_nodes = 128});
  auto a = bare.map(16), b = coated.map(16);
  ASSERT_TRUE(a && b);
  EXPECT_NEAR(b->mean / a->mean, 1, 0.05);
}

TEST(Bake, WithoutLightTheMapIsBlackAndSure) {
  Scene scene = make_cornell_box();
  for (Material& m : scene.materials) m.emission = vec3(0);
  Baked baked(scene, {.gather_nodes = 200, .direct_nodes = 400});
  auto map = baked.map(2);
  ASSERT_TRUE(map);
  EXPECT_EQ(map->error, 0);
  EXPECT_EQ(map->mean, 0);
  ASSERT_GT(map->nodes.light.size(), 0u);
  for (uint32_t light : map->nodes.light) ASSERT_EQ(unpack_rgb9e5(light), vec3(0));
}

TEST(Bake, WhereNothingIsDiffuseThereIsNothingToDo) {
  for (const Material& material : {metal(vec3(0.9f), 0.3f), glass(1.5f, 0, 1)}) {
    Scene scene = empty_scene();
    add_mesh(scene, box_mesh(add_material(scene, material), vec3(1)), "box");
    scene.environment.radiance = vec3(1);
    Baked baked(scene);
    EXPECT_EQ(baked.bake.charts.tiles, 0u);
    bake_passes(baked.lit, baked.bake, 3);
    EXPECT_EQ(baked.bake.direct.nodes(), 0u);
    EXPECT_EQ(bake_error(baked.bake), 0);
    EXPECT_FALSE(finish_map(baked.bake));
    const vec3 eye(0, 0, 3);
    EXPECT_FALSE(make_bake_scene(baked.world, std::span(&eye, 1)).known);
  }
}

TEST(Bake, ThereIsNoMapBeforeTheFirstPass) {
  Baked baked(make_lit_floor(), {.gather_nodes = 128, .direct_nodes = 200});
  EXPECT_FALSE(finish_map(baked.bake));
  while (baked.bake.pilot()) {
    EXPECT_FALSE(finish_map(baked.bake));
    go_on(baked.lit, baked.bake, [] { return true; });
  }
  EXPECT_TRUE(baked.map(1));
}

// A card between the light and the floor: nodes are close at its shadow's edge, not elsewhere.
TEST(Bake, NodesAreFinerAtTheEdgeOfAShadow) {
  Scene scene = make_lit_floor();
  Material card = diffuse(vec3(0.5f));
  card.double_sided = true;
  scene.lights[0].position = {0, 1, 0};
  add_quad(scene, add_material(scene, card), {-0.25f, 0.45f, 0.25f}, {0.5f, 0, 0}, {0, 0, -0.5f});
  Baked baked(scene, {.gather_nodes = 1500, .direct_nodes = 8000});
  bake_passes(baked.lit, baked.bake, 1);
  const float edge = 0.25f / 0.55f;  // the shadow's edge, from the middle
  double at_edge = 0, edges = 0, elsewhere = 0, others = 0;
  for (uint32_t t = 0; t < baked.bake.charts.tiles; t++) {
    const TilePlace& at = baked.bake.places[t];
    if (baked.bake.charts.surfaces[at.chart].instance != 0) continue;
    const IlluminationTile one{0, 1, 1};
    const IlluminationChart& chart = baked.bake.charts.places->charts[at.chart];
    float low = 9, high = 0;  // how far from the middle, by the larger coordinate
    for (uint32_t i = 0; i < 4; i++) {
      vec3 place = node_place(chart, at, one, i);
      float away = std::max(std::abs(place.x), std::abs(place.z));
      low = std::min(low, away), high = std::max(high, away);
    }
    double cells = baked.bake.direct.tiles[t].columns;
    if (low < edge - 0.01f && high > edge + 0.01f) at_edge += cells, edges++;
    else if (low > edge + 0.1f || high < edge - 0.1f) elsewhere += cells, others++;
  }
  ASSERT_GT(edges, 4);
  ASSERT_GT(others, 4);
  EXPECT_GT(at_edge / edges, 2 * elsewhere / others);
  EXPECT_LE(baked.bake.direct.nodes(), 8000u);
}

// Walks that end on coarse light find the light that paths find, lamp by lamp.
TEST(Bake, OfCoarseLightTheLightOfPathsComes) {
  Scene scene = make_cornell_box();
  scene.lights.push_back(point_light({-0.1f, 0.3f, -0.1f}, {0.1f, 0.2f, 0.3f}));
  scene.lamps.push_back({"bulb", {0}, {}});
  const BakeSettings few{.gather_nodes = 200, .direct_nodes = 400};
  Baked paths(scene, few), cached(scene, few);
  const vec3 eye(0, 0.27f, 0.3f);
  BakeScene with_coarse = make_bake_scene(cached.world, std::span(&eye, 1));
  ASSERT_TRUE(with_coarse.known);
  bake_passes(with_coarse, cached.bake, 32);
  bake_passes(paths.lit, paths.bake, 32);
  for (int layer : {0, 1}) {
    vec3 a(0), b(0);
    for (vec3 light : layer_means(cached.bake.gather, cached.bake.gather.light, layer)) a += light;
    for (vec3 light : layer_means(paths.bake.gather, paths.bake.gather.light, layer)) b += light;
    for (int c = 0; c < 3; c++) EXPECT_NEAR(a[c] / b[c], 1, 0.04) << layer;
  }
}

Scene make_two_lamps(bool first, bool second) {
  Scene scene = make_cornell_box();
  for (Material& m : scene.materials)
    if (m.emission != vec3(0) && !first) m.emission = vec3(0);
  if (second) scene.lights.push_back(point_light({-0.1f, 0.3f, -0.1f}, {0.1f, 0.2f, 0.3f}));
  return scene;
}

TEST(Bake, LampsAddUpAndAloneAreAsIfThereWereNoOther) {
  Scene scene = make_two_lamps(true, true);
  scene.lamps.push_back({"panel", {}, {4}});
  scene.lamps.push_back({"bulb", {0}, {}});
  const BakeSettings few{.gather_nodes = 200, .direct_nodes = 400};
  Baked both(scene, few);
  auto map = both.map(48);
  ASSERT_TRUE(map);
  const auto& layers = *map->layers;
  ASSERT_EQ(layers.size(), 3u);
  for (size_t i = 0; i < map->nodes.light.size(); i++) {
    vec3 sum(0), all = unpack_rgb9e5(map->nodes.light[i]);
    for (const auto& layer : layers) sum += unpack_rgb9e5(layer.light[i]);
    ASSERT_LT(length(sum - all), 0.005f * length(all) + 1e-6f);
    EXPECT_EQ(unpack_rgb9e5(layers[0].light[i]), vec3(0));
  }
  for (int lamp : {0, 1}) {
    LampLevels on(2, 0);
    on[size_t(lamp)] = lamp_full;
    auto alone = relit(*map, find_layer_colors(scene, on));
    for (size_t i = 0; i < map->nodes.light.size(); i++) {
      vec3 layer = unpack_rgb9e5(layers[size_t(lamp) + 1].light[i]);
      ASSERT_LT(length(unpack_rgb9e5(alone->nodes.light[i]) - layer),
                0.005f * length(layer) + 1e-6f);
    }
    on[size_t(lamp)] = level_of(0.25f);
    const float dim = brightness_of(on[size_t(lamp)]);
    auto dimmed = relit(*map, find_layer_colors(scene, on));
    for (size_t i = 0; i < map->nodes.light.size(); i++) {
      vec3 layer = dim * unpack_rgb9e5(layers[size_t(lamp) + 1].light[i]);
      ASSERT_LT(length(unpack_rgb9e5(dimmed->nodes.light[i]) - layer),
                0.005f * length(layer) + 1e-6f);
    }
    Baked other(make_two_lamps(lamp == 0, lamp == 1), few);
    auto expected = other.map(48);
    // Places all over the box, but for the small lamp itself.
    double sum = 0, wanted = 0, differ = 0;
    for (uint32_t chart = 0; chart < 5; chart++)
      for (int k = 0; k < 64; k++) {
        const IlluminationChart& c = map->places->charts[chart];
        vec2 at((float(k % 8) + 0.5f) / 8, (float(k / 8) + 0.5f) / 8);
        at *= vec2(float(c.columns), float(c.rows));
        float a = luminance(eval_illumination(*alone, c, at)),
              b = luminance(eval_illumination(*expected, expected->places->charts[chart], at));
        sum += double(a), wanted += double(b), differ += std::abs(double(a - b));
      }
    EXPECT_NEAR(sum / wanted, 1, 0.05) << lamp;
    EXPECT_LT(differ / wanted, 0.2) << lamp;
  }
  const LampLevels none{0, 0};
  auto dark = relit(*map, find_layer_colors(scene, none));
  for (uint32_t light : dark->nodes.light) EXPECT_EQ(unpack_rgb9e5(light), vec3(0));
}

// Tiles that visitors look at are taken some passes ahead of the rest, and no farther.
TEST(Bake, GoesAheadWhereOneLooks) {
  Baked baked(make_lit_floor());
  const Ray down{.origin = {0.6f, 1, 0.6f}, .direction = {0, -1, 0}};
  const std::vector<Ray> rays = {down, down, {.origin = {0, 1, 0}, .direction = {0, 1, 0}}};
  const std::vector<uint32_t> tiles = find_tiles(baked.world, baked.bake, rays);
  ASSERT_EQ(tiles.size(), 1u);
  EXPECT_FALSE(go_ahead(baked.lit, baked.bake, tiles, 3)) << "not refined yet";
  bake_passes(baked.lit, baked.bake, 1);
  for (int i = 0; i < 3; i++) EXPECT_TRUE(go_ahead(baked.lit, baked.bake, tiles, 3)) << i;
  EXPECT_FALSE(go_ahead(baked.lit, baked.bake, tiles, 3));
  const uint32_t other = tiles[0] == 0 ? 1 : 0;
  EXPECT_EQ(baked.bake.gather.asked[tiles[0]], 4 * baked.bake.gather.asked[other]);
}

}  // namespace
}  // namespace wellspring::test
