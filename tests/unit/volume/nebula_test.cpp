// SPDX-License-Identifier: Apache-2.0
#include "volume/nebula/nebula.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>

#include "base/load_error.h"
#include "unit/volume/nebula_pictures.h"

namespace wellspring::test {
namespace {

NebulaSettings small_nebula() {
  NebulaSettings settings;
  settings.rings = {20, 40};
  settings.solve.iterations = 30;
  settings.remove_stars = false;
  return settings;
}

// Returns an ellipse with a spot on one side, which no solid of revolution has.
image::LinearImage lopsided(int width, int height) {
  image::LinearImage picture = soft_ellipse(width, height, 0.5, 0.25 * width, 0.13 * width);
  for (int y = height / 3; y < height / 2; ++y)
    for (int x = width / 2; x < 3 * width / 5; ++x) picture.color[size_t(y * width + x)].x += 0.5f;
  return picture;
}

TEST(Nebula, AfterCorrectionItShowsThePictureAgain) {
  NebulaSettings settings = small_nebula();
  settings.angle_degrees = 28, settings.tilt_degrees = 40;
  NebulaReport report;
  const Volume volume = make_nebula(lopsided(80, 64), settings, report);
  EXPECT_LT(report.cubes.reprojection_error, 1e-6);
  EXPECT_LT(report.cubes.unreached_light, 0.01);
  ASSERT_EQ(volume.channels, 3);
  // The report agrees with the samples, which are never negative; and the sum of the voxels is that
  // of the pixels.
  const NebulaPicture nebula = prepare_nebula(lopsided(80, 64), settings, report);
  EXPECT_EQ(volume.size.x, nebula.picture.width);
  double voxels = 0, pixels = 0;
  for (int y = 0; y < volume.size.y; ++y)
    for (int x = 0; x < volume.size.x; ++x) {
      const double wanted = double(nebula.picture.color[size_t(y * volume.size.x + x)].x);
      double sum = 0;
      for (int z = 0; z < volume.size.z; ++z) {
        EXPECT_GE(volume.at(x, y, z, 0), 0);
        sum += volume.at(x, y, z, 0);
      }
      if (sum > 0) {
        EXPECT_NEAR(sum, wanted, 1e-6 * 1.5);
      }
      voxels += sum, pixels += wanted;
    }
  EXPECT_NEAR(voxels, pixels, 0.01 * pixels);
}

TEST(Nebula, WithoutCorrectionTheSpotIsLost) {
  NebulaSettings settings = small_nebula();
  settings.cubes.correct = false;
  NebulaReport report;
  make_nebula(lopsided(80, 64), settings, report);
  EXPECT_GT(report.cubes.reprojection_error, 0.05);
  EXPECT_LT(report.cubes.reprojection_error, 0.6);
}

TEST(Nebula, SmallCodesShowThePictureWithinHalfAStep) {
  NebulaSettings settings = small_nebula();
  for (const SampleKind kind : {SampleKind::u8, SampleKind::u16}) {
    settings.cubes.kind = kind;
    NebulaReport report;
    const Volume volume = make_nebula(lopsided(60, 60), settings, report);
    EXPECT_EQ(volume.kind, kind);
    EXPECT_LT(report.cubes.reprojection_error, 0.6 * volume.slope);
  }
  settings.cubes.kind = SampleKind::i16;
  NebulaReport report;
  EXPECT_THROW(make_nebula(lopsided(20, 20), settings, report), LoadError);
}

TEST(Nebula, PixelsBehindWhichNoRingGlowsStayDarkAndAreCounted) {
  RingMap map{{4, 4, 4, 4}, std::vector<ColorLanes>(16)};
  for (int k = 0; k < 4; ++k) map.light[size_t(map.grid.index(k, 1))] = ColorLanes{1, 1, 0, 0};
  const image::LinearImage picture{16, 1, std::vector<vec3>(16, vec3(1, 0, 0))};
  CubeReport report;
  const Volume volume = fill_cubes(map, {{8, 0.5}, 0}, 0, picture, {}, report);
  EXPECT_GT(report.unreached_pixels, 8);
  EXPECT_NEAR(report.unreached_light, report.unreached_pixels / 16.0, 1e-9);
  EXPECT_LT(report.reprojection_error, 1e-6);
  EXPECT_EQ(volume.at(0, 0, volume.size.z / 2), 0);
}

TEST(Nebula, AnEndOfPositiveTiltLeansToTheVisitor) {
  RingMap map{{4, 16, 3, 12}, std::vector<ColorLanes>(64)};
  for (int m = 14; m < 16; ++m) map.light[size_t(map.grid.index(0, m))] = ColorLanes{1, 1, 1, 0};
  const image::LinearImage picture{32, 32, std::vector<vec3>(1024, vec3(1))};
  CubeReport report;
  CubeSettings settings;
  settings.correct = false;
  const Volume volume = fill_cubes(map, {{16, 16}, 90 * degree}, 0.5, picture, settings, report);
  glm::dvec4 middle(0);
  for (int z = 0; z < volume.size.z; ++z)
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 32; ++x)
        middle += volume.at(x, y, z, 0) * (volume.to_metres * glm::dvec4(x, y, z, 1));
  middle /= middle.w;
  EXPECT_NEAR(middle.x, 0, 1e-3);
  EXPECT_NEAR(middle.y, 11 * std::cos(0.5) / 32, 0.03);  // the angle points up
  EXPECT_NEAR(middle.z, 11 * std::sin(0.5) / 32, 0.03);  // +Z is where the visitor stands
}

TEST(Nebula, ASliderKeepsThePictureAndBeginsWithTheRingsBefore) {
  NebulaSettings settings = small_nebula();
  NebulaReport report;
  const NebulaPicture nebula = prepare_nebula(lopsided(80, 64), settings, report);
  const RingMap before = solve_nebula(nebula, 0.30, settings, report);
  settings.solve.iterations = 6;
  solve_nebula(nebula, 0.32, settings, report);
  const double cold = report.residual.back().x;
  const RingMap map = solve_nebula(nebula, 0.32, settings, report, &before);
  EXPECT_LT(report.residual.back().x, cold);
  EXPECT_GT(map.grid.half_length, before.grid.half_length);
}

TEST(Nebula, TinyAndBlackPicturesAndLightThatIsNoNumberAreTaken) {
  NebulaSettings settings;
  settings.rings = {5, 7};
  for (const glm::ivec2 size : {glm::ivec2(1, 1), glm::ivec2(1, 9), glm::ivec2(4, 2)})
    for (const float light :
         {0.0f, 1.0f, std::nanf(""), -1.0f, std::numeric_limits<float>::infinity(),
          std::numeric_limits<float>::max()})
      for (const double tilt : {0.0, -75.0}) {
        image::LinearImage picture{size.x, size.y, std::vector<vec3>(size_t(size.x * size.y))};
        picture.color.back() = vec3(light);
        settings.tilt_degrees = tilt;
        NebulaReport report;
        const Volume volume = make_nebula(picture, settings, report);
        EXPECT_GE(volume.size.z, 2);
        for (int c = 0; c < 3; ++c)
          for (const float value : to_grid(volume, c).values) EXPECT_GE(value, 0);
      }
}

TEST(Nebula, SettingsThatMakeNoSenseAreRefused) {
  const image::LinearImage picture = soft_ellipse(16, 16, 0, 4, 3);
  const auto refused = [&](const auto& change) {
    NebulaSettings settings;
    change(settings);
    NebulaReport report;
    EXPECT_THROW(make_nebula(picture, settings, report), LoadError);
  };
  refused([](NebulaSettings& settings) { settings.tilt_degrees = 80; });
  refused([](NebulaSettings& settings) { settings.tilt_degrees = std::nan(""); });
  refused([](NebulaSettings& settings) { settings.angle_degrees = std::nan(""); });
  refused([](NebulaSettings& settings) { settings.rings = {0, 5}; });
  refused([](NebulaSettings& settings) { settings.rings = {70000, 70000}; });
  refused([](NebulaSettings& settings) { settings.solve.iterations = 0; });
  refused([](NebulaSettings& settings) { settings.most_side = 5000; });
  NebulaReport report;
  EXPECT_THROW(make_nebula({}, {}, report), LoadError);
}

TEST(Nebula, TheSameVolumeComesOutEachTime) {
  const auto made = [] {
    NebulaReport report;
    const Volume volume = make_nebula(lopsided(50, 40), small_nebula(), report);
    const auto* bytes = reinterpret_cast<const char*>(volume.bytes.get());
    return std::string(bytes, volume.byte_count());
  };
  EXPECT_TRUE(made() == made());
}

TEST(Nebula, PicturesOfTelescopesAreShownAgain) {
  const std::string folder = WELLSPRING_DATA "/10_exhibits/sky/";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not here";
  for (const char* name : {"n7009.png", "n6543.png"}) {
    NebulaSettings settings;
    settings.rings = {30, 60};
    settings.most_side = 128;
    NebulaReport report;
    const Volume volume = make_nebula(load_nebula_picture(folder + name), settings, report);
    EXPECT_LT(report.cubes.reprojection_error, 1e-6) << name;
    EXPECT_LT(report.cubes.unreached_light, 0.01) << name;
    EXPECT_GT(volume.size.z, 20) << name;
    if (name[1] == '6') {
      EXPECT_GT(report.stars, 20);
    } else {  // the Saturn nebula's long axis falls to the right
      EXPECT_NEAR(report.angle_degrees, -17, 10);
    }
  }
}

TEST(Nebula, FilesThatAreNoPictureAreNamed) {
  EXPECT_THROW(load_nebula_picture("/nowhere/at_all.png"), LoadError);
  EXPECT_THROW(load_nebula_picture(WELLSPRING_SOURCE "/CMakeLists.txt"), LoadError);
}

}  // namespace
}  // namespace wellspring::test
