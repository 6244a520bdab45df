// SPDX-License-Identifier: Apache-2.0
#include "light/kept/charts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <tuple>

#include "unit/light/kept/bake_cases.h"

namespace wellspring::test {
namespace {

using namespace scenes;

constexpr float facing = 0.766f;  // cosine of 40 degrees

Scene scene_of(Mesh mesh, mat4 to_world = mat4(1)) {
  Scene scene = empty_scene();
  mesh.material = add_material(scene, diffuse(vec3(0.5f)));
  add_mesh(scene, std::move(mesh), "it", to_world);
  return scene;
}

vec2 place_in(const IlluminationChart& chart, vec3 place) {
  return {dot(place - chart.origin, chart.along_u), dot(place - chart.origin, chart.along_v)};
}

template <class Visit>
void for_each_corner(const World& world, const BakeCharts& charts, const Visit& visit) {
  for (size_t c = 0; c < charts.surfaces.size(); c++)
    for (uint32_t i = 0; i < charts.surfaces[c].count; i++) {
      const ChartSurface& surface = charts.surfaces[c];
      uint32_t triangle = charts.triangles[surface.first + i];
      for (vec2 corner : {vec2(0, 0), vec2(1, 0), vec2(0, 1)})
        visit(charts.places->charts[c], eval_position(world, surface.instance, triangle, corner));
    }
}

TEST(Charts, ACubeHasSix) {
  Scene scene = scene_of(box_mesh(0, vec3(2)));
  World world(scene);
  BakeCharts charts = make_charts(world, 0.5f);
  ASSERT_EQ(charts.surfaces.size(), 6u);
  for (const ChartSurface& surface : charts.surfaces) EXPECT_EQ(surface.count, 2u);
  EXPECT_NEAR(charts.area, 24, 1e-4);
  EXPECT_NEAR(charted_area(world), 24, 1e-4);
}

TEST(Charts, OfCurvedSurfacesFaceAboutOneWay) {
  for (const Mesh& mesh : {sphere_mesh(0, 1, 16), test::tube_mesh(0, 1, 2, 48)}) {
    Scene scene = scene_of(mesh);
    World world(scene);
    BakeCharts charts = make_charts(world, 0.5f);
    EXPECT_GE(charts.surfaces.size(), 4u);
    EXPECT_LE(charts.surfaces.size(), 40u);
    for (const ChartSurface& surface : charts.surfaces)
      for (uint32_t i = 0; i < surface.count; i++) {
        vec3 normal = eval_face(world, surface.instance, charts.triangles[surface.first + i]);
        ASSERT_GE(dot(normal, surface.normal), facing - 1e-4f);
      }
  }
}

TEST(Charts, EveryTriangleHasOneForEachSideItHas) {
  Scene scene = scene_of(sphere_mesh(0, 1, 8));
  Material sheet = diffuse(vec3(0.5f));
  sheet.double_sided = true;
  int both = add_material(scene, sheet);
  add_mesh(scene, test::tube_mesh(both, 1, 2, 24), "tube");
  add_mesh(scene, box_mesh(1, vec3(1)), "box", at({3, 0, 0}));
  World world(scene);
  BakeCharts charts = make_charts(world, 0.25f);
  std::map<std::tuple<uint32_t, bool, uint32_t>, uint32_t> chart_of;
  for (uint32_t c = 0; c < charts.surfaces.size(); c++) {
    const ChartSurface& surface = charts.surfaces[c];
    for (uint32_t i = 0; i < surface.count; i++) {
      uint32_t triangle = charts.triangles[surface.first + i];
      EXPECT_TRUE(chart_of.try_emplace({surface.instance, surface.back, triangle}, c).second);
    }
  }
  size_t sides = 0;
  for (uint32_t i = 0; i < scene.instances.size(); i++)
    for (uint32_t t = 0; t < world.mesh_of(i).triangles.size(); t++)
      for (bool back : {false, true}) {
        auto found = chart_of.find({i, back, t});
        bool has = !back || world.mesh_of(i).material == both;
        ASSERT_EQ(found != chart_of.end(), has);
        EXPECT_EQ(charts.places->find(i, t, !back), has ? found->second : no_chart);
        sides += has;
      }
  EXPECT_EQ(charts.triangles.size(), sides);
}

TEST(Charts, OfTwoSidesLookOppositeWays) {
  Material sheet = diffuse(vec3(0.5f));
  sheet.double_sided = true;
  Scene scene = empty_scene();
  add_quad(scene, add_material(scene, sheet), {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  World world(scene);
  BakeCharts charts = make_charts(world, 1);
  ASSERT_EQ(charts.surfaces.size(), 2u);
  const ChartSurface& front = charts.surfaces[charts.places->find(0, 0, true)];
  const ChartSurface& back = charts.surfaces[charts.places->find(0, 0, false)];
  EXPECT_FALSE(front.back);
  EXPECT_TRUE(back.back);
  EXPECT_NEAR(front.normal.z, 1, 1e-6);
  EXPECT_NEAR(back.normal.z, -1, 1e-6);
  EXPECT_NEAR(charts.area, 2, 1e-6);
}

TEST(Charts, TrianglesWithoutAreaHaveNone) {
  Mesh mesh = box_mesh(0, vec3(1));
  const uint32_t good = uint32_t(mesh.triangles.size()), first = uint32_t(mesh.positions.size());
  for (vec3 p : {vec3(0), vec3(1, 0, 0), vec3(2, 0, 0), vec3(NAN, 0, 1), vec3(0, INFINITY, 0)}) {
    mesh.positions.push_back(p);
    mesh.normals.push_back({0, 1, 0});
    mesh.uv[0].push_back(vec2(0));
  }
  mesh.triangles.push_back({first, first + 1, first + 2});  // a line
  mesh.triangles.push_back({first, first, first + 1});
  mesh.triangles.push_back({first, first, first});
  mesh.triangles.push_back({first, first + 1, first + 3});  // NaN
  mesh.triangles.push_back({first + 1, first + 4, first});  // infinite
  Scene scene = scene_of(mesh);
  scene.environment.radiance = vec3(1);
  test::Baked baked(scene, {.gather_nodes = 100, .direct_nodes = 200});
  for (uint32_t t = 0; t < mesh.triangles.size(); t++)
    EXPECT_EQ(baked.bake.charts.places->find(0, t, true) != no_chart, t < good) << t;
  EXPECT_NEAR(baked.bake.charts.area, 6, 1e-4);
  auto map = baked.map(2);
  ASSERT_TRUE(map);
  EXPECT_NEAR(map->mean, 1, 0.1);
}

TEST(Charts, WhatScattersNothingDiffuselyHasNone) {
  Material unlit = diffuse(vec3(0.5f)), black = diffuse(vec3(0)), repaints = diffuse(vec3(0.5f));
  unlit.unlit = true;
  repaints.repaints = true;
  for (const Material& material :
       {unlit, black, repaints, glass(1.5f, 0, 0), glass(1.5f, 0, 1), metal(vec3(0.9f), 0.3f)}) {
    Scene scene = empty_scene();
    add_quad(scene, add_material(scene, material), {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    World world(scene);
    BakeCharts charts = make_charts(world, 1);
    EXPECT_EQ(charts.surfaces.size(), 0u);
    EXPECT_EQ(charts.tiles, 0u);
    EXPECT_EQ(charted_area(world), 0);
    for (bool front : {true, false}) EXPECT_EQ(charts.places->find(0, 0, front), no_chart);
  }
}

TEST(Charts, LeavesAndClothHaveThemOnBothSides) {
  for (AlphaMode alpha : {AlphaMode::opaque, AlphaMode::mask, AlphaMode::blend}) {
    Material leaf = diffuse(vec3(0.5f));
    leaf.double_sided = true, leaf.alpha_mode = alpha;
    Scene scene = empty_scene();
    add_quad(scene, add_material(scene, leaf), {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    World world(scene);
    BakeCharts charts = make_charts(world, 1);
    for (bool front : {true, false})
      for (uint32_t t : {0u, 1u}) EXPECT_NE(charts.places->find(0, t, front), no_chart);
    EXPECT_NE(charts.places->find(0, 0, true), charts.places->find(0, 0, false));
  }
}

// A flat fan, one with a map of normals, a box and a tube.
TEST(Charts, SlopesAreKeptWhereNormalsDiffer) {
  Scene scene = empty_scene();
  const int plain = add_material(scene, diffuse(vec3(0.5f)));
  test::add_fan(scene, plain, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  add_mesh(scene, box_mesh(plain, vec3(1)), "box", at({3, 0, 0}));
  World flat(scene);
  EXPECT_FALSE(make_charts(flat, 0.3f).sloped);
  Material mapped = diffuse(vec3(0.5f));
  mapped.normal_texture.texture = 0;
  scene.textures.emplace_back();
  test::add_fan(scene, add_material(scene, mapped), {6, 0, 0}, {1, 0, 0}, {0, 1, 0});
  add_mesh(scene, test::tube_mesh(plain, 1, 2, 24), "tube", at({9, 0, 0}));
  World world(scene);
  BakeCharts charts = make_charts(world, 0.3f);
  EXPECT_TRUE(charts.sloped);
  for (size_t c = 0; c < charts.surfaces.size(); c++) {
    const uint32_t instance = charts.surfaces[c].instance;
    EXPECT_EQ(charts.places->charts[c].bent, instance == 3) << instance;
    EXPECT_EQ(charts.places->charts[c].sloped, instance >= 2) << instance;
  }
}

TEST(Charts, HoldTheirSurfaceAtAnyScaleAndPlace) {
  for (float scale : {1e-3f, 1.0f, 1e3f})
    for (float away : {0.0f, 1e2f, 1e4f}) {  // in the object's own size
      vec3 offset = away * scale * vec3(0.6f, -0.3f, 0.7f);
      mat4 placed = at(offset) * glm::scale(mat4(1), vec3(scale));
      for (const Mesh& mesh : {sphere_mesh(0, 1, 8), box_mesh(0, vec3(1, 2, 3))}) {
        Scene scene = scene_of(mesh, placed);
        World world(scene);
        const float tile = 0.3f * scale;
        BakeCharts charts = make_charts(world, tile);
        const float slack = 1e-3f + 4 * away * 1.2e-7f / 0.3f;
        for_each_corner(world, charts, [&](const IlluminationChart& chart, vec3 corner) {
          vec2 in = place_in(chart, corner);
          EXPECT_GE(std::min(in.x, in.y), -slack);
          EXPECT_LE(in.x, float(chart.columns) + slack);
          EXPECT_LE(in.y, float(chart.rows) + slack);
        });
        for (const IlluminationChart& chart : charts.places->charts)
          for (vec3 along : {chart.along_u, chart.along_v})
            EXPECT_LE(1 / length(along), 1.0001f * tile);
        EXPECT_NEAR(charts.area / charted_area(world), 1, 1e-6);
        EXPECT_LT(charts.tiles, 2000u);
      }
    }
}

TEST(Charts, AreAFunctionOfTheSceneAlone) {
  Scene scene = make_cornell_box();
  add_mesh(scene, sphere_mesh(1, 0.1f, 16), "ball", at({0, 0.3f, 0}));
  World world(scene), again(scene);
  BakeCharts a = make_charts(world, 0.1f), b = make_charts(again, 0.1f);
  EXPECT_EQ(a.tiles, b.tiles);
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.places->chart_of, b.places->chart_of);
  EXPECT_EQ(a.places->first_triangle, b.places->first_triangle);
  ASSERT_EQ(a.places->charts.size(), b.places->charts.size());
  for (size_t i = 0; i < a.places->charts.size(); i++) {
    const IlluminationChart &x = a.places->charts[i], &y = b.places->charts[i];
    EXPECT_EQ(x.origin, y.origin);
    EXPECT_EQ(x.along_u, y.along_u);
    EXPECT_EQ(x.along_v, y.along_v);
    EXPECT_EQ(x.first_tile, y.first_tile);
    EXPECT_EQ(x.columns, y.columns);
    EXPECT_EQ(x.rows, y.rows);
  }
}

// The frame of a picture 1 km a side, a millimetre wide; and a thread of 1000 km.
TEST(Charts, OfThinThingsTakeBoundedTiles) {
  Mesh frame;
  const float s = 500, w = 1e-3f;
  for (float r : {s, s + w})
    for (vec2 way : {vec2(-1, -1), vec2(1, -1), vec2(1, 1), vec2(-1, 1)}) {
      frame.positions.push_back(vec3(r * way, 0));
      frame.normals.push_back({0, 0, 1});
    }
  for (uint32_t i = 0; i < 4; i++) {
    frame.triangles.push_back({i, i + 4, (i + 1) % 4 + 4});
    frame.triangles.push_back({i, (i + 1) % 4 + 4, (i + 1) % 4});
  }
  Mesh thread;
  append_quad(thread, vec3(0), {1e6f, 0, 0}, {0, 1e-3f, 0});
  for (const Mesh& mesh : {frame, thread}) {
    Scene scene = scene_of(mesh);
    World world(scene);
    BakeCharts charts = make_charts(world, 1e-3f);
    ASSERT_EQ(charts.surfaces.size(), 1u);
    EXPECT_LE(charts.tiles, 1u << 21);
    EXPECT_GE(charts.tiles, 1u << 10);
  }
}

}  // namespace
}  // namespace wellspring::test
