// SPDX-License-Identifier: Apache-2.0
// What a file says and what the scene then is: topologies, transforms, normals, cameras, lights,
// poses.
#include <cmath>

#include "unit/world/load/asset.h"
#include "world/view.h"

namespace wellspring::test {
namespace {

Asset points_asset(int mode, std::vector<uint16_t> indices) {
  Asset asset;
  int position = asset.add_floats("VEC3", 3, {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0});
  json primitive = {{"attributes", {{"POSITION", position}}}, {"mode", mode}};
  if (!indices.empty())
    primitive["indices"] =
        asset.add_accessor(asset.add_view(indices), 5123, "SCALAR", indices.size());
  asset.add_mesh(primitive);
  asset.add_node({{"mesh", 0}});
  return asset;
}

TEST(SceneLoad, StripsAndFansKeepTheWinding) {
  Scene strip = load(points_asset(5, {}));
  ASSERT_EQ(triangle_count(strip), 3u);
  for (const Mesh& mesh : strip.meshes)
    for (const vec3& n : mesh.normals) EXPECT_EQ(n, vec3(0, 0, 1));
  Scene fan = load(points_asset(6, {0, 1, 3, 2}));
  ASSERT_EQ(triangle_count(fan), 2u);
  for (const vec3& n : fan.meshes[0].normals) EXPECT_EQ(n, vec3(0, 0, 1));
  EXPECT_EQ(triangle_count(load(points_asset(4, {0, 1, 2, 2, 1, 3, 1}))), 2u);
  EXPECT_EQ(triangle_count(load(points_asset(4, {0, 1, 1, 0, 1, 2}))), 1u);  // a degenerate one
}

TEST(SceneLoad, PointsAndLinesAreNamedOnceAndSkipped) {
  for (int mode : {0, 1, 2, 3}) {
    Asset asset = points_asset(mode, {});
    asset.add_node({{"mesh", 0}});
    Scene scene = load(asset);
    EXPECT_EQ(triangle_count(scene), 0u);
    int told = 0;
    for (const std::string& warning : scene.warnings)
      told += warning.find("points and lines") != std::string::npos;
    EXPECT_EQ(told, 1);
  }
  EXPECT_EQ(refused(points_asset(7, {})).where, "/meshes/0/primitives/0/mode");
}

TEST(SceneLoad, FlatNormalsSplitVertices) {
  Asset asset;
  int position = asset.add_floats("VEC3", 3, {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1});
  int indices = asset.add_accessor(asset.add_view<uint8_t>({0, 1, 2, 0, 3, 1}), 5121, "SCALAR", 6);
  asset.add_mesh({{"attributes", {{"POSITION", position}}}, {"indices", indices}});
  asset.add_node({{"mesh", 0}});
  Mesh mesh = load(asset).meshes[0];
  ASSERT_EQ(mesh.positions.size(), 6u);
  for (int corner = 0; corner < 3; corner++) {
    EXPECT_EQ(mesh.normals[mesh.triangles[0][corner]], vec3(0, 0, 1));
    EXPECT_EQ(mesh.normals[mesh.triangles[1][corner]], vec3(0, 1, 0));
  }
}

TEST(SceneLoad, TransformsComposeDownTheTree) {
  Asset asset = triangle_asset();
  float h = std::sqrt(0.5f);
  asset.root["nodes"][0]["translation"] = {1, 0, 0};
  asset.root["nodes"][0]["scale"] = {2, 3, 4};
  asset.root["nodes"].push_back({{"children", {0}}, {"rotation", {0, 0, h, h}}});  // 90 deg about Z
  asset.root["nodes"].push_back(
      {{"children", {1}}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1}}});
  asset.root["scenes"][0]["nodes"] = {2};
  Scene scene = load(asset);
  expect_near(corner_of(scene, 0, 0, 0), vec3(0, 1, 5));
  expect_near(corner_of(scene, 0, 0, 1), vec3(0, 3, 5));
  expect_near(corner_of(scene, 0, 0, 2), vec3(-3, 1, 5));
}

TEST(SceneLoad, OneObjectPerNodeWithAMesh) {
  Asset asset = triangle_asset();
  json second = asset.root["meshes"][0]["primitives"][0];
  asset.root["meshes"][0]["primitives"].push_back(second);
  asset.root["meshes"][0]["name"] = "mesh name";
  asset.add_node({{"mesh", 0}});
  Scene scene = load(asset);
  ASSERT_EQ(scene.objects.size(), 3u);
  EXPECT_EQ(scene.objects[0], "");
  EXPECT_EQ(scene.objects[1], "triangle");
  EXPECT_EQ(scene.objects[2], "mesh name");
  ASSERT_EQ(scene.instances.size(), 4u);
  EXPECT_EQ(scene.instances[0].object, scene.instances[1].object);
  EXPECT_EQ(scene.instances[2].object, 2u);
  EXPECT_EQ(scene.meshes.size(), 2u);  // both nodes share them
}

// A millimetre at a distance of ten thousand kilometres.
TEST(SceneLoad, FarFromZeroKeepsPrecision) {
  Asset asset;
  int position = asset.add_floats("VEC3", 3, {0, 0, 0, 0.001f, 0, 0, 0, 0.001f, 0});
  asset.add_mesh({{"attributes", {{"POSITION", position}}}});
  asset.add_node({{"mesh", 0}, {"translation", {1e7 + 0.25, -2e7, 3e7}}});
  asset.add_node({{"mesh", 0}, {"translation", {1e7 + 0.252, -2e7, 3e7}}});
  asset.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}}};
  asset.add_node({{"camera", 0}, {"translation", {1e7, -2e7, 3e7}}});
  Scene scene = load(asset);
  vec3 a = corner_of(scene, 0, 0, 0), b = corner_of(scene, 1, 0, 0);
  EXPECT_NEAR(b.x - a.x, 0.002f, 1e-6f);
  EXPECT_NEAR(scene.origin.x + double(a.x), 1e7 + 0.25, 1e-6);
  EXPECT_EQ(scene.viewpoints[0].position, dvec3(1e7, -2e7, 3e7));
  EXPECT_LT(length(a), 10);
}

// Vertices themselves far from their own zero, brought back by the node.
TEST(SceneLoad, MeshesFarFromTheirOwnZero) {
  Asset asset;
  int position = asset.add_floats("VEC3", 3, {1e6f, 0, 0, 1e6f + 1, 0, 0, 1e6f, 1, 0});
  asset.add_mesh({{"attributes", {{"POSITION", position}}}});
  asset.add_node({{"mesh", 0}, {"translation", {-1e6 + 0.1, 0, 0}}});
  Scene scene = load(asset);
  EXPECT_NEAR(corner_of(scene, 0, 0, 0).x, 0.1f, 1e-6f);
  EXPECT_EQ(scene.origin, dvec3(0));
}

TEST(SceneLoad, Cameras) {
  Asset asset = triangle_asset();
  float h = std::sqrt(0.5f);
  asset.root["cameras"] = {
      {{"type", "perspective"}, {"name", "lens"}, {"perspective", {{"yfov", 0.7}, {"znear", 1}}}},
      {{"type", "orthographic"},
       {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"zfar", 9}, {"znear", 1}}}}};
  asset.add_node({{"camera", 0}, {"translation", {1, 2, 3}}});
  asset.add_node({{"camera", 0}, {"name", "left"}, {"rotation", {0, h, 0, h}}});
  asset.add_node({{"camera", 0}, {"rotation", {-h, 0, 0, h}}});
  asset.add_node({{"camera", 1}});
  Scene scene = load(asset);
  ASSERT_EQ(scene.viewpoints.size(), 4u);
  EXPECT_EQ(scene.viewpoints[0].name, "lens");
  EXPECT_EQ(scene.viewpoints[0].position, dvec3(1, 2, 3));
  EXPECT_NEAR(scene.viewpoints[0].fov, 0.7f, 1e-6f);
  EXPECT_NEAR(scene.viewpoints[0].yaw, 0, 1e-6f);
  EXPECT_EQ(scene.viewpoints[1].name, "left");
  EXPECT_NEAR(scene.viewpoints[1].yaw, pi / 2, 1e-5f);
  EXPECT_NEAR(scene.viewpoints[2].pitch, -pi / 2, 1e-3f);
  EXPECT_NEAR(scene.viewpoints[2].yaw, 0, 1e-3f);
  EXPECT_TRUE(warns_of(scene, "not perspective"));
}

// The view has the axes to which the camera's node turns them.
TEST(SceneLoad, CamerasKeepTheirRoll) {
  Asset asset = triangle_asset();
  asset.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}}};
  std::vector<quat> turns;
  for (float yaw : {0.0f, 2.0f})
    for (float pitch : {0.0f, -0.7f, 1.5f})
      for (float roll : {0.0f, 0.4f, -1.2f, 3.0f}) {
        quat q = glm::angleAxis(yaw, vec3(0, 1, 0)) * glm::angleAxis(pitch, vec3(1, 0, 0)) *
                 glm::angleAxis(roll, vec3(0, 0, 1));
        turns.push_back(q);
        asset.add_node({{"camera", 0}, {"rotation", {q.x, q.y, q.z, q.w}}, {"scale", {2, 3, 2}}});
      }
  Scene scene = load(asset);
  ASSERT_EQ(scene.viewpoints.size(), turns.size());
  for (size_t i = 0; i < turns.size(); i++) {
    View view = make_view(scene, scene.viewpoints[i], 4, 4);
    EXPECT_LT(length(view.right - turns[i] * vec3(1, 0, 0)), 1e-4f) << i;
    EXPECT_LT(length(view.up - turns[i] * vec3(0, 1, 0)), 1e-4f) << i;
    EXPECT_LT(length(view.forward - turns[i] * vec3(0, 0, -1)), 1e-4f) << i;
  }
  EXPECT_EQ(scene.viewpoints[0].roll, 0);
}

TEST(SceneLoad, PunctualLights) {
  Asset asset = triangle_asset();
  float h = std::sqrt(0.5f);
  asset.root["extensionsUsed"] = {"KHR_lights_punctual"};
  asset.root["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}, {"color", {1, 0.5, 0.25}}, {"intensity", 8}, {"range", 4}},
      {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.4}}}},
      {{"type", "directional"}, {"intensity", 3}}};
  auto light = [](int i) { return json{{"KHR_lights_punctual", {{"light", i}}}}; };
  asset.add_node({{"extensions", light(0)}, {"translation", {1, 2, 3}}, {"name", "lamp"}});
  asset.add_node({{"extensions", light(1)}, {"scale", {2, 2, 2}}});
  asset.add_node({{"extensions", light(2)}, {"rotation", {-h, 0, 0, h}}});
  Scene scene = load(asset);
  ASSERT_EQ(scene.lights.size(), 3u);
  EXPECT_EQ(scene.lights[0].type, PunctualType::point);
  EXPECT_EQ(scene.lights[0].name, "lamp");
  EXPECT_EQ(scene.lights[0].position, vec3(1, 2, 3));
  EXPECT_EQ(scene.lights[0].intensity, vec3(8, 4, 2));
  EXPECT_EQ(scene.lights[0].range, 4);
  EXPECT_EQ(scene.lights[1].type, PunctualType::spot);
  EXPECT_EQ(scene.lights[1].direction, vec3(0, 0, -1));
  EXPECT_NEAR(scene.lights[1].inner_cone, 0.2f, 1e-6f);
  EXPECT_NEAR(scene.lights[1].outer_cone, 0.4f, 1e-6f);
  EXPECT_EQ(scene.lights[2].type, PunctualType::directional);
  expect_near(scene.lights[2].direction, vec3(0, -1, 0));
  EXPECT_TRUE(has_light(scene));
  EXPECT_FALSE(has_light(load(triangle_asset())));
}

TEST(SceneLoad, MorphTargetsAtRestAndAnimated) {
  Asset asset = triangle_asset();
  int delta = asset.add_floats("VEC3", 3, {0, 0, 1, 0, 0, 1, 0, 0, 1});
  int shift = asset.add_floats("VEC3", 3, {2, 0, 0, 2, 0, 0, 2, 0, 0});
  asset.root["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", delta}},
                                                         {{"POSITION", shift}}};
  asset.root["meshes"][0]["weights"] = {0.5, 0};
  int times = asset.add_floats("SCALAR", 1, {0, 2});
  int weights = asset.add_floats("SCALAR", 1, {0, 0, 1, 0.5f});
  asset.root["animations"] = {
      {{"samplers", {{{"input", times}, {"output", weights}}}},
       {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}}}};
  expect_near(corner_of(load(asset), 0, 0, 0), vec3(0, 0, 0.5f));  // rest
  expect_near(corner_of(load(asset, 1), 0, 0, 0), vec3(0.5f, 0, 0.5f));
  expect_near(corner_of(load(asset, 99), 0, 0, 0), vec3(1, 0, 1));  // holds its last key
  asset.root["nodes"][0]["weights"] = {0, 1};
  expect_near(corner_of(load(asset), 0, 0, 0), vec3(2, 0, 0));  // the node's own weights
}

Scene animated(const char* path, const char* type, int components, const char* interpolation,
               std::vector<float> values, double time) {
  Asset asset = triangle_asset();
  int times = asset.add_floats("SCALAR", 1, {1, 3});
  int output = asset.add_floats(type, components, values);
  asset.root["animations"] = {
      {{"samplers", {{{"input", times}, {"output", output}, {"interpolation", interpolation}}}},
       {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", path}}}}}}}};
  return load(asset, time);
}

TEST(SceneLoad, AnimationCurves) {
  std::vector<float> move = {0, 0, 0, 4, 8, 0};
  auto at = [&](const char* curve, double time) {
    return corner_of(animated("translation", "VEC3", 3, curve, move, time), 0, 0, 0);
  };
  expect_near(at("LINEAR", 1.5), vec3(1, 2, 0));
  expect_near(at("LINEAR", 0.5), vec3(0));  // before the first key
  expect_near(at("STEP", 2.9), vec3(0));
  expect_near(at("STEP", 3), vec3(4, 8, 0));
  // In-tangent, value, out-tangent for two keys two seconds apart; Hermite at the middle:
  // (v0 + v1) / 2 + 2 (out0 - in1) / 8.
  std::vector<float> cubic = {9, 9, 9, 0, 0, 0, 1, 0, 0, 0, 4, 0, 4, 0, 0, 9, 9, 9};
  expect_near(corner_of(animated("translation", "VEC3", 3, "CUBICSPLINE", cubic, 2), 0, 0, 0),
              vec3(2.25f, -1, 0));
  expect_near(corner_of(animated("scale", "VEC3", 3, "LINEAR", {1, 1, 1, 3, 1, 1}, 2), 0, 0, 1),
              vec3(2, 0, 0));
  float h = std::sqrt(0.5f);  // a quarter turn, taken the short way although the sign is other
  Scene turned = animated("rotation", "VEC4", 4, "LINEAR", {0, 0, 0, 1, 0, 0, -h, -h}, 2);
  expect_near(corner_of(turned, 0, 0, 1), vec3(h, h, 0));
}

// Two joints, the second moved up by its node: a vertex between them goes half the way.
Asset skinned_asset() {
  Asset asset;
  int position = asset.add_floats("VEC3", 3, {0, 0, 0, 1, 0, 0, 0, 1, 0});
  int normal = asset.add_floats("VEC3", 3, {0, 0, 1, 0, 0, 1, 0, 0, 1});
  int joints = asset.add_accessor(asset.add_view<uint8_t>({0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0}),
                                  5121, "VEC4", 3);
  int weights = asset.add_floats("VEC4", 4, {1, 0, 0, 0, 0.5f, 0.5f, 0, 0, 2, 0, 0, 0});
  asset.add_mesh({{"attributes",
                   {{"POSITION", position},
                    {"NORMAL", normal},
                    {"JOINTS_0", joints},
                    {"WEIGHTS_0", weights}}}});
  std::vector<float> bind;
  for (int m = 0; m < 2; m++)
    for (int i = 0; i < 16; i++) bind.push_back(i % 5 == 0 ? 1 : 0);
  bind[16 + 13] = -1;  // the second joint was bound at (0, 1, 0)
  int matrices = asset.add_floats("MAT4", 16, bind);
  asset.add_node({{"mesh", 0}, {"skin", 0}, {"translation", {50, 0, 0}}});  // must not matter
  asset.add_node({{"children", {2}}, {"translation", {0, 0, 7}}});
  asset.root["nodes"].push_back({{"translation", {0, 5, 0}}});
  asset.root["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", matrices}}};
  return asset;
}

TEST(SceneLoad, SkinsStandWhereTheirJointsAre) {
  Scene scene = load(skinned_asset());
  expect_near(corner_of(scene, 0, 0, 0), vec3(0, 0, 7));
  expect_near(corner_of(scene, 0, 0, 1), vec3(1, 2, 7));
  expect_near(corner_of(scene, 0, 0, 2), vec3(0, 5, 7));  // weight 2 counts as 1
  expect_near(scene.meshes[0].normals[1], vec3(0, 0, 1));
}

TEST(SceneLoad, BrokenSkinsAreRefused) {
  Asset asset = skinned_asset();
  asset.root["skins"][0]["joints"] = {1};
  EXPECT_EQ(refused(asset).where, "/meshes/0/primitives/0/attributes/JOINTS_0");
  asset = skinned_asset();
  asset.root["accessors"][4]["count"] = 1;
  EXPECT_EQ(refused(asset).where, "/skins/0/inverseBindMatrices");
  asset = skinned_asset();
  asset.root["meshes"][0]["primitives"][0]["attributes"].erase("WEIGHTS_0");
  EXPECT_EQ(refused(asset).where, "/meshes/0/primitives/0/attributes");
}

TEST(SceneLoad, ValuesThatAreNotFiniteNeverReachTheScene) {
  float nan = std::nanf(""), infinity = INFINITY;
  Asset asset;
  int position = asset.add_floats(
      "VEC3", 3, {0, 0, 0, 1, 0, 0, 0, 1, 0, nan, 0, 0, 0, infinity, 1e30f, 0, 0, 1});
  int normal =
      asset.add_floats("VEC3", 3, {nan, 0, 0, 0, 0, 0, infinity, 0, 0, 0, 0, 5, 0, 0, 1, 0, 0, 1});
  int uv = asset.add_floats("VEC2", 2, {nan, 0, infinity, 0, 0.5f, 0.5f, 0, 0, 0, 0, 0, 0});
  int color = asset.add_floats("VEC3", 3, std::vector<float>(18, nan));
  int indices = asset.add_accessor(asset.add_view<uint8_t>({0, 1, 2, 0, 1, 3, 0, 1, 4, 5, 0, 1}),
                                   5121, "SCALAR", 12);
  asset.add_mesh(
      {{"attributes",
        {{"POSITION", position}, {"NORMAL", normal}, {"TEXCOORD_0", uv}, {"COLOR_0", color}}},
       {"indices", indices}});
  asset.add_node({{"mesh", 0}});
  Scene scene = load(asset);
  EXPECT_EQ(triangle_count(scene), 2u);
  EXPECT_TRUE(warns_of(scene, "2 triangles"));
  EXPECT_TRUE(warns_of(scene, "normals without a direction"));
  const Mesh& mesh = scene.meshes[0];
  for (size_t i = 0; i < mesh.positions.size(); i++) {
    EXPECT_TRUE(is_finite(mesh.positions[i]));
    EXPECT_NEAR(length(mesh.normals[i]), 1, 1e-5f);
    EXPECT_TRUE(std::isfinite(mesh.uv[0][i].x));
    EXPECT_EQ(mesh.colors[i], vec4(1));
  }
}

TEST(SceneLoad, EmptyAndStrangeButReadable) {
  Scene scene = load_scene_text(R"({"asset":{"version":"2.0"}})");
  EXPECT_EQ(triangle_count(scene), 0u);
  EXPECT_EQ(scene.materials.size(), 1u);
  EXPECT_EQ(scene.objects.size(), 1u);
  Asset asset = triangle_asset();
  asset.root["something"] = 1;
  asset.root["nodes"][0]["extras"] = {1, 2, "x"};
  asset.root["extensionsUsed"] = {"KHR_materials_iridescence"};
  asset.root.erase("scenes");
  asset.root.erase("scene");
  scene = load(asset);
  EXPECT_EQ(triangle_count(scene), 1u);
  EXPECT_TRUE(warns_of(scene, "something"));
  EXPECT_TRUE(warns_of(scene, "KHR_materials_iridescence"));
  EXPECT_TRUE(warns_of(scene, "no scene"));
  EXPECT_EQ(triangle_count(load_scene_text("\xef\xbb\xbf" + triangle_asset().gltf())), 1u);
}

TEST(SceneLoad, GlbIsTheSame) {
  TempFolder folder;
  Scene scene = load_scene(folder.write("a.glb", triangle_asset().glb()));
  EXPECT_EQ(corner_of(scene, 0, 0, 1), vec3(1, 0, 0));
  EXPECT_TRUE(scene.warnings.empty());
  scene = load_scene(folder.write("b.glb", triangle_asset().glb() + "tail"));
  EXPECT_TRUE(warns_of(scene, "after the end"));
}

}  // namespace
}  // namespace wellspring::test
