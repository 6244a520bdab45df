// SPDX-License-Identifier: Apache-2.0
// Bodies over time: who comes, leaves, passes or stays, and when the network is not run.
#include "kiosk/body/body_tracks.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "unit/kiosk/body/made_body.h"

namespace wellspring::test {
namespace {

struct Scene {
  BodyTracks tracks{Mount{}};
  int looks = 0;
  double time = 0;

  // Plays seconds of frames; `bodies` says who is there at a time. The network finds whose middle
  // is in the square, nearest to its middle first.
  void play(double seconds, double rate, const std::function<std::vector<MadeBody>(double)>& bodies,
            std::span<const FaceInView> faces = {}, bool arms = false) {
    const double end = time + seconds;
    for (; time < end; time += 1 / rate) {
      std::vector<BodyMarks> seen;
      std::vector<Box> zones;
      for (const MadeBody& body : bodies(time)) {
        seen.push_back(marks_of(body));
        const BodyBox box = body_box(seen.back());
        zones.push_back({box.low.x, box.low.y, box.high.x - box.low.x, box.high.y - box.low.y});
      }
      const auto look = tracks.plan(time, made_width, made_height, zones, faces, arms);
      if (!look) continue;
      looks++;
      std::vector<BodyMarks> found;
      auto off = [&](const BodyMarks& marks) {
        const BodyBox box = body_box(marks);
        return glm::length((box.low + box.high) / 2.f - look->square.middle);
      };
      for (const BodyMarks& marks : seen)
        if (off(marks) < look->square.width / 2) found.push_back(marks);
      std::ranges::sort(found, {}, off);
      found.resize(std::min(found.size(), look->most));
      tracks.take(time, found, faces);
    }
  }
  std::vector<wire::Body> bodies() const { return tracks.bodies(time); }
};

MadeBody at(float x, float z) {
  MadeBody body;
  body.feet = {x, -1.2f, z};
  return body;
}

struct Walk {
  const char* name;
  vec2 from, speed;  // right and away, metres
  BodyCourse course;
};

class Courses : public testing::TestWithParam<std::tuple<Walk, double>> {};

TEST_P(Courses, AreTold) {
  const auto& [walk, rate] = GetParam();
  Scene scene;
  scene.play(3, rate, [&, walk = walk](double t) {
    const vec2 place = walk.from + walk.speed * float(t);
    return std::vector{at(place.x, place.y)};
  });
  const auto bodies = scene.bodies();
  ASSERT_EQ(bodies.size(), 1u);
  EXPECT_EQ(bodies[0].course, walk.course);
  EXPECT_EQ(scene.tracks.somebody_comes(), walk.course == BodyCourse::comes);
}

INSTANTIATE_TEST_SUITE_P(
    Walks, Courses,
    testing::Combine(testing::Values(Walk{"comes", {0.5f, 6}, {0, -1}, BodyCourse::comes},
                                     Walk{"leaves", {0, 2.5f}, {0, 1}, BodyCourse::leaves},
                                     Walk{"passes", {-1.6f, 4}, {1, 0}, BodyCourse::passes},
                                     Walk{"stays", {0, 3.5f}, {0.05f, 0}, BodyCourse::stays}),
                     testing::Values(5.0, 15.0)),
    [](const auto& info) {
      return std::string(std::get<0>(info.param).name) +
             std::to_string(int(std::get<1>(info.param)));
    });

TEST(BodyTracks, SomebodyIsSeenFromSixMetresWithinTwoSeconds) {
  Scene scene;
  scene.play(2, 15, [](double) { return std::vector{at(0, 6)}; });
  ASSERT_EQ(scene.bodies().size(), 1u);
  EXPECT_NEAR(scene.bodies()[0].position.z, 6, 0.6f);
}

TEST(BodyTracks, TwoPeopleKeepTheirNumbers) {
  Scene scene;
  auto both = [](double t) { return std::vector{at(-0.9f, 4), at(0.9f, 4 - 0.3f * float(t))}; };
  scene.play(3, 15, both);
  ASSERT_EQ(scene.bodies().size(), 2u);
  const auto before = scene.bodies();
  scene.play(2, 15, both);
  const auto after = scene.bodies();
  ASSERT_EQ(after.size(), 2u);
  EXPECT_EQ(after[0].id, before[0].id);
  EXPECT_NEAR(after[0].position.x, 0.9f, 0.2f);
}

TEST(BodyTracks, WhoIsGoneIsForgotten) {
  Scene scene;
  scene.play(2, 15, [](double) { return std::vector{at(0, 3)}; });
  EXPECT_EQ(scene.bodies().size(), 1u);
  scene.play(2, 15, [](double) { return std::vector<MadeBody>(); });
  EXPECT_TRUE(scene.bodies().empty());
  EXPECT_FALSE(scene.tracks.somebody_comes());
}

TEST(BodyTracks, NobodyIsLookedForWhileNothingMoves) {
  Scene scene;
  scene.play(5, 15, [](double) { return std::vector<MadeBody>(); });
  EXPECT_EQ(scene.looks, 0);
}

TEST(BodyTracks, WhoIsNearAndHasAFaceCostsNothing) {
  const MadeBody body = at(0, 0.9f);
  const FaceInView face{7, face_of(marks_of(body), 0.9f), 0.9f};
  Scene scene;
  scene.play(
      4, 15, [&](double) { return std::vector{body}; }, std::span(&face, 1));
  EXPECT_EQ(scene.looks, 0);
  // Wrists that are asked for are looked for a few times a second.
  scene.play(
      4, 15, [&](double) { return std::vector{body}; }, std::span(&face, 1), true);
  EXPECT_GT(scene.looks, 8);
  EXPECT_LT(scene.looks, 17);
}

TEST(BodyTracks, SomebodyBehindAGuestIsStillSeen) {
  const MadeBody guest = at(-0.5f, 0.9f);
  const FaceInView face{7, face_of(marks_of(guest), 0.9f), 0.9f};
  Scene scene;
  scene.play(
      4, 15,
      [&](double) {
        return std::vector{guest, at(1.4f, 4)};
      },
      std::span(&face, 1));
  const auto bodies = scene.bodies();
  ASSERT_FALSE(bodies.empty());
  EXPECT_NEAR(bodies.back().position.x, 1.4f, 0.2f);
}

TEST(BodyTracks, LooksAreBounded) {
  Scene scene;
  scene.play(10, 30, [](double t) {
    return std::vector{at(-1, 4), at(1, 4), at(0, 3 + float(std::sin(t)))};
  });
  EXPECT_LE(scene.looks, 51);
}

TEST(BodyTracks, ForearmsBelongToTheFace) {
  const MadeBody body = at(0, 1.5f);
  const FaceInView face{7, face_of(marks_of(body), 1.5f), 1.5f};
  Scene scene;
  scene.play(
      1, 15, [&](double) { return std::vector{body}; }, std::span(&face, 1), true);
  const auto looked = scene.tracks.forearms(7, scene.time - 1. / 15);
  EXPECT_TRUE(scene.tracks.forearms(8, scene.time).empty());
  EXPECT_TRUE(scene.tracks.forearms(7, scene.time + 5).empty());
  for (const Forearm& arm : looked) EXPECT_TRUE(arm.has_elbow);
}

TEST(BodyTracks, ABodyNearThatStaysIsSomebody) {
  Scene scene;
  MadeBody turned_away = at(0, 1.2f);
  scene.play(0.5, 15, [&](double) { return std::vector{turned_away}; });
  EXPECT_FALSE(scene.tracks.somebody_stays_near(scene.time));
  scene.play(3, 15, [&](double) { return std::vector{turned_away}; });
  EXPECT_TRUE(scene.tracks.somebody_stays_near(scene.time));
  Scene far;
  far.play(4, 15, [&](double) { return std::vector{at(0, 4)}; });
  EXPECT_FALSE(far.tracks.somebody_stays_near(far.time));
}

TEST(BodyTracks, APictureOnTheWallIsNobody) {
  BodyTracks tracks{Mount{}};
  const std::vector<BodyMarks> poster = {marks_of(at(1.5f, 4))};
  // Something else moves far from it.
  const Box zone{0, 0, 60, 60};
  for (double t = 0; t < 4; t += 0.1)
    if (tracks.plan(t, made_width, made_height, std::span(&zone, 1), {}, false))
      tracks.take(t, poster, {});
  EXPECT_TRUE(tracks.bodies(4).empty());
}

TEST(BodyTracks, AClockThatRunsBackwardsForgetsEverybody) {
  Scene scene;
  scene.play(3, 15, [](double) { return std::vector{at(0, 4)}; });
  ASSERT_EQ(scene.bodies().size(), 1u);
  scene.time = 0;
  scene.play(0.05, 15, [](double) { return std::vector<MadeBody>(); });
  EXPECT_TRUE(scene.bodies().empty());
  scene.play(3, 15, [](double) { return std::vector{at(0, 4)}; });
  EXPECT_EQ(scene.bodies().size(), 1u);
}

TEST(BodyTracks, NumbersThatAreNoneAreIgnored) {
  BodyTracks tracks{Mount{}};
  const Box zone{0, 0, 640, 480};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(tracks.plan(nan, made_width, made_height, std::span(&zone, 1), {}, false));
  EXPECT_FALSE(tracks.plan(1, 0, 0, std::span(&zone, 1), {}, false));
  ASSERT_TRUE(tracks.plan(1, made_width, made_height, std::span(&zone, 1), {}, false));
  BodyMarks marks = marks_of({});
  marks.points[5].pixel.x = std::numeric_limits<float>::infinity();
  tracks.take(1, std::vector{marks}, {});
  tracks.take(1.1, std::vector{marks}, {});
  EXPECT_TRUE(tracks.bodies(1.1).empty());
}

TEST(BodyTracks, ABodyAtTheRimIsFollowedAsFarAsItIsSeen) {
  Scene scene;
  scene.play(3, 15, [](double) { return std::vector{at(2.2f, 4)}; });
  ASSERT_EQ(scene.bodies().size(), 1u);
  EXPECT_NEAR(scene.bodies()[0].position.x, 2.2f, 0.4f);
}

}  // namespace
}  // namespace wellspring::test
