// SPDX-License-Identifier: Apache-2.0
#include "museum/reception.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace wellspring::test {
namespace {

using nlohmann::json;

const std::vector<ExhibitDoor> doors = {{"castle", {"hall"}}, {"mill", {"yard", "attic"}}};
const std::string hello = R"({"type":"hello"})";

struct ReceptionTest : testing::Test {
  static constexpr int seats = 3;
  std::shared_ptr<Capacity> capacity =
      std::make_shared<Capacity>(CapacitySettings{.most = seats, .cores = 64});
  Reception reception{
      doors,
      capacity,
      {.most_waiting = 2, .most_resting = 2, .most_strangers = 3, .kiosk_tokens = {}}};
  std::vector<Reception::Shown> inside;
  uint64_t numbers = 0;

  std::shared_ptr<Link> come(LinkKind kind, std::vector<std::string> texts, bool local = false) {
    auto link = std::make_shared<Link>(++numbers, kind, "test");
    link->local = local;
    for (std::string& text : texts) link->push_text_in(std::move(text));
    reception.enter(link);
    return link;
  }
  std::shared_ptr<Link> visit(std::vector<std::string> texts) {
    return come(LinkKind::visit, std::move(texts));
  }
  // Counts how many come in at once; they stay inside.
  size_t let_in() {
    auto shown = reception.show_in(0);
    for (auto& one : shown) inside.push_back(std::move(one));
    return shown.size();
  }
  // Says whether the link is in at second 5: waiting ones are looked at now and then only.
  bool comes_in(const std::shared_ptr<Link>& link) {
    for (auto& one : reception.show_in(5)) inside.push_back(std::move(one));
    return std::ranges::any_of(inside, [&](const auto& one) { return one.link == link; });
  }
  void fill() {
    while (int(inside.size()) < seats) {
      visit({hello});
      ASSERT_EQ(let_in(), 1u);
    }
  }
};

json told(Link& link) {
  Link::Out out;
  return link.take_out(out) ? json::parse(out.text) : json();
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
           Case{eye, observation + R"(,"kiosk":"yard"})", 1},
           Case{eye, observation + "}", 0},
       })
    EXPECT_EQ(find_door(doors, one.kind == eye ? hear_camera(one.text) : hear_visitor(one.text)),
              one.door)
        << one.text;
}

TEST_F(ReceptionTest, NothingThatWasSaidIsLost) {
  auto link = visit({R"({"type":"hello","exhibit":"mill"})", "second", "third"});
  auto shown = reception.show_in(5);
  ASSERT_EQ(shown.size(), 1u);
  EXPECT_EQ(shown[0].door, 1u);
  EXPECT_EQ(shown[0].link, link);
  EXPECT_TRUE(shown[0].seat);
  const auto heard = link->take_heard();
  ASSERT_EQ(heard.size(), 3u);
  EXPECT_EQ(heard[0].text, R"({"type":"hello","exhibit":"mill"})");
  EXPECT_TRUE(reception.show_in(0).empty());
}

TEST_F(ReceptionTest, WhoSaysNoHelloTakesNoSeatAndMayAskAgain) {
  auto quiet = visit({}), rash = visit({R"({"type":"input","seq":1})", "nonsense"});
  auto lost = visit({R"({"type":"hello","exhibit":"tower"})"});
  EXPECT_TRUE(reception.show_in(0).empty());
  EXPECT_EQ(capacity->standing().seats, 0);
  EXPECT_TRUE(told(*quiet).is_null());
  EXPECT_EQ(told(*rash)["code"], "hello_first");
  EXPECT_EQ(told(*rash)["code"], "bad_json");
  EXPECT_EQ(told(*lost)["code"], "unknown_exhibit");
  lost->push_text_in(hello);
  quiet->push_text_in(R"({"type":"hello","exhibit":"mill"})");
  auto shown = reception.show_in(0);
  ASSERT_EQ(shown.size(), 2u);
  EXPECT_EQ(shown[0].door + shown[1].door, 1u);
}

TEST_F(ReceptionTest, TooManyStrangersAreToldToComeBackAndTheGoneAreForgotten) {
  std::vector<std::shared_ptr<Link>> links;
  for (int i = 0; i < 4; i++) links.push_back(visit({}));
  EXPECT_EQ(told(*links[3])["code"], "full");
  std::string why;
  EXPECT_TRUE(links[3]->close_requested(why));
  EXPECT_EQ(reception.standing().turned_away, 1u);
  for (auto& link : links) link->mark_closed();
  EXPECT_TRUE(reception.show_in(0).empty());
  visit({hello});
  EXPECT_EQ(reception.show_in(0).size(), 1u);
}

TEST_F(ReceptionTest, WhereThereIsNoSeatVisitorsWaitAndComeInByTurn) {
  fill();
  auto first = visit({hello}), second = visit({hello});
  EXPECT_EQ(let_in(), 0u);
  EXPECT_EQ(told(*first), json({{"type", "waiting"}, {"place", 1}, {"of", 2}}));
  EXPECT_EQ(told(*second)["place"], 2);
  auto third = visit({hello});
  EXPECT_EQ(let_in(), 0u);
  EXPECT_EQ(told(*third)["code"], "full") << "as many as may wait";
  inside.pop_back();
  EXPECT_TRUE(comes_in(first));
  EXPECT_EQ(first->first_heard()->text, hello);
  // Nobody overtakes.
  auto late = visit({hello});
  inside.pop_back();
  EXPECT_TRUE(comes_in(second));
  EXPECT_FALSE(std::ranges::any_of(inside, [&](auto& one) { return one.link == late; }));
}

TEST_F(ReceptionTest, KiosksAndCamerasDoNotWait) {
  fill();
  const std::string page = R"({"type":"hello","role":"kiosk","kiosk":"yard"})";
  auto kiosk = come(LinkKind::visit, {page}, true);
  auto eye = come(LinkKind::eye, {"whatever"});
  EXPECT_EQ(let_in(), 2u);
  EXPECT_EQ(capacity->standing().seats, seats + 1);
  auto pretends = visit({page});
  EXPECT_EQ(let_in(), 0u);
  EXPECT_EQ(told(*pretends)["code"], "not_trusted");
  EXPECT_EQ(capacity->standing().seats, seats + 1) << "only who is believed to be one has a seat";
}

TEST_F(ReceptionTest, LargePicturesOfOneAddressKeepNobodyElseOut) {
  auto small = std::make_shared<Capacity>(CapacitySettings{.cores = 2, .memory = 1e12});
  Reception door(doors, small);
  const auto come_from = [&](const char* address, int width, int height) {
    auto link = std::make_shared<Link>(++numbers, LinkKind::visit, "test");
    link->address = address;
    link->push_text_in(json{{"type", "hello"}, {"width", width}, {"height", height}}.dump());
    door.enter(link);
    for (auto& one : door.show_in(0)) inside.push_back(std::move(one));
    return !inside.empty() && inside.back().link == link;
  };
  EXPECT_TRUE(come_from("a", 1920, 1200));
  EXPECT_FALSE(come_from("a", 1920, 1200)) << "there are no cores for two";
  EXPECT_TRUE(come_from("b", 640, 360));
}

TEST_F(ReceptionTest, WhoRestsComesBackAsSoonAsSomebodyIsThere) {
  const std::string goes_on = R"({"type":"hello","exhibit":"mill","resume":"abc"})";
  for (const char* back :
       {R"({"type":"presence","here":true})", R"({"type":"input","seq":1,"look":[1,0]})"}) {
    auto link = std::make_shared<Link>(++numbers, LinkKind::visit, "test");
    link->push_text_in(goes_on);
    reception.rest(link);
    for (const char* nobody : {R"({"type":"presence","here":false})", R"({"type":"settings"})",
                               R"({"type":"ack","frame":1})"})
      link->push_text_in(nobody);
    EXPECT_TRUE(reception.show_in(0.1).empty());
    EXPECT_EQ(reception.standing().resting, 1u);
    link->push_text_in(back);
    auto shown = reception.show_in(5);
    ASSERT_EQ(shown.size(), 1u) << back;
    EXPECT_EQ(shown[0].door, 1u);
    EXPECT_EQ(link->first_heard()->text, goes_on);
    EXPECT_EQ(reception.standing().resting, 0u);
  }
}

TEST_F(ReceptionTest, WhoComesBackWaitsWhereThereIsNoSeat) {
  fill();
  auto link = std::make_shared<Link>(++numbers, LinkKind::visit, "test");
  link->push_text_in(hello);
  reception.rest(link);
  link->push_text_in(R"({"type":"presence","here":true})");
  EXPECT_TRUE(reception.show_in(0.2).empty());
  EXPECT_EQ(told(*link)["type"], "waiting");
  EXPECT_EQ(reception.standing().waiting, 1u);
}

TEST_F(ReceptionTest, WhoRestsForLongestMakesRoom) {
  std::vector<std::shared_ptr<Link>> links;
  for (int i = 0; i < 3; i++) {
    links.push_back(std::make_shared<Link>(++numbers, LinkKind::visit, "test"));
    links.back()->push_text_in(hello);
    reception.rest(links.back());
  }
  EXPECT_EQ(told(*links[0])["code"], "full");
  EXPECT_TRUE(told(*links[2]).is_null());
  EXPECT_EQ(reception.standing().resting, 2u);
}

}  // namespace
}  // namespace wellspring::test
