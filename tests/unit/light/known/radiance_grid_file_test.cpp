// SPDX-License-Identifier: Apache-2.0
#include "light/known/radiance_grid_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "light/sample/lamps_seen.h"
#include "unit/folder.h"

namespace wellspring {
namespace {

namespace fs = std::filesystem;

// Two lamps that can be switched, seen from one place.
RadianceGrid make_small_grid() {
  RadianceGrid grid;
  grid.cell = 0.125f;
  grid.keys = {0, 77, 0, 5};
  grid.light = {vec3(0), vec3(1, 2, 3), vec3(0), vec3(0.1f, 1e-30f, 7e8f)};
  grid.count = {0, 12, 0, 3};
  grid.keeps = {1, 0, 1};
  auto lamps = std::make_shared<LampsSeen>();
  lamps->cell = 0.25f;
  lamps->keys = {9, 0};
  lamps->shares.resize(2);
  lamps->shares[0][1] = 200;
  grid.lamps = lamps;
  auto parts = std::make_shared<RadianceGrid::Parts>();
  parts->slots = {1, 3};
  parts->albedo = {vec3(0.5f), vec3(0.25f)};
  parts->light = {{vec3(1), vec3(2)}, {vec3(3), vec3(4)}, {vec3(5), vec3(6)}};
  grid.parts = parts;
  return grid;
}

struct RadianceGridFile : testing::Test {
  test::Folder folder;
  std::string file = (folder.path / "deep" / "hall.grid").string();
  RadianceGrid grid = make_small_grid();
};

TEST_F(RadianceGridFile, LoadsTheBitsThatWereSaved) {
  ASSERT_TRUE(save_radiance_grid(grid, file, 4711));
  auto again = load_radiance_grid(file, 4711);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->cell, grid.cell);
  EXPECT_EQ(again->keys, grid.keys);
  EXPECT_EQ(again->light, grid.light);
  EXPECT_EQ(again->count, grid.count);
  EXPECT_EQ(again->keeps, grid.keeps);
  ASSERT_TRUE(again->lamps && again->parts);
  EXPECT_EQ(again->lamps->cell, grid.lamps->cell);
  EXPECT_EQ(again->lamps->keys, grid.lamps->keys);
  EXPECT_EQ(again->lamps->shares, grid.lamps->shares);
  EXPECT_EQ(again->parts->slots, grid.parts->slots);
  EXPECT_EQ(again->parts->albedo, grid.parts->albedo);
  EXPECT_EQ(again->parts->light, grid.parts->light);
}

TEST_F(RadianceGridFile, KeepsWhatIsAbsentAbsent) {
  grid.lamps = nullptr, grid.parts = nullptr;
  ASSERT_TRUE(save_radiance_grid(grid, file, 1));
  auto again = load_radiance_grid(file, 1);
  ASSERT_TRUE(again);
  EXPECT_FALSE(again->lamps);
  EXPECT_FALSE(again->parts);
}

TEST_F(RadianceGridFile, AnotherKeyOrNoFileIsNothing) {
  EXPECT_FALSE(load_radiance_grid(file, 1));
  ASSERT_TRUE(save_radiance_grid(grid, file, 1));
  EXPECT_FALSE(load_radiance_grid(file, 2));
  ASSERT_TRUE(save_radiance_grid(grid, file, 2));
  EXPECT_TRUE(load_radiance_grid(file, 2));
  EXPECT_FALSE(load_radiance_grid(folder.path.string(), 2)) << "a folder";
}

TEST_F(RadianceGridFile, EveryDamagedByteAndLengthIsNoticed) {
  ASSERT_TRUE(save_radiance_grid(grid, file, 1));
  const auto size = fs::file_size(file);
  std::string bytes(size_t(size), '\0');
  std::ifstream(file, std::ios::binary).read(bytes.data(), std::streamsize(size));
  auto write = [&](const std::string& damaged) {
    std::ofstream(file, std::ios::binary).write(damaged.data(), std::streamsize(damaged.size()));
  };
  for (size_t i = 0; i < bytes.size(); i++) {
    std::string damaged = bytes;
    damaged[i] = char(damaged[i] ^ 0x40);
    write(damaged);
    EXPECT_FALSE(load_radiance_grid(file, 1)) << "byte " << i;
    write(bytes.substr(0, i));
    EXPECT_FALSE(load_radiance_grid(file, 1)) << "cut at " << i;
  }
  write(bytes);
  EXPECT_TRUE(load_radiance_grid(file, 1));
}

TEST_F(RadianceGridFile, ATableInWhichALookUpWouldNotEndIsNone) {
  auto loads = [&](const RadianceGrid& one) {
    EXPECT_TRUE(save_radiance_grid(one, file, 1));
    return load_radiance_grid(file, 1) != nullptr;
  };
  RadianceGrid full = grid, odd = grid, fine = grid, dark = grid;
  full.keys = {1, 77, 2, 5};
  EXPECT_FALSE(loads(full));
  odd.keys.resize(3), odd.light.resize(3), odd.count.resize(3), odd.parts = nullptr;
  EXPECT_FALSE(loads(odd)) << "no power of two";
  fine.cell = 1e-30f;
  EXPECT_FALSE(loads(fine)) << "places have no whole numbers";
  auto lamps = std::make_shared<LampsSeen>(*grid.lamps);
  lamps->keys = {9, 8};
  dark.lamps = lamps;
  EXPECT_FALSE(loads(dark));
  EXPECT_TRUE(loads(grid));
}

TEST_F(RadianceGridFile, AFolderThatCannotBeWrittenIsTold) {
  EXPECT_FALSE(save_radiance_grid(grid, "/proc/nowhere/hall.grid", 1));
}

}  // namespace
}  // namespace wellspring
