// SPDX-License-Identifier: Apache-2.0
// Materials, textures and pictures of glTF files.
#include <cmath>

#include "unit/world/load/asset.h"

namespace wellspring::test {
namespace {

std::string crc_chunk(const std::string& kind, const std::string& data) {
  auto big = [](uint32_t v) {
    return std::string{char(v >> 24), char(v >> 16), char(v >> 8), char(v)};
  };
  uint32_t crc = 0xffffffffu;
  for (char c : kind + data) {
    crc ^= uint8_t(c);
    for (int k = 0; k < 8; k++) crc = crc & 1 ? 0xedb88320u ^ (crc >> 1) : crc >> 1;
  }
  return big(uint32_t(data.size())) + kind + data + big(~crc);
}

// A PNG of RGBA rows (each starting with filter byte 0) in one stored deflate block.
std::string make_png(uint32_t width, uint32_t height, int bits, const std::string& rows) {
  auto big = [](uint32_t v) {
    return std::string{char(v >> 24), char(v >> 16), char(v >> 8), char(v)};
  };
  uint32_t a = 1, b = 0;
  for (char c : rows) a = (a + uint8_t(c)) % 65521, b = (b + a) % 65521;
  uint16_t n = uint16_t(rows.size());
  std::string zlib = std::string("\x78\x01\x01", 3) + char(n) + char(n >> 8) + char(~n) +
                     char(uint16_t(~n) >> 8) + rows + big(b << 16 | a);
  return "\x89PNG\r\n\x1a\n" +
         crc_chunk("IHDR", big(width) + big(height) + char(bits) + std::string("\6\0\0\0", 4)) +
         crc_chunk("IDAT", zlib) + crc_chunk("IEND", "");
}

std::string small_png() {
  return make_png(2, 1, 8,
                  std::string("\0", 1) + "\xff" + std::string("\0\0", 2) + "\xff" +
                      std::string("\0", 1) + "\x80" + std::string("\0", 1) + "\x40");
}

Asset textured(const std::string& uri, json material = json::object()) {
  Asset asset = triangle_asset();
  int uv = asset.add_floats("VEC2", 2, {0, 0, 1, 0, 0, 1});
  json& primitive = asset.root["meshes"][0]["primitives"][0];
  primitive["attributes"]["TEXCOORD_0"] = uv;
  primitive["material"] = 0;
  asset.root["images"] = {{{"uri", uri}}};
  asset.root["textures"] = {{{"source", 0}}};
  if (material.empty())
    material = {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}};
  asset.root["materials"] = {material};
  return asset;
}

TEST(Material, DefaultsAndFactors) {
  Scene scene = load(textured("unused", {{"name", "plain"}}));
  ASSERT_EQ(scene.materials.size(), 2u);
  EXPECT_EQ(scene.meshes[0].material, 1);
  const Material& plain = scene.materials[1];
  EXPECT_EQ(plain.name, "plain");
  EXPECT_EQ(plain.base_color, vec4(1));
  EXPECT_EQ(plain.metallic, 1);
  EXPECT_EQ(plain.roughness, 1);
  EXPECT_EQ(plain.emission, vec3(0));
  EXPECT_EQ(plain.ior, 1.5f);
  EXPECT_EQ(plain.alpha_mode, AlphaMode::opaque);
  EXPECT_TRUE(scene.images.empty());  // an image that no material uses is not opened

  scene = load(textured("unused", {{"pbrMetallicRoughness",
                                    {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}},
                                     {"metallicFactor", 0.5},
                                     {"roughnessFactor", 0.6}}},
                                   {"emissiveFactor", {0.5, 0, 1}},
                                   {"alphaMode", "MASK"},
                                   {"alphaCutoff", 0.25},
                                   {"doubleSided", true},
                                   {"extensions",
                                    {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8}}},
                                     {"KHR_materials_ior", {{"ior", 1.33}}},
                                     {"KHR_materials_transmission", {{"transmissionFactor", 0.9}}},
                                     {"KHR_materials_volume",
                                      {{"thicknessFactor", 2},
                                       {"attenuationDistance", 3},
                                       {"attenuationColor", {1, 0.5, 0.25}}}},
                                     {"KHR_materials_unlit", json::object()}}}}));
  const Material& m = scene.materials[1];
  EXPECT_EQ(m.base_color, vec4(0.1f, 0.2f, 0.3f, 0.4f));
  EXPECT_EQ(m.metallic, 0.5f);
  EXPECT_EQ(m.roughness, 0.6f);
  EXPECT_EQ(m.emission, vec3(4, 0, 8));
  EXPECT_EQ(m.alpha_mode, AlphaMode::mask);
  EXPECT_EQ(m.alpha_cutoff, 0.25f);
  EXPECT_TRUE(m.double_sided);
  EXPECT_TRUE(m.unlit);
  EXPECT_EQ(m.ior, 1.33f);
  EXPECT_EQ(m.transmission, 0.9f);
  EXPECT_EQ(m.thickness, 2);
  EXPECT_EQ(m.attenuation_distance, 3);
  EXPECT_EQ(m.attenuation_color, vec3(1, 0.5f, 0.25f));
  EXPECT_TRUE(has_light(scene));
}

// A material with these extensions, of which the file says that it cannot be shown without them.
Asset extended(const json& extensions, const std::string& uri = "unused") {
  Asset asset = textured(uri, {{"extensions", extensions}});
  for (auto it = extensions.begin(); it != extensions.end(); ++it) {
    asset.root["extensionsUsed"].push_back(it.key());
    asset.root["extensionsRequired"].push_back(it.key());
  }
  return asset;
}

TEST(Material, LayersAndGlossAreRead) {
  Scene scene = load(extended(
      {{"KHR_materials_specular", {{"specularFactor", 0.25}, {"specularColorFactor", {0.5, 2, 1}}}},
       {"KHR_materials_clearcoat",
        {{"clearcoatFactor", 0.75}, {"clearcoatRoughnessFactor", 0.125}}},
       {"KHR_materials_sheen",
        {{"sheenColorFactor", {0.5, 0.25, 1}}, {"sheenRoughnessFactor", 0.5}}},
       {"KHR_materials_dispersion", {{"dispersion", 0.36}}}}));
  EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
  const Material& m = scene.materials[1];
  EXPECT_EQ(m.specular, 0.25f);
  EXPECT_EQ(m.specular_color, vec3(0.5f, 2, 1));
  EXPECT_EQ(m.clearcoat, 0.75f);
  EXPECT_EQ(m.clearcoat_roughness, 0.125f);
  EXPECT_EQ(m.sheen_color, vec3(0.5f, 0.25f, 1));
  EXPECT_EQ(m.sheen_roughness, 0.5f);
  EXPECT_EQ(m.dispersion, 0.36f);
  // These extensions are empty and have their defaults.
  scene = load(extended({{"KHR_materials_specular", json::object()},
                         {"KHR_materials_clearcoat", json::object()},
                         {"KHR_materials_sheen", json::object()},
                         {"KHR_materials_anisotropy", json::object()},
                         {"KHR_materials_dispersion", json::object()}}));
  EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
  const Material& plain = scene.materials[1];
  EXPECT_EQ(plain.specular, 1);
  EXPECT_EQ(plain.specular_color, vec3(1));
  EXPECT_EQ(plain.clearcoat, 0);
  EXPECT_EQ(plain.sheen_color, vec3(0));
  EXPECT_EQ(plain.anisotropy, 0);
  EXPECT_EQ(plain.dispersion, 0);
}

TEST(Material, LayersOutOfRangeAreClampedAloudAndWrongTypesRefused) {
  Scene scene = load(extended({{"KHR_materials_clearcoat", {{"clearcoatFactor", -3}}},
                               {"KHR_materials_sheen", {{"sheenColorFactor", {2, 0, 0}}}},
                               {"KHR_materials_dispersion", {{"dispersion", -1}}}}));
  EXPECT_TRUE(warns_of(scene, "clearcoatFactor"));
  EXPECT_TRUE(warns_of(scene, "sheenColorFactor"));
  EXPECT_TRUE(warns_of(scene, "dispersion"));
  EXPECT_EQ(scene.materials[1].clearcoat, 0);
  EXPECT_EQ(scene.materials[1].sheen_color, vec3(1, 0, 0));
  EXPECT_EQ(scene.materials[1].dispersion, 0);
  auto refused_at = [](const json& extensions) { return refused(extended(extensions)).where; };
  const std::string place = "/materials/0/extensions/";
  EXPECT_EQ(refused_at({{"KHR_materials_sheen", {{"sheenColorFactor", {1, 1}}}}}),
            place + "KHR_materials_sheen/sheenColorFactor");
  EXPECT_EQ(refused_at({{"KHR_materials_anisotropy", {{"anisotropyStrength", "much"}}}}),
            place + "KHR_materials_anisotropy/anisotropyStrength");
  EXPECT_EQ(refused_at({{"KHR_materials_specular", {{"specularTexture", {{"index", 7}}}}}}),
            place + "KHR_materials_specular/specularTexture/index");
}

TEST(Material, PicturesOfLayersAreColoursOrNumbersAsTheirExtensionsSay) {
  const json map = {{"index", 0}};
  Asset asset = extended(
      {{"KHR_materials_specular", {{"specularTexture", map}, {"specularColorTexture", map}}},
       {"KHR_materials_clearcoat",
        {{"clearcoatFactor", 1},
         {"clearcoatTexture", map},
         {"clearcoatRoughnessTexture", map},
         {"clearcoatNormalTexture", {{"index", 0}, {"scale", 0.5}}}}},
       {"KHR_materials_sheen", {{"sheenColorTexture", map}, {"sheenRoughnessTexture", map}}},
       {"KHR_materials_anisotropy",
        {{"anisotropyStrength", 0.5}, {"anisotropyRotation", 1.5}, {"anisotropyTexture", map}}}},
      "data:image/png;base64," + base64(small_png()));
  Scene scene = load(asset);
  EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
  const Material& m = scene.materials[1];
  auto is_color = [&](const TextureRef& r) {
    EXPECT_GE(r.texture, 0);
    return scene.images[size_t(scene.textures[size_t(r.texture)].image)].srgb;
  };
  EXPECT_TRUE(is_color(m.specular_color_texture) && is_color(m.sheen_color_texture));
  for (const TextureRef* r :
       {&m.specular_texture, &m.clearcoat_texture, &m.clearcoat_roughness_texture,
        &m.clearcoat_normal_texture, &m.sheen_roughness_texture, &m.anisotropy_texture})
    EXPECT_FALSE(is_color(*r));
  EXPECT_EQ(m.clearcoat_normal_scale, 0.5f);
  EXPECT_EQ(m.anisotropy, 0.5f);
  EXPECT_EQ(m.anisotropy_rotation, 1.5f);
  EXPECT_EQ(scene.meshes[0].tangents.size(), scene.meshes[0].positions.size());
  asset.root["meshes"][0]["primitives"][0]["attributes"].erase("TEXCOORD_0");
  EXPECT_TRUE(warns_of(load(asset), "anisotropy"));
}

TEST(Material, FactorsOutOfRangeAreClampedAloud) {
  Scene scene = load(textured("unused", {{"pbrMetallicRoughness", {{"roughnessFactor", 7}}}}));
  EXPECT_EQ(scene.materials[1].roughness, 1);
  EXPECT_TRUE(warns_of(scene, "roughnessFactor"));
  scene = load(textured("unused", {{"emissiveFactor", {1e300, 0, 0}}}));
  EXPECT_TRUE(std::isfinite(scene.materials[1].emission.x));
}

TEST(Material, SpecularGlossinessBecomesMetallicRoughness) {
  auto converted = [](json diffuse, json specular, double gloss) {
    return load(textured("unused", {{"extensions",
                                     {{"KHR_materials_pbrSpecularGlossiness",
                                       {{"diffuseFactor", diffuse},
                                        {"specularFactor", specular},
                                        {"glossinessFactor", gloss}}}}}}))
        .materials[1];
  };
  Material plastic = converted({0.8, 0.2, 0.1, 0.5}, {0.04, 0.04, 0.04}, 0.75);
  EXPECT_NEAR(plastic.metallic, 0, 1e-3f);
  EXPECT_NEAR(plastic.roughness, 0.25f, 1e-6f);
  expect_near(vec3(plastic.base_color), vec3(0.8f, 0.2f, 0.1f), 1e-3f);
  EXPECT_EQ(plastic.base_color.w, 0.5f);
  Material gold = converted({0, 0, 0, 1}, {1, 0.77, 0.34}, 1);
  EXPECT_NEAR(gold.metallic, 1, 1e-3f);
  expect_near(vec3(gold.base_color), vec3(1, 0.77f, 0.34f), 1e-2f);
}

TEST(Material, PicturesFromUriViewAndFile) {
  TempFolder folder;
  folder.write("pictures/a b.png", small_png());
  std::vector<std::string> places = {"data:image/png;base64," + base64(small_png()),
                                     "pictures/a%20b.png", "pictures/a b.png"};
  for (const std::string& uri : places) {
    Scene scene = load_scene(folder.write("test.gltf", textured(uri).gltf()));
    ASSERT_EQ(scene.images.size(), 1u) << uri;
    const Image& image = scene.images[0];
    EXPECT_EQ(image.width, 2);
    EXPECT_EQ(image.height, 1);
    EXPECT_TRUE(image.srgb);
    EXPECT_EQ(image.texels8, (std::vector<uint8_t>{255, 0, 0, 255, 0, 128, 0, 64}));
  }
  Asset asset = textured("");
  std::string png = small_png();
  int view = asset.add_view(std::vector<char>(png.begin(), png.end()));
  asset.root["images"] = {{{"bufferView", view}, {"mimeType", "image/png"}}};
  EXPECT_EQ(load(asset).images[0].width, 2);
}

TEST(Material, SixteenBitPicturesKeepTheirPrecision) {
  // Two texels: red 0x0102 and 0xffff.
  std::string rows =
      std::string("\0\x01\x02\0\0\0\0\xff\xff", 9) + std::string("\xff\xff\0\0\0\0\xff\xff", 8);
  std::string uri = "data:image/png;base64," + base64(make_png(2, 1, 16, rows));
  json linear = {{"pbrMetallicRoughness", {{"metallicRoughnessTexture", {{"index", 0}}}}}};
  Image image = load(textured(uri, linear)).images[0];
  ASSERT_EQ(image.texels.size(), 2u);
  EXPECT_NEAR(image.texels[0].x, 258.0f / 65535, 1e-7f);
  EXPECT_EQ(image.texels[1].x, 1.0f);
  image = load(textured(uri)).images[0];  // as a colour: decoded from sRGB
  EXPECT_NEAR(image.texels[0].x, 258.0f / 65535 / 12.92f, 1e-7f);
  EXPECT_FALSE(image.srgb);
}

TEST(Material, OnePictureAsColourAndAsNumbers) {
  json material = {
      {"pbrMetallicRoughness",
       {{"baseColorTexture", {{"index", 0}}}, {"metallicRoughnessTexture", {{"index", 0}}}}}};
  Scene scene = load(textured("data:image/png;base64," + base64(small_png()), material));
  ASSERT_EQ(scene.images.size(), 2u);
  auto image_of = [&](const TextureRef& r) {
    return scene.images[size_t(scene.textures[size_t(r.texture)].image)];
  };
  EXPECT_TRUE(image_of(scene.materials[1].base_color_texture).srgb);
  EXPECT_FALSE(image_of(scene.materials[1].metallic_roughness_texture).srgb);
}

TEST(Material, SamplersAndTextureTransform) {
  Asset asset = textured("data:image/png;base64," + base64(small_png()));
  asset.root["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}}};
  asset.root["textures"][0]["sampler"] = 0;
  asset.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] = {
      {"KHR_texture_transform",
       {{"offset", {0.5, 0.25}}, {"scale", {2, 4}}, {"rotation", pi / 2.0}, {"texCoord", 1}}}};
  Scene scene = load(asset);
  EXPECT_EQ(scene.textures[0].wrap_u, Wrap::clamp);
  EXPECT_EQ(scene.textures[0].wrap_v, Wrap::mirror);
  EXPECT_TRUE(scene.textures[0].nearest);
  const TextureRef& reference = scene.materials[1].base_color_texture;
  EXPECT_EQ(reference.uv_set, 1);
  vec3 u = reference.uv_transform * vec3(1, 0, 1), v = reference.uv_transform * vec3(0, 1, 1);
  expect_near(u, vec3(0.5f, 0.25f - 2, 1));  // scaled, turned clockwise as seen with v down, moved
  expect_near(v, vec3(0.5f + 4, 0.25f, 1));
  EXPECT_TRUE(warns_of(scene, "one texel"));  // the mesh has no second set
}

TEST(Material, MissingPicturesAreWarnedOfBrokenOnesRefused) {
  Scene scene = load(textured("nowhere.png"));
  EXPECT_TRUE(warns_of(scene, "nowhere.png"));
  EXPECT_EQ(scene.materials[1].base_color_texture.texture, -1);
  EXPECT_EQ(refused(textured("data:image/png;base64,AAAA")).where, "/images/0");
  EXPECT_EQ(refused(textured("data:image/png;base64," + base64("GIF89a......"))).where,
            "/images/0");
  EXPECT_EQ(refused(textured("data:image/png;base64,*")).where, "/images/0/uri");
  EXPECT_EQ(refused(textured("data:image/png;base64")).where, "/images/0/uri");
  std::string png = small_png();
  for (size_t cut = 8; cut + 16 < png.size(); cut += 3)
    EXPECT_EQ(refused(textured("data:image/png;base64," + base64(png.substr(0, cut)))).where,
              "/images/0");
  Asset asset = textured("x.png");
  asset.root["textures"][0].erase("source");  // only an extension could say which picture
  EXPECT_TRUE(warns_of(load(asset), "no picture"));
}

TEST(Material, PictureBombsAreRefusedByTheirHeader) {
  std::string bomb = make_png(16385, 1, 8, "x");
  EXPECT_NE(refused(textured("data:image/png;base64," + base64(bomb))).what_.find("picture"),
            std::string::npos);
  Asset asset = textured("data:image/png;base64," + base64(make_png(16384, 16384, 8, "x")));
  asset.root["materials"][0]["emissiveTexture"] = {{"index", 0}};
  EXPECT_EQ(refused(asset).where, "/images/0");
}

TEST(Material, TangentsAreMadeForNormalMaps) {
  json material = {{"normalTexture", {{"index", 0}, {"scale", 0.5}}}};
  Asset asset = textured("data:image/png;base64," + base64(small_png()), material);
  // Upright picture on the triangle: u along +X, v down along -Y.
  asset.root["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] =
      asset.add_floats("VEC2", 2, {0, 1, 1, 1, 0, 0});
  Scene scene = load(asset);
  EXPECT_EQ(scene.materials[1].normal_scale, 0.5f);
  ASSERT_EQ(scene.meshes[0].tangents.size(), scene.meshes[0].positions.size());
  for (const vec4& t : scene.meshes[0].tangents) {
    expect_near(vec3(t), vec3(1, 0, 0));
    EXPECT_EQ(t.w, 1);
  }
  asset.root["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] =
      asset.add_floats("VEC2", 2, {0, 0, 1, 0, 0, 1});  // upside down
  scene = load(asset);
  for (const vec4& t : scene.meshes[0].tangents) EXPECT_EQ(t.w, -1);
  asset.root["meshes"][0]["primitives"][0]["attributes"].erase("TEXCOORD_0");
  EXPECT_TRUE(warns_of(load(asset), "no effect"));
}

TEST(Material, MirroredPicturesSplitTheirSharedVertices) {
  // Two triangles over a shared edge, the picture mirrored from one to the other.
  Asset asset =
      textured("data:image/png;base64," + base64(small_png()), {{"normalTexture", {{"index", 0}}}});
  int position = asset.add_floats("VEC3", 3, {0, 0, 0, 0, 1, 0, -1, 0, 0, 1, 0, 0});
  int normal = asset.add_floats("VEC3", 3, {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
  int uv = asset.add_floats("VEC2", 2, {0, 1, 0, 0, 1, 1, 1, 1});
  int indices = asset.add_accessor(asset.add_view<uint8_t>({0, 1, 2, 0, 3, 1}), 5121, "SCALAR", 6);
  asset.root["meshes"][0]["primitives"][0] = {
      {"attributes", {{"POSITION", position}, {"NORMAL", normal}, {"TEXCOORD_0", uv}}},
      {"indices", indices},
      {"material", 0}};
  Mesh mesh = load(asset).meshes[0];
  EXPECT_EQ(mesh.positions.size(), 6u);
  for (int corner = 0; corner < 3; corner++) {
    expect_near(vec3(mesh.tangents[mesh.triangles[0][corner]]), vec3(-1, 0, 0));
    expect_near(vec3(mesh.tangents[mesh.triangles[1][corner]]), vec3(1, 0, 0));
    EXPECT_EQ(mesh.tangents[mesh.triangles[0][corner]].w, -1);
    EXPECT_EQ(mesh.tangents[mesh.triangles[1][corner]].w, 1);
  }
}

TEST(Environment, RadiancePicture) {
  TempFolder folder;
  // Two texels, flat RGBE: (1, 0.5, 0.25) and black.
  std::string hdr = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n";
  hdr += std::string("\x80\x40\x20\x81\0\0\0\0", 8);
  Scene scene;
  load_environment(folder.write("sky.hdr", hdr), scene);
  ASSERT_EQ(scene.environment.image, 0);
  EXPECT_EQ(scene.environment.radiance, vec3(1));
  EXPECT_EQ(scene.images[0].width, 2);
  expect_near(vec3(scene.images[0].texels[0]), vec3(1, 0.5f, 0.25f));
  expect_near(vec3(scene.images[0].texels[1]), vec3(0));
  EXPECT_TRUE(has_light(scene));
  EXPECT_THROW(load_environment(folder.write("bad.hdr", "#?RADIANCE\n"), scene), LoadError);
  EXPECT_THROW(load_environment(folder.write("png.hdr", small_png()), scene), LoadError);
  EXPECT_THROW(load_environment((folder.path() / "none.hdr").string(), scene), LoadError);
}

}  // namespace
}  // namespace wellspring::test
