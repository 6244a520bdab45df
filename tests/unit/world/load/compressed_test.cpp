// SPDX-License-Identifier: Apache-2.0
// Meshes, pictures and copies that a file has by extensions: EXT_meshopt_compression,
// KHR_draco_mesh_compression, EXT_texture_webp, EXT_mesh_gpu_instancing.
#include <gtest/gtest.h>

#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <meshoptimizer.h>
#include <webp/encode.h>

#include "unit/world/load/asset.h"

namespace wellspring::test {
namespace {

const std::vector<float> square_positions = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
const std::vector<uint32_t> square_indices = {0, 1, 2, 0, 2, 3};

float area_of(const Scene& scene) {
  float area = 0;
  for (const Mesh& mesh : scene.meshes)
    for (const uvec3& t : mesh.triangles)
      area += 0.5f * glm::length(cross(mesh.positions[t.y] - mesh.positions[t.x],
                                       mesh.positions[t.z] - mesh.positions[t.x]));
  return area;
}

// A view of `count` elements whose bytes are those of `packed`, by meshopt.
int add_packed(Asset& asset, const std::vector<uint8_t>& packed, size_t count, size_t stride,
               const char* mode, const char* name = "EXT_meshopt_compression") {
  const int stored = asset.add_view(packed);
  json view = asset.root["bufferViews"][size_t(stored)];
  json extension = {{"buffer", 0},
                    {"byteOffset", view["byteOffset"]},
                    {"byteLength", packed.size()},
                    {"byteStride", stride},
                    {"count", count},
                    {"mode", mode}};
  view = {{"buffer", 0}, {"byteLength", count * stride}, {"extensions", {{name, extension}}}};
  asset.root["bufferViews"].push_back(view);
  return int(asset.root["bufferViews"].size()) - 1;
}

std::vector<uint8_t> pack_positions() {
  std::vector<uint8_t> packed(meshopt_encodeVertexBufferBound(4, 12));
  packed.resize(
      meshopt_encodeVertexBuffer(packed.data(), packed.size(), square_positions.data(), 4, 12));
  return packed;
}

std::vector<uint8_t> pack_indices() {
  std::vector<uint8_t> packed(meshopt_encodeIndexBufferBound(6, 4));
  packed.resize(meshopt_encodeIndexBuffer(packed.data(), packed.size(), square_indices.data(), 6));
  return packed;
}

// The packed positions may be changed by `change` first.
Asset meshopt_square(const char* name = "EXT_meshopt_compression") {
  Asset asset;
  asset.add_view(std::vector<uint8_t>(400));  // so that the views' own bytes are there
  const int position = asset.add_accessor(
      add_packed(asset, pack_positions(), 4, 12, "ATTRIBUTES", name), 5126, "VEC3", 4);
  const int indices = asset.add_accessor(add_packed(asset, pack_indices(), 6, 4, "TRIANGLES", name),
                                         5125, "SCALAR", 6);
  asset.add_mesh({{"attributes", {{"POSITION", position}}}, {"indices", indices}});
  asset.add_node({{"mesh", 0}});
  asset.root["extensionsUsed"] = asset.root["extensionsRequired"] = {name};
  return asset;
}

TEST(Meshopt, ViewsAreUnpacked) {
  for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
    EXPECT_NEAR(area_of(load(meshopt_square(name))), 1, 1e-6f) << name;
}

TEST(Meshopt, WhatDoesNotFitIsRefusedAtItsPlace) {
  const std::string at = "/bufferViews/2/extensions/EXT_meshopt_compression";
  auto refused_with = [&](const char* key, const json& value) {
    Asset asset = meshopt_square();
    asset.root["bufferViews"][2]["extensions"]["EXT_meshopt_compression"][key] = value;
    return refused(asset).where;
  };
  EXPECT_EQ(refused_with("mode", "POINTS"), at + "/mode");
  EXPECT_EQ(refused_with("byteStride", 6), at + "/byteStride");
  EXPECT_EQ(refused_with("filter", "OCTAHEDRAL"), at + "/filter");
  EXPECT_EQ(refused_with("count", 5), at + "/count");
  EXPECT_EQ(refused_with("byteLength", 100'000), at);
  EXPECT_EQ(refused_with("buffer", 3), at + "/buffer");
  EXPECT_EQ(refused_with("byteLength", 9), at);  // cut off: the decoder finds out
}

TEST(Meshopt, BrokenDataIsRefusedOrLoads) {
  Asset good = meshopt_square();
  for (size_t i = 400; i < good.bytes.size(); i++)
    for (uint8_t flip : {0x01, 0x80, 0xff}) {
      Asset bad = good;
      bad.bytes[i] = char(uint8_t(bad.bytes[i]) ^ flip);
      try {
        load(bad);
      } catch (const LoadError& error) {
        EXPECT_FALSE(error.where.empty());
      }
    }
}

std::vector<uint8_t> draco_bytes() {
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(2);
  const int id = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  for (int f = 0; f < 2; f++) {
    const float* corner[3];
    for (size_t c = 0; c < 3; c++)
      corner[c] = &square_positions[square_indices[size_t(f) * 3 + c] * 3];
    builder.SetAttributeValuesForFace(id, draco::FaceIndex(uint32_t(f)), corner[0], corner[1],
                                      corner[2]);
  }
  const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
  draco::Encoder encoder;
  draco::EncoderBuffer buffer;
  EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
  return {buffer.data(), buffer.data() + buffer.size()};
}

Asset draco_square() {
  Asset asset;
  const int view = asset.add_view(draco_bytes());
  const int position = asset.add_accessor(-1, 5126, "VEC3", 4);
  const int indices = asset.add_accessor(-1, 5123, "SCALAR", 6);
  asset.add_mesh({{"attributes", {{"POSITION", position}}},
                  {"indices", indices},
                  {"extensions",
                   {{"KHR_draco_mesh_compression",
                     {{"bufferView", view}, {"attributes", {{"POSITION", 0}}}}}}}});
  asset.add_node({{"mesh", 0}});
  asset.root["extensionsUsed"] = asset.root["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  return asset;
}

TEST(Draco, MeshesAreUnpacked) {
  const Scene scene = load(draco_square());
  EXPECT_EQ(triangle_count(scene), 2u);
  EXPECT_NEAR(area_of(scene), 1, 1e-5f);
}

TEST(Draco, WhatDoesNotFitIsRefusedAtItsPlace) {
  const std::string at = "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression";
  auto packed = [](Asset& asset) -> json& {
    return asset.root["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"];
  };
  Asset asset = draco_square();
  packed(asset)["attributes"]["POSITION"] = 7;
  EXPECT_EQ(refused(asset).where, at + "/attributes/POSITION");
  asset = draco_square();
  packed(asset)["bufferView"] = 1;
  EXPECT_EQ(refused(asset).where, at + "/bufferView");
  asset = draco_square();
  asset.root["accessors"][0]["type"] = "VEC2";
  EXPECT_EQ(refused(asset).where, at + "/attributes/POSITION");
  asset = draco_square();
  asset.bytes[0] = 'X';
  EXPECT_EQ(refused(asset).where, at);
}

TEST(Draco, BrokenDataIsRefusedOrLoads) {
  const Asset good = draco_square();
  for (size_t i = 0; i < good.bytes.size(); i++)
    for (uint8_t flip : {0x01, 0x80, 0xff}) {
      Asset bad = good;
      bad.bytes[i] = char(uint8_t(bad.bytes[i]) ^ flip);
      try {
        load(bad);
      } catch (const LoadError& error) {
        EXPECT_FALSE(error.where.empty());
      }
    }
}

TEST(Instances, AMeshStandsWhereverItsNodeSays) {
  Asset asset = triangle_asset();
  const int places = asset.add_floats("VEC3", 3, {0, 0, 0, 5, 0, 0});
  const int scales = asset.add_floats("VEC3", 3, {1, 1, 1, 2, 2, 2});
  const int turns = asset.add_accessor(asset.add_view<int8_t>({0, 0, 0, 127, 0, 127, 0, 0}), 5120,
                                       "VEC4", 2, {{"normalized", true}});
  asset.root["nodes"][0]["translation"] = {0, 1, 0};
  asset.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
      {"TRANSLATION", places}, {"SCALE", scales}, {"ROTATION", turns}};
  asset.root["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
  const Scene scene = load(asset);
  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(scene.instances[0].mesh, scene.instances[1].mesh);
  EXPECT_EQ(scene.instances[0].object, scene.instances[1].object);
  const vec4 corner = scene.instances[1].to_world * vec4(1, 0, 0, 1);  // half a turn about +Y
  EXPECT_NEAR(glm::length(vec3(corner) - vec3(3, 1, 0)), 0, 1e-5f);
  asset.root["accessors"][size_t(scales)]["count"] = 1;
  EXPECT_EQ(refused(asset).where, "/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes/SCALE");
}

Asset webp_triangle(const std::string& bytes) {
  Asset asset = triangle_asset();
  const int view = asset.add_view(std::vector<uint8_t>(bytes.begin(), bytes.end()));
  asset.root["images"] = {{{"bufferView", view}, {"mimeType", "image/webp"}}};
  asset.root["textures"] = {{{"extensions", {{"EXT_texture_webp", {{"source", 0}}}}}}};
  asset.root["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
  asset.root["meshes"][0]["primitives"][0]["material"] = 0;
  asset.root["extensionsRequired"] = {"EXT_texture_webp"};
  return asset;
}

TEST(WebP, PicturesAreRead) {
  const std::vector<uint8_t> texels = {255, 0, 0, 255, 0, 255, 0, 128};
  uint8_t* made = nullptr;
  const size_t size = WebPEncodeLosslessRGBA(texels.data(), 2, 1, 8, &made);
  const std::string bytes(reinterpret_cast<char*>(made), size);
  WebPFree(made);
  const Scene scene = load(webp_triangle(bytes));
  ASSERT_EQ(scene.images.size(), 1u);
  EXPECT_EQ(scene.images[0].width, 2);
  EXPECT_EQ(std::vector<uint8_t>(scene.images[0].texels8.begin(), scene.images[0].texels8.end()),
            texels);
  for (size_t length = 12; length < size; length++)
    EXPECT_EQ(refused(webp_triangle(bytes.substr(0, length))).where, "/images/0") << length;
}

TEST(Basis, PicturesThatAreNotReadAreRefusedWithWhatToDo) {
  Asset asset = triangle_asset();
  asset.root["extensionsRequired"] = {"KHR_texture_basisu"};
  const LoadError error = refused(asset);
  EXPECT_EQ(error.where, "/extensionsRequired/0");
  EXPECT_NE(error.what_.find("gltf-transform ktxdecompress"), std::string::npos);
}

}  // namespace
}  // namespace wellspring::test
