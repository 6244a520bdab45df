// SPDX-License-Identifier: Apache-2.0
// The transport plan's decisions: each part is used when something in use asks for it, and left out
// when a factor, texture, alpha or power takes it away again.
#include "light/transport_plan.h"

#include <gtest/gtest.h>

#include <functional>

#include "scenes/scenes.h"
#include "unit/light/full_plan.h"

namespace wellspring::test {
namespace {

using namespace scenes;
using enum light::TransportPart;

int add_picture(Scene& scene, std::vector<vec4> texels) {
  Image image{.width = int(texels.size()), .height = 1, .texels = std::move(texels)};
  return add_texture(scene, image);
}

// A floor, a lamp of one triangle pair, and a ball of the material in question.
Scene scene_with(const Material& material) {
  Scene scene = make_plane_with_rect_light(3);
  add_sphere(scene, material, 0.2f, "ball", at({0, 0.3f, 0}), 8);
  return scene;
}
TransportPlan plan_with(const Material& material) {
  return make_transport_plan(scene_with(material));
}
bool asks(TransportPart part, const Material& material) { return plan_with(material).uses(part); }

Material with(Material material, const std::function<void(Material&)>& change) {
  change(material);
  return material;
}

TEST(TransportPlan, EveryPartHasANameAndEveryDecisionAReason) {
  for (const TransportPlan& plan :
       {make_transport_plan(empty_scene()), plan_with(glass(1.5f, 0, 1)),
        test::make_full_plan(empty_scene())})
    for (size_t i = 0; i < transport_parts; i++) {
      EXPECT_GT(std::string(transport_part_name(TransportPart(i))).size(), 3u);
      EXPECT_GT(plan.decisions[i].why.size(), 3u) << transport_part_name(TransportPart(i));
    }
}

TEST(TransportPlan, AnEmptySceneNeedsNothing) {
  for (const Scene& scene : {Scene{}, empty_scene()}) {
    TransportPlan plan = make_transport_plan(scene);
    for (size_t i = 0; i < transport_parts; i++)
      EXPECT_FALSE(plan.uses(TransportPart(i))) << transport_part_name(TransportPart(i));
  }
}

TEST(TransportPlan, ADiffuseSceneWithOneLampNeedsLittle) {
  TransportPlan plan = plan_with(diffuse(vec3(0.5f)));
  for (size_t i = 0; i < transport_parts; i++) {
    TransportPart part = TransportPart(i);
    EXPECT_EQ(plan.uses(part), part == area_lights || part == kept_light)
        << transport_part_name(part);
  }
}

TEST(TransportPlan, PanesAreThinSmoothAndLetLightThrough) {
  Material pane = glass(1.5f, 0, 0);
  EXPECT_TRUE(asks(panes, pane));
  EXPECT_FALSE(asks(refraction, pane));
  EXPECT_FALSE(asks(panes, glass(1.5f, 0.4f, 0)));  // rough: only scattering leads through
  EXPECT_FALSE(asks(panes, glass(1.5f, 0, 1)));     // a solid
  EXPECT_FALSE(asks(panes, with(pane, [](Material& m) { m.transmission = 0; })));
  EXPECT_FALSE(asks(panes, with(pane, [](Material& m) { m.metallic = 1; })));
  EXPECT_FALSE(asks(panes, with(pane, [](Material& m) { m.base_color = vec4(0, 0, 0, 1); })));
  EXPECT_FALSE(asks(panes, with(pane, [](Material& m) { m.unlit = true; })));
}

TEST(TransportPlan, SolidsAbsorbAndDisperseOnlyWhereTheyTransmit) {
  Material solid = glass(1.5f, 0, 1);
  EXPECT_TRUE(asks(refraction, solid));
  EXPECT_FALSE(asks(absorption, solid));
  EXPECT_FALSE(asks(dispersion, solid));
  Material tinted = with(solid, [](Material& m) {
    m.attenuation_distance = 0.1f;
    m.attenuation_color = vec3(0.9f, 1, 1);
  });
  EXPECT_TRUE(asks(absorption, tinted));
  EXPECT_FALSE(asks(absorption, with(tinted, [](Material& m) { m.attenuation_color = vec3(1); })));
  EXPECT_FALSE(asks(absorption, with(tinted, [](Material& m) { m.thickness = 0; })));
  Material prism = with(solid, [](Material& m) { m.dispersion = 0.3f; });
  EXPECT_TRUE(asks(dispersion, prism));
  EXPECT_FALSE(asks(dispersion, with(prism, [](Material& m) { m.ior = 1; })));
  EXPECT_FALSE(asks(dispersion, with(prism, [](Material& m) { m.thickness = 0; })));
  EXPECT_FALSE(asks(dispersion, with(prism, [](Material& m) { m.transmission = 0; })));
}

TEST(TransportPlan, CoatsOfNoStrengthAreNone) {
  EXPECT_TRUE(asks(coats, with(diffuse(vec3(0.5f)), [](Material& m) { m.clearcoat = 0.2f; })));
  EXPECT_TRUE(asks(coats, with(diffuse(vec3(0.5f)), [](Material& m) { m.sheen_color.y = 0.2f; })));
  EXPECT_FALSE(asks(coats, with(diffuse(vec3(0.5f)), [](Material& m) {
                      m.clearcoat_roughness = 0.2f;
                      m.sheen_roughness = 0.5f;
                    })));
}

TEST(TransportPlan, CausticsNeedSomethingSharpSomethingRoughAndLight) {
  EXPECT_TRUE(asks(caustics, metal(vec3(0.9f), 0)));
  EXPECT_TRUE(asks(caustics, glass(1.5f, 0.1f, 1)));
  EXPECT_TRUE(asks(caustics, plastic(vec3(0.5f), 0.1f)));
  EXPECT_TRUE(asks(caustics, with(diffuse(vec3(0.5f)), [](Material& m) { m.clearcoat = 1; })));
  EXPECT_FALSE(asks(caustics, metal(vec3(0.9f), 0.7f)));
  EXPECT_FALSE(asks(caustics, plastic(vec3(0.5f), 0.7f)));
  // Lambertian, however small its roughness: an index of 1 reflects nothing.
  EXPECT_FALSE(asks(caustics, plastic(vec3(0.5f), 0.0f, 1.0f)));
  Scene mirrors = empty_scene();
  mirrors.environment.radiance = vec3(1);
  add_sphere(mirrors, metal(vec3(0.9f), 0), 1, "ball", mat4(1), 8);
  EXPECT_FALSE(make_transport_plan(mirrors).uses(caustics));  // nothing rough to see them on
  EXPECT_FALSE(make_transport_plan(mirrors).uses(kept_light));
  add_floor(mirrors, 0.5f);
  EXPECT_TRUE(make_transport_plan(mirrors).uses(caustics));
  mirrors.environment.radiance = vec3(0);
  EXPECT_FALSE(make_transport_plan(mirrors).uses(caustics));
  EXPECT_FALSE(make_transport_plan(mirrors).uses(kept_light));
}

TEST(TransportPlan, TexturesAreLookedAt) {
  auto uses = [](TransportPart part, Material material, TextureRef Material::*reference,
                 std::vector<vec4> texels) {
    Scene scene = scene_with(material);
    scene.materials.back().*reference = TextureRef{};
    int texture = add_picture(scene, std::move(texels));
    (scene.materials.back().*reference).texture = texture;
    return make_transport_plan(scene).uses(part);
  };
  const vec4 black(0, 0, 0, 1), white(1);
  Material lamp = emitter(vec3(1));
  EXPECT_FALSE(uses(panes, glass(1.5f, 0, 0), &Material::transmission_texture, {black, black}));
  EXPECT_TRUE(uses(panes, glass(1.5f, 0, 0), &Material::transmission_texture, {black, white}));
  // Green is roughness, blue metalness: the smoothest texel decides.
  EXPECT_TRUE(uses(panes, glass(1.5f, 0.8f, 0), &Material::metallic_roughness_texture,
                   {vec4(0, 0, 0, 1), white}));
  EXPECT_FALSE(uses(caustics, metal(vec3(1), 0.9f), &Material::metallic_roughness_texture,
                    {vec4(0, 0.6f, 1, 1), white}));
  EXPECT_TRUE(uses(caustics, metal(vec3(1), 0.9f), &Material::metallic_roughness_texture,
                   {vec4(0, 0.2f, 1, 1), white}));
  Material coated = with(diffuse(vec3(0.5f)), [](Material& m) { m.clearcoat = 1; });
  EXPECT_FALSE(uses(coats, coated, &Material::clearcoat_texture, {black}));
  EXPECT_TRUE(uses(coats, coated, &Material::clearcoat_texture, {white}));
  EXPECT_FALSE(uses(emission_texture, lamp, &Material::emission_texture, {black, black}));
  EXPECT_FALSE(uses(emission_texture, lamp, &Material::emission_texture, {white, white}));
  EXPECT_TRUE(uses(emission_texture, lamp, &Material::emission_texture, {black, white}));
  Scene dark = scene_with(lamp);
  dark.materials.back().emission_texture.texture = add_picture(dark, {black});
  EXPECT_FALSE(make_transport_plan(dark).materials.back().emits);
  // Texels that are no numbers read as black; a picture that is missing reads as white.
  dark.images.back().texels = {vec4(NAN), vec4(NAN)};
  EXPECT_FALSE(make_transport_plan(dark).materials.back().emits);
  dark.images.back().texels.clear();
  EXPECT_TRUE(make_transport_plan(dark).materials.back().emits);
}

// The least metallic and the smoothest texel decide for all of a material.
TEST(TransportPlan, MetalsAreKeptByWhatTheyAreAllOver) {
  auto kept = [](const Material& material, std::vector<vec4> texels) {
    Scene scene = scene_with(material);
    scene.materials.back().metallic_roughness_texture.texture =
        add_picture(scene, std::move(texels));
    return make_transport_plan(scene).materials.back().metal;
  };
  auto texel = [](float roughness, float metallic) { return vec4(0, roughness, metallic, 1); };
  Material gold = metal(vec3(1, 0.8f, 0.3f), 1);
  EXPECT_EQ(kept(gold, {texel(0.3f, 1), texel(0.9f, 1)}), MetalDemodulation::light);
  EXPECT_EQ(kept(gold, {texel(0.3f, 0.9f), texel(0.9f, 1)}), MetalDemodulation::light);
  EXPECT_EQ(kept(gold, {texel(0.22f, 1), texel(0.9f, 1)}), MetalDemodulation::reflectance);
  EXPECT_EQ(kept(gold, {texel(0.1f, 1), texel(0.9f, 1)}), MetalDemodulation::none);
  EXPECT_EQ(kept(gold, {texel(0.9f, 1), texel(0.9f, 0)}), MetalDemodulation::none);
  EXPECT_EQ(kept(diffuse(vec3(0.5f)), {texel(0.9f, 1)}), MetalDemodulation::none);
  // A coat is as sharp as it is, whatever lies beneath.
  Material coated = with(gold, [](Material& m) { m.clearcoat = 1; });
  EXPECT_EQ(kept(coated, {texel(0.9f, 1)}), MetalDemodulation::reflectance);
  Material brushed = with(gold, [](Material& m) { m.anisotropy = 0.5f; });
  EXPECT_EQ(kept(brushed, {texel(0.9f, 1)}), MetalDemodulation::reflectance);
}

TEST(TransportPlan, EightBitPicturesInBothEncodings) {
  for (bool srgb : {false, true}) {
    Image image{
        .width = 2, .height = 1, .srgb = srgb, .texels8 = {0, 128, 255, 51, 10, 128, 255, 102}};
    Scene scene;
    scene.images.push_back(image);
    TexelRange range = TextureRanges(scene).image(0);
    EXPECT_EQ(range.low.x, 0);
    EXPECT_FLOAT_EQ(range.high.x, srgb ? decode_srgb(10) : 10 / 255.0f);
    EXPECT_FLOAT_EQ(range.low.y, srgb ? decode_srgb(128) : 128 / 255.0f);
    EXPECT_FLOAT_EQ(range.low.w, 0.2f);  // never encoded
    EXPECT_FLOAT_EQ(range.high.w, 0.4f);
  }
}

TEST(TransportPlan, WhatNothingShowsDoesNotCount) {
  Scene scene = scene_with(diffuse(vec3(0.5f)));
  add_material(scene, glass(1.5f, 0, 1));  // no mesh is made of it
  EXPECT_FALSE(make_transport_plan(scene).uses(refraction));
  EXPECT_FALSE(make_transport_plan(scene).materials.back().visible);
  scene.meshes.push_back(sphere_mesh(int(scene.materials.size()) - 1, 1, 8));  // no instance of it
  EXPECT_FALSE(make_transport_plan(scene).uses(refraction));
  const Mesh* moving = &scene.meshes.back();
  EXPECT_TRUE(make_transport_plan(scene, std::span(&moving, 1)).uses(refraction));
  scene.instances.push_back({int(scene.meshes.size()) - 1, mat4(1), 1});
  EXPECT_TRUE(make_transport_plan(scene).uses(refraction));
  // Cut out all over, or blended to nothing; a vertex colour may bring it back.
  Material& m = scene.materials.back();
  m.alpha_mode = AlphaMode::mask;
  m.base_color.w = 0.4f;
  EXPECT_FALSE(make_transport_plan(scene).uses(refraction));
  scene.meshes.back().colors.assign(scene.meshes.back().positions.size(), vec4(1));
  scene.meshes.back().colors[3].w = 2;
  EXPECT_TRUE(make_transport_plan(scene).uses(refraction));
  m.alpha_mode = AlphaMode::blend;
  m.base_color.w = 0;
  EXPECT_FALSE(make_transport_plan(scene).uses(refraction));
  m.alpha_mode = AlphaMode::opaque;
  EXPECT_TRUE(make_transport_plan(scene).uses(refraction));
}

TEST(TransportPlan, LightsCountByTheirPowerAndByWhomTheyLight) {
  Scene scene = empty_scene();
  add_floor(scene, 0.5f);
  PunctualLight light{.intensity = vec3(0)};
  scene.lights.push_back(light);
  EXPECT_FALSE(make_transport_plan(scene).uses(punctual_lights));
  scene.lights[0].intensity = vec3(0, 0, 1);
  EXPECT_TRUE(make_transport_plan(scene).uses(punctual_lights));
  scene.lights[0].position.y = NAN;
  EXPECT_FALSE(make_transport_plan(scene).uses(punctual_lights));
  scene.lights[0].position.y = 1;
  for (Material& m : scene.materials)
    m.unlit = true;  // a scan that carries its light in its picture
  TransportPlan plan = make_transport_plan(scene);
  EXPECT_FALSE(plan.uses(punctual_lights));
  EXPECT_FALSE(plan.uses(area_lights));
  EXPECT_FALSE(plan.uses(light_tree));
}

TEST(TransportPlan, SkiesAreSampledWhereTheyAreUneven) {
  Scene scene = empty_scene();
  add_floor(scene, 0.5f);
  scene.environment.radiance = vec3(1);
  EXPECT_TRUE(make_transport_plan(scene).uses(environment));
  EXPECT_FALSE(make_transport_plan(scene).uses(environment_importance));
  add_picture(scene, {vec4(2), vec4(2), vec4(2)});
  scene.environment.image = 0;
  EXPECT_FALSE(make_transport_plan(scene).uses(environment_importance));
  scene.images[0].texels[1] = vec4(2, 2, 3, 1);
  EXPECT_TRUE(make_transport_plan(scene).uses(environment_importance));
  scene.images[0].texels.assign(3, vec4(0));
  EXPECT_FALSE(make_transport_plan(scene).uses(environment));
}

TEST(TransportPlan, KeptLightNeedsSomethingThatStandsStill) {
  Scene scene = empty_scene();
  scene.environment.radiance = vec3(1);
  Mesh figure = sphere_mesh(add_material(scene, diffuse(vec3(0.5f))), 1, 8);
  const Mesh* moving = &figure;
  EXPECT_FALSE(make_transport_plan(scene, std::span(&moving, 1)).uses(kept_light));
  add_floor(scene, 0.5f);
  TransportPlan plan = make_transport_plan(scene, std::span(&moving, 1));
  EXPECT_TRUE(plan.uses(kept_light));
  EXPECT_NE(plan.decisions[size_t(kept_light)].why.find("moving"), std::string::npos);
}

TEST(TransportPlan, LightsThatMoveAreFoundAnewForEachPicture) {
  Scene scene = make_cornell_box();
  EXPECT_FALSE(make_transport_plan(scene).uses(TransportPart::dynamic_lights));
  scene.dynamic_lights = 2;
  const TransportPlan plan = make_transport_plan(scene);
  EXPECT_TRUE(plan.uses(TransportPart::dynamic_lights));
  EXPECT_NE(explain(plan).find("2 lights move or change"), std::string::npos);
  EXPECT_NE(explain(plan).find("multires_splatting"), std::string::npos);
}

TEST(TransportPlan, ExplanationListsEveryPartOnce) {
  Scene scene = scene_with(glass(1.5f, 0, 1));
  scene.materials.back().name = "green\nglass";
  std::string text = explain(make_transport_plan(scene));
  for (size_t i = 0; i < transport_parts; i++) {
    std::string name = std::string("\n  ") + transport_part_name(TransportPart(i)) + "  ";
    size_t first = text.find(name);
    EXPECT_NE(first, std::string::npos) << name;
    EXPECT_EQ(text.find(name, first + 1), std::string::npos) << name;
  }
  EXPECT_LT(text.find("  refraction"), text.find("left out"));
  EXPECT_GT(text.find("  dispersion"), text.find("left out"));
  EXPECT_NE(text.find("'green?glass'"), std::string::npos);
  // The text says how each technique handles parted colours if the scene parts them.
  EXPECT_EQ(text.find("wavelengths from"), std::string::npos);
  scene.materials.back().dispersion = 0.3f;
  text = explain(make_transport_plan(scene));
  size_t parted = text.find("  dispersion");
  EXPECT_LT(parted, text.find("left out"));
  EXPECT_LT(parted, text.find("instant_radiosity: photons and walks of light carry wavelengths"));
}

}  // namespace
}  // namespace wellspring::test
