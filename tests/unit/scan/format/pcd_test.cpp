// SPDX-License-Identifier: Apache-2.0
#include <bit>

#include "unit/scan/format/scan_files.h"

namespace wellspring::test {
namespace {

std::string pcd_head(const std::string& data, size_t points, const std::string& type = "U") {
  const std::string count = std::to_string(points);
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z _ rgb intensity normal_x normal_y normal_z\n"
         "SIZE 4 4 8 1 4 2 4 4 4\nTYPE F F F U " +
         type +
         " U F F F\nCOUNT 1 1 1 3 1 1 1 1 1\n"
         "WIDTH " +
         count + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + count + "\nDATA " + data + "\n";
}

template <class Value>
void put_all(ScanBytes& to, std::initializer_list<Value> values) {
  for (const Value value : values) to.put(value);
}

void expect_points(const ReadScan& read) {
  ASSERT_EQ(read.points.size(), 2u);
  EXPECT_EQ(read.dropped, 1u);
  EXPECT_EQ(read.points.place[1], dvec3(4, 5, 6));
  EXPECT_EQ(read.points.color[0], (std::array<uint16_t, 3>{1, 2, 3}));
  EXPECT_EQ(read.points.color[1], (std::array<uint16_t, 3>{255, 128, 0}));
  EXPECT_EQ(read.points.intensity, (std::vector<uint16_t>{700, 9}));
  EXPECT_EQ(read.points.normal[1], vec3(0, 0, 1));
  EXPECT_EQ(read.info.points, 3u);
}

// Literal runs alone are LZF, too; and a copy that reaches into itself.
std::string lzf(const std::string& bytes) {
  std::string packed;
  for (size_t at = 0; at < bytes.size(); at += 32) {
    const std::string run = bytes.substr(at, 32);
    packed += char(run.size() - 1) + run;
  }
  return packed;
}

TEST(Pcd, reads_text_binary_and_compressed_points) {
  const Folder folder;
  const std::string text =
      "1 2 3 0 0 0 66051 700 0 0 0\nnan 2 3 0 0 0 66051 700 0 0 0\n"
      "4 5 6 0 0 0 4294934528 9 0 0 5\n";  // an alpha of 255 is left out
  expect_points(read_scan(folder.write("a.pcd", pcd_head("ascii", 3) + text)));
  ScanBytes rows, columns;
  const float x[] = {1, std::numeric_limits<float>::quiet_NaN(), 4}, y[] = {2, 2, 5};
  const double z[] = {3, 3, 6};
  const uint32_t rgb[] = {66051, 66051, 0xffff8000};
  const uint16_t intensity[] = {700, 700, 9};
  const float normal[] = {0, 0, 5};
  for (int i = 0; i < 3; i++) {
    rows.put(x[i]).put(y[i]).put(z[i]).put(uint8_t(0)).put(uint8_t(0)).put(uint8_t(0));
    rows.put(rgb[i]).put(intensity[i]).put(0.0f).put(0.0f).put(normal[i]);
  }
  expect_points(read_scan(folder.write("a.pcd", pcd_head("binary", 3) + rows.bytes)));
  for (const float value : x) columns.put(value);
  for (const float value : y) columns.put(value);
  for (const double value : z) columns.put(value);
  columns.bytes += std::string(9, '\0');
  for (const uint32_t value : rgb) columns.put(value);
  for (const uint16_t value : intensity) columns.put(value);
  columns.bytes += std::string(24, '\0');
  for (const float value : normal) columns.put(value);
  const auto sized = [&](const std::string& packed, size_t size) {
    ScanBytes to;
    to.put(uint32_t(packed.size())).put(uint32_t(size));
    return to.bytes + packed;
  };
  const std::string packed = lzf(columns.bytes);
  const std::string whole = pcd_head("binary_compressed", 3) + sized(packed, columns.bytes.size());
  expect_points(read_scan(folder.write("a.pcd", whole)));
  // The nine zeros and the 24 as copies: 1 zero, then a copy of 8 from one byte before.
  std::string repeated = columns.bytes.substr(0, 48) + '\0';
  repeated = lzf(repeated) + char(6 << 5) + '\0' + lzf(columns.bytes.substr(57));
  expect_points(read_scan(folder.write(
      "a.pcd", pcd_head("binary_compressed", 3) + sized(repeated, columns.bytes.size()))));
  EXPECT_NE(refusal_of_scan(folder.write("b.pcd", pcd_head("binary_compressed", 3) +
                                                      sized(packed, 4'000'000'000)))
                .find("not 3 points"),
            std::string::npos);
  const auto read = [](const std::string& path) { read_scan(path); };
  expect_no_harm(folder, "c.pcd", whole, read);
  expect_no_harm(folder, "d.pcd", pcd_head("binary", 3) + rows.bytes, read, 60);
}

TEST(Pcd, reads_colours_in_the_bits_of_a_real_number) {
  const Folder folder;
  const float bits = std::bit_cast<float>(0x00ff8000u);
  char digits[40];
  snprintf(digits, sizeof digits, "%.9g", double(bits));
  const ReadScan read = read_scan(
      folder.write("a.pcd", pcd_head("ascii", 1, "F") + "1 2 3 0 0 0 " + digits + " 1 0 0 0\r\n"));
  EXPECT_EQ(read.points.color[0], (std::array<uint16_t, 3>{255, 128, 0}));
}

TEST(Pcd, names_the_place_of_faults) {
  const Folder folder;
  const auto refused = [&](const std::string& bytes) {
    return refusal_of_scan(folder.write("a.pcd", bytes));
  };
  EXPECT_NE(refused(pcd_head("ascii", 1) + "1 2 3 0 0 0 5 word 0 0 0\n").find("line 12: 'word'"),
            std::string::npos);
  EXPECT_NE(refused(pcd_head("binary", 900'000'000'000)).find("promises 900000000000"),
            std::string::npos);
  EXPECT_NE(refused("# .PCD v0.7\nFIELDS a b\nSIZE 4 4\nTYPE F F\nPOINTS 1\nDATA ascii\n1 2\n")
                .find("no x, y, z"),
            std::string::npos);
  EXPECT_NE(refused("# .PCD v0.7\nFIELDS x y z\nSIZE 4 4\nTYPE F F F\nDATA ascii\n"), "");
  EXPECT_NE(refused(pcd_head("zipped", 1)).find("'zipped' is not read"), std::string::npos);
}

TEST(Pcd, counts_the_points_of_a_real_file) {
  WELLSPRING_SKIP_WITHOUT_SCANS();
  const ReadScan read = read_scan((scans_folder() / "ply/simple-ascii.pcd").string());
  EXPECT_EQ(read.points.size(), 213u);
  EXPECT_TRUE(read.info.fields.color);
}

}  // namespace
}  // namespace wellspring::test
