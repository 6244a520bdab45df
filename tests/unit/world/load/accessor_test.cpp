// SPDX-License-Identifier: Apache-2.0
// Every accessor form of glTF 2.0 section 3.6.2, seen through the vertices it makes.
#include "unit/world/load/asset.h"

namespace wellspring::test {
namespace {

TEST(Accessor, Interleaved) {
  Asset asset;
  int view = asset.add_view<float>({0, 0, 0, 0, 0, 1, 2, 0, 0, 0, 0, 1, 0, 3, 0, 0, 0, 1}, 24);
  int position = asset.add_accessor(view, 5126, "VEC3", 3);
  int normal = asset.add_accessor(view, 5126, "VEC3", 3, {{"byteOffset", 12}});
  asset.add_mesh({{"attributes", {{"POSITION", position}, {"NORMAL", normal}}}});
  asset.add_node({{"mesh", 0}});
  Scene scene = load(asset);
  EXPECT_EQ(corner_of(scene, 0, 0, 1), vec3(2, 0, 0));
  EXPECT_EQ(corner_of(scene, 0, 0, 2), vec3(0, 3, 0));
  EXPECT_EQ(scene.meshes[0].normals[2], vec3(0, 0, 1));
  EXPECT_EQ(scene.meshes[0].positions.size(), 3u);
}

template <class T>
void expect_index_type(int component_type) {
  Asset asset;
  int position = asset.add_floats("VEC3", 3, {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
  std::vector<T> list = {0, 1, 2, 0, 2, 3};
  int indices = asset.add_accessor(asset.add_view(list), component_type, "SCALAR", 6);
  asset.add_mesh({{"attributes", {{"POSITION", position}}}, {"indices", indices}});
  asset.add_node({{"mesh", 0}});
  Scene scene = load(asset);
  ASSERT_EQ(triangle_count(scene), 2u);
  EXPECT_EQ(corner_of(scene, 0, 1, 1), vec3(1, 1, 0));
  EXPECT_EQ(corner_of(scene, 0, 1, 2), vec3(0, 1, 0));
}

TEST(Accessor, IndexTypes) {
  expect_index_type<uint8_t>(5121);
  expect_index_type<uint16_t>(5123);
  expect_index_type<uint32_t>(5125);
}

TEST(Accessor, SparseOverData) {
  Asset asset;
  int base = asset.add_view<float>({0, 0, 0, 1, 0, 0, 0, 1, 0});
  int indices = asset.add_view<uint16_t>({1, 2}),
      values = asset.add_view<float>({5, 0, 0, 0, 7, 0});
  int position =
      asset.add_accessor(base, 5126, "VEC3", 3,
                         {{"sparse",
                           {{"count", 2},
                            {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                            {"values", {{"bufferView", values}}}}}});
  asset.add_mesh({{"attributes", {{"POSITION", position}}}});
  asset.add_node({{"mesh", 0}});
  Scene scene = load(asset);
  EXPECT_EQ(corner_of(scene, 0, 0, 0), vec3(0, 0, 0));
  EXPECT_EQ(corner_of(scene, 0, 0, 1), vec3(5, 0, 0));
  EXPECT_EQ(corner_of(scene, 0, 0, 2), vec3(0, 7, 0));
}

TEST(Accessor, SparseOverZerosAndSparseIndices) {
  Asset asset;
  int which = asset.add_view<uint8_t>({1, 3}), values = asset.add_view<float>({4, 0, 0, 0, 4, 0});
  int position =
      asset.add_accessor(-1, 5126, "VEC3", 4,
                         {{"sparse",
                           {{"count", 2},
                            {"indices", {{"bufferView", which}, {"componentType", 5121}}},
                            {"values", {{"bufferView", values}}}}}});
  int base = asset.add_view<uint16_t>({0, 1, 2}), slot = asset.add_view<uint32_t>({2}),
      value = asset.add_view<uint16_t>({3});
  int indices = asset.add_accessor(base, 5123, "SCALAR", 3,
                                   {{"sparse",
                                     {{"count", 1},
                                      {"indices", {{"bufferView", slot}, {"componentType", 5125}}},
                                      {"values", {{"bufferView", value}}}}}});
  asset.add_mesh({{"attributes", {{"POSITION", position}}}, {"indices", indices}});
  asset.add_node({{"mesh", 0}});
  Scene scene = load(asset);
  EXPECT_EQ(corner_of(scene, 0, 0, 0), vec3(0, 0, 0));
  EXPECT_EQ(corner_of(scene, 0, 0, 1), vec3(4, 0, 0));
  EXPECT_EQ(corner_of(scene, 0, 0, 2), vec3(0, 4, 0));
}

TEST(Accessor, WithoutDataIsZero) {
  Asset asset = triangle_asset();
  int colors = asset.add_accessor(-1, 5126, "VEC4", 3);
  asset.root["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = colors;
  EXPECT_EQ(load(asset).meshes[0].colors[1], vec4(0));
}

// Stored numbers of each type and what they must become, as the colours and texture coordinates.
TEST(Accessor, NormalisedColoursAndCoordinates) {
  Asset asset = triangle_asset();
  json& attributes = asset.root["meshes"][0]["primitives"][0]["attributes"];
  int bytes = asset.add_view<uint8_t>({255, 51, 0, 0, 255, 51, 0, 0, 255, 51, 0, 0}, 4);
  attributes["COLOR_0"] = asset.add_accessor(bytes, 5121, "VEC3", 3, {{"normalized", true}});
  int shorts = asset.add_view<uint16_t>({65535, 13107, 0, 65535, 13107, 0});
  attributes["TEXCOORD_0"] = asset.add_accessor(shorts, 5123, "VEC2", 3, {{"normalized", true}});
  Scene scene = load(asset);
  EXPECT_NEAR(scene.meshes[0].colors[2].y, 0.2f, 1e-6f);
  EXPECT_EQ(scene.meshes[0].colors[2].x, 1.0f);
  EXPECT_EQ(scene.meshes[0].colors[2].w, 1.0f);  // three components: opaque
  EXPECT_EQ(scene.meshes[0].uv[0][0].x, 1.0f);
  EXPECT_NEAR(scene.meshes[0].uv[0][0].y, 0.2f, 1e-6f);
  EXPECT_NEAR(scene.meshes[0].uv[0][1].y, 1.0f, 1e-6f);
}

TEST(Accessor, QuantizedPositionsAndNormals) {
  Asset asset;
  int shorts = asset.add_view<int16_t>({0, 0, 0, 0, 32767, 0, 0, 0, -32768, 16384, 0, 0}, 8);
  int bytes = asset.add_view<int8_t>({0, 0, 127, 0, 0, -128, 0, 0, 127, 0, 0, 0}, 4);
  int position = asset.add_accessor(shorts, 5122, "VEC3", 3, {{"normalized", true}});
  int normal = asset.add_accessor(bytes, 5120, "VEC3", 3, {{"normalized", true}});
  asset.add_mesh({{"attributes", {{"POSITION", position}, {"NORMAL", normal}}}});
  asset.add_node({{"mesh", 0}});
  EXPECT_EQ(refused(asset).where,
            "/meshes/0/primitives/0/attributes/NORMAL");  // not without saying so
  asset.root["extensionsUsed"] = asset.root["extensionsRequired"] = {"KHR_mesh_quantization"};
  Scene scene = load(asset);
  expect_near(corner_of(scene, 0, 0, 1), vec3(1, 0, 0), 1e-6f);
  expect_near(corner_of(scene, 0, 0, 2), vec3(-1, 16384.0f / 32767.0f, 0), 1e-6f);
  EXPECT_EQ(scene.meshes[0].normals[1], vec3(0, -1, 0));
  // Unnormalised: the integers themselves.
  asset.root["accessors"][0].erase("normalized");
  expect_near(corner_of(load(asset), 0, 0, 1), vec3(32767, 0, 0), 1e-6f);
}

TEST(Accessor, IntegersThatForgotToSayNormalisedAreColoursAnyway) {
  Asset asset = triangle_asset();
  int bytes = asset.add_view<uint8_t>({255, 0, 51, 255, 255, 0, 51, 255, 255, 0, 51, 255});
  asset.root["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
      asset.add_accessor(bytes, 5121, "VEC4", 3);
  Scene scene = load(asset);
  EXPECT_NEAR(scene.meshes[0].colors[0].z, 0.2f, 1e-6f);
  EXPECT_TRUE(warns_of(scene, "normalised"));
}

TEST(Accessor, BoundsAreChecked) {
  auto with = [](auto change) {
    Asset asset = triangle_asset();
    change(asset.root);
    return refused(asset);
  };
  EXPECT_EQ(with([](json& r) { r["accessors"][0]["count"] = 4; }).where, "/accessors/0");
  EXPECT_EQ(with([](json& r) { r["accessors"][0]["count"] = 4000000000u; }).where, "/accessors/0");
  EXPECT_EQ(with([](json& r) { r["accessors"][0]["byteOffset"] = 4; }).where, "/accessors/0");
  EXPECT_EQ(with([](json& r) { r["accessors"][0]["byteOffset"] = 9007199254740991; }).where,
            "/accessors/0");
  EXPECT_EQ(with([](json& r) { r["accessors"][0]["byteOffset"] = -4; }).where,
            "/accessors/0/byteOffset");
  EXPECT_EQ(with([](json& r) { r["accessors"][0]["type"] = "MAT4"; }).where, "/accessors/0");
  EXPECT_EQ(with([](json& r) { r["accessors"][0]["componentType"] = 5124; }).where,
            "/meshes/0/primitives/0/attributes/POSITION");
  EXPECT_EQ(with([](json& r) { r["bufferViews"][0]["byteLength"] = 37; }).where, "/bufferViews/0");
  EXPECT_EQ(with([](json& r) { r["bufferViews"][0]["byteOffset"] = 9007199254740991; }).where,
            "/bufferViews/0");
  EXPECT_EQ(with([](json& r) { r["bufferViews"][0]["byteStride"] = 8; }).where, "/accessors/0");
  EXPECT_EQ(with([](json& r) { r["bufferViews"][0]["byteStride"] = 1e15; }).where,
            "/bufferViews/0/byteStride");
  EXPECT_EQ(with([](json& r) { r["bufferViews"][0]["buffer"] = 1; }).where,
            "/bufferViews/0/buffer");
}

TEST(Accessor, SparseBoundsAreChecked) {
  auto with = [](int count, uint16_t last, int values_count) {
    Asset asset;
    int indices = asset.add_view<uint16_t>({0, last});
    int values = asset.add_view(std::vector<float>(size_t(values_count) * 3));
    int position =
        asset.add_accessor(-1, 5126, "VEC3", 3,
                           {{"sparse",
                             {{"count", count},
                              {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                              {"values", {{"bufferView", values}}}}}});
    asset.add_mesh({{"attributes", {{"POSITION", position}}}});
    asset.add_node({{"mesh", 0}});
    return refused(asset).where;
  };
  EXPECT_EQ(with(2, 3, 2), "/accessors/0/sparse/indices");
  EXPECT_EQ(with(4, 1, 2), "/accessors/0/sparse/count");
  EXPECT_EQ(with(3, 1, 3), "/accessors/0/sparse/indices");
  EXPECT_EQ(with(2, 1, 1), "/accessors/0/sparse/values");
}

TEST(Accessor, SmallFilesCannotAskForEndlessMemory) {
  // A thousand primitives over one accessor of four million zeros.
  Asset asset;
  int position = asset.add_accessor(-1, 5126, "VEC3", 4'000'000);
  json primitive = {{"attributes", {{"POSITION", position}}}};
  asset.add_mesh(primitive);
  for (int i = 0; i < 1000; i++) asset.root["meshes"][0]["primitives"].push_back(primitive);
  asset.add_node({{"mesh", 0}});
  EXPECT_NE(refused(asset).what_.find("vertices"), std::string::npos);
  asset.root["accessors"][0]["count"] = 5'000'000;  // and no data to show for it
  EXPECT_EQ(refused(asset).where, "/accessors/0/count");
}

TEST(Accessor, PrimitivesThatShareAListKeepOnlyTheirOwnVertices) {
  Asset asset;
  std::vector<float> row;
  for (int i = 0; i < 300; i++) row.insert(row.end(), {float(i), float(i % 2), 0});
  int position = asset.add_floats("VEC3", 3, row);
  std::vector<uint16_t> first = {7, 8, 9}, second = {299, 4, 299 - 1};
  int a = asset.add_accessor(asset.add_view(first), 5123, "SCALAR", 3);
  int b = asset.add_accessor(asset.add_view(second), 5123, "SCALAR", 3);
  asset.add_mesh({{"attributes", {{"POSITION", position}}}, {"indices", a}});
  asset.root["meshes"][0]["primitives"].push_back(
      {{"attributes", {{"POSITION", position}}}, {"indices", b}});
  asset.add_node({{"mesh", 0}});
  Scene scene = load(asset);
  ASSERT_EQ(scene.meshes.size(), 2u);
  EXPECT_EQ(scene.meshes[0].positions.size(), 3u);
  EXPECT_EQ(corner_of(scene, 0, 0, 1), vec3(8, 0, 0));
  EXPECT_EQ(corner_of(scene, 1, 0, 0), vec3(299, 1, 0));
  EXPECT_EQ(corner_of(scene, 1, 0, 1), vec3(4, 0, 0));
}

}  // namespace
}  // namespace wellspring::test
