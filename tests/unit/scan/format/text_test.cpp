// SPDX-License-Identifier: Apache-2.0
#include "unit/scan/format/scan_files.h"

namespace wellspring::test {
namespace {

struct TextFile {
  Folder folder;
  ReadScan read(const std::string& name, const std::string& text) const {
    return read_scan(folder.write(name, text));
  }
  std::string refusal(const std::string& name, const std::string& text) const {
    return refusal_of_scan(folder.write(name, text));
  }
};
using Color = std::array<uint16_t, 3>;

TEST(TextScan, reads_every_separator_and_line_end) {
  const TextFile file;
  for (const char* text : {"1 2 3\n-4.5e1 +5 6\n", "1,2,3\r\n-45,5,6\r\n", "1;2;3\n-45;5;6",
                           "\xef\xbb\xbf"
                           "1\t2\t3\n\n-45\t5\t6\n\n",
                           "  1,  2, 3 \n# comment\n -45, 5, 6 \n", "x,y,z\n1,2,3\n-45,5,6\n"}) {
    const ReadScan read = file.read("a.xyz", text);
    ASSERT_EQ(read.points.size(), 2u) << text;
    EXPECT_EQ(read.points.place[0], dvec3(1, 2, 3)) << text;
    EXPECT_EQ(read.points.place[1], dvec3(-45, 5, 6)) << text;
    EXPECT_FALSE(read.info.is_counted);
    EXPECT_FALSE(read.info.fields.color || read.info.fields.intensity || read.info.fields.normal);
  }
  EXPECT_EQ(file.read("a.xyz", "1 2 3").points.size(), 1u);
}

TEST(TextScan, knows_columns_by_number_and_range) {
  const TextFile file;
  const ReadScan plain = file.read("a.txt", "0 0 0 255 0 7\n1 1 1 3 4 5\n");
  EXPECT_EQ(plain.points.color[1], (Color{3, 4, 5}));
  EXPECT_EQ(plain.info.color_max, 0);
  const ReadScan normals = file.read("a.txt", "0 0 0 0.6 0 0.8\n1 1 1 0 0 -1\n");
  EXPECT_FALSE(normals.info.fields.color);
  EXPECT_EQ(normals.points.normal[1], vec3(0, 0, -1));
  const ReadScan one = file.read("a.txt", "0 0 0 0.25\n1 1 1 1\n");
  EXPECT_EQ(one.points.intensity, (std::vector<uint16_t>{16384, 65535}));
  const ReadScan all = file.read("a.txt", "0 0 0 9 8 7 0.5 0 0 1\n");  // CloudCompare's order
  EXPECT_EQ(all.points.color[0], (Color{9, 8, 7}));
  EXPECT_EQ(all.points.intensity.size(), 1u);
  EXPECT_EQ(all.points.normal[0], vec3(0, 0, 1));
  const ReadScan real = file.read("a.txt", "0 0 0 0.5 1 0\n0 0 0 0.25 0.5 0.75\n");
  EXPECT_EQ(real.points.color[0], (Color{32768, 65535, 0}));
  const ReadScan seven = file.read("a.txt", "0 0 0 9 8 7 0.5\n");
  EXPECT_EQ(seven.points.color[0], (Color{9, 8, 7}));
  const ReadScan named =
      file.read("a.csv", "\"X\";\"Y\";\"Z\";Name;Blue;Green;Red\n1;2;3;4;10;20;30\n");
  EXPECT_EQ(named.points.color[0], (Color{30, 20, 10}));
  const ReadScan said = file.read("a.asc", "//X Y Z Intensity R G B\n1 2 3 100 4 5 6\n");
  EXPECT_EQ(said.points.color[0], (Color{4, 5, 6}));
  EXPECT_EQ(said.points.intensity[0], 100);
}

TEST(TextScan, reads_pts_of_leica) {
  const TextFile file;
  const ReadScan read = file.read("a.pts", "2\r\n1 2 3 -2048 10 20 30\r\n4 5 6 2047 0 0 255\r\n");
  EXPECT_TRUE(read.info.is_counted);
  EXPECT_EQ(read.info.points, 2u);
  EXPECT_EQ(read.points.intensity, (std::vector<uint16_t>{0, 65535}));
  EXPECT_EQ(read.points.color[0], (Color{10, 20, 30}));
  const ReadScan bytes = file.read("b.PTS", "1\n1 2 3 200 10 20 30\n\n");
  EXPECT_EQ(bytes.points.intensity[0], 200);
  EXPECT_EQ(bytes.points.color[0], (Color{10, 20, 30}));
  EXPECT_EQ(bytes.info.points, 1u);
  // A count may lie; several clouds may follow each other.
  const ReadScan lying = file.read("c.pts", "9000000000\n1 2 3\n");
  EXPECT_EQ(lying.info.points, 1u);
  EXPECT_EQ(lying.info.notices.size(), 1u);
  const ReadScan two = file.read("d.pts", "1\n1 2 3 4\n2\n4 5 6 7\n7 8 9 9\n");
  EXPECT_EQ(two.points.size(), 3u);
  EXPECT_EQ(two.points.place[2], dvec3(7, 8, 9));
}

TEST(TextScan, names_the_line_of_a_fault) {
  const TextFile file;
  std::string text;
  for (int i = 0; i < 10'000; i++) text += "1 2 3 4 5 6\n";
  EXPECT_NE(file.refusal("a.xyz", text + "1 2 word 4 5 6\n").find("line 10001: 'word'"),
            std::string::npos);
  EXPECT_NE(file.refusal("a.xyz", "1 2 3\n1 2 word\n").find("line 2: 'word'"), std::string::npos);
  EXPECT_NE(file.refusal("a.xyz", "1 2 3\n1 2\n").find("line 2: has"), std::string::npos);
  EXPECT_NE(file.refusal("a.xyz", "Dear reader,\nhello\n").find("line 1: is neither"),
            std::string::npos);
  EXPECT_NE(file.refusal("a.xyz", "1 2\n").find("line 1: has fewer"), std::string::npos);
  EXPECT_NE(file.refusal("a.ptx", "2\n2\n0 0 0\n1 0 0\n").find("line 2: a count follows"),
            std::string::npos);
  EXPECT_NE(file.refusal("a.xyz", std::string(2'000'000, '1')), "");
  EXPECT_EQ(file.read("a.xyz", "nan 2 3\n1 2 3\n").dropped, 1u);
  expect_no_harm(file.folder, "b.pts", "3\n1 2 3 -4 5 6 7\n1 2 3 4 5 6 7\n1 2 3 4 5 6 7\n",
                 [](const std::string& path) { read_scan(path); });
}

TEST(OpenScan, refuses_what_it_does_not_know) {
  const TextFile file;
  EXPECT_NE(file.refusal("a.xyz", "").find("is empty"), std::string::npos);
  EXPECT_NE(file.refusal("a.bin", std::string("\0\1\2\3", 4)).find("no format"), std::string::npos);
  EXPECT_NE(file.refusal("a.splat", std::string(32, '\0')).find("splats"), std::string::npos);
  EXPECT_NE(refusal_of_scan(file.folder.path.string()).find("ept.json"), std::string::npos);
  EXPECT_NE(refusal_of_scan(file.folder.file("none.e57")).find("cannot be read"),
            std::string::npos);
}

}  // namespace
}  // namespace wellspring::test
