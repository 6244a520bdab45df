// SPDX-License-Identifier: Apache-2.0
#include "volume/bricks/brick_file.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>

#include "base/load_error.h"
#include "bricks_made.h"

namespace wellspring::test {
namespace {

// The folder has the volume's bricks and nothing else.
std::string written(const Folder& folder, const Volume& volume) {
  const std::string path = folder.file("a.bricks");
  write_bricks(volume, path);
  return path;
}

std::string reason_of(const std::string& path) {
  try {
    open_bricks(path);
  } catch (const LoadError& error) {
    EXPECT_EQ(error.file, path);
    return error.what();
  }
  return "";
}

TEST(BrickFile, EveryBrickHasItsSamplesItsSkirtAndItsNormals) {
  // 65 samples have places for two bricks, 66 for three.
  const Volume volume = volume_of({65, 66, 40}, rough);
  const ShownVolume whole = make_shown_volume(volume);
  const Folder folder;
  const BrickFile file = open_bricks(written(folder, volume));
  ASSERT_EQ(file.levels.size(), whole.levels.size());
  EXPECT_EQ(file.levels[0].bricks, glm::ivec3(2, 3, 2));
  EXPECT_EQ(file.levels.back().bricks, glm::ivec3(1));
  std::vector<uint16_t> codes(stored_samples);
  std::vector<uint32_t> normals(stored_samples);
  for (size_t k = 0; k < file.levels.size(); k++) {
    const VolumeLevel& level = whole.levels[k];
    const glm::ivec3 bricks = file.levels[k].bricks;
    ASSERT_EQ(file.levels[k].size, level.size);
    for (int i = 0; i < bricks.x * bricks.y * bricks.z; i++) {
      const glm::ivec3 brick(i % bricks.x, i / bricks.x % bricks.y, i / bricks.x / bricks.y);
      file.read(file.entries[file.levels[k].number_of(brick)], codes.data(), normals.data());
      int wrong = 0;
      for (int n = 0; n < stored_samples; n++) {
        const glm::ivec3 in(n % stored_side, n / stored_row % stored_side, n / stored_slice);
        const glm::ivec3 at = glm::clamp(32 * brick + in - 1, glm::ivec3(0), level.size - 1);
        const size_t index =
            (size_t(at.z) * size_t(level.size.y) + size_t(at.y)) * size_t(level.size.x) +
            size_t(at.x);
        wrong += codes[size_t(n)] != level.codes[index] ||
                 normals[size_t(n)] != level.normals.words[index];
      }
      EXPECT_EQ(wrong, 0) << "level " << k << ", brick " << i;
    }
  }
}

TEST(BrickFile, WhatIsKnownOfTheVolumeIsThatOfTheWholeOne) {
  Volume volume = volume_of({70, 41, 53}, rough);
  volume.slope = 0.5, volume.intercept = -1000;
  volume.to_metres[3] = glm::dvec4(0.25, -0.5, 1, 1);
  const ShownVolume whole = make_shown_volume(volume);
  const Bricked bricked(volume, 8);
  const ShownVolume& shown = bricked.shown;
  EXPECT_EQ(shown.low, whole.low);
  EXPECT_EQ(shown.high, whole.high);
  EXPECT_EQ(shown.to_metres, whole.to_metres);
  EXPECT_EQ(shown.voxel, whole.voxel);
  EXPECT_EQ(shown.code_counts, whole.code_counts);
  ASSERT_EQ(shown.levels.size(), whole.levels.size());
  for (size_t k = 0; k < whole.levels.size(); k++) {
    const VolumeLevel &a = shown.levels[k], &b = whole.levels[k];
    EXPECT_EQ(a.size, b.size);
    ASSERT_EQ(a.cells, b.cells);
    ASSERT_EQ(a.ranges.size(), b.ranges.size());
    EXPECT_EQ(std::memcmp(a.ranges.data(), b.ranges.data(), a.ranges.size() * sizeof(CodeRange)),
              0);
    EXPECT_EQ(read_level_codes(shown.bricks->file(), int(k)), b.codes) << k;
  }
}

TEST(BrickFile, BricksOfOneCodeHaveNoData) {
  const Folder folder;
  const BrickFile file = open_bricks(written(folder, shelled_ball(160)));
  const BrickEntry corner = file.entries[0],
                   middle = file.entries[file.levels[0].number_of({1, 2, 2})];
  EXPECT_EQ(corner.record, no_record);
  EXPECT_NE(middle.record, no_record);
  EXPECT_EQ(corner.most, 0);
  EXPECT_EQ(middle.most, 65535);
  std::vector<uint16_t> codes(stored_samples, 7);
  std::vector<uint32_t> normals(stored_samples, 7);
  file.read(corner, codes.data(), normals.data());
  EXPECT_EQ(codes, std::vector<uint16_t>(stored_samples, 0));
  EXPECT_EQ(normals, std::vector<uint32_t>(stored_samples, 0));
  // An even volume has tables alone.
  write_bricks(volume_of({64, 64, 64}, [](glm::ivec3) { return uint16_t(5); }),
               folder.file("even.bricks"));
  EXPECT_LT(std::filesystem::file_size(folder.file("even.bricks")), 10000u);
}

TEST(BrickFile, ThinVolumesAreWritten) {
  for (const glm::ivec3 size : {glm::ivec3(1), glm::ivec3(1, 1, 4000), glm::ivec3(700, 1, 2),
                                glm::ivec3(33, 33, 33), glm::ivec3(34, 32, 64)}) {
    const Volume volume = volume_of(size, rough);
    const ShownVolume whole = make_shown_volume(volume);
    const Folder folder;
    const BrickFile file = open_bricks(written(folder, volume));
    for (size_t k = 0; k < whole.levels.size(); k++)
      EXPECT_EQ(read_level_codes(file, int(k)), whole.levels[k].codes)
          << size.x << " x " << size.y << " x " << size.z << ", level " << k;
  }
}

TEST(BrickFile, TheSameVolumeGivesTheSameFileAndNothingElse) {
  const Folder folder;
  const Volume volume = volume_of({80, 70, 90}, rough);
  write_bricks(volume, folder.file("a.bricks"));
  write_bricks(volume, folder.file("b.bricks"));
  EXPECT_EQ(folder.read("a.bricks"), folder.read("b.bricks"));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path), {}), 2);
  EXPECT_THROW(write_bricks(volume, folder.file("none/a.bricks")), LoadError);
}

TEST(BrickFile, FilesOfAnotherLengthThanTheirHeadSaysAreRefused) {
  const Folder folder;
  written(folder, volume_of({40, 50, 60}, rough));
  const std::string good = folder.read("a.bricks");
  EXPECT_EQ(reason_of(folder.write("good", good)), "");
  for (const size_t size :
       {size_t(0), size_t(7), size_t(100), sizeof(BrickHead), good.size() / 2, good.size() - 1})
    EXPECT_NE(reason_of(folder.write("short", good.substr(0, size))), "") << size;
  EXPECT_NE(reason_of(folder.write("long", good + "x")), "");
  EXPECT_NE(reason_of(folder.file("missing")), "");
  EXPECT_NE(reason_of(folder.path.string()), "");
}

TEST(BrickFile, HeadsThatLieAreRefusedWithThePlace) {
  const Folder folder;
  written(folder, volume_of({40, 50, 60}, rough));
  const std::string good = folder.read("a.bricks");
  BrickHead head;
  std::memcpy(&head, good.data(), sizeof head);
  const auto reason = [&](const auto& change) {
    BrickHead changed = head;
    change(changed);
    std::string bytes = good;
    std::memcpy(bytes.data(), &changed, sizeof changed);
    return reason_of(folder.write("lie", bytes));
  };
  EXPECT_NE(reason([](BrickHead& h) { h.magic[7] = '0'; }).find("byte 0"), std::string::npos);
  EXPECT_NE(reason([](BrickHead& h) { h.size[1] = 0; }).find("byte 8"), std::string::npos);
  EXPECT_NE(reason([](BrickHead& h) { h.size[1] = 1 << 30; }).find("byte 8"), std::string::npos);
  EXPECT_NE(reason([](BrickHead& h) { h.size[0] = h.size[1] = h.size[2] = 1 << 20; }), "");
  EXPECT_NE(reason([](BrickHead& h) { h.records = 1000; }).find("byte 20"), std::string::npos);
  EXPECT_NE(reason([](BrickHead& h) { h.records--; }), "");
  EXPECT_NE(reason([](BrickHead& h) { h.high = h.low; }).find("byte 24"), std::string::npos);
  EXPECT_NE(reason([](BrickHead& h) { h.low = std::nan(""); }).find("byte 24"), std::string::npos);
  EXPECT_NE(reason([](BrickHead& h) { h.to_metres[0] = 0; }).find("byte 40"), std::string::npos);
}

TEST(BrickFile, EntriesThatLieAreRefused) {
  const Folder folder;
  const BrickFile file = open_bricks(written(folder, volume_of({40, 50, 60}, rough)));
  const std::string good = folder.read("a.bricks");
  BrickHead head;
  std::memcpy(&head, good.data(), sizeof head);
  const size_t at = sizeof head + head.records * record_bytes;
  for (const BrickEntry wrong :
       {BrickEntry{0, 1, no_record}, BrickEntry{0, 1, head.records}, BrickEntry{3, 1, 0}}) {
    std::string bytes = good;
    std::memcpy(&bytes[at + sizeof wrong], &wrong, sizeof wrong);
    EXPECT_NE(reason_of(folder.write("lie", bytes)).find("byte " + std::to_string(at + 8)),
              std::string::npos);
  }
}

}  // namespace
}  // namespace wellspring::test
