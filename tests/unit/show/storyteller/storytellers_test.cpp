// SPDX-License-Identifier: Apache-2.0
// Several storytellers in one exhibit: one is there at a time, and visitors choose.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "show/http/still.h"
#include "show/state/make_show.h"
#include "show/storyteller/voice.h"
#include "unit/show/show_stage.h"

namespace wellspring::test {
namespace {

struct StorytellersTest : testing::Test, ShowStage {
  std::vector<SpeechRequest> asked;

  void SetUp() override {
    Exhibit exhibit = make_tiny_exhibit();
    for (int i : {0, 1}) {
      StorytellerPlace& storyteller_place = add_storyteller(
          exhibit, i == 0 ? "anna" : "otto", i == 0 ? dvec3(-2, 0, 2) : dvec3(3, 0, -2));
      storyteller_place.name = {{"en", i == 0 ? "Anna" : "Otto"}};
      storyteller_place.kiosk_viewpoint = i;
      storyteller_place.voice.variant = i == 0 ? "f3" : "m3";
      storyteller_place.greetings["en"].emplace_back().text = i == 0 ? "I am Anna." : "I am Otto.";
    }
    exhibit.stories.push_back(exhibit.stories[0]);
    exhibit.stories[1].id = "bell";
    exhibit.stories[1].storyteller_index = 1;
    tick_seconds = 0.04;
    begin(std::move(exhibit), settings_for("direct"));
    show->cast.speech.find = [](const SpeechRequest&) { return nullptr; };
    show->cast.speech.speak = [this](const SpeechRequest& request) {
      asked.push_back(request);
      std::promise<SpeechAnswer> promise;
      promise.set_value({nullptr, "mute"});
      return promise.get_future().share();
    };
  }
  void join(const char* role) {
    ShowStage::join(32, 32, "en", role);
    run(0.1);
  }
  // Says who is to be seen, by rays from above onto the places where the two stand.
  std::string seen() {
    std::string who;
    for (const StorytellerPlace& storyteller_place : show->stage.exhibit.storytellers) {
      Ray ray{.origin = vec3(storyteller_place.position) + vec3(0.02f, 2, 0.02f),
              .direction = vec3(0, -1, 0)};
      if (std::abs(show->stage.world->intersect(ray).t - 1.5f) < 0.1f) who += storyteller_place.id;
    }
    return who;
  }
};

TEST_F(StorytellersTest, OneIsThereAndTheOtherComesWhenCalled) {
  join("visitor");
  EXPECT_EQ(last("welcome")["storyteller"]["id"], "anna");
  ASSERT_EQ(last("welcome")["storytellers"].size(), 2u);
  EXPECT_EQ(last("welcome")["storytellers"][1]["name"], "Otto");
  EXPECT_EQ(last("welcome")["storytellers"][1]["viewpoint"], "corner");
  EXPECT_EQ(last("agent")["teller"], "anna");
  EXPECT_EQ(seen(), "anna");
  order(R"({"type":"storyteller","teller":"otto"})");
  EXPECT_EQ(last("agent")["teller"], "otto");
  EXPECT_EQ(seen(), "otto");
  order(R"({"type":"storyteller","teller":"emil"})");
  EXPECT_EQ(last("error")["code"], "unknown_storyteller");
  EXPECT_EQ(seen(), "otto");
  order(R"({"type":"storyteller","visible":false,"teller":"anna"})");
  EXPECT_EQ(seen(), "");
}

// Finished pictures (still.jpg) show who is there, too.
TEST(Storytellers, OneIsInFinishedPictures) {
  auto picture = [](std::vector<dvec3> places) {
    Exhibit exhibit = make_tiny_exhibit();
    for (size_t i = 0; i < places.size(); i++)
      add_storyteller(exhibit, "storyteller" + std::to_string(i), places[i]);
    exhibit.tours.clear();
    exhibit.viewpoints[0].view.position = {0, 1.6, 3.5};  // sees the world's origin, too
    exhibit.viewpoints[0].view.yaw = 0, exhibit.viewpoints[0].view.pitch = -0.3f;
    std::unique_ptr<Show> show = make_show(std::move(exhibit), settings_for("direct"));
    return StillRoom(*show).make({.width = 64, .height = 48, .seconds = 600, .spp = 4}).jpeg;
  };
  const dvec3 in_view(0, 0, 1.5), behind_the_wall(-3, 0, -3);
  std::string nobody = picture({behind_the_wall});
  EXPECT_TRUE(picture({in_view}) != nobody);
  EXPECT_TRUE(picture({behind_the_wall, in_view}) == nobody);
}

TEST_F(StorytellersTest, AStoryBringsItsOwnStorytellerAndVoice) {
  join("visitor");
  order(R"({"type":"storyteller","story":"tale"})");
  ASSERT_FALSE(asked.empty());
  EXPECT_EQ(asked.back().variant, "f3");
  EXPECT_EQ(last("agent")["teller"], "anna") << "whoever is there tells what is nobody's own";
  order(R"({"type":"storyteller","story":"bell"})");
  EXPECT_EQ(asked.back().variant, "m3");
  EXPECT_EQ(last("agent")["teller"], "otto");
  EXPECT_EQ(last("agent")["story"], "bell");
  EXPECT_EQ(last("subtitle")["speaker"], "Otto");
  order(R"({"type":"storyteller","teller":"anna"})");
  EXPECT_EQ(last("agent")["story"], nullptr) << "who goes falls silent";
}

TEST_F(StorytellersTest, AKioskStandsBeforeWhoeverIsThereAndIsGreeted) {
  join("kiosk");
  EXPECT_EQ(show->visits.visitors.front().place.viewpoint, 0);
  order(R"({"type":"storyteller","teller":"otto"})");
  EXPECT_EQ(show->visits.visitors.front().place.viewpoint, 1);
  auto eye = std::make_shared<Link>(2, LinkKind::eye, "camera");
  arrivals.put(eye);
  for (int i = 0; i < 50 && asked.empty(); i++) {
    eye->push_text_in(
        R"({"type":"observation","time":1,"presence":true,"state":"person",)"
        R"("people":[{"id":1,"position":[0,0,1],"rotation":[0,0,0],"confidence":1}]})");
    run(0.1);
  }
  ASSERT_FALSE(asked.empty());
  EXPECT_EQ(asked.back().text, "I am Otto.");
}

TEST(Storytellers, OnlyTheirOwnStoriesAreMadeReadyForThem) {
  Exhibit exhibit = make_tiny_exhibit();
  exhibit.storytellers.resize(2);
  exhibit.storytellers[0].voice.variant = "f3";
  exhibit.storytellers[1].voice.variant = "m3";
  exhibit.stories.push_back(exhibit.stories[0]);
  exhibit.stories[1].storyteller_index = 1;
  int by_first = 0, by_second = 0;
  for (const SpeechRequest& line : lines_of(exhibit)) {
    by_first += line.variant == "f3";
    by_second += line.variant == "m3";
  }
  EXPECT_EQ(by_first, 5) << "two lines in two languages, and the tour's";
  EXPECT_EQ(by_second, 4);
}

}  // namespace
}  // namespace wellspring::test
