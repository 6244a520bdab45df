// SPDX-License-Identifier: Apache-2.0
#include "museum/reception.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace wellspring {
namespace {

using nlohmann::json;

const std::vector<ExhibitDoor> doors = {{"castle", {"hall"}}, {"mill", {"yard", "attic"}}};

struct ReceptionTest : testing::Test {
  Reception reception{doors, 3};
  uint64_t numbers = 0;
  std::shared_ptr<Link> come(LinkKind kind, std::vector<std::string> texts) {
    auto link = std::make_shared<Link>(++numbers, kind, "test");
    for (std::string& text : texts) link->push_text_in(std::move(text));
    reception.enter(link);
    return link;
  }
};

std::string told(Link& link) {
  Link::Out out;
  return link.take_out(out) ? json::parse(out.text)["code"].get<std::string>() : "";
}

TEST_F(ReceptionTest, EverybodyComesToWhatTheyAskFor) {
  const std::string observation = R"({"type":"observation","time":1,"presence":false,)"
                                  R"("state":"absent","people":[])";
  struct Case {
    LinkKind kind;
    std::string text;
    int door;
  };
  const LinkKind visit = LinkKind::visit, eye = LinkKind::eye;
  for (const Case& one : {
           Case{visit, R"({"type":"hello","exhibit":"mill"})", 1},
           Case{visit, R"({"type":"hello","exhibit":"castle","kiosk":"yard"})", 0},
           Case{visit, R"({"type":"hello"})", 0},
           Case{visit, R"({"type":"hello","role":"kiosk","kiosk":"attic"})", 1},
           Case{visit, R"({"type":"hello","kiosk":"nowhere"})", 0},
           Case{visit, R"({"type":"hello","exhibit":"tower"})", -1},
           Case{visit, "no message at all", 0},  // whose show says what is wrong with it
           Case{eye, observation + R"(,"kiosk":"yard"})", 1},
           Case{eye, observation + "}", 0},
       })
    EXPECT_EQ(find_door(doors, one.kind, one.text), one.door) << one.text;
}

TEST_F(ReceptionTest, NothingThatWasSaidIsLost) {
  auto link = come(LinkKind::visit, {R"({"type":"hello","exhibit":"mill"})", "second", "third"});
  auto shown = reception.show_in(5);
  ASSERT_EQ(shown.size(), 1u);
  EXPECT_EQ(shown[0].door, 1u);
  EXPECT_EQ(shown[0].link, link);
  EXPECT_EQ(link->take_texts().size(), 3u);
  EXPECT_TRUE(reception.show_in(0).empty());
}

TEST_F(ReceptionTest, WhoSaysNothingWaitsAndWhoAsksForWhatIsNotThereMayAskAgain) {
  auto quiet = come(LinkKind::visit, {});
  auto lost = come(LinkKind::visit, {R"({"type":"hello","exhibit":"tower"})"});
  EXPECT_TRUE(reception.show_in(0).empty());
  EXPECT_EQ(told(*lost), "unknown_exhibit");
  EXPECT_EQ(told(*quiet), "");
  lost->push_text_in(R"({"type":"hello"})");
  quiet->push_text_in(R"({"type":"hello","exhibit":"mill"})");
  auto shown = reception.show_in(0);
  ASSERT_EQ(shown.size(), 2u);
  EXPECT_EQ(shown[0].door + shown[1].door, 1u);
}

TEST_F(ReceptionTest, ManyAreToldToComeBackAndTheGoneAreForgotten) {
  std::vector<std::shared_ptr<Link>> links;
  for (int i = 0; i < 4; i++) links.push_back(come(LinkKind::visit, {}));
  EXPECT_EQ(told(*links[3]), "full");
  std::string why;
  EXPECT_TRUE(links[3]->close_requested(why));
  for (auto& link : links) link->mark_closed();
  EXPECT_TRUE(reception.show_in(0).empty());
  auto next = come(LinkKind::visit, {R"({"type":"hello"})"});
  EXPECT_EQ(reception.show_in(0).size(), 1u);
}

}  // namespace
}  // namespace wellspring
