// SPDX-License-Identifier: Apache-2.0
// What a story's mark <show> makes of a piece, and the way there.
#include <gtest/gtest.h>

#include "image/image.h"
#include "show/exhibit/pieces/piece_choices.h"
#include "unit/show/ball_piece.h"
#include "unit/show/exhibit/room_package.h"

namespace wellspring::test {
namespace {

PieceMark mark_of(const std::string& attributes) {
  const StoryScript script = read_story("<show piece='ball' " + attributes + "/>Look.", "a");
  return script.lines.at(0).marks.at(0).piece;
}

struct PieceMarks : testing::Test {
  Exhibit exhibit;
  PieceChoices choices;
  PieceMarks() { add_ball(exhibit, dvec3(0)); }
  PieceChoice tell(const std::string& attributes) {
    EXPECT_EQ(choose_told(exhibit, "ball", mark_of(attributes), choices), "") << attributes;
    return choices.at(0);
  }
};

TEST_F(PieceMarks, SayWhatIsSeenAndLeaveTheRestAsItIs) {
  PieceChoice seen = tell("layer='core' turn='90' cut='30%'");
  EXPECT_EQ(seen.layer, 1);
  EXPECT_EQ(seen.by, Blend::none);
  EXPECT_NEAR(seen.turn, pi / 2, 1e-6f);
  EXPECT_NEAR(seen.high.z, 0.7f, 1e-6f);
  EXPECT_EQ(seen.low, vec3(0));
  choices[0].low.x = 0.2f;  // cut by the visitor
  seen = tell("turn='-45deg'");
  EXPECT_EQ(seen.layer, 1);
  EXPECT_NEAR(seen.turn, -pi / 4, 1e-6f);
  EXPECT_NEAR(seen.high.z, 0.7f, 1e-6f);
  EXPECT_FLOAT_EQ(seen.low.x, 0.2f);
  seen = tell("layer='skin' over='core' share='0.25'");
  EXPECT_EQ(seen.layer, 0);
  EXPECT_EQ(seen.over, 1);
  EXPECT_EQ(seen.by, Blend::fade);
  EXPECT_FLOAT_EQ(seen.share, 0.25f);
  EXPECT_NEAR(seen.turn, -pi / 4, 1e-6f);
  seen = tell("cut='0'");
  EXPECT_EQ(seen.by, Blend::none) << "a mixture ends unless it is said";
  EXPECT_EQ(seen.high, vec3(1));
}

TEST_F(PieceMarks, NameWhatIsNotThere) {
  EXPECT_EQ(choose_told(exhibit, "bal", {}, choices),
            "there is no piece 'bal'; did you mean 'ball'?");
  const std::string wrong = choose_told(exhibit, "ball", mark_of("layer='cor'"), choices);
  EXPECT_NE(wrong.find("no layer 'cor'"), std::string::npos) << wrong;
  EXPECT_NE(wrong.find("did you mean 'core'?"), std::string::npos) << wrong;
  EXPECT_TRUE(choices.empty());
}

TEST_F(PieceMarks, TurnTheShorterWayAndCutEvenly) {
  PieceChoice from, to;
  from.turn = glm::radians(350.0f), to.turn = glm::radians(20.0f);
  to.high.z = 0.5f, to.low.x = 0.2f;
  const PieceChoice half = glide({from}, {to}, 0.5f).at(0);
  EXPECT_NEAR(std::remainder(half.turn, 2 * pi), glm::radians(5.0f), 1e-5f);
  EXPECT_FLOAT_EQ(half.high.z, 0.75f);
  EXPECT_FLOAT_EQ(half.low.x, 0.1f);
  EXPECT_EQ(glide({}, {to}, 0).at(0), PieceChoice{}) << "nothing chosen is as at first";
}

TEST_F(PieceMarks, LetPresetsFadeIntoOneAnother) {
  const auto way = [](PieceChoice from, PieceChoice to) { return glide({from}, {to}, 0.5f).at(0); };
  const PieceChoice skin{.layer = 0}, core{.layer = 1};
  const PieceChoice mixed{.layer = 0, .over = 1, .by = Blend::fade, .share = 0.6f};
  EXPECT_EQ(way(skin, core), (PieceChoice{.layer = 0, .over = 1, .by = Blend::fade}));
  EXPECT_FLOAT_EQ(way(skin, mixed).share, 0.3f);
  EXPECT_EQ(way(skin, mixed).over, 1);
  EXPECT_FLOAT_EQ(way(mixed, skin).share, 0.3f);
  EXPECT_EQ(way(mixed, skin).over, 1) << "it fades out";
  EXPECT_FLOAT_EQ(way(mixed, core).share, 0.8f);
  const PieceChoice curtain{.layer = 0, .over = 1, .by = Blend::curtain};
  EXPECT_EQ(way(skin, curtain), curtain) << "others begin at once";
}

TEST(StoryMarks, ShowPiecesThatThePackageHas) {
  RoomPackage package;
  const Image8 image{4, 2, std::vector<uint8_t>(24, 99)};
  const std::vector<uint8_t> png = encode_png(image, "", "a.png");
  package.write("a.png", std::string(png.begin(), png.end()));
  package.manifest["pieces"] = {{{"id", "valley"},
                                 {"kind", "picture"},
                                 {"source", "a.png"},
                                 {"width_m", 1},
                                 {"place", {{"position", {0, 1.5, -2.9}}}},
                                 {"label", {{"en", "V"}}}}};
  package.manifest["stories"] = {{{"id", "s"}, {"text", {{"en", "s.story"}}}}};
  package.write("s.story",
                "<story>\n<p><show piece=\"valley\"/>One.</p>\n<p><show piece=\"valey\"/>Two.</p>\n"
                "<p><show piece=\"valley\" turn=\"30\"/>Three.</p>\n</story>");
  package.read();
  EXPECT_EQ(package.told().find("line 2"), std::string::npos) << package.told();
  EXPECT_EQ(package.says("line 3, column 4", "there is no piece 'valey'"), 1) << package.told();
  EXPECT_EQ(package.says("line 4, column 4", "is no volume"), 1) << package.told();
}

}  // namespace
}  // namespace wellspring::test
