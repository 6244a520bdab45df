// SPDX-License-Identifier: Apache-2.0
// Storytellers stand on the ground: on meshes, on scanned points, and in the content's ruin.
#include "show/check/footing.h"

#include <gtest/gtest.h>

#include "show/exhibit/pieces/exhibit_scans.h"
#include "show/moving/exhibit_scene.h"
#include "unit/show/exhibit/room_package.h"
#include "unit/show/tiny_exhibit.h"

namespace wellspring::test {
namespace {

// Checks a room with somebody who stands there. Returns what is told.
std::string told_of(RoomPackage& package, const Exhibit& furnished, dvec3 feet) {
  Exhibit exhibit = furnished;
  exhibit.storytellers.clear();
  add_storyteller(exhibit, "guide", feet);
  World world(exhibit.scene);
  place_scans(exhibit, world);
  package.problems.clear();
  check_places(exhibit, world, package.problems);
  return package.told();
}

TEST(Footing, WhoFloatsOrSinksInIsNamedWithTheHeightOfTheGround) {
  RoomPackage package;
  const Exhibit room = package.read();
  EXPECT_EQ(told_of(package, room, {2, 0, 1}), "");
  EXPECT_EQ(told_of(package, room, {2, 0.015, 1}), "");
  EXPECT_NE(told_of(package, room, {2, 0.03, 1}).find("'guide' floats by 0.030 m"),
            std::string::npos)
      << package.told();
  const std::string low = told_of(package, room, {2, -0.2, 1});
  EXPECT_NE(low.find("'guide' sinks in by 0.200 m: the ground is at a height of 0.000 m"),
            std::string::npos)
      << low;
  const std::string high = told_of(package, room, {2, 0.7, 1});
  EXPECT_NE(high.find("no ground within 0.5 m"), std::string::npos) << high;
}

// A scanned floor 1 cm over the room's, uneven by a centimetre: its points count, not the mesh that
// rays meet, and not a wall beside the feet.
TEST(Footing, OnAScanTheMedianOfItsPointsIsTheGround) {
  RoomPackage package;
  std::string floor;
  for (int x = 0; x <= 100; x++)
    for (int y = 0; y <= 100; y++)
      floor += std::to_string(0.02 * x) + " " + std::to_string(0.02 * y) + " " +
               std::to_string(0.005 * ((x * 7 + y * 3) % 3)) + "\n";
  for (int y = 0; y <= 100; y++)
    for (int z = 1; z <= 10; z++)
      floor += "2 " + std::to_string(0.02 * y) + " " + std::to_string(0.1 * z) + "\n";
  package.write("floor.xyz", floor);
  package.manifest["pieces"] = json::array({{{"id", "floor"},
                                             {"kind", "scan"},
                                             {"source", "floor.xyz"},
                                             {"label", {{"en", "Floor"}}},
                                             {"place", {{"position", {2, 0.01, 1.5}}}}}});
  const Exhibit room = package.read();
  ASSERT_EQ(package.told(), "");
  World world(room.scene);
  place_scans(room, world);
  const vec3 feet(2, 0.01f, 1.5f);
  EXPECT_NEAR(find_footing(world, feet, 0.2f).value(), 0.015f, 0.002f);
  EXPECT_NEAR(find_footing(world, feet + vec3(0.9f, 0, 0), 0.2f).value(), 0.015f, 0.006f);
  EXPECT_EQ(told_of(package, room, {2, 0.02, 1.5}), "");
  EXPECT_NE(told_of(package, room, {2, 0.05, 1.5}).find("floats by 0.035 m"), std::string::npos)
      << package.told();
}

// Returns how far the lowest place of each foot is above what was scanned below it, metres.
std::vector<float> gaps_of(const Exhibit& exhibit) {
  constexpr float sole = 0.015f, around = 0.08f;  // metres
  World world(exhibit.scene);
  place_scans(exhibit, world);
  const Scene acted = make_exhibit_scene(exhibit, 2);
  const StorytellerPlace& place = exhibit.storytellers.front();
  const mat4 own = glm::inverse(place_storyteller(place, exhibit.scene));
  std::vector<vec3> low[2];
  float lowest = INFINITY;
  const auto each_corner = [&](const auto& take) {
    for (size_t i = exhibit.scene.instances.size(); i < acted.instances.size(); i++)
      for (const vec3& p : acted.meshes[size_t(acted.instances[i].mesh)].positions)
        take(vec3(acted.instances[i].to_world * vec4(p, 1)));
  };
  each_corner([&](vec3 p) { lowest = std::min(lowest, p.y); });
  each_corner([&](vec3 p) {
    if (p.y < lowest + sole) low[(own * vec4(p, 1)).x > 0].push_back(p);
  });
  std::vector<float> gaps;
  for (const std::vector<vec3>& foot : low) {
    EXPECT_FALSE(foot.empty());
    vec3 middle(0);
    for (const vec3& p : foot) middle += p / float(foot.size());
    gaps.push_back(lowest - find_footing(world, middle, around).value_or(NAN));
  }
  return gaps;
}

TEST(Footing, TheChapelsStorytellerStandsOnTheScannedFloorWithBothFeet) {
  std::vector<Problem> problems;
  Exhibit chapel = read_exhibit(std::string(WELLSPRING_SOURCE) + "/content/chapel", problems);
  for (const Problem& problem : problems) ADD_FAILURE() << to_string(problem);
  ASSERT_EQ(chapel.storytellers.size(), 1u);
  for (const float gap : gaps_of(chapel)) EXPECT_NEAR(gap, 0, 0.02f);
  World world(chapel.scene);
  place_scans(chapel, world);
  check_places(chapel, world, problems);
  for (const Problem& problem : problems) ADD_FAILURE() << to_string(problem);
  chapel.storytellers[0].position.y += 0.05;
  for (const float gap : gaps_of(chapel)) EXPECT_GT(gap, 0.03f);
  check_places(chapel, world, problems);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_NE(problems[0].what.find("'ludmila' floats by"), std::string::npos) << problems[0].what;
}

}  // namespace
}  // namespace wellspring::test
