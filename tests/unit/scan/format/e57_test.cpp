// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <fmt/format.h>
#include <set>

#include "scan/format/e57_pages.h"
#include "unit/scan/format/scan_files.h"

namespace wellspring::test {
namespace {

// Seals every page with its checksum anew.
std::string sealed(std::string bytes) {
  for (size_t page = 0; page + 1024 <= bytes.size(); page += 1024) {
    const uint32_t crc = scan::crc_32c(bytes.data() + page, 1020);
    for (size_t i = 0; i < 4; i++) bytes[page + 1020 + i] = char(crc >> (24 - 8 * i));
  }
  return bytes;
}

// One scan of an E57 that a test makes: its streams are packed by hand.
struct MadeScan {
  std::string about, prototype;  // XML
  uint64_t points = 0;
  std::vector<std::string> streams;  // bytes; split into packets of at most `packet_bytes` each
  size_t packet_bytes = 400;
};

// Lays a file's contents out as logical bytes, and then in pages. Sections lie in the first page,
// so that their places are the same in both counts.
std::string made_e57(const std::vector<MadeScan>& scans) {
  std::string logical(48, '\0'), xml;
  for (const MadeScan& scan : scans) {
    const size_t begin = logical.size();
    ScanBytes section;
    for (size_t at = 0;; at += scan.packet_bytes) {
      ScanBytes packet;
      std::string data;
      bool is_last = true;
      packet.put(uint8_t(1)).put(uint8_t(0)).put(uint16_t(0)).put(uint16_t(scan.streams.size()));
      for (const std::string& stream : scan.streams) {
        const std::string part = at < stream.size() ? stream.substr(at, scan.packet_bytes) : "";
        is_last = is_last && at + scan.packet_bytes >= stream.size();
        packet.put(uint16_t(part.size()));
        data += part;
      }
      packet.bytes += data;
      packet.bytes.resize((packet.bytes.size() + 3) / 4 * 4);
      const uint16_t length = uint16_t(packet.bytes.size() - 1);
      std::memcpy(packet.bytes.data() + 2, &length, 2);
      section.bytes += packet.bytes;
      if (is_last) break;
    }
    ScanBytes head;
    head.put(uint64_t(1)).put(uint64_t(32 + section.bytes.size()));
    head.put(uint64_t(begin + 32)).put(uint64_t(0));
    logical += head.bytes + section.bytes;
    xml += fmt::format(
        "<vectorChild type=\"Structure\">{}<points type=\"CompressedVector\" fileOffset=\"{}\" "
        "recordCount=\"{}\"><prototype type=\"Structure\">{}</prototype></points></vectorChild>",
        scan.about, begin, scan.points, scan.prototype);
  }
  EXPECT_LT(logical.size(), 1020u);
  xml = "<?xml version=\"1.0\"?><e57Root type=\"Structure\"><data3D type=\"Vector\">" + xml +
        "</data3D></e57Root>";
  logical.resize(1020);
  const uint64_t xml_begin = 1024, xml_bytes = xml.size();
  logical += xml;
  logical.resize((logical.size() + 1019) / 1020 * 1020);
  const uint64_t size = logical.size() / 1020 * 1024;
  ScanBytes header;
  header.bytes = "ASTM-E57";
  header.put(uint32_t(1)).put(uint32_t(0)).put(size).put(xml_begin).put(xml_bytes);
  header.put(uint64_t(1024));
  logical.replace(0, 48, header.bytes);
  std::string bytes;
  for (size_t at = 0; at < logical.size(); at += 1020)
    bytes += logical.substr(at, 1020) + std::string(4, '\0');
  return sealed(bytes);
}

template <class Value>
std::string packed(std::initializer_list<Value> values) {
  ScanBytes to;
  for (const Value value : values) to.put(value);
  return to.bytes;
}

const std::string cartesian =
    "<cartesianX type=\"Float\" precision=\"single\"/><cartesianY type=\"Float\" "
    "precision=\"single\"/><cartesianZ type=\"Float\"/>";

MadeScan three_points() {
  return {"<name type=\"String\"><![CDATA[Nordwand é]]></name>",
          cartesian,
          3,
          {packed({1.0f, 2.0f, 3.0f}), packed({0.0f, 0.5f, NAN}), packed({1.0, 2.0, 3.0})}};
}

TEST(E57, checks_a_known_remainder) {
  EXPECT_EQ(scan::crc_32c("123456789", 9), 0xe3069283u);  // RFC 3720, and every table of CRCs
}

TEST(E57, turns_scans_by_their_poses_into_the_files_frame) {
  const Folder folder;
  MadeScan moved = three_points();
  moved.about =
      "<name type=\"String\">two</name><pose type=\"Structure\"><rotation "
      "type=\"Structure\"><w type=\"Float\">2</w><x/><y/><z type=\"Float\">2</z>"
      "</rotation><translation><x type=\"Float\">10000000.001</x><y/><z "
      "type=\"Float\">5</z></translation></pose>";
  const ReadScan read = read_scan(folder.write("a.e57", made_e57({three_points(), moved})));
  ASSERT_EQ(read.points.size(), 4u);
  EXPECT_EQ(read.dropped, 2u);
  EXPECT_EQ(read.info.points, 6u);
  EXPECT_EQ(read.info.stations[0].name, "Nordwand é");
  EXPECT_EQ(read.info.stations[1].place, dvec3(10000000.001, 0, 5));
  EXPECT_EQ(read.points.station, (std::vector<uint16_t>{0, 0, 1, 1}));
  EXPECT_EQ(read.points.place[1], dvec3(2, 0.5, 2));
  // A quarter turn about z: (2, 0.5, 2) becomes (-0.5, 2, 2).
  EXPECT_NEAR(read.points.place[3].x, 10000000.001 - 0.5, 1e-8);
  EXPECT_NEAR(read.points.place[3].y, 2, 1e-12);
  EXPECT_NEAR(read.points.place[3].z, 7, 1e-12);
}

TEST(E57, reads_spherical_places_states_bits_and_limits) {
  const Folder folder;
  // Three bits a point for the colours, which lie across bytes and packets; a constant elevation.
  MadeScan scan{
      "<colorLimits><colorRedMinimum/><colorRedMaximum>7</colorRedMaximum></colorLimits>"
      "<intensityLimits><intensityMinimum>-1</intensityMinimum><intensityMaximum>1"
      "</intensityMaximum></intensityLimits>",
      "<sphericalRange type=\"Float\"/><sphericalAzimuth type=\"ScaledInteger\" minimum=\"-100\" "
      "maximum=\"155\" scale=\"0.01\" offset=\"0.5\"/><sphericalElevation type=\"Integer\" "
      "minimum=\"0\" maximum=\"0\"/><sphericalInvalidState type=\"Integer\" minimum=\"0\" "
      "maximum=\"2\"/><colorRed type=\"Integer\" minimum=\"0\" maximum=\"7\"/><colorGreen "
      "type=\"Integer\" minimum=\"0\" maximum=\"7\"/><colorBlue type=\"Integer\" minimum=\"0\" "
      "maximum=\"7\"/><intensity type=\"Float\"/><nor:normalX type=\"Float\"/><nor:normalY "
      "type=\"Float\"/><nor:normalZ type=\"Float\"/>",
      4,
      {packed({1.0, 2.0, 3.0, 4.0}), packed<uint8_t>({50, 150, 100, 100}), "",
       packed<uint8_t>({0b00'10'00'00}), packed<uint8_t>({0b11'010'111, 0b0000'001'1}),
       packed<uint8_t>({0, 0}), packed<uint8_t>({0b11'111'111, 0b0000'111'1}),
       packed({-1.0, 0.0, 0.0, 1.0}), packed({0.0, 0.0, 0.0, 0.0}), packed({0.0, 0.0, 0.0, 2.0}),
       packed({3.0, 0.0, 1.0, 0.0})},
      11};
  const ReadScan read = read_scan(folder.write("a.e57", made_e57({scan})));
  ASSERT_EQ(read.points.size(), 3u);  // the third is invalid
  EXPECT_NEAR(read.points.place[0].x, 1, 1e-12);
  EXPECT_NEAR(read.points.place[1].x, 2 * std::cos(1), 1e-12);
  EXPECT_NEAR(read.points.place[1].y, 2 * std::sin(1), 1e-12);
  EXPECT_EQ(read.info.color_max, 65535);
  EXPECT_EQ(read.points.color[0][0], 65535);
  EXPECT_EQ(read.points.color[1][0], std::lround(2 * 65535 / 7.0));
  EXPECT_EQ(read.points.color[2][0], std::lround(1 * 65535 / 7.0));
  EXPECT_EQ(read.points.color[2][2], 65535);
  EXPECT_EQ(read.points.intensity, (std::vector<uint16_t>{0, 32768, 65535}));
  EXPECT_EQ(read.points.normal[0], vec3(0, 0, 1));
  EXPECT_EQ(read.points.normal[1], vec3(0));
  EXPECT_EQ(read.points.normal[2], vec3(0, 1, 0));
}

TEST(E57, refuses_damage_by_its_place) {
  const Folder folder;
  const std::string good = made_e57({three_points()});
  std::string damaged = good;
  damaged[100] = char(damaged[100] ^ 1);
  EXPECT_NE(refusal_of_scan(folder.write("a.e57", damaged)).find("page 0, byte 0: is damaged"),
            std::string::npos);
  MadeScan lying = three_points();
  lying.points = 1'000'000'000'000;
  EXPECT_NE(
      refusal_of_scan(folder.write("b.e57", made_e57({lying}))).find("promises 1000000000000"),
      std::string::npos);
  lying.points = 4;
  EXPECT_NE(
      refusal_of_scan(folder.write("c.e57", made_e57({lying}))).find("points of 'Nordwand é'"),
      std::string::npos);
  const auto read = [](const std::string& path) { read_scan(path); };
  expect_no_harm(folder, "d.e57", good, read, 20);
  // Damage that the checksums agree with.
  expect_no_harm(
      folder, "e.e57", good,
      [&](const std::string& path) {
        std::string bytes = sealed(bytes_of_file(path));
        read(folder.write("f.e57", bytes));
      },
      300);
}

TEST(E57, counts_the_points_of_real_files) {
  WELLSPRING_SKIP_WITHOUT_SCANS();
  const std::filesystem::path folder = scans_folder();
  const std::pair<const char*, size_t> files[] = {
      {"e57/reference/bunnyDouble.e57", 30571},
      {"e57/reference/bunnyInt32.e57", 30571},
      {"e57/self/ColouredCubeDouble.e57", 7680},
      {"e57/self/ColouredCubeFloat.e57", 7680},
      {"e57/3rdParty/las2e57/ColourRepresentation.e57", 153},
      {"e57/self/empty.e57", 0},
      {"e57/self/ZeroPoints.e57", 0},
      {"e57/self/ZeroPointsInvalid.e57", 0},
      {"e57/self/PinholeImageWithDistortionParameters.e57", 0},
      {"e57/self/test filename äöü.e57", 0},
      {"e57/self/测试点云.e57", 0},
      {"pdal/e57/A4.e57", 4},
      {"pdal/e57/A4_moved.e57", 4},
      {"pdal/e57/B2.e57", 2},
      {"pdal/e57/A_B.e57", 6},
      {"pdal/e57/A_moved_B.e57", 6},
      {"pdal/e57/A_B_different_dims.e57", 2},
      {"pdal/e57/A_merged_B.e57", 6},
  };
  for (const auto& [name, count] : files) {
    const ReadScan read = read_scan((folder / name).string());
    EXPECT_EQ(read.points.size() + read.dropped, count) << name;
    EXPECT_EQ(read.info.points, count) << name;
    EXPECT_EQ(read.dropped, 0u) << name;
  }
  EXPECT_NE(refusal_of_scan((folder / "e57/self/bad-crc.e57").string()).find("checksum is wrong"),
            std::string::npos);
  EXPECT_NE(refusal_of_scan((folder / "e57/self/InvalidCVHeader.e57").string()).find("kind is 182"),
            std::string::npos);
}

TEST(E57, gives_the_same_bunny_from_both_codings) {
  WELLSPRING_SKIP_WITHOUT_SCANS();
  const std::string folder = (scans_folder() / "e57/reference").string();
  const ReadScan real = read_scan(folder + "/bunnyDouble.e57");
  const ReadScan whole = read_scan(folder + "/bunnyInt32.e57", 777);
  ASSERT_EQ(real.points.size(), whole.points.size());
  dvec3 low(1e9), high(-1e9);
  double worst = 0;
  for (size_t i = 0; i < real.points.size(); i++) {
    worst = std::max(worst, glm::length(real.points.place[i] - whole.points.place[i]));
    low = glm::min(low, real.points.place[i]), high = glm::max(high, real.points.place[i]);
  }
  EXPECT_LT(worst, 1e-6);
  EXPECT_NEAR(low.x, -0.0947, 1e-4);
  EXPECT_NEAR(high.x, 0.0610, 1e-4);
  EXPECT_NEAR(low.y, 0.0400, 1e-4);
  EXPECT_NEAR(high.y, 0.1873, 1e-4);
}

TEST(E57, gives_the_colours_of_the_cube) {
  WELLSPRING_SKIP_WITHOUT_SCANS();
  const ReadScan read = read_scan((scans_folder() / "e57/self/ColouredCubeFloat.e57").string());
  EXPECT_EQ(read.info.color_max, 255);
  // Faces that look at each other have one colour, and all points lie on a face.
  std::set<std::array<uint16_t, 3>> colors[3];
  for (size_t i = 0; i < read.points.size(); i++) {
    const dvec3 place = glm::abs(read.points.place[i]);
    int faces = 0, axis = 0;
    for (int k = 0; k < 3; k++)
      if (std::abs(place[k] - 0.5) < 1e-6) faces++, axis = k;
    EXPECT_GE(faces, 1);
    if (faces == 1) colors[axis].insert(read.points.color[i]);
  }
  for (int k = 0; k < 3; k++) EXPECT_EQ(colors[k].size(), 1u) << k;
  EXPECT_NE(*colors[0].begin(), *colors[1].begin());
}

}  // namespace
}  // namespace wellspring::test
