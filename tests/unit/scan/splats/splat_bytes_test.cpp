// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "unit/scan/splats/splat_files.h"

namespace wellspring::test {
namespace {
using scan::load_splats;
using scan::SplatSet;

TEST(SplatBytes, reads_the_same_four_splats_of_every_format) {
  WELLSPRING_SKIP_WITHOUT_SCANS();
  const std::filesystem::path folder = scans_folder() / "splats/minimal";
  for (const char* name : {"minimal.splat", "minimal.ksplat", "minimal-raw.spz", "minimal-v2.spz",
                           "minimal-v3.spz", "minimal-v4.spz"}) {
    EXPECT_TRUE(scan::holds_splats((folder / name).string())) << name;
    const SplatSet set = load_splats((folder / name).string());
    ASSERT_EQ(set.size(), 4u) << name;
    EXPECT_EQ(set.degree, 0) << name;
    EXPECT_TRUE(set.notices.empty()) << name;
    // Those of versions 3 and 4 were made in another frame.
    const float z = name == std::string("minimal-v3.spz") || name == std::string("minimal-v4.spz")
                        ? 1.0f
                        : -1.0f;
    const vec3 places[] = {{-1, 0, z}, {0, 0, z}, {-1, 0, 0}, {0, 0, 0}};
    for (size_t i = 0; i < 4; i++) {
      EXPECT_NEAR(glm::length(set.place[i] - places[i]), 0, 1e-4f) << name << i;
      EXPECT_NEAR(set.scale[i].x, 0.1f, 0.004f) << name;
      EXPECT_NEAR(set.opacity[i], 0.9f, 0.004f) << name;
      EXPECT_NEAR(glm::length(set.turn[i]), 1, 1e-5f) << name;
    }
    // One is of another colour than the next, in red alone.
    EXPECT_GT(set.color[1].x - set.color[0].x, 0.2f) << name;
    EXPECT_NEAR(set.color[1].y, set.color[0].y, 1e-5f) << name;
  }
}

std::string ksplat(int level, size_t sections) {
  ScanBytes head, data;
  head.put(uint8_t(0)).put(uint8_t(1)).put(uint16_t(0)).put(uint32_t(sections));
  head.put(uint32_t(sections)).put(uint32_t(3 * sections)).put(uint32_t(3 * sections));
  head.put(uint16_t(level)).bytes.resize(36);
  head.put(-2.0f).put(2.0f).bytes.resize(4096);
  for (size_t s = 0; s < sections; s++) {
    ScanBytes section;  // a full bucket of 1, partial ones of 1 and 1, room for one more splat
    section.put(uint32_t(3)).put(uint32_t(4)).put(uint32_t(1)).put(uint32_t(3)).put(2.0f);
    section.put(uint16_t(12)).put(uint16_t(0)).put(uint32_t(100)).put(uint32_t(0));
    section.put(uint32_t(1)).put(uint32_t(2)).put(uint16_t(1)).bytes.resize(1024);
    head.bytes += section.bytes;
    data.put(uint32_t(1)).put(uint32_t(1));
    for (int bucket = 0; bucket < 3; bucket++) data.put(float(10 * bucket)).put(0.0f).put(-1.0f);
    for (int i = 0; i < 4; i++) {
      const auto number = [&](float value, uint16_t half) {
        if (level == 0) data.put(value);
        else data.put(half);
      };
      if (level == 0) data.put(float(10 * i) + 0.5f).put(0.0f).put(0.0f);
      else data.put(uint16_t(150)).put(uint16_t(100)).put(uint16_t(200));  // 0.5, 0, 1
      for (int k = 0; k < 3; k++) number(0.5f, 0x3800);
      for (int k = 0; k < 4; k++) number(k == 1 ? 2.0f : 0.0f, k == 1 ? 0x4000 : 0);
      data.put(uint32_t(0xff00'3366));
      for (int k = 0; k < 9; k++) {
        if (level == 2) data.put(uint8_t(k == 4 ? 255 : 0));
        else number(k == 4 ? 2.0f : -2.0f, k == 4 ? 0x4000 : 0xc000);
      }
    }
  }
  return head.bytes + data.bytes;
}

TEST(SplatBytes, reads_every_level_of_ksplat) {
  const Folder folder;
  for (int level = 0; level < 3; level++) {
    const std::string bytes = ksplat(level, 2);
    const SplatSet set = load_splats(folder.write("a.ksplat", bytes));
    ASSERT_EQ(set.size(), 6u);
    EXPECT_EQ(set.degree, 1);
    for (size_t i = 0; i < 6; i++) {
      EXPECT_NEAR(glm::length(set.place[i] - vec3(10 * float(i % 3) + 0.5f, 0, 0)), 0, 1e-5f);
      EXPECT_EQ(set.scale[i], vec3(0.5f));
      EXPECT_EQ(set.turn[i], quat(0, 1, 0, 0));
      EXPECT_EQ(set.opacity[i], 1);
      EXPECT_NEAR(set.color[i].x, 0.4f, 1e-6f);
      EXPECT_EQ(set.harmonics[3 * i + 1], vec3(-2, 2, -2)) << level;  // the fifth is green's second
    }
    expect_no_harm(folder, "b.ksplat", bytes, [](const std::string& path) { load_splats(path); });
  }
}

// Four splats of version 1, whose places are half floats, have a turn about x and degree 1.
std::string spz(uint32_t version, uint32_t splats) {
  ScanBytes to;
  to.bytes = "NGSP";
  to.put(version).put(splats).put(uint8_t(1)).put(uint8_t(12)).put(uint16_t(0));
  for (int i = 0; i < 4; i++) to.put(uint16_t(0x3c00)).put(uint16_t(0xc000)).put(uint16_t(0x3800));
  to.bytes += std::string(4, char(51)) + std::string(12, char(255)) + std::string(12, char(160));
  for (int i = 0; i < 4; i++) to.put(uint8_t(255)).put(uint8_t(127)).put(uint8_t(128));
  for (int i = 0; i < 36; i++) to.put(uint8_t(128 + i % 9));
  return to.bytes;
}

TEST(SplatBytes, reads_the_oldest_spz) {
  const Folder folder;
  for (const std::string& bytes : {spz(1, 4), gzipped(spz(1, 4))}) {
    const SplatSet set = load_splats(folder.write("a.spz", bytes));
    ASSERT_EQ(set.size(), 4u);
    EXPECT_EQ(set.place[3], vec3(1, -2, 0.5f));
    EXPECT_NEAR(set.opacity[0], 0.2f, 1e-6f);
    EXPECT_NEAR(set.scale[0].x, 1, 1e-6f);
    EXPECT_NEAR(set.color[0].x, 0.5f + 0.2820948f * 0.5f / 0.15f, 1e-5f);
    EXPECT_LT(turn_distance(set.turn[0], quat(0, 1, 0, 0)), 1e-4f);
    EXPECT_EQ(set.harmonics[1], vec3(3, 4, 5) / 128.0f);
    const auto read = [](const std::string& path) { load_splats(path); };
    expect_no_harm(folder, "b.spz", bytes, read);
  }
}

TEST(SplatBytes, refuses_lying_counts_and_damage) {
  const Folder folder;
  EXPECT_NE(refusal_of_splats(folder.write("a.spz", spz(1, 3'000'000'000))).find("is cut off"),
            std::string::npos);
  EXPECT_NE(refusal_of_splats(folder.write("a.spz", gzipped(spz(1, 3'000'000'000)))), "");
  EXPECT_NE(refusal_of_splats(folder.write("a.spz", spz(9, 4))).find("version 9"),
            std::string::npos);
  EXPECT_NE(refusal_of_splats(folder.write("a.splat", std::string(40, '\1'))).find("byte 32"),
            std::string::npos);
  EXPECT_NE(refusal_of_splats(folder.write("a.bin", std::string(32, '\1'))).find("no Gaussian"),
            std::string::npos);
  EXPECT_FALSE(scan::holds_splats(folder.write("a.xyz", "1 2 3\n")));
  WELLSPRING_SKIP_WITHOUT_SCANS();
  const auto read = [](const std::string& path) { load_splats(path); };
  for (const char* name : {"minimal-v2.spz", "minimal-v4.spz", "minimal.splat"})
    expect_no_harm(folder, name, bytes_of_file(scans_folder() / "splats/minimal" / name), read);
  expect_no_harm(folder, "b.spz",
                 bytes_of_file(scans_folder() / "splats/train-1000/train-1000.spz"), read, 60);
}

}  // namespace
}  // namespace wellspring::test
