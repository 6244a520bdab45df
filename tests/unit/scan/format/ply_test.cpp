// SPDX-License-Identifier: Apache-2.0
#include "unit/scan/format/scan_files.h"

namespace wellspring::test {
namespace {

std::string ply_head(const std::string& format, size_t count, const std::string& properties) {
  return "ply\nformat " + format + " 1.0\ncomment made\nelement vertex " + std::to_string(count) +
         "\n" + properties + "end_header\n";
}
const std::string xyz = "property float x\nproperty double y\nproperty short z\n";
const std::string rgb = "property uchar red\nproperty uchar green\nproperty uchar blue\n";

TEST(Ply, reads_text_and_both_byte_orders_alike) {
  const Folder folder;
  const std::string properties = xyz + rgb +
                                 "property float nx\nproperty float ny\n"
                                 "property float nz\nproperty uchar intensity\n";
  std::vector<ReadScan> all;
  for (const bool is_big : {false, true}) {
    ScanBytes data{is_big};
    for (int i = 0; i < 2; i++) {
      data.put(0.5f + float(i)).put(1e7 + 0.001).put(int16_t(-3));
      data.put(uint8_t(1)).put(uint8_t(2)).put(uint8_t(255));
      data.put(0.0f).put(0.0f).put(-2.0f).put(uint8_t(77));
    }
    all.push_back(read_scan(folder.write(
        "a.ply", ply_head(is_big ? "binary_big_endian" : "binary_little_endian", 2, properties) +
                     data.bytes)));
  }
  all.push_back(read_scan(folder.write("a.ply", ply_head("ascii", 2, properties) +
                                                    "0.5 10000000.001 -3 1 2 255 0 0 -2 77\r\n\r\n"
                                                    " 1.5\t10000000.001 -3 1 2 255 0 0 -2 77")));
  for (const ReadScan& read : all) {
    ASSERT_EQ(read.points.size(), 2u);
    EXPECT_EQ(read.points.place[1], dvec3(1.5, 1e7 + 0.001, -3));
    EXPECT_EQ(read.points.color[1], (std::array<uint16_t, 3>{1, 2, 255}));
    EXPECT_EQ(read.info.color_max, 255);
    EXPECT_EQ(read.points.normal[0], vec3(0, 0, -1));
    EXPECT_EQ(read.points.intensity[0], 77);
    EXPECT_EQ(read.info.intensity_max, 255);
    EXPECT_TRUE(read.info.is_counted);
  }
}

TEST(Ply, passes_other_elements_and_lists_over) {
  const Folder folder;
  const std::string bytes = ply_head(
      "binary_little_endian", 2,
      "property list uchar int near\n" + xyz + "element face 1\nproperty list uchar int corners\n");
  std::string whole = bytes;
  whole.replace(whole.find("element vertex"), 0,
                "element camera 1\nproperty int a\nproperty list int short b\n");
  ScanBytes data;
  data.put(int32_t(7)).put(int32_t(2)).put(int16_t(1)).put(int16_t(1));
  data.put(uint8_t(1)).put(int32_t(9)).put(1.0f).put(2.0).put(int16_t(3));
  data.put(uint8_t(0)).put(4.0f).put(5.0).put(int16_t(6));
  data.put(uint8_t(1)).put(int32_t(0));
  const ReadScan read = read_scan(folder.write("a.ply", whole + data.bytes));
  ASSERT_EQ(read.points.size(), 2u);
  EXPECT_EQ(read.points.place[1], dvec3(4, 5, 6));
  EXPECT_FALSE(read.info.fields.color);
  expect_no_harm(folder, "b.ply", whole + data.bytes,
                 [](const std::string& path) { read_scan(path); });
}

TEST(Ply, keeps_wide_colours_and_scales_real_ones) {
  const Folder folder;
  const auto read = [&](const std::string& type, const std::string& color) {
    return read_scan(
        folder.write("a.ply", ply_head("ascii", 1,
                                       xyz + "property " + type + " diffuse_red\nproperty " + type +
                                           " diffuse_green\nproperty " + type + " diffuse_blue\n") +
                                  "0 0 0 " + color + "\n"));
  };
  const ReadScan wide = read("ushort", "65535 1000 0");
  EXPECT_EQ(wide.points.color[0], (std::array<uint16_t, 3>{65535, 1000, 0}));
  EXPECT_EQ(wide.info.color_max, 0);
  const ReadScan real = read("float", "1 0.5 0");
  EXPECT_EQ(real.points.color[0], (std::array<uint16_t, 3>{65535, 32768, 0}));
  EXPECT_EQ(real.info.color_max, 65535);
}

TEST(Ply, drops_points_that_are_nowhere) {
  const Folder folder;
  const ReadScan read =
      read_scan(folder.write("a.ply", ply_head("ascii", 3, xyz) + "nan 0 0\n1 2 3\n0 inf 0\n"));
  EXPECT_EQ(read.points.size(), 1u);
  EXPECT_EQ(read.dropped, 2u);
}

TEST(Ply, names_the_place_of_faults) {
  const Folder folder;
  const auto refused = [&](const std::string& bytes) {
    return refusal_of_scan(folder.write("a.ply", bytes));
  };
  EXPECT_NE(
      refused(ply_head("ascii", 2, xyz) + "1 2 3\n1 word 3\n").find("line 10: 'word' is no number"),
      std::string::npos);
  EXPECT_NE(refused(ply_head("ascii", 2, xyz) + "1 2 3\n4 5\n\n\n").find("line 10: has fewer"),
            std::string::npos);
  EXPECT_NE(
      refused(ply_head("binary_little_endian", 4'000'000'000'000, xyz)).find("promises 4000000"),
      std::string::npos);
  EXPECT_NE(refused(ply_head("ascii", 1, "property float x\n") + "1\n").find("no x, y, z"),
            std::string::npos);
  EXPECT_NE(refused("ply\nformat ascii 1.0\nend_header\n").find("no element vertex"),
            std::string::npos);
  EXPECT_NE(refused("ply\nformat middle_endian 1.0\n").find("line 2"), std::string::npos);
  EXPECT_NE(refused(ply_head("ascii", 1,
                             xyz + "property float f_dc_0\nproperty float opacity\nproperty float "
                                   "scale_0\nproperty float rot_0\n") +
                    "1 2 3 4 5 6 7\n")
                .find("Gaussian splats"),
            std::string::npos);
  expect_no_harm(folder, "b.ply", ply_head("ascii", 2, xyz + rgb) + "1 2 3 4 5 6\n1 2 3 4 5 6\n",
                 [](const std::string& path) { read_scan(path); });
}

TEST(Ply, counts_the_points_of_real_files) {
  WELLSPRING_SKIP_WITHOUT_SCANS();
  const std::pair<const char*, size_t> files[] = {
      {"ply/bunny.ply", 34834},        {"ply/cube_att.ply", 24},
      {"pdal/ply/mesh.ply", 4},        {"pdal/ply/mesh_fixed.ply", 4},
      {"pdal/ply/issue_2421.ply", 1},  {"pdal/ply/simple_binary.ply", 3},
      {"pdal/ply/simple_text.ply", 3}, {"pdal/ply/text_extradim.ply", 1}};
  for (const auto& [name, count] : files) {
    const ReadScan read = read_scan((scans_folder() / name).string());
    EXPECT_EQ(read.points.size(), count) << name;
    EXPECT_EQ(read.info.points, count) << name;
  }
  for (const char* name : {"sized_dims.ply", "unsized_dims.ply", "no_vertex.ply"})
    EXPECT_NE(refusal_of_scan((scans_folder() / "pdal/ply" / name).string()), "") << name;
}

}  // namespace
}  // namespace wellspring::test
