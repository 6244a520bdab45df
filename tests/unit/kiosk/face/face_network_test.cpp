// SPDX-License-Identifier: Apache-2.0
// The eye with the trained networks on the synthetic visitor, and what happens without them.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <typeinfo>

#include "kiosk/face/face_finder.h"
#include "kiosk/figure.h"
#include "kiosk/observe.h"

namespace wellspring::test {
namespace {

namespace fs = std::filesystem;

const fs::path weights = fs::path(WELLSPRING_WEIGHTS_FOLDER) / "face";
#define NEEDS_WEIGHTS \
  if (!fs::exists(weights)) GTEST_SKIP() << weights << " is not here; ./wellspring installs it"

GrayFrame stand(vec3 position, vec3 rotation, double time) {
  FigurePose pose{true, position, rotation};
  return draw_figure({640, 480, 1, 2.5f, 1}, {}, pose, time);
}

// Returns the observation of a visitor who sways a little for `seconds`, in turns at `rotation`.
Observation watch(const ObserverSettings& settings, vec3 rotation, double seconds) {
  Observer observer(settings);
  Observation seen;
  for (int k = 0; k < int(seconds * 10); k++)
    seen =
        observer.step(stand({0.1f + 0.005f * std::sin(float(k)), 0.02f, 0.8f}, rotation, 0.1 * k));
  return seen;
}

TEST(FaceNetwork, a_turned_head_has_its_place_and_rotation) {
  NEEDS_WEIGHTS;
  ObserverSettings settings;
  settings.face.weights = weights.string();
  for (vec3 rotation : {vec3(0.5f, 0, 0), vec3(-0.5f, 0.1f, 0.2f)}) {
    const Observation seen = watch(settings, rotation, 2);
    ASSERT_EQ(seen.people.size(), 1u);
    const Person& person = seen.people[0];
    EXPECT_LT(glm::length(person.position - vec3(0.1f, 0.02f, 0.8f)), 0.05f);
    for (int axis = 0; axis < 3; axis++)
      EXPECT_NEAR(person.rotation[axis], rotation[axis], 0.14f) << axis;  // 8 degrees
    EXPECT_GT(person.confidence, 0.3f);
    EXPECT_FALSE(person.expression);
  }
}

TEST(FaceNetwork, a_face_three_metres_away_is_found_where_something_moves) {
  NEEDS_WEIGHTS;
  const auto finder = make_network_finder(weights.string());
  const GrayFrame frame = stand({0, 0, 3}, vec3(0), 0);
  std::vector<Face> faces;
  for (int call = 0; call < 8 && faces.empty(); call++)
    faces = finder->search_thoroughly(frame, {240, 200, 160, 280});
  ASSERT_EQ(faces.size(), 1u);
  EXPECT_NEAR(faces[0].box.center_x(), 320, 10);
  EXPECT_LT(faces[0].box.width, 45);
}

TEST(FaceNetwork, an_empty_room_has_no_face_and_one_who_leaves_is_given_up) {
  NEEDS_WEIGHTS;
  const auto finder = make_network_finder(weights.string());
  const GrayFrame empty = draw_figure({640, 480, 1, 2.5f, 1}, {}, {}, 0);
  for (int call = 0; call < 12; call++) {
    EXPECT_TRUE(finder->search(empty).empty());
    EXPECT_TRUE(finder->search_thoroughly(empty, {0, 0, 640, 480}).empty());
  }
  auto faces = finder->search(stand({0, 0, 0.8f}, vec3(0), 0));
  for (int call = 0; call < 4 && faces.empty(); call++)
    faces = finder->search(stand({0, 0, 0.8f}, vec3(0), 0));
  ASSERT_EQ(faces.size(), 1u);
  std::optional<Face> face = faces[0];
  int frames = 0;
  for (; face && frames < 60; frames++) {
    GrayFrame frame = empty;
    frame.time = (frames + 1) / 30.0;
    face = finder->follow(frame, *face);
  }
  EXPECT_LT(frames, 30);
}

TEST(FaceNetwork, expressions_are_there_only_when_asked_for) {
  NEEDS_WEIGHTS;
  ObserverSettings settings;
  settings.face.weights = weights.string();
  settings.expression = true;
  const Observation seen = watch(settings, vec3(0), 1.9);
  ASSERT_EQ(seen.people.size(), 1u);
  ASSERT_TRUE(seen.people[0].expression);
  EXPECT_EQ(*seen.people[0].expression, Expression{});  // rest is still being learnt
}

TEST(FaceNetwork, expressions_stop_while_nobody_needs_them) {
  NEEDS_WEIGHTS;
  ObserverSettings settings;
  settings.face.weights = weights.string();
  settings.expression = true;
  Observer observer(settings);
  bool before = false, unneeded = false, again = false, person = false;
  for (int i = 0; i < 60; i++) {
    if (i == 20) observer.need({true, false, true});
    if (i == 40) observer.need({});
    const Observation seen =
        observer.step(stand({0.1f + 0.005f * std::sin(float(i)), 0.02f, 0.8f}, vec3(0), 0.1 * i));
    if (seen.people.empty()) continue;
    const bool expression = seen.people[0].expression.has_value();
    (i < 20 ? before : i < 40 ? unneeded : again) |= expression;
    person |= i >= 20 && i < 40;
  }
  EXPECT_TRUE(before);
  EXPECT_TRUE(person);
  EXPECT_FALSE(unneeded);
  EXPECT_TRUE(again);
}

bool are_alike(const std::unique_ptr<FaceFinder>& one, const std::unique_ptr<FaceFinder>& other) {
  const FaceFinder &a = *one, &b = *other;
  return typeid(a) == typeid(b);
}

TEST(FaceNetwork, without_weights_or_with_damaged_ones_cascades_run) {
  FaceSettings settings{.weights = "/nowhere"};
  EXPECT_TRUE(are_alike(make_face_finder(settings), make_cascade_finder()));
  const fs::path folder = fs::temp_directory_path() / "wellspring_damaged_weights";
  fs::create_directories(folder);
  std::ofstream(folder / "tiny_face_detector_model-weights_manifest.json") << "[{]";
  settings.weights = folder.string();
  EXPECT_TRUE(are_alike(make_face_finder(settings), make_cascade_finder()));
  fs::remove_all(folder);
  if (fs::exists(weights)) {
    settings.weights = weights.string();
    EXPECT_TRUE(are_alike(make_face_finder(settings), make_network_finder(weights.string())));
  }
  // With cascades a person is seen all the same, and expressions are not made up.
  ObserverSettings eye;
  eye.face.weights = "/nowhere";
  eye.expression = true;
  const Observation seen = watch(eye, vec3(0), 2);
  ASSERT_EQ(seen.people.size(), 1u);
  EXPECT_FALSE(seen.people[0].expression);
}

}  // namespace
}  // namespace wellspring::test
