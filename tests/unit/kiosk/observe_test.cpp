// SPDX-License-Identifier: Apache-2.0
// The whole eye on the synthetic camera, whose truth is known.
#include "kiosk/observe.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <vector>

#include "base/load_error.h"
#include "benchmark/kiosk/made_objects.h"
#include "kiosk/camera.h"
#include "kiosk/face/face_finder.h"
#include "kiosk/figure.h"
#include "kiosk/station/learn.h"

namespace wellspring::test {
namespace {

constexpr double frame_rate = 10;

std::vector<Observation> watch_round(const Mount& mount, double until = figure_round,
                                     const std::string& weights = "/nowhere") {
  CameraSettings settings{.source = "synthetic",
                          .width = 320,
                          .rate = frame_rate,
                          .synthetic_ends = true,
                          .mount = mount};
  auto camera = make_camera(settings);
  ObserverSettings eye{.mount = mount};
  eye.face.weights = weights;
  Observer observer(eye);
  std::vector<Observation> seen;
  GrayFrame frame;
  while (camera->next(frame) == Got::frame && frame.time < until)
    seen.push_back(observer.step(frame));
  return seen;
}

TEST(Observe, a_visitor_comes_is_followed_and_leaves) {
  auto seen = watch_round({});
  ASSERT_EQ(seen.size(), size_t(std::ceil(figure_round * frame_rate)));
  std::vector<std::pair<double, Presence>> changes;
  for (size_t i = 1; i < seen.size(); i++)
    if (seen[i].state != seen[i - 1].state) changes.push_back({seen[i].time, seen[i].state});
  ASSERT_EQ(changes.size(), 4u);
  const PresenceSettings presence;
  EXPECT_EQ(changes[0].second, Presence::motion);
  EXPECT_GT(changes[0].first, figure_enters);
  EXPECT_EQ(changes[1].second, Presence::person);
  EXPECT_LT(changes[1].first, figure_stands + presence.confirm_after + 0.6);
  EXPECT_EQ(changes[2].second, Presence::motion);
  EXPECT_EQ(changes[3].second, Presence::absent);
  EXPECT_GT(changes[2].first, figure_leaves + presence.hold_person - 0.1);
  EXPECT_LT(changes[3].first, figure_gone + presence.hold_motion + 1);

  double position[3] = {}, rotation[3] = {};
  int frames = 0;
  for (const Observation& o : seen) {
    EXPECT_EQ(o.state == Presence::person, !o.people.empty()) << "at " << o.time;
    EXPECT_LE(o.people.size(), 1u) << "at " << o.time;
    if (o.time < figure_stands + 1.5 || o.time > figure_leaves) continue;
    ASSERT_FALSE(o.people.empty()) << "at " << o.time;
    const Person& p = o.people[0];
    const FigurePose truth = figure_at(o.time);
    EXPECT_EQ(p.id, 1u);
    EXPECT_GT(p.confidence, 0.3f);
    for (int k = 0; k < 3; k++) {
      position[k] += std::pow(p.position[k] - truth.position[k], 2);
      rotation[k] += std::pow(p.rotation[k] - truth.rotation[k], 2);
    }
    frames++;
  }
  ASSERT_GT(frames, 80);
  auto rms = [&](double sum) { return std::sqrt(sum / frames); };
  EXPECT_LT(rms(position[0]), 0.02);
  EXPECT_LT(rms(position[1]), 0.02);
  EXPECT_LT(rms(position[2]), 0.12);
  EXPECT_LT(rms(rotation[2]), 0.05);  // cascades tell roll alone
}

TEST(Observe, with_networks_yaw_and_roll_are_known_too) {
  const auto weights = std::filesystem::path(WELLSPRING_WEIGHTS_FOLDER) / "face";
  if (!std::filesystem::exists(weights)) GTEST_SKIP() << weights << " is not here";
  vec3 squares{0};
  int frames = 0;
  for (const Observation& o : watch_round({}, 8, weights.string())) {
    if (o.time < figure_stands + 1.5) continue;
    ASSERT_EQ(o.people.size(), 1u) << "at " << o.time;
    const FigurePose truth = figure_at(o.time);
    const vec3 off = o.people[0].rotation - truth.rotation;
    squares += off * off;
    EXPECT_LT(glm::length(o.people[0].position - truth.position), 0.06f) << "at " << o.time;
    frames++;
  }
  ASSERT_GE(frames, 29);
  EXPECT_LT(std::sqrt(squares.x / frames), 0.08);  // the figure's own: 0.27
  EXPECT_LT(std::sqrt(squares.y / frames), 0.12);
  EXPECT_LT(std::sqrt(squares.z / frames), 0.05);
}

TEST(Observe, networks_that_are_missing_are_told) {
  EXPECT_EQ(watch_round({}, 0.2).at(0).parts.faces, false);
  const std::string weights = WELLSPRING_WEIGHTS_FOLDER "/face";
  if (!std::filesystem::exists(weights)) GTEST_SKIP() << weights << " is not here";
  EXPECT_EQ(watch_round({}, 0.2, weights).at(0).parts.faces, true);
  // The folder lacks only the network for expressions.
  const std::filesystem::path part = testing::TempDir() + "some_face_networks";
  std::filesystem::create_directories(part);
  for (const auto& file : std::filesystem::directory_iterator(weights))
    if (!file.path().filename().string().starts_with("face_expression"))
      std::filesystem::copy_file(file.path(), part / file.path().filename(),
                                 std::filesystem::copy_options::overwrite_existing);
  ObserverSettings eye;
  eye.face.weights = part.string();
  EXPECT_FALSE(Observer(eye).step_blind(0).parts.expression) << "it is not asked for";
  eye.expression = true;
  EXPECT_EQ(Observer(eye).step_blind(0).parts.expression, false);
}

TEST(Observe, a_camera_above_the_screen_that_looks_down_gives_the_same_place) {
  Mount mount{.fov = 75 * pi / 180, .offset = {0.1f, 0.35f, 0}, .pitch = -0.35f};
  double worst[3] = {};
  int frames = 0;
  for (const Observation& o : watch_round(mount, 9)) {
    if (o.time < figure_stands + 1.5 || o.people.empty()) continue;
    vec3 truth = figure_at(o.time).position;
    for (int k = 0; k < 3; k++) worst[k] += std::abs(o.people[0].position[k] - truth[k]);
    frames++;
  }
  ASSERT_GT(frames, 30);
  EXPECT_LT(worst[0] / frames, 0.03);
  EXPECT_LT(worst[1] / frames, 0.06);
  EXPECT_LT(worst[2] / frames, 0.15);
}

TEST(Observe, a_face_that_never_stirs_is_a_picture) {
  Observer observer;
  for (int i = 0; i < 30; i++) {
    const GrayFrame frame =
        draw_figure({320, 240, 1, 2.5f, uint64_t(i)}, {}, {.visible = true}, 0.1 * i);
    EXPECT_NE(observer.step(frame).state, Presence::person) << "at " << frame.time;
  }
}

TEST(Observe, who_stirs_no_more_becomes_a_picture) {
  ObserverSettings settings;
  settings.liveness.still = 2;
  Observer observer(settings);
  bool person_early = false;
  for (int i = 0; i < 8 * 10; i++) {
    const double time = 0.1 * i;
    FigurePose pose{.visible = true};
    if (time < 2)
      pose.position.x = 0.02f * std::sin(float(i)), pose.rotation.x = 5 * pose.position.x;
    Observation o = observer.step(draw_figure({320, 240, 1, 2.5f, uint64_t(i)}, {}, pose, time));
    person_early |= time < 3 && o.state == Presence::person;
    if (time > 2 + 2 + 2 + 0.5) {
      EXPECT_NE(o.state, Presence::person) << "at " << time;
    }
  }
  EXPECT_TRUE(person_early);
}

TEST(Observe, a_blind_camera_lets_everything_run_out) {
  Observer observer;
  FigurePose pose{.visible = true};
  Observation o;
  for (int i = 0; i < 25; i++) {
    pose.position.x = 0.02f * std::sin(float(i));
    o = observer.step(draw_figure({320, 240, 1, 2.5f, 9}, {}, pose, 0.1 * i));
  }
  ASSERT_EQ(o.state, Presence::person);
  const float sure = o.people.at(0).confidence;
  o = observer.step_blind(3.4);
  ASSERT_EQ(o.people.size(), 1u);
  EXPECT_LT(o.people[0].confidence, 0.7f * sure);
  for (double time = 4; time < 6.5; time += 0.5) o = observer.step_blind(time);
  EXPECT_EQ(o.state, Presence::absent);
  EXPECT_TRUE(o.people.empty());
}

TEST(Observe, a_tilted_head_is_found_when_its_tilt_is_known) {
  const auto finder = make_cascade_finder();
  for (float roll : {-0.6f, 0.6f}) {
    FigurePose pose{.visible = true, .position = {0.05f, 0, 0.7f}, .rotation = {0, 0, roll}};
    GrayFrame frame = draw_figure({640, 480, 1, 1, 2}, {}, pose, 0);
    const float focal = focal_length({}, 640, 480), side = focal * face_box_metres / 0.7f;
    const float u = 320 - 0.05f / 0.7f * focal, v = 240;
    const Box last{u - side / 2, v - eyes_in_box * side, side, side};
    Face before;
    before.box = last;
    auto face = finder->follow(frame, before, roll);
    ASSERT_TRUE(face) << roll;
    EXPECT_NEAR(face->box.center_x(), u, 0.3f * side);
    EXPECT_NEAR(face->box.center_y(), v + 0.1f * side, 0.3f * side);
    ASSERT_TRUE(face->eyes) << roll;
    vec2 d = (*face->eyes)[1] - (*face->eyes)[0];
    EXPECT_NEAR(std::atan2(-d.y, d.x), roll, 0.12f);
  }
}

TEST(Observe, a_missing_cascade_is_named_with_its_package) {
  ObserverSettings settings;
  settings.face.weights = "/nowhere";  // so that cascades are asked for
  settings.face.cascades = "/nowhere";
  try {
    Observer observer(settings);
    FAIL() << "no error";
  } catch (const LoadError& error) {
    EXPECT_EQ(error.file.rfind("/nowhere/", 0), 0u) << error.file;
    EXPECT_NE(std::string(error.what()).find("opencv-data"), std::string::npos);
  }
}

// A card is held up for two seconds, and taken away.
TEST(Observe, what_is_held_is_told_while_something_moves) {
  const cv::Mat card = make_face(1), room = make_room(5);
  std::vector<LearnObject> objects;
  objects.push_back(make_object("card", {{card, "front"}}));
  objects.push_back(make_object("other", {{make_face(2), "front"}}));
  objects[0].sizes[""] = {0.12f, 0.09f};
  ObserverSettings settings;
  settings.face.weights = "/nowhere";
  settings.station = learn_tree(std::move(objects), "made").tree;
  Observer observer(settings);
  int told = 0, early = 0;
  std::optional<Holding> last;
  for (int i = 0; i < 150; i++) {
    cv::Mat picture = room.clone();
    Held held;
    held.size = 260, held.x = 260 + 2 * float(i % 30), held.roll = 0.01f * float(i % 30);
    if (i >= 30 && i < 90) put_face(picture, card, held);
    const Observation seen = observer.step(to_frame(picture, i / 30.0, 0.7, 4, unsigned(i)));
    EXPECT_EQ(seen.parts.objects, true);
    early += seen.holding && i < 30;
    last = seen.holding;
    if (!seen.holding) continue;
    EXPECT_EQ(seen.holding->id, "card");
    EXPECT_TRUE(seen.holding->position.has_value());
    told++;
  }
  EXPECT_EQ(early, 0);
  EXPECT_GT(told, 20);
  EXPECT_FALSE(last) << "it was taken away two seconds ago";
}

TEST(Observe, without_a_tree_nothing_is_told_of_objects) {
  ObserverSettings settings;
  settings.face.weights = "/nowhere";
  Observer observer(settings);
  const Observation seen = observer.step(to_frame(make_room(5), 0, 0.7, 4));
  EXPECT_FALSE(seen.parts.objects.has_value());
  EXPECT_FALSE(seen.holding);
}

}  // namespace
}  // namespace wellspring::test
