// SPDX-License-Identifier: Apache-2.0
#include "kiosk/station/station.h"

#include <gtest/gtest.h>

#include "base/load_error.h"
#include "benchmark/kiosk/made_objects.h"
#include "kiosk/station/learn.h"
#include "kiosk/station/pattern.h"
#include "kiosk/tree/tree_file.h"

namespace wellspring::test {
namespace {

using Sides = std::vector<std::pair<cv::Mat, std::string>>;

RecognitionTree learn(std::vector<LearnObject> objects) {
  // A tree goes through its file, as ever.
  return parse_tree("tree.json", write_tree(learn_tree(std::move(objects), "made").tree));
}

std::string id_of(const Station& station, const Recognition& found) {
  return found.node < 0 ? "" : station.tree().nodes[size_t(found.node)].id;
}

GrayFrame show(const cv::Mat& face, const Held& held, unsigned seed = 1, double time = 0) {
  cv::Mat picture = make_room(seed);
  put_face(picture, face, held);
  put_fingers(picture, held);
  return to_frame(picture, time, 0.7, 4, seed);
}

struct Cards : testing::Test {
  static constexpr int count = 8;
  static std::vector<cv::Mat> faces;
  static RecognitionTree tree;
  static void SetUpTestSuite() {
    std::vector<LearnObject> objects;
    for (unsigned i = 0; i < unsigned(count); i++) {
      faces.push_back(make_face(i));
      objects.push_back(make_object("card" + std::to_string(i), {{faces.back(), "front"}}));
      objects.back().sizes[""] = {0.12f, 0.09f};
    }
    tree = learn(std::move(objects));
  }
};
std::vector<cv::Mat> Cards::faces;
RecognitionTree Cards::tree;

TEST_F(Cards, are_named_however_they_are_held) {
  int named = 0, tries = 0;
  for (unsigned seed = 0; seed < 24; seed++) {
    Station station(tree);
    const unsigned card = seed % count;
    const Recognition found = station.look(show(faces[card], random_held(seed), seed));
    const std::string id = id_of(station, found);
    EXPECT_TRUE(id.empty() || id == "card" + std::to_string(card)) << id;
    named += id == "card" + std::to_string(card);
    tries++;
  }
  EXPECT_GE(named, tries * 9 / 10);
}

TEST_F(Cards, are_named_upside_down_blurred_noisy_and_shining) {
  auto name = [&](const cv::Mat& picture, double blur, double noise) {
    Station station(tree);
    return id_of(station, station.look(to_frame(picture, 0, blur, noise)));
  };
  Held held;
  held.roll = pi;
  cv::Mat picture = make_room(3);
  put_face(picture, faces[2], held);
  EXPECT_EQ(name(picture, 0.7, 4), "card2");
  EXPECT_EQ(name(picture, 1.6, 4), "card2");
  EXPECT_EQ(name(picture, 0.7, 14), "card2");
  cv::ellipse(picture, {350, 220}, {50, 35}, 30, 0, 360, {255, 255, 255}, -1, cv::LINE_AA);
  EXPECT_EQ(name(picture, 0.7, 4), "card2");
  Held other;
  other.x = 470, other.size = 220;
  held.x = 170, held.size = 220;
  cv::Mat two = make_room(4);
  put_face(two, faces[2], held);
  put_face(two, faces[5], other);
  const std::string one = name(two, 0.7, 4);
  EXPECT_TRUE(one == "card2" || one == "card5") << one;
}

TEST_F(Cards, what_was_not_learnt_has_no_name) {
  Station station(tree);
  for (unsigned seed = 0; seed < 30; seed++) {
    const GrayFrame room = to_frame(make_room(seed), seed);
    EXPECT_EQ(id_of(station, station.look(room)), "");
    const GrayFrame unknown = show(make_face(100 + seed), random_held(seed), seed);
    EXPECT_EQ(id_of(station, station.look(unknown)), "");
  }
}

TEST_F(Cards, mirrored_face_is_another_object) {
  cv::Mat mirrored;
  cv::flip(faces[1], mirrored, 1);
  Station station(tree);
  EXPECT_EQ(id_of(station, station.look(show(mirrored, {}))), "");
}

TEST_F(Cards, object_that_moves_is_followed_by_the_verifier) {
  Station station(tree);
  Held held;
  int kept = 0;
  std::array<vec2, 4> corners;
  for (int i = 0; i < 40; i++) {
    held.x = 320 + 4 * float(i) - 80, held.roll = 0.01f * float(i);
    held.tilt_y = 0.01f * float(i);
    cv::Mat picture = make_room(9);
    corners = put_face(picture, faces[4], held);
    const Recognition found = station.look(to_frame(picture, i / 30.0, 0.7, 4, unsigned(i)));
    EXPECT_EQ(id_of(station, found), "card4") << i;
    EXPECT_TRUE(!found.kept || found.matches == 0);
    kept += found.kept;
  }
  EXPECT_GE(kept, 38);
  const mat3* pose = station.context().get<mat3>(pose_value);
  ASSERT_TRUE(pose);
  const View view{.width = 320, .height = 240};
  const auto seen = corners_of(*pose, view);
  for (size_t i = 0; i < 4; i++) EXPECT_LT(glm::distance(seen[i], corners[i]), 3.f);
}

TEST_F(Cards, name_needs_two_looks_and_stays_a_moment) {
  Station station(tree);
  const GrayFrame room = to_frame(make_room(2), 0);
  auto at = [&](GrayFrame frame, double time) {
    frame.time = time;
    return station.step(frame);
  };
  const GrayFrame held = show(faces[3], {}, 2);
  EXPECT_FALSE(at(room, 0));
  EXPECT_FALSE(at(held, 0.7));
  const auto told = at(held, 0.73);
  ASSERT_TRUE(told);
  EXPECT_EQ(told->id, "card3");
  EXPECT_EQ(told->title.at("en"), "The card3");
  EXPECT_TRUE(told->hint.empty());
  ASSERT_TRUE(told->position && told->rotation);
  // 0.12 m across 260 pixels, in the middle of the picture.
  EXPECT_NEAR(told->position->z, 0.12f * made_focal / 260, 0.01f);
  EXPECT_NEAR(told->position->x, 0, 0.005f);
  EXPECT_TRUE(at(room, 1.0));
  EXPECT_FALSE(at(room, 1.6));
}

TEST_F(Cards, mirrored_camera_names_them_as_well) {
  StationSettings settings;
  settings.mount.mirrored = true;
  Station station(tree, settings);
  Held held;
  held.x = 220;
  cv::Mat picture = make_room(2), mirror;
  put_face(picture, faces[6], held);
  cv::flip(picture, mirror, 1);
  std::optional<Holding> told;
  for (int i = 0; i < 3; i++) told = station.step(to_frame(mirror, 0.3 * i));
  ASSERT_TRUE(told);
  EXPECT_EQ(told->id, "card6");
  ASSERT_TRUE(told->position);
  EXPECT_GT(told->position->x, 0.02f);  // left in the true picture: at the visitor's right
}

// Two that differ in an emblem of the back, and two in the colour of a stripe.
struct TwinObjects : testing::Test {
  static cv::Mat front, back_a, back_b, red, green;
  static RecognitionTree tree;
  static void SetUpTestSuite() {
    front = make_face(50);
    back_a = make_face(51);
    back_b = back_a.clone();
    draw_emblem(back_a, 1, {180, 120});
    draw_emblem(back_b, 2, {180, 120});
    red = make_face(52);
    green = red.clone();
    cv::rectangle(red, {40, 200, 320, 50}, {40, 40, 200}, -1);
    cv::rectangle(green, {40, 200, 320, 50}, {60, 128, 40}, -1);
    std::vector<LearnObject> objects;
    objects.push_back(make_object("a", {{front, "front"}, {back_a, "back"}}));
    objects.push_back(make_object("b", {{front, "front"}, {back_b, "back"}}));
    objects[0].of_class["en"] = "a tile";
    objects.push_back(make_object("red", {{red, "front"}}));
    objects.push_back(make_object("green", {{green, "front"}}));
    for (unsigned i = 0; i < 4; i++)
      objects.push_back(make_object("other" + std::to_string(i), {{make_face(60 + i), "front"}}));
    tree = learn(std::move(objects));
  }
};
cv::Mat TwinObjects::front, TwinObjects::back_a, TwinObjects::back_b, TwinObjects::red,
    TwinObjects::green;
RecognitionTree TwinObjects::tree;

TEST_F(TwinObjects, class_and_a_hint_come_before_the_name) {
  for (const auto& [back, id] : {std::pair(back_a, "a"), {back_b, "b"}}) {
    Station station(tree);
    Held held;
    std::optional<Holding> told;
    for (int i = 0; i < 30; i++) {
      held.x = 320 + float(i);
      told = station.step(show(front, held, 5, i / 30.0));
    }
    ASSERT_TRUE(told);
    EXPECT_EQ(told->id, "");
    EXPECT_EQ(told->of_class, "a+b");
    EXPECT_EQ(told->title.at("en"), "a tile");
    ASSERT_TRUE(told->hint.contains("en"));
    EXPECT_EQ(told->hint.at("en"), "Turn it over, please.");
    for (int i = 0; i < 15; i++) told = station.step(show(back, held, 5, 1.5 + i / 30.0));
    ASSERT_TRUE(told);
    EXPECT_EQ(told->id, id);
    EXPECT_EQ(told->of_class, "a+b");
    EXPECT_TRUE(told->hint.empty());
  }
}

TEST_F(TwinObjects, side_that_tells_needs_no_hint) {
  for (const auto& [face, id] :
       {std::pair(back_a, "a"), {back_b, "b"}, {red, "red"}, {green, "green"}}) {
    int named = 0;
    for (unsigned seed = 0; seed < 8; seed++) {
      Station station(tree);
      Held held = random_held(seed);
      held.size = std::max(held.size, 240.f);
      Recognition found;
      for (int i = 0; i < 4; i++) found = station.look(show(face, held, seed, i / 30.0));
      const std::string seen = id_of(station, found);
      const std::string other = std::string(id) == "a"     ? "b"
                                : std::string(id) == "b"   ? "a"
                                : std::string(id) == "red" ? "green"
                                                           : "red";
      EXPECT_NE(seen, other);
      named += seen == id;
    }
    EXPECT_GE(named, 7) << id;
  }
}

TEST_F(TwinObjects, who_is_too_far_away_is_asked_to_come_closer) {
  Station station(tree);
  Held held;
  held.size = 130;
  std::optional<Holding> told;
  for (int i = 0; i < 60; i++) told = station.step(show(back_a, held, 5, i / 30.0));
  ASSERT_TRUE(told);
  EXPECT_EQ(told->id, "");
  EXPECT_EQ(told->hint.at("en"), "A little closer, please.");
}

TEST_F(TwinObjects, front_and_back_of_one_kind_are_never_asked_for_in_turn) {
  // Covering what differs makes both sides useless.
  cv::Mat covered = back_a.clone();
  covered(cv::Rect(160, 100, 110, 110)).setTo(cv::Scalar(130, 160, 215));
  Station station(tree);
  std::vector<std::string> hints;
  for (int i = 0; i < 120; i++) {
    const auto told = station.step(show(i / 30 % 2 ? covered : front, {}, 5, i / 30.0));
    if (!told || told->hint.empty()) continue;
    EXPECT_EQ(told->id, "");
    if (hints.empty() || hints.back() != told->hint.at("en")) hints.push_back(told->hint.at("en"));
  }
  EXPECT_LE(std::ranges::count(hints, "Turn it over, please."), 1);
}

// Turns are those of the object, whichever side is seen; its front faces the screen at 0.
TEST(Sides, turn_with_the_object) {
  std::vector<LearnObject> objects;
  Sides sides;
  for (const char* side : {"front", "back", "left"})
    sides.emplace_back(make_face(unsigned(40 + sides.size())), side);
  objects.push_back(make_object("casket", sides));
  objects.back().sizes[""] = {0.12f, 0.09f};
  Station station(learn(std::move(objects)));
  auto yaw = [&](size_t side) {
    station.forget();
    std::optional<Holding> told;
    for (int i = 0; i < 4; i++)
      told = station.step(show(sides[side].first, {}, 3, 10 * double(side) + i));
    return told && told->rotation ? told->rotation->x : -9.f;
  };
  EXPECT_NEAR(yaw(0), 0, 0.1f);
  EXPECT_NEAR(std::abs(yaw(1)), pi, 0.1f);
  EXPECT_NEAR(std::abs(yaw(2)), pi / 2, 0.1f);
}

TEST(PlainObjects, are_told_by_outline_and_colours) {
  auto plain = [](cv::Scalar a, cv::Scalar b) {
    cv::Mat out(300, 400, CV_8UC3, a);
    out(cv::Rect(0, 0, 200, 300)).setTo(b);
    return out;
  };
  const cv::Mat one = plain({40, 40, 190}, {200, 200, 60}),
                two = plain({40, 170, 40}, {200, 60, 160});
  std::vector<LearnObject> objects{make_object("one", {{one, "front"}}),
                                   make_object("two", {{two, "front"}})};
  for (LearnObject& object : objects) object.sizes[""] = {0.12f, 0.09f};
  const RecognitionTree tree = learn(objects);
  for (const auto& [face, id] : {std::pair(one, "one"), {two, "two"}})
    for (const float roll : {0.f, 0.5f, 3.0f}) {
      Station station(tree);
      cv::Mat picture(made_height, made_width, CV_8UC3, cv::Scalar(170, 175, 180));
      Held held;
      held.roll = roll, held.tilt_x = 0.3f;
      put_face(picture, face, held);
      EXPECT_EQ(id_of(station, station.look(to_frame(picture, 0))), id) << roll;
    }
  Station station(tree);
  for (unsigned seed = 0; seed < 30; seed++)
    EXPECT_EQ(id_of(station, station.look(to_frame(make_room(seed), seed))), "");
  // Who has neither texture nor colours, or no size, is refused.
  objects[0] = make_object("one", {{plain({90, 90, 90}, {90, 90, 90}), "front"}});
  EXPECT_THROW(learn(objects), LoadError);
  objects[0].sizes[""] = {0.12f, 0.09f};
  EXPECT_THROW(learn(objects), LoadError);
}

TEST(SameObjects, cannot_be_learnt) {
  const cv::Mat face = make_face(3);
  try {
    learn({make_object("a", {{face, "front"}}), make_object("b", {{face, "front"}})});
    FAIL();
  } catch (const LoadError& error) {
    EXPECT_EQ(error.file, "made/b");
    EXPECT_NE(error.what_.find("cannot be told from a"), std::string::npos);
  }
}

}  // namespace
}  // namespace wellspring::test
