// SPDX-License-Identifier: Apache-2.0
// Materials of glTF figures come from the reader that scenes use.
#include <gtest/gtest.h>

#include <fstream>

#include "avatar/load/character_load.h"
#include "frame/picture_file.h"
#include "light/visible/visibility.h"
#include "light/technique/technique.h"
#include "show/moving/figure.h"
#include "unit/avatar/load/gltf_person.h"

namespace wellspring::test {
namespace {

struct Made {
  Character character;
  Scene scene;
  std::vector<Mesh> moving;
  std::vector<uint32_t> objects;
  Figure figure;
};

Made make(const Asset& asset, const std::map<std::string, std::string>& files = {}) {
  TempFolder folder;
  for (const auto& [name, bytes] : files) folder.write(name, bytes);
  Made made;
  made.character = load_character(folder.write("person.glb", asset.glb()));
  made.scene.materials.push_back({});
  made.figure = make_figure(made.character, made.scene, made.moving, made.objects);
  return made;
}

Asset painted(const json& material) {
  Asset asset = test::make_person();
  asset.root["materials"] = json::array({material});
  asset.root["meshes"][0]["primitives"][0]["material"] = 0;
  return asset;
}

const Material& worn(const Made& made) {
  return made.scene.materials[size_t(made.moving[0].material)];
}

bool says(const Made& made, const std::string& text) {
  for (const std::string& warning : made.scene.warnings)
    if (warning.find(text) != std::string::npos) return true;
  return false;
}

TEST(FigureOfGltf, WearsTheFilesMaterial) {
  Made made =
      make(painted({{"name", "silk"},
                    {"alphaMode", "MASK"},
                    {"pbrMetallicRoughness",
                     {{"baseColorFactor", {0.2, 0.4, 0.6, 1}}, {"roughnessFactor", 0.3}}},
                    {"extensions", {{"KHR_materials_sheen", {{"sheenColorFactor", {1, 0, 0}}}}}}}));
  ASSERT_EQ(made.moving.size(), 1u);
  EXPECT_EQ(worn(made).name, "silk");
  EXPECT_FLOAT_EQ(worn(made).base_color.y, 0.4f);
  EXPECT_FLOAT_EQ(worn(made).roughness, 0.3f);
  EXPECT_FLOAT_EQ(worn(made).sheen_color.x, 1);
  EXPECT_EQ(worn(made).alpha_mode, AlphaMode::mask);
  EXPECT_EQ(made.scene.materials[0].name, "") << "the scene's own stay";
}

TEST(FigureOfGltf, CartoonsAreShownLambertian) {
  Made made = make(painted({{"name", "toon"},
                            {"pbrMetallicRoughness", {{"baseColorFactor", {0.2, 0.4, 0.6, 1}}}},
                            {"extensions", {{"KHR_materials_unlit", json::object()}}}}));
  EXPECT_FALSE(worn(made).unlit);
  EXPECT_FLOAT_EQ(worn(made).metallic, 0);
  EXPECT_FLOAT_EQ(worn(made).roughness, 1);
  bool said = false;
  for (const std::string& warning : made.character.warnings)
    said = said || warning.find("cartoons") != std::string::npos;
  EXPECT_TRUE(said);
}

// A person whose skin has a map of normals, with u along x and v down.
Asset mapped(json material) {
  material["normalTexture"] = {{"index", 0}, {"scale", 0.5}};
  Asset asset = painted(material);
  asset.root["textures"] = json::array({{{"source", 0}}});
  asset.root["images"] = json::array({{{"uri", "normals.png"}}});
  std::vector<float> uv;
  for (const test::PersonBone& bone : test::person_bones())
    for (int corner = 0; corner < 8; corner++) {
      vec3 p = (corner & 1) ? bone.to : bone.place;
      p += vec3((corner & 1) ? 0.03f : -0.03f, (corner & 2) ? 0.03f : -0.03f,
                (corner & 4) ? 0.03f : -0.03f);
      uv.push_back(p.x + 0.2f * p.y + 0.3f * p.z);  // no face of the boxes lies along u or v
      uv.push_back(0.15f * p.x - p.y + 0.25f * p.z);
    }
  asset.root["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] =
      asset.add_floats("VEC2", 2, uv);
  return asset;
}

// One flat texel, as a PNG of stored bytes.
std::string flat_normals() {
  Frame frame{.width = 2, .height = 2};
  frame.color.assign(4, vec3(0.5f, 0.5f, 1));
  TempFolder folder;
  std::string path = folder.write("flat.png", "");
  save_picture(path, frame, Tonemap{});
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(FigureOfGltf, TangentsOfNormalMapsFollowTheBentSkin) {
  Made made = make(mapped({{"name", "skin"}}), {{"normals.png", flat_normals()}});
  ASSERT_GE(worn(made).normal_texture.texture, 0);
  EXPECT_FLOAT_EQ(worn(made).normal_scale, 0.5f);
  ASSERT_EQ(made.moving[0].tangents.size(), made.moving[0].positions.size());
  EXPECT_GT(made.moving[0].positions.size(), made.character.positions.size())
      << "split where the picture is seen mirrored, on the back";

  // The figure is in a World of its own, turned, and with one arm bent.
  std::vector<vec4> rest = made.moving[0].tangents;
  World world(made.scene, made.moving, made.objects);
  Pose pose = make_rest_pose(made.character);
  int elbow = find_joint(made.character, "l_elbow");
  ASSERT_GE(elbow, 0);
  pose.rotations[size_t(elbow)] = glm::angleAxis(1.1f, vec3(0, 0, 1));
  quat turned = glm::angleAxis(0.8f, glm::normalize(vec3(0.2f, 1, 0.1f)));
  SkinScratch scratch;
  pose_figure(world, made.figure, made.character, pose, glm::mat4_cast(turned), scratch);
  world.commit();
  const Mesh& bent = world.mesh_of(0);
  ASSERT_EQ(bent.tangents.size(), rest.size());
  size_t arm = 0;
  for (size_t i = 0; i < rest.size(); i++) {
    uint32_t v = made.figure.parts[0].vertices[i];
    int joint = made.character.weights[made.character.first_weight[v]].joint;
    quat turn = turned;
    for (int j = joint; j >= 0; j = made.character.joints[size_t(j)].parent)
      if (j == elbow) turn = turned * pose.rotations[size_t(elbow)], arm++;
    EXPECT_GT(dot(vec3(bent.tangents[i]), turn * vec3(rest[i])), 0.999f) << "vertex " << i;
    EXPECT_EQ(bent.tangents[i].w, rest[i].w);
    EXPECT_NEAR(dot(vec3(bent.tangents[i]), bent.normals[i]), 0, 1e-4f);
  }
  EXPECT_GT(arm, 8u);
}

// A VRM person that blushes and glows: the ray tracer's look, drawn pictures and paths all show it.
// One place of a figure's chest: as a ray sees it, as it is drawn, and in traced light.
struct ChestSeen {
  PrimaryHit seen, drawn;
  vec3 traced{0};
};
ChestSeen see_chest(const Scene& scene, const World& world, const Lights& lights,
                    const VisibilityPass& visibility) {
  vec3 chest(0, 1.3f, 0.0f);
  Ray ray{.origin = chest + vec3(0.004f, 0.003f, 2), .direction = {0, 0, -1}};
  View view = make_view(scene, {0.004, 1.303, 2}, 0, 0, 0.05f, 33, 33);
  ChestSeen result;
  see(world, lights, std::span(&ray, 1), std::span(&result.seen, 1));
  visibility.see(view, vec2(0.5f), [&](const VisibleRun& run) {
    if (run.y == 16 && run.x <= 16 && 16 < run.x + run.count) result.drawn = run.see(16 - run.x);
  });
  std::vector<Request> requests(64);
  for (uint32_t i = 0; i < 64; i++)
    requests[i].ray = ray, requests[i].seed = 1, requests[i].index = i;
  std::vector<Sample> samples(64);
  trace(*find_technique("path"), world, lights, {}, requests, samples);
  for (const Sample& sample : samples) result.traced += sample.radiance() / 64.0f;
  return result;
}

TEST(FigureOfGltf, ExpressionsRepaintMaterials) {
  Asset asset = painted({{"name", "skin"},
                         {"doubleSided", true},
                         {"pbrMetallicRoughness", {{"baseColorFactor", {0.2, 0.2, 0.2, 1}}}},
                         {"extensions", {{"VRMC_materials_mtoon", json::object()}}}});
  test::add_vrm_1(asset);
  asset.root["extensions"]["VRMC_vrm"]["expressions"]["preset"]["happy"]["materialColorBinds"] = {
      {{"material", 0}, {"type", "color"}, {"targetValue", {1, 0.2, 0.2, 1}}},
      {{"material", 0}, {"type", "emissionColor"}, {"targetValue", {0, 0.5, 0, 1}}}};
  Made made = make(asset);
  ASSERT_EQ(made.figure.paints.size(), 1u);
  EXPECT_TRUE(worn(made).repaints);
  made.scene.environment.radiance = vec3(1);
  World world(made.scene, made.moving, made.objects);
  SkinScratch scratch;
  Pose pose = make_rest_pose(made.character);
  int happy = find_displacer(made.character, "happy");
  ASSERT_GE(happy, 0) << "an expression of materials alone";
  auto show = [&](float weight) {
    pose.displacers[size_t(happy)] = weight;
    pose_figure(world, made.figure, made.character, pose, mat4(1), scratch);
    world.commit();
  };
  show(0);
  Lights lights = make_lights(world);
  VisibilityPass visibility(world, lights);
  EXPECT_EQ(world.paints(), 0u) << "nothing is done while nothing changes";
  auto chest = [&] { return see_chest(made.scene, world, lights, visibility); };
  ChestSeen pale = chest();
  EXPECT_NEAR(pale.seen.albedo.x, pale.seen.albedo.y, 1e-5f);
  show(1);
  ChestSeen red = chest();
  EXPECT_EQ(world.paints(), 1u);
  EXPECT_NEAR(red.seen.albedo.x / pale.seen.albedo.x, 5, 0.05f);
  EXPECT_NEAR(red.seen.albedo.z, pale.seen.albedo.z, 1e-4f);
  EXPECT_NEAR(red.seen.glow.y, 0.5f, 1e-5f);
  for (const ChestSeen* l : {&pale, &red})
    for (int c = 0; c < 3; c++) {
      EXPECT_NEAR(l->drawn.albedo[c], l->seen.albedo[c], 1e-3f);
      EXPECT_NEAR(l->drawn.glow[c], l->seen.glow[c], 1e-5f);
    }
  EXPECT_GT(red.traced.x, 3 * pale.traced.x);
  EXPECT_NEAR(red.traced.y - pale.traced.y, 0.5f, 0.05f) << "it glows";
  show(1);
  EXPECT_EQ(world.paints(), 1u) << "the same again is no change";
  show(0.5f);
  EXPECT_NEAR(world.material_of(0).base_color.x, 0.6f, 1e-6f);
  show(0);
  ChestSeen again = chest();
  EXPECT_EQ(again.seen.albedo, pale.seen.albedo);
  EXPECT_EQ(again.seen.glow, vec3(0));
}

// Eyes and mouths that are pictures: another part of them shows, to rays and in drawn pictures.
TEST(FigureOfGltf, ExpressionsMovePictures) {
  Asset asset = painted(
      {{"name", "face"},
       {"doubleSided", true},
       {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}, {"metallicFactor", 0}}}});
  test::add_vrm_1(asset);
  asset.root["textures"] = json::array({{{"source", 0}}});
  asset.root["images"] = json::array({{{"uri", "two.png"}}});
  std::vector<float> uv;
  for (size_t v = 0; v < test::person_bones().size() * 8; v++) uv.insert(uv.end(), {0.25f, 0.5f});
  asset.root["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] =
      asset.add_floats("VEC2", 2, uv);
  asset.root["extensions"]["VRMC_vrm"]["expressions"]["preset"]["surprised"]
            ["textureTransformBinds"] = {{{"material", 0}, {"offset", {0.5, 0}}}};
  Frame halves{.width = 8, .height = 4};
  for (int i = 0; i < 32; i++)
    halves.color.push_back(i % 8 < 4 ? vec3(0.8f, 0.05f, 0.05f) : vec3(0.05f, 0.8f, 0.05f));
  TempFolder folder;
  std::string path = folder.write("two.png", "");
  save_picture(path, halves, Tonemap{});
  std::ifstream file(path, std::ios::binary);
  Made made = make(asset, {{"two.png", {std::istreambuf_iterator<char>(file), {}}}});
  ASSERT_GE(worn(made).base_color_texture.texture, 0);
  made.scene.environment.radiance = vec3(1);
  World world(made.scene, made.moving, made.objects);
  SkinScratch scratch;
  Pose pose = make_rest_pose(made.character);
  pose_figure(world, made.figure, made.character, pose, mat4(1), scratch);
  world.commit();
  Lights lights = make_lights(world);
  VisibilityPass visibility(world, lights);
  Ray ray{.origin = vec3(0.004f, 1.303f, 2), .direction = {0, 0, -1}};
  View view = make_view(made.scene, {0.004, 1.303, 2}, 0, 0, 0.05f, 33, 33);
  for (float weight : {0.0f, 1.0f, 0.0f}) {
    pose.displacers[size_t(find_displacer(made.character, "surprised"))] = weight;
    pose_figure(world, made.figure, made.character, pose, mat4(1), scratch);
    world.commit();
    PrimaryHit seen, drawn;
    see(world, lights, std::span(&ray, 1), std::span(&seen, 1));
    visibility.see(view, vec2(0.5f), [&](const VisibleRun& run) {
      if (run.y == 16 && run.x <= 16 && 16 < run.x + run.count) drawn = run.see(16 - run.x);
    });
    for (const PrimaryHit& one : {seen, drawn}) {
      EXPECT_EQ(one.albedo.x > 4 * one.albedo.y, weight == 0) << weight;
      EXPECT_EQ(one.albedo.y > 4 * one.albedo.x, weight == 1) << weight;
    }
  }
}

TEST(FigureOfGltf, NothingIsRepaintedWhereNoExpressionAsksForIt) {
  Asset asset = painted({{"name", "skin"}});
  test::add_vrm_1(asset);
  Made made = make(asset);
  EXPECT_TRUE(made.figure.paints.empty());
  for (const Material& material : made.scene.materials) EXPECT_FALSE(material.repaints);
}

// The same pictures as an X3D 4 file names them.
TEST(FigureOfX3d, WearsThePicturesOfItsMaterial) {
  TempFolder folder;
  folder.write("normals.png", flat_normals());
  std::string path = folder.write("figure.x3d", R"(<X3D><Scene><HAnimHumanoid>
    <HAnimJoint name='humanoid_root' containerField='skeleton'><HAnimSegment name='sacrum'><Shape><Appearance>
      <PhysicalMaterial normalScale='0.7'>
        <ImageTexture containerField='normalTexture' url='"normals.png"'/>
        <ImageTexture containerField='metallicRoughnessTexture' url='"normals.png"'/>
        <ImageTexture containerField='emissiveTexture' url='"gone.png"'/>
        <ImageTexture containerField='occlusionTexture' url='"normals.png"'/>
      </PhysicalMaterial></Appearance><Box/></Shape></HAnimSegment></HAnimJoint></HAnimHumanoid></Scene></X3D>)");
  Made made;
  made.character = load_character(path);
  made.scene.materials.push_back({});
  made.figure = make_figure(made.character, made.scene, made.moving, made.objects);
  const Material& material = worn(made);
  ASSERT_GE(material.normal_texture.texture, 0);
  EXPECT_FLOAT_EQ(material.normal_scale, 0.7f);
  EXPECT_EQ(material.metallic_roughness_texture.texture, material.normal_texture.texture)
      << "read once";
  EXPECT_EQ(material.emission_texture.texture, -1);
  EXPECT_FALSE(made.moving[0].tangents.empty());
  size_t said = 0;
  for (const std::string& warning : made.character.warnings)
    said += warning.find("occlusionTexture") != std::string::npos ||
            warning.find("gone.png") != std::string::npos;
  EXPECT_EQ(said, 2u);
}

TEST(FigureOfGltf, WhatNeedsNoTangentsHasNone) {
  Made made = make(painted({{"name", "plain"}}));
  EXPECT_TRUE(made.moving[0].tangents.empty());
}

TEST(FigureOfGltf, MissingAndBrokenPicturesAreTold) {
  Asset asset =
      painted({{"pbrMetallicRoughness",
                {{"baseColorTexture", {{"index", 0}}}, {"baseColorFactor", {0.5, 0.5, 0.5, 1}}}}});
  asset.root["textures"] = json::array({{{"source", 0}}});
  asset.root["images"] = json::array({{{"uri", "face.png"}}});
  Made missing = make(asset);
  EXPECT_EQ(worn(missing).base_color_texture.texture, -1);
  EXPECT_FLOAT_EQ(worn(missing).base_color.x, 0.5f);
  EXPECT_TRUE(says(missing, "no such file: \"face.png\""));
  Made broken = make(asset, {{"face.png", "\x89PNG\r\n\x1a\nnothing"}});
  EXPECT_EQ(worn(broken).base_color_texture.texture, -1);
  EXPECT_TRUE(says(broken, "cannot be decoded"));
}

}  // namespace
}  // namespace wellspring::test
