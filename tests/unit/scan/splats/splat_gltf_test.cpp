// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <fmt/format.h>

#include "unit/scan/splats/splat_files.h"

namespace wellspring::test {
namespace {
using scan::load_splats;
using scan::SplatSet;

// A GLB of one JSON and one buffer.
std::string glb(std::string json, std::string binary) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  binary.resize((binary.size() + 3) / 4 * 4);
  ScanBytes to;
  to.bytes = "glTF";
  to.put(uint32_t(2)).put(uint32_t(28 + json.size() + binary.size()));
  to.put(uint32_t(json.size())).bytes += "JSON" + json;
  to.put(uint32_t(binary.size())).bytes += std::string("BIN\0", 4) + binary;
  return to.bytes;
}

// One primitive whose attributes are lists of floats, shown by one node.
struct MadeGltf {
  std::string attributes, accessors, views, binary;
  int count = 0;
  void add(const std::string& name, const std::string& type, int components,
           std::initializer_list<float> values) {
    const char* comma = count ? "," : "";
    attributes += fmt::format("{}\"{}\":{}", comma, name, count);
    accessors += fmt::format(
        "{}{{\"bufferView\":{},\"componentType\":5126,\"count\":{},"
        "\"type\":\"{}\",\"min\":[0,0,0],\"max\":[0,0,0]}}",
        comma, count, values.size() / size_t(components), type);
    views += fmt::format("{}{{\"buffer\":0,\"byteOffset\":{},\"byteLength\":{}}}", comma,
                         binary.size(), values.size() * 4);
    ScanBytes to;
    for (const float value : values) to.put(value);
    binary += to.bytes;
    count++;
  }
  std::string file(const std::string& extensions, const std::string& node = "",
                   const std::string& more_views = "") const {
    return glb(
        fmt::format("{{\"asset\":{{\"version\":\"2.0\"}},\"extensionsUsed\":"
                    "[\"KHR_gaussian_splatting\"],\"scene\":0,\"scenes\":[{{\"nodes\":[0]}}],"
                    "\"nodes\":[{{\"mesh\":0{}}}],\"meshes\":[{{\"primitives\":[{{\"mode\":0,"
                    "\"attributes\":{{{}}}{}}}]}}],\"accessors\":[{}],\"bufferViews\":[{}{}],"
                    "\"buffers\":[{{\"byteLength\":{}}}]}}",
                    node, attributes, extensions, accessors, views, more_views, binary.size()),
        binary);
  }
};

const std::string as_splats =
    ",\"extensions\":{\"KHR_gaussian_splatting\":{\"kernel\":\"ellipse\",\"colorSpace\":"
    "\"srgb_rec709_display\"}}";

MadeGltf one_splat() {
  MadeGltf made;
  made.add("POSITION", "VEC3", 3, {1, 2, 3});
  made.add("KHR_gaussian_splatting:ROTATION", "VEC4", 4, {0, 0, 0, 3});
  made.add("KHR_gaussian_splatting:SCALE", "VEC3", 3, {0.1f, 0.2f, 0.3f});
  made.add("KHR_gaussian_splatting:OPACITY", "SCALAR", 1, {0.75f});
  made.add("KHR_gaussian_splatting:SH_DEGREE_0_COEF_0", "VEC3", 3, {1, 0, -1});
  for (int degree = 1; degree <= 3; degree++)
    for (int k = 0; k <= 2 * degree; k++)
      made.add(fmt::format("KHR_gaussian_splatting:SH_DEGREE_{}_COEF_{}", degree, k), "VEC3", 3,
               {0.1f * float(k + 1), 0.2f * float(degree), -0.3f * float(k)});
  return made;
}

TEST(SplatGltf, holds_what_the_ply_holds_but_for_a_half_turn) {
  WELLSPRING_SKIP_WITHOUT_SCANS();
  const std::string name = (scans_folder() / "splats/train-1000/train-1000").string();
  const SplatSet ply = load_splats(name + ".ply"), gltf = load_splats(name + ".glb");
  ASSERT_EQ(ply.size(), 1000u);
  ASSERT_EQ(gltf.size(), 1000u);
  ASSERT_EQ(gltf.degree, 3);
  const char* signs = "-+-+-+-+-+-+-+-";  // half a turn about z does this to harmonics
  float worst = 0;
  const auto differ = [&worst](float a, float b) {
    worst = std::max(worst, std::abs(a - b) / std::max(1.0f, std::abs(a)));
  };
  for (size_t i = 0; i < 1000; i++) {
    for (int axis = 0; axis < 3; axis++) {
      differ(ply.place[i][axis] * (axis < 2 ? -1.0f : 1.0f), gltf.place[i][axis]);
      differ(ply.scale[i][axis], gltf.scale[i][axis]);
      differ(ply.color[i][axis], gltf.color[i][axis]);
      for (size_t h = 0; h < 15; h++)
        differ(ply.harmonics[15 * i + h][axis] * (signs[h] == '-' ? -1.0f : 1.0f),
               gltf.harmonics[15 * i + h][axis]);
    }
    differ(ply.opacity[i], gltf.opacity[i]);
    const quat turn = ply.turn[i];
    differ(0, turn_distance(quat(-turn.z, -turn.y, turn.x, turn.w), gltf.turn[i]));
    differ(1, glm::length(gltf.turn[i]));
  }
  EXPECT_LT(worst, 2e-6f);
}

TEST(SplatGltf, turns_mirrors_and_scales_splats_by_their_node) {
  const Folder folder;
  const MadeGltf made = one_splat();
  const SplatSet still = load_splats(folder.write("a.glb", made.file(as_splats)));
  EXPECT_EQ(still.turn[0], quat(1, 0, 0, 0));
  EXPECT_EQ(still.opacity[0], 0.75f);
  EXPECT_EQ(still.degree, 3);
  const std::pair<std::string, mat3> nodes[] = {
      {",\"rotation\":[0.5,0.5,0.5,0.5],\"scale\":[2,2,2],\"translation\":[0,0,5]",
       mat3(0, 1, 0, 0, 0, 1, 1, 0, 0)},
      {",\"scale\":[-2,2,2],\"translation\":[0,0,5]", mat3(-1, 0, 0, 0, 1, 0, 0, 0, 1)}};
  for (const auto& [node, turn] : nodes) {
    const SplatSet moved = load_splats(folder.write("a.glb", made.file(as_splats, node)));
    EXPECT_LT(glm::length(moved.place[0] - (turn * vec3(2, 4, 6) + vec3(0, 0, 5))), 1e-5f);
    const mat3 axes = glm::mat3_cast(moved.turn[0]);
    mat3 spread(0), wanted(0);
    for (int k = 0; k < 3; k++)
      for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
          const float s = moved.scale[0][k], w = 2 * still.scale[0][k];
          spread[c][r] += axes[k][r] * axes[k][c] * s * s;
          wanted[c][r] += turn[k][r] * turn[k][c] * w * w;
        }
    for (int k = 0; k < 9; k++) EXPECT_NEAR(spread[k / 3][k % 3], wanted[k / 3][k % 3], 1e-5f);
    for (const vec3 d : {vec3(1, 0, 0), glm::normalize(vec3(1, -2, 3)), vec3(0, -0.6f, 0.8f)})
      EXPECT_LT(glm::length(harmonics_towards(moved, 0, turn * d) - harmonics_towards(still, 0, d)),
                1e-5f);
  }
  EXPECT_NE(refusal_of_splats(folder.write("a.glb", made.file(as_splats, ",\"scale\":[1,2,1]")))
                .find("unevenly"),
            std::string::npos);
}

TEST(SplatGltf, reads_the_other_colour_space_and_scales_of_drafts) {
  const Folder folder;
  MadeGltf made;
  made.add("POSITION", "VEC3", 3, {1, 2, 3});
  made.add("KHR_gaussian_splatting:ROTATION", "VEC4", 4, {0, 0, 0, 1});
  made.add("KHR_gaussian_splatting:SCALE", "VEC3", 3, {-1, 0, 1});
  made.add("KHR_gaussian_splatting:OPACITY", "SCALAR", 1, {0.75f});
  made.add("KHR_gaussian_splatting:SH_DEGREE_0_COEF_0", "VEC3", 3, {0, 1.7724539f, -1.7724539f});
  std::string linear = as_splats;
  linear.replace(linear.find("srgb"), 4, "lin");
  const SplatSet set = load_splats(folder.write("a.glb", made.file(linear)));
  EXPECT_EQ(set.notices.size(), 2u);
  EXPECT_NEAR(set.color[0].x, 0.735357f, 1e-5f);  // sRGB of 0.5
  EXPECT_NEAR(set.color[0].y, 1, 1e-5f);
  EXPECT_NEAR(set.color[0].z, 0, 1e-5f);
  EXPECT_NEAR(set.scale[0].x, std::exp(-1.0f), 1e-6f);
  linear.replace(linear.find("lin"), 3, "odd");
  EXPECT_NE(refusal_of_splats(folder.write("a.glb", made.file(linear))).find("is not read"),
            std::string::npos);
}

TEST(SplatGltf, unpacks_spz_into_the_frame_of_gltf) {
  WELLSPRING_SKIP_WITHOUT_SCANS();
  const Folder folder;
  MadeGltf made;
  made.add("POSITION", "VEC3", 3, {0, 0, 0});
  const std::string spz = bytes_of_file(scans_folder() / "splats/minimal/minimal-v2.spz");
  const std::string view = fmt::format(",{{\"buffer\":0,\"byteOffset\":{},\"byteLength\":{}}}",
                                       made.binary.size(), spz.size());
  made.binary += spz;
  const SplatSet set = load_splats(folder.write(
      "a.glb", made.file(",\"extensions\":{\"KHR_gaussian_splatting\":{\"extensions\":"
                         "{\"KHR_gaussian_splatting_compression_spz_2\":{\"bufferView\":1}}}}",
                         "", view)));
  ASSERT_EQ(set.size(), 4u);
  EXPECT_EQ(set.place[0], vec3(1, 0, 1));
}

TEST(SplatGltf, says_which_draft_it_reads) {
  WELLSPRING_SKIP_WITHOUT_SCANS();
  const SplatSet set =
      load_splats((scans_folder() / "splats/cesium_synthetic/synthetic.gltf").string());
  ASSERT_EQ(set.size(), 5u);
  // Its node turns z up into y up, and moves the splats by (2, 12, -7).
  EXPECT_LT(glm::length(set.place[0] - vec3(0, 10, -5)), 1e-5f);
  EXPECT_LT(glm::length(set.place[4] - vec3(4, 14, -9)), 1e-5f);
  EXPECT_NE(set.format.find("early draft"), std::string::npos);
  EXPECT_NEAR(set.scale[0].x, std::exp(1.0f), 1e-4f);
}

TEST(SplatGltf, survives_damage) {
  const Folder folder;
  const auto read = [](const std::string& path) { load_splats(path); };
  expect_no_harm(folder, "a.glb", one_splat().file(as_splats), read, 200);
}

TEST(GltfPoints, stand_where_their_node_places_them) {
  const Folder folder;
  MadeGltf made;
  made.add("POSITION", "VEC3", 3, {1, 0, 0, NAN, 0, 0});
  made.add("NORMAL", "VEC3", 3, {1, 0, 0, 1, 0, 0});
  made.add("COLOR_0", "VEC3", 3, {1, 0.21404114f, 0, 1, 1, 1});
  const ReadScan read = read_scan(
      folder.write("a.glb", made.file("",
                                      ",\"rotation\":[0,0,0.70710678,0.70710678],\"scale\":[2,1,1],"
                                      "\"translation\":[0,0,1000000]")));
  ASSERT_EQ(read.points.size(), 1u);
  EXPECT_EQ(read.dropped, 1u);
  EXPECT_LT(glm::length(read.points.place[0] - dvec3(0, 2, 1000000)), 1e-6);
  EXPECT_LT(glm::length(read.points.normal[0] - vec3(0, 1, 0)), 1e-6f);
  EXPECT_EQ(read.points.color[0][0], 65535);
  EXPECT_NEAR(read.points.color[0][1], 32768, 2);  // sRGB of that light is a half
  EXPECT_NE(refusal_of_scan(folder.write("b.glb", one_splat().file(as_splats))).find("splats"),
            std::string::npos);
}

}  // namespace
}  // namespace wellspring::test
