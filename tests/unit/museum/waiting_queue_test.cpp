// SPDX-License-Identifier: Apache-2.0
#include "museum/waiting_queue.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace wellspring {
namespace {

using nlohmann::json;

struct WaitingQueueTest : testing::Test {
  WaitingQueue queue{4};
  std::vector<std::shared_ptr<Link>> links;
  std::shared_ptr<Capacity> capacity = std::make_shared<Capacity>(CapacitySettings{.cores = 64});
  int seats = 0;  // that are free

  std::shared_ptr<Link> come(size_t door = 0) {
    links.push_back(std::make_shared<Link>(links.size() + 1, LinkKind::visit, "test"));
    queue.join({links.back(), hear_visitor(R"({"type":"hello"})"), door, 1e5, {}});
    return links.back();
  }
  std::vector<uint64_t> let_in(double now) {
    std::vector<uint64_t> in;
    for (Newcomer& who : queue.let_in(now, [&](const Newcomer& one) {
           return seats-- > 0 ? capacity->give_seat(one.pixels) : nullptr;
         }))
      in.push_back(who.link->id);
    return in;
  }
  json told(Link& link) {
    Link::Out out;
    return link.take_out(out) ? json::parse(out.text) : json();
  }
};

TEST_F(WaitingQueueTest, WhoCameFirstComesInFirst) {
  for (int i = 0; i < 3; i++) come();
  EXPECT_TRUE(let_in(0).empty());
  seats = 2;
  EXPECT_EQ(let_in(1), (std::vector<uint64_t>{1, 2}));
  EXPECT_EQ(queue.size(), 1u);
}

TEST_F(WaitingQueueTest, TheQueueHasAnEnd) {
  for (int i = 0; i < 4; i++) {
    EXPECT_FALSE(queue.full());
    come(size_t(i % 2));
  }
  EXPECT_TRUE(queue.full());
}

TEST_F(WaitingQueueTest, EachIsToldTheirPlaceAndWhenItChanges) {
  for (int i = 0; i < 3; i++) come();
  queue.tell_places(0);
  EXPECT_EQ(told(*links[1]), json({{"type", "waiting"}, {"place", 2}, {"of", 3}}));
  queue.tell_places(1);
  EXPECT_TRUE(told(*links[1]).is_null()) << "nothing has changed";
  links[0]->mark_closed();
  let_in(1.5);
  queue.tell_places(1.5);
  EXPECT_TRUE(told(*links[1]).is_null()) << "not more often than every two seconds";
  queue.tell_places(2);
  EXPECT_EQ(told(*links[1]), json({{"type", "waiting"}, {"place", 1}, {"of", 2}}));
  queue.tell_places(5.9);
  EXPECT_TRUE(told(*links[1]).is_null());
  queue.tell_places(6);
  EXPECT_EQ(told(*links[1])["place"], 1) << "so that the page knows that the line is good";
}

TEST_F(WaitingQueueTest, TheTimeIsThatOfTheTurnsBefore) {
  for (int i = 0; i < 4; i++) come();
  seats = 1, let_in(10);
  queue.tell_places(10);
  EXPECT_FALSE(told(*links[3]).contains("seconds")) << "one turn tells nothing yet";
  seats = 1, let_in(30);
  queue.tell_places(50);  // two turns in 40 s
  EXPECT_EQ(told(*links[3])["seconds"], 40);
  queue.tell_places(700);
  told(*links[3]);
  let_in(700);
  queue.tell_places(710);
  EXPECT_FALSE(told(*links[3]).contains("seconds")) << "that was too long ago to tell anything";
}

TEST_F(WaitingQueueTest, WhoLeavesOrIsGoneIsForgottenAndAnotherHelloCounts) {
  auto gone = come(), leaving = come(), resized = come();
  gone->mark_closed();
  leaving->push_text_in(R"({"type":"bye"})");
  resized->push_text_in("nonsense");
  resized->push_text_in(R"({"type":"input","seq":1,"move":[0,0,1]})");
  resized->push_text_in(R"({"type":"hello","width":64,"height":32})");
  seats = 3;
  auto in = queue.let_in(0, [&](const Newcomer& one) {
    EXPECT_EQ(one.pixels, 64 * 32);
    return capacity->give_seat(one.pixels);
  });
  ASSERT_EQ(in.size(), 1u);
  EXPECT_EQ(in[0].link, resized);
  EXPECT_EQ(said_as<Hello>(in[0].hello)->width, 64);
  std::string why;
  EXPECT_TRUE(leaving->close_requested(why));
}

}  // namespace
}  // namespace wellspring
