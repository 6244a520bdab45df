// SPDX-License-Identifier: Apache-2.0
// Who is told a story sees pieces as its marks say: they glide there, for nobody else.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "unit/show/ball_piece.h"
#include "unit/show/show_stage.h"

namespace wellspring::test {
namespace {

struct PieceTold : testing::Test, ShowStage {
  void SetUp() override {
    Exhibit exhibit = make_tiny_exhibit();
    add_storyteller(exhibit, "anna", {-2, 0, 1});
    add_ball(exhibit, dvec3(-2, 1, 1.5));
    exhibit.stories[0].text = {
        {"en", read_story("<show piece='ball' turn='90' cut='0.5'/>One. Two.", "a").lines}};
    begin(std::move(exhibit), settings_for("direct", 25));
    for (int i = 0; i < 2; i++) join(32, 32);
    run(0.3);
  }
  VisitorPieces& pieces(size_t visitor) {
    auto at = show->visits.visitors.begin();
    std::advance(at, visitor);
    return at->pieces;
  }
};

TEST_F(PieceTold, GlidesToWhatTheStorySays) {
  say(R"({"type":"storyteller","story":"tale"})");
  ASSERT_TRUE(step_until([&] { return !pieces(0).wish.empty(); }, 200));
  EXPECT_NEAR(pieces(0).wish[0].turn, pi / 2, 1e-6f);
  run(0.75);
  const PieceChoice half = choice_of(pieces(0).shown.choices, 0);
  EXPECT_GT(half.turn, 0.2f);
  EXPECT_LT(half.turn, 1.4f);
  EXPECT_LT(half.high.z, 0.95f);
  EXPECT_GT(half.high.z, 0.55f);
  EXPECT_EQ(last("state")["pieces"]["ball"]["turn"], 90) << "pages are told where it goes";
  run(1.2);
  EXPECT_EQ(pieces(0).shown.choices, pieces(0).wish);
  EXPECT_TRUE(pieces(1).wish.empty()) << "nobody else's";
  EXPECT_TRUE(pieces(1).shown.choices.empty());
}

TEST_F(PieceTold, WhoChoosesMeanwhileSeesThatAtOnce) {
  say(R"({"type":"storyteller","story":"tale"})");
  ASSERT_TRUE(step_until([&] { return !pieces(0).wish.empty(); }, 200));
  run(0.3);
  order(R"({"type":"piece","name":"ball","turn":200})");
  EXPECT_NEAR(choice_of(pieces(0).shown.choices, 0).turn, glm::radians(200.0f), 1e-4f);
}

}  // namespace
}  // namespace wellspring::test
