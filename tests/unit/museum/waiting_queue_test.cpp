// SPDX-License-Identifier: Apache-2.0
#include "museum/reception.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace wellspring::test {
namespace {

using nlohmann::json;

struct WaitingQueueTest : testing::Test {
  static constexpr double pixels = 1e5;
  WaitingQueue queue{6, 1920 * 1200};
  std::vector<std::shared_ptr<Link>> links;
  std::shared_ptr<Capacity> capacity =
      std::make_shared<Capacity>(CapacitySettings{.most = 7, .cores = 64, .memory = 1e12});
  std::vector<std::unique_ptr<Seat>> taken;  // all but those that are free
  std::vector<Newcomer> inside;

  WaitingQueueTest() {
    while (auto seat = capacity->find_seat(pixels)) taken.push_back(std::move(seat));
  }
  void free_seats(size_t count) { taken.resize(taken.size() - count); }
  std::shared_ptr<Link> come(const std::string& address = "", double now = 0,
                             const std::string& hello = R"({"type":"hello"})",
                             double wanted = pixels) {
    links.push_back(std::make_shared<Link>(links.size() + 1, LinkKind::visit, "test"));
    links.back()->address = address;
    queue.join({links.back(), hear_visitor(hello), 0, wanted, {}}, now);
    return links.back();
  }
  // The numbers of those who come in, and stay.
  std::vector<uint64_t> let_in(double now) {
    std::vector<uint64_t> in;
    for (Newcomer& who : queue.let_in(now, *capacity)) {
      in.push_back(who.link->id);
      inside.push_back(std::move(who));
    }
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
  free_seats(2);
  EXPECT_EQ(let_in(1), (std::vector<uint64_t>{1, 2}));
  EXPECT_EQ(queue.size(), 1u);
}

TEST_F(WaitingQueueTest, TurnsGoRoundAmongAddressesAndThenAmongTheirVisits) {
  for (const char* address : {"a", "a", "a", "b", "c"}) come(address);  // 1 to 5
  EXPECT_TRUE(let_in(0).empty());
  queue.tell_places(0);
  for (const auto& [number, place] : {std::pair{1, 1}, {4, 2}, {5, 3}, {2, 4}, {3, 5}})
    EXPECT_EQ(told(*links[size_t(number) - 1])["place"], place) << number;
  free_seats(2);
  EXPECT_EQ(let_in(1), (std::vector<uint64_t>{1, 4}));
  come("b");  // 6, has a seat already
  come("d");  // 7
  free_seats(5);
  EXPECT_EQ(let_in(2), (std::vector<uint64_t>{5, 7, 2, 6, 3}));
}

TEST_F(WaitingQueueTest, WhoWaitsFirstOfItsAddressIsNotPutBackForEver) {
  free_seats(1);
  come("a");
  EXPECT_EQ(let_in(0).size(), 1u);
  for (int i = 0; i < 2; i++) come("a", 1);  // 2 and 3
  const double later = 2 + WaitingQueue::patience;
  come("b", later), come("c", later);  // 4 and 5
  free_seats(4);
  EXPECT_EQ(let_in(later), (std::vector<uint64_t>{2, 4, 5, 3}));
}

TEST_F(WaitingQueueTest, WhoFitsComesInBeforeWhoDoesNotWhoAtLastGetsSmallerPictures) {
  capacity = std::make_shared<Capacity>(CapacitySettings{.cores = 2, .memory = 1e12});
  auto busy = capacity->give_seat(2e6);  // 1.07 of 1.7 cores, and 0.42 more for newcomers
  come("a", 0, R"({"type":"hello","width":1920,"height":1200})", 1920 * 1200);
  come("b", 0, R"({"type":"hello","width":640,"height":360})", 640 * 360);
  EXPECT_EQ(let_in(0), (std::vector<uint64_t>{2}));
  EXPECT_TRUE(let_in(WaitingQueue::patience).empty());
  EXPECT_EQ(let_in(WaitingQueue::patience + 1), (std::vector<uint64_t>{1}));
  const Hello& hello = *said_as<Hello>(inside.back().hello);
  EXPECT_EQ(hello.width, 607);
  EXPECT_EQ(hello.height, 379);
  EXPECT_TRUE(inside.back().seat->resize(607 * 379)) << "it has a seat for that";
}

TEST_F(WaitingQueueTest, TheQueueHasAnEnd) {
  for (int i = 0; i < 6; i++) {
    EXPECT_FALSE(queue.full());
    come();
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
  free_seats(1), let_in(10);
  queue.tell_places(10);
  EXPECT_FALSE(told(*links[3]).contains("seconds")) << "one turn tells nothing yet";
  free_seats(1), let_in(30);
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
  free_seats(3);
  ASSERT_EQ(let_in(0).size(), 1u);
  EXPECT_EQ(inside[0].link, resized);
  EXPECT_EQ(inside[0].size.pixels, 64 * 32);
  EXPECT_EQ(said_as<Hello>(inside[0].hello)->width, 64);
  std::string why;
  EXPECT_TRUE(leaving->close_requested(why));
}

}  // namespace
}  // namespace wellspring::test
