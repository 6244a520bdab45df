// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "scan/tree/import/write_tree.h"
#include "show/scanner/scanned_place.h"
#include "show/scanner/scanner_source.h"
#include "unit/show/exhibit/room_package.h"

namespace wellspring::test {
namespace {

// A wall 4 m to the east of the station, with a pillar of 0.4 m before its middle.
struct Yard {
  Folder folder;
  json description = {{"scene", "yard.gltf"},
                      {"points", 20000},
                      {"stations", json::array({{{"name", "A"}, {"position", {0, 1, 0}}}})}};
  std::vector<Problem> problems;

  Yard() {
    Asset asset;
    add_box(asset, "Wall", {4, 0, -3}, {4.5f, 3, 3}, false);
    add_box(asset, "Pillar", {2, 0, -0.2f}, {2.4f, 3, 0.2f}, false);
    folder.write("yard.gltf", asset.gltf());
  }
  ScannerFile file() {
    problems.clear();
    folder.write("yard.scanner.json", description.dump(1));
    return read_scanner_file(folder.file("yard.scanner.json"), problems);
  }
  PointBlock scan(size_t at_once = 1000) {
    PointBlock all, block;
    for (const TreeSource& source : open_scanner(file(), UINT64_MAX)) {
      const auto points = source.open();
      while (points->read(block, at_once)) {
        EXPECT_LE(block.size(), at_once);
        all.place.insert(all.place.end(), block.place.begin(), block.place.end());
        all.color.insert(all.color.end(), block.color.begin(), block.color.end());
        all.intensity.insert(all.intensity.end(), block.intensity.begin(), block.intensity.end());
      }
    }
    return all;
  }
  std::string told() const {
    std::string all;
    for (const Problem& problem : problems) all += to_string(problem) + "\n";
    return all;
  }
};

// Returns the root of the mean square of how far points of the wall's face lie off it.
double error_at_wall(const PointBlock& points, double face) {
  double sum = 0, count = 0;
  for (const dvec3& p : points.place)
    if (std::abs(p.x - face) < 0.1 && std::abs(p.z) > 1)
      sum += (p.x - face) * (p.x - face), count++;
  EXPECT_GT(count, 5000);
  return std::sqrt(sum / count);
}

TEST(Scanner, PointsLieOnSurfacesWithinTheirNoise) {
  Yard yard;
  yard.description["noise_mm"] = 0;
  EXPECT_LT(error_at_wall(yard.scan(), 4), 1e-5);
  yard.description["noise_mm"] = 3;
  const PointBlock noisy = yard.scan();
  ASSERT_TRUE(yard.problems.empty()) << yard.told();
  const double error = error_at_wall(noisy, 4);
  EXPECT_GT(error, 0.002);
  EXPECT_LT(error, 0.006);
  EXPECT_NEAR(double(noisy.size()), 20000, 3000);
}

TEST(Scanner, AtEdgesSomePointsHangBetweenTwoSurfaces) {
  Yard yard;
  Asset asset;
  add_box(asset, "Wall", {4, 0, -3}, {4.5f, 3, 3}, false);
  add_box(asset, "Board", {3.6f, 0, -0.5f}, {3.7f, 3, 0.5f}, false);
  yard.folder.write("yard.gltf", asset.gltf());
  yard.description["points"] = 200000;
  int between = 0;
  for (const dvec3& p : yard.scan().place)
    if (p.x > 3.65 && p.x < 3.95) {
      between++;
      EXPECT_NEAR(std::abs(p.z), 0.5, 0.08);
    }
  EXPECT_GT(between, 50);
}

TEST(Scanner, NothingIsMeasuredWhereNoStationSees) {
  Yard yard;
  const auto count_shadow = [](const PointBlock& points) {
    int count = 0;  // on the wall, behind the pillar; what lies behind both is never seen
    for (const dvec3& p : points.place) {
      count += p.x > 3.9 && std::abs(p.z) < 0.35;
      EXPECT_LT(p.x, 4.1);
    }
    return count;
  };
  EXPECT_EQ(count_shadow(yard.scan()), 0);
  yard.description["stations"].push_back({{"position", {3, 1, -2}}});
  EXPECT_GT(count_shadow(yard.scan()), 100);
}

TEST(Scanner, TheSameSeedGivesTheSamePointsHoweverTheyAreRead) {
  Yard yard;
  const PointBlock one = yard.scan(1000), two = yard.scan(7777);
  EXPECT_TRUE(one.place == two.place && one.color == two.color && one.intensity == two.intensity);
  yard.description["seed"] = 2;
  EXPECT_FALSE(one.place == yard.scan().place);
}

TEST(Scanner, LightThatComesBackGrowsWeakerWithDistance) {
  Yard yard;
  const PointBlock points = yard.scan();
  double near = 0, far = 0;
  for (size_t i = 0; i < points.size(); i++) {
    const dvec3& p = points.place[i];
    if (std::abs(p.x - 2) < 0.05 && std::abs(p.z) < 0.05 && std::abs(p.y - 1) < 0.05)
      near = points.intensity[i];
    if (std::abs(p.x - 4) < 0.05 && std::abs(p.z) > 2.9) far = points.intensity[i];
    EXPECT_NEAR(points.color[i][0], 203, 1);  // sRGB of 0.6
  }
  EXPECT_GT(far, 1000);
  EXPECT_GT(near, 1.3 * far);
}

TEST(Scanner, InShadeColoursAreDarker) {
  Yard yard;
  const auto mean = [](const PointBlock& points) {
    double sum = 0;
    for (const auto& color : points.color) sum += color[0];
    return sum / double(points.size());
  };
  const double plain = mean(yard.scan());
  yard.description["shade"] = 1;
  EXPECT_LT(mean(yard.scan()), plain - 20);
}

TEST(Scanner, AMovedTripodMovesAllThatItSaw) {
  Yard yard;
  yard.description["noise_mm"] = 0;
  yard.description["stations"][0]["shift_mm"] = {30, 0, 0};
  EXPECT_LT(error_at_wall(yard.scan(), 4.03), 1e-5);
  yard.description["stations"][0]["shift_mm"] = {0, 0, 0};
  yard.description["stations"][0]["turn_arcmin"] = 10;  // 2.9 mm a metre
  const double error = error_at_wall(yard.scan(), 4);
  EXPECT_GT(error, 0.004);
  EXPECT_LT(error, 0.009);
}

TEST(Scanner, WhatIsWrongInItsFileIsNamed) {
  Yard yard;
  yard.description["points"] = "many", yard.description["scene"] = "../yard.gltf";
  yard.description["stations"][0].erase("position");
  yard.file();
  const std::string told = yard.told();
  EXPECT_NE(told.find("yard.scanner.json: /points: "), std::string::npos) << told;
  EXPECT_NE(told.find("/scene: '../yard.gltf' leaves the package's folder"), std::string::npos);
  EXPECT_NE(told.find("/stations/0/position: "), std::string::npos) << told;
}

TEST(Scanner, ScansAreKeptUntilTheirFilesChange) {
  Yard yard;
  const std::string cache = yard.folder.file("cache");
  const ScannedPlace made = open_scanned_place(yard.file(), cache);
  EXPECT_NEAR(double(made.points.points), 20000, 3000);
  // The box is the scene's, which points hardly reach.
  EXPECT_NEAR(made.box.high.x + made.points.origin.x, 4.5, 1e-6);
  const auto kept = [&] {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(cache + "/scans"))
      names.push_back(entry.path().filename().string());
    return names;
  };
  const std::vector<std::string> first = kept();
  ASSERT_EQ(first.size(), 1u);
  EXPECT_TRUE(first[0].starts_with("yard-") && first[0].ends_with(".points")) << first[0];
  // The second time the kept file is taken.
  EXPECT_EQ(open_scanned_place(yard.file(), cache).points.file, made.points.file);
  yard.description["points"] = 5000;
  EXPECT_LT(open_scanned_place(yard.file(), cache).points.points, 8000u);
  const std::vector<std::string> second = kept();
  ASSERT_EQ(second.size(), 1u);
  EXPECT_NE(first, second);
}

TEST(Scanner, AWholeScanBesideTheFileComesFirst) {
  Yard yard;
  const ScannerFile file = yard.file();
  TreeSettings settings;
  settings.up = UpAxis::y;
  const std::string whole = yard.folder.file(scanned_name(file, file.points));
  write_tree(open_scanner(file, file.points), whole, settings);
  EXPECT_EQ(open_scanned_place(file, "").points.file, whole);
}

}  // namespace
}  // namespace wellspring::test
