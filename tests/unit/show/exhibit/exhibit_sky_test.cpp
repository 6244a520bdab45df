// SPDX-License-Identifier: Apache-2.0
// An exhibit's environment.sky: what it makes of the scene's light, and its mistakes with file and
// place.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "show/exhibit/load/exhibit_load.h"
#include "world/sky.h"

using namespace wellspring;

using namespace wellspring::test;

namespace {

struct SkyPackage {
  std::string folder = std::string(testing::TempDir()) + "exhibit_sky_" +
                       testing::UnitTest::GetInstance()->current_test_info()->name();
  std::vector<Problem> problems;
  Exhibit exhibit;

  explicit SkyPackage(const std::string& environment) {
    std::filesystem::create_directories(folder);
    std::ofstream(folder + "/scene.gltf") << R"({"asset": {"version": "2.0"}})";
    std::ofstream(folder + "/exhibit.json")
        << R"({"title": {"en": "Sky"}, "scene": "scene.gltf", "environment": )" + environment + "}";
    exhibit = read_exhibit(folder, problems);
  }
  ~SkyPackage() { std::filesystem::remove_all(folder); }

  // The problems that lie in the environment.
  std::vector<std::string> found() const {
    std::vector<std::string> list;
    for (const Problem& p : problems)
      if (p.where.find("environment") != std::string::npos) {
        EXPECT_NE(p.file.find("exhibit.json"), std::string::npos) << p.file;
        list.push_back(p.fatal ? p.where : p.where + " (ignored)");
      }
    return list;
  }
};

using Places = std::vector<std::string>;

}  // namespace

TEST(ExhibitSky, IsTheSkyOfItsAnglesAndAir) {
  SkyPackage package(
      R"({"sky": {"elevation_deg": 30, "azimuth_deg": 90, "turbidity": 4, "strength": 0.5}})");
  EXPECT_EQ(package.found(), Places{});
  SkySettings settings;
  settings.elevation = 30;
  settings.azimuth = 90;
  settings.turbidity = 4;
  settings.strength = 0.5f;
  Scene expected;
  add_sky(settings, expected);
  const SunDisc &sun = package.exhibit.scene.environment.sun, &other = expected.environment.sun;
  EXPECT_EQ(sun.direction, other.direction);
  EXPECT_EQ(sun.radiance, other.radiance);
  EXPECT_NEAR(sun.direction.x, std::sqrt(0.75), 1e-5) << "clockwise from -Z: the east";
  EXPECT_NEAR(sun.direction.y, 0.5, 1e-5);
  ASSERT_EQ(package.exhibit.scene.images.size(), expected.images.size());
  ASSERT_FALSE(expected.images.empty());
  EXPECT_EQ(package.exhibit.scene.images[0].texels, expected.images[0].texels);
}

TEST(ExhibitSky, MistakesHaveAPlace) {
  auto places = [](const std::string& environment) { return SkyPackage(environment).found(); };
  EXPECT_EQ(places(R"({"sky": {"azimuth_deg": 0}})"), Places{"/environment/sky/elevation_deg"});
  EXPECT_EQ(places(R"({"sky": {"elevation_deg": 30}})"), Places{"/environment/sky/azimuth_deg"});
  EXPECT_EQ(places(R"({"sky": {"elevation_deg": 91, "azimuth_deg": 0}})"),
            Places{"/environment/sky/elevation_deg"});
  EXPECT_EQ(places(R"({"sky": {"elevation_deg": "high", "azimuth_deg": 0}})"),
            Places{"/environment/sky/elevation_deg"});
  EXPECT_EQ(places(R"({"sky": {"elevation_deg": 5, "azimuth_deg": 0, "turbidity": 0.5}})"),
            Places{"/environment/sky/turbidity"});
  EXPECT_EQ(places(R"({"sky": {"elevation_deg": 5, "azimuth_deg": 0, "strength": -1}})"),
            Places{"/environment/sky/strength"});
  EXPECT_EQ(places(R"({"sky": {"elevation_deg": 5, "azimuth_deg": 0, "colour": 1}})"),
            Places{"/environment/sky/colour (ignored)"});
  EXPECT_EQ(places(R"({"sky": 7})"), Places{"/environment/sky"});
}
