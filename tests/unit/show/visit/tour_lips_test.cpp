// SPDX-License-Identifier: Apache-2.0
// The words of a tour on the storyteller's lips: while it is in the visitor's picture, and only
// then.
#include <gtest/gtest.h>

#include "show/state/in_view.h"
#include "unit/show/show_stage.h"

namespace wellspring::test {
namespace {

// One vowel of four seconds.
std::shared_ptr<const Speech> make_vowel(const std::string& text) {
  auto speech = std::make_shared<Speech>();
  speech->text = text;
  speech->rate = 8000;
  speech->duration = 4;
  speech->pcm.resize(32000);
  VisemeKey key;
  key.weights[size_t(Viseme::aa)] = 1;
  speech->visemes.keys = {key};
  key.time = 4;
  speech->visemes.keys.push_back(key);
  return speech;
}

struct TourLips : testing::Test, ShowStage {
  std::map<std::string, std::shared_ptr<const Speech>> kept;

  void SetUp() override {
    Exhibit exhibit = make_tiny_exhibit();
    exhibit.shared_storyteller = true;
    // 2 m before the viewpoint where the tour begins.
    StorytellerPlace& storyteller_place = add_storyteller(exhibit, "anna", {-2, 0, 1});
    Displacer open{.name = "viseme_aa", .vertices = {0}, .displacements = {{0, 0.01f, 0}}};
    storyteller_place.character.displacers = {open};
    tick_seconds = 0.04;
    begin(std::move(exhibit), settings_for("direct"));
    show->cast.speech.find = [this](const SpeechRequest& request) {
      auto& speech = kept[request.text];
      if (!speech) speech = make_vowel(request.text);
      return speech;
    };
    show->cast.speech.speak = [](const SpeechRequest&) {
      return std::shared_future<SpeechAnswer>();
    };
  }
  void join() {
    ShowStage::join(32, 32);
    run(0.1);
  }
  float lips() const { return show->cast.teller.pose.displacers.at(0); }
};

TEST_F(TourLips, MoveWhileTheTourIsTold) {
  join();
  run(1);
  EXPECT_LT(lips(), 0.05f);
  order(R"({"type":"tour","action":"play"})");
  run(1.5);
  ASSERT_TRUE(heard(show->visits.visitors.front().hearing.narration.voice));
  EXPECT_GT(lips(), 0.5f);
  order(R"({"type":"tour","action":"pause"})");
  run(1);
  EXPECT_LT(lips(), 0.05f);
}

TEST_F(TourLips, NothingOfTheFaceRunsBehindTheVisitorsBack) {
  join();
  order(R"({"type":"tour","action":"play"})");
  run(1);
  StorytellerWork before = show->cast.teller.mind.work;
  EXPECT_GT(before.visemes, 0u);
  EXPECT_GT(before.blinks, 0u);
  // Half round; the tour goes on.
  order(R"({"type":"input","seq":1,"move":[0,0,0],"look":[3.1416,0]})");
  ASSERT_FALSE(
      sees_head(show->cast, show->cast.teller, view_of(*show, show->visits.visitors.front())));
  ASSERT_TRUE(heard(show->visits.visitors.front().hearing.narration.voice));
  before = show->cast.teller.mind.work;
  run(0.8);
  EXPECT_GT(show->cast.teller.mind.work.ticks, before.ticks);
  EXPECT_EQ(show->cast.teller.mind.work.visemes, before.visemes);
  EXPECT_EQ(show->cast.teller.mind.work.blinks, before.blinks);
  EXPECT_EQ(show->cast.teller.mind.work.flexes, before.flexes);
  EXPECT_EQ(show->cast.teller.mind.work.expressions, before.expressions);
  EXPECT_EQ(show->cast.teller.mind.work.eyes, before.eyes);
  EXPECT_EQ(lips(), 0);
}

TEST_F(TourLips, HerOwnWordsComeFirst) {
  join();
  join();
  auto silence = std::make_shared<Speech>(*make_vowel("One."));
  for (VisemeKey& key : silence->visemes.keys) {
    key.weights.fill(0);
    key.weights[size_t(Viseme::sil)] = 1;
  }
  kept["One."] = silence;
  order(R"({"type":"tour","action":"play"})");
  run(1);
  EXPECT_GT(lips(), 0.5f);
  order(R"({"type":"storyteller","story":"tale"})", 1);
  run(1);
  ASSERT_TRUE(heard(show->visits.visitors.front().hearing.narration.voice)) << "the tour goes on";
  EXPECT_LT(lips(), 0.05f);
}

TEST_F(TourLips, OfTwoToursTheNearerOneInViewCounts) {
  join();
  join();
  for (size_t i = 0; i < 2; i++) order(R"({"type":"tour","action":"play"})", i);
  Visitor &far = show->visits.visitors.front(), &near = show->visits.visitors.back();
  far.place.view.position = {-2, 1.6, 3.5};
  near.place.view.position = {-2, 1.6, 2.5};
  far.place.view.yaw = near.place.view.yaw = 0;
  EXPECT_EQ(heard_on_tour(*show, show->cast.teller), &near);
  near.place.view.yaw = 3.1f;
  EXPECT_EQ(heard_on_tour(*show, show->cast.teller), &far);
  EXPECT_NEAR(viewer_distance(*show, show->cast.teller), 2.5f, 0.15f);
  show->cast.teller.visible = false;
  EXPECT_EQ(heard_on_tour(*show, show->cast.teller), nullptr);
}

// A guest before a kiosk sees the storyteller from there, not from where the picture's camera is.
TEST_F(TourLips, ThePersonBeforeAKioskIsTheViewer) {
  ShowStage::join(32, 32, "en", "kiosk");
  run(0.1);
  visitor().place.view.position = {-2, 1.6, 2.5};
  visitor().place.view.yaw = 0;
  Audience& audience = show->kiosks.all.at(0).audience;
  audience.guests.clear();
  const float camera = viewer_distance(*show, show->cast.teller);
  const View view = view_of(*show, visitor());
  for (float away : {0.6f, 1.6f, 4.6f}) {
    Person person{.position = {0, 0, away}};
    audience.guests = {place_person(person, view, 0)};
    EXPECT_NEAR(viewer_distance(*show, show->cast.teller), camera + away - viewing_distance, 0.1f);
  }
}

TEST(InView, AgreesWithProjectionAtTheEdge) {
  Scene scene;
  View view = make_view(scene, {1, 2, 3}, 0.4f, -0.2f, 0.9f, 160, 90);
  // Points: in the picture they are always in view; far outside of its circle never.
  int shown = 0;
  for (int i = 0; i < 4000; i++) {
    vec3 p(float(i % 20) - 9.5f, float(i / 20 % 10) - 3.5f, float(i / 200) - 9.5f);
    Projected at = project_point(view, p);
    bool inside = at.depth > 0 && at.x >= 0 && at.x < 160 && at.y >= 0 && at.y < 90;
    float round = std::hypot(at.x - 80, at.y - 45) / std::hypot(80.0f, 45.0f);
    shown += inside;
    if (inside) {
      EXPECT_TRUE(in_view(view, p, 0));
    }
    if (at.depth <= 0 || round > 1.01f) {
      EXPECT_FALSE(in_view(view, p, 0)) << i;
    }
  }
  EXPECT_GT(shown, 50);
}

}  // namespace
}  // namespace wellspring::test
