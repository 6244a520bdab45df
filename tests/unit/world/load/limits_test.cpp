// SPDX-License-Identifier: Apache-2.0
// What a file may cost is counted in bytes and totals, however it divides its data.
#include "gltf/file.h"

#include "unit/world/load/asset.h"

namespace wellspring::test {
namespace {

constexpr size_t corners = 17'000'001;  // indices of one primitive

// A square of two triangles after very many without area, all in one list of bytes.
Asset long_list(size_t primitives) {
  Asset asset;
  const int position = asset.add_floats("VEC3", 3, {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
  std::vector<uint8_t> list(corners, 0);
  const uint8_t square[] = {0, 1, 2, 0, 2, 3};
  std::copy(square, square + 6, list.end() - 6);
  const int indices = asset.add_accessor(asset.add_view(list), 5121, "SCALAR", corners);
  const json primitive = {{"attributes", {{"POSITION", position}}}, {"indices", indices}};
  asset.add_mesh(primitive);
  for (size_t i = 1; i < primitives; i++)
    asset.root["meshes"][0]["primitives"].push_back(primitive);
  asset.add_node({{"mesh", 0}});
  return asset;
}

TEST(Limits, AScanInOnePrimitiveIsAsGoodAsInMany) {
  TempFolder folder;
  EXPECT_EQ(triangle_count(load_scene(folder.write("one.glb", long_list(1).glb()))), 2u);
}

TEST(Limits, WhatIsRefusedSaysTheLimitAndWhatToDo) {
  const LoadError error = refused(long_list(6).glb(), "six.glb");
  EXPECT_EQ(error.where, "/meshes/0/primitives/5");
  EXPECT_NE(error.what_.find(std::to_string(gltf::triangles_limit)), std::string::npos);
  EXPECT_NE(error.what_.find("Decimate"), std::string::npos) << error.what_;
  EXPECT_NE(error.what_.find("docs/operation.md"), std::string::npos) << error.what_;
}

TEST(Limits, ASmallFileCannotAskForManyNumbersWithoutBytes) {
  for (const char* type : {"SCALAR", "VEC3", "MAT4"}) {
    Asset asset = triangle_asset();
    const int64_t components = type[0] == 'S' ? 1 : type[0] == 'V' ? 3 : 16;
    const int64_t most = gltf::empty_numbers_limit / components;
    asset.add_accessor(-1, 5126, type, size_t(most));
    EXPECT_EQ(triangle_count(load(asset)), 1u) << type;
    asset.root["accessors"][1]["count"] = most + 1;
    EXPECT_EQ(refused(asset).where, "/accessors/1/count") << type;
  }
}

}  // namespace
}  // namespace wellspring::test
