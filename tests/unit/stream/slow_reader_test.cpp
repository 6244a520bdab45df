// SPDX-License-Identifier: Apache-2.0
// Readers that do not read: they see newer pictures, cost no memory that grows, disturb nobody, and
// are cut.
#include <fstream>

#include "judge/ws_client.h"
#include "unit/stream/fixture.h"

namespace wellspring::test {
namespace {

static long resident_kib() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmRSS:")) return std::stol(line.substr(6));
  return 0;
}

TEST(SlowReader, is_cut_although_it_pings_while_others_see_on) {
  auto settings = quick_settings();
  settings.write_timeout = 1;
  House house(settings);
  RawClient slow(house.port(), 4096);
  ASSERT_EQ(slow.join().status, 101);
  auto slow_link = house.link(0);
  WsClient good;
  good.connect({.port = house.port()});
  good.send_text("first");
  auto good_link = house.link(1);
  ASSERT_TRUE(slow_link && good_link);

  const auto big =
      picture_packet(1, 400'000);  // one allocation, so that memory seen to grow is the server's
  const auto small = picture_packet(2);
  const long before = resident_kib();
  long most = 0;
  uint32_t sent = 0;
  int seen = 0;
  const auto start = std::chrono::steady_clock::now();
  WsMessage message;
  const auto passed = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  while (!slow_link->closed() && passed() < patience) {
    slow_link->send_picture(big);
    good_link->send_picture(small);
    sent++;
    seen += good.receive(message, patience) == WsClient::Got::message;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    if (sent % 10 == 0) slow.send(RawClient::frame_bytes(0x89, "still here"));
    most = std::max(most, resident_kib());
  }
  const double seconds = passed();
  EXPECT_TRUE(slow_link->closed());
  EXPECT_GE(seconds, 0.9);  // not before its time
  EXPECT_EQ(house.server.counters().slow_closed, 1u);
  EXPECT_LT(slow_link->pictures_sent, 10u);
  EXPECT_FALSE(good_link->closed());
  EXPECT_EQ(seen, int(sent));
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  EXPECT_LT(most - before, 4096) << "KiB";
#endif
  good_link->send_text("and on");
  do ASSERT_EQ(good.receive(message, patience), WsClient::Got::message);
  while (message.binary);
  EXPECT_EQ(message.text(), "and on");
  EXPECT_TRUE(eventually([&] { return house.server.counters().open == 1; }));
}

TEST(SlowReader, that_is_sent_nothing_stays) {
  auto settings = quick_settings();
  settings.write_timeout = 0.2;
  House house(settings);
  RawClient quiet(house.port());
  quiet.join();
  auto link = house.link();
  ASSERT_TRUE(link);
  link->send_picture(picture_packet(1));
  EXPECT_TRUE(eventually([&] { return link->pictures_sent == 1; }));
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  EXPECT_FALSE(link->closed());
  link->send_picture(picture_packet(2));
  EXPECT_EQ(picture_number(quiet.next_frame()->payload), 1u);
  EXPECT_EQ(picture_number(quiet.next_frame()->payload), 2u);
}

TEST(SlowReader, gets_the_newest_picture_when_it_reads_again) {
  House house;
  RawClient client(house.port(), 4096);
  client.join();
  auto link = house.link();
  ASSERT_TRUE(link);
  constexpr uint32_t count = 100;
  for (uint32_t i = 1; i <= count; i++) {
    link->send_picture(picture_packet(i, 100'000));
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  link->send_text("text overtakes");
  std::vector<uint32_t> seen;
  bool text_seen = false, text_before_last = false;
  while (seen.empty() || seen.back() != count) {
    const auto frame = client.next_frame();
    ASSERT_TRUE(frame);
    if (frame->opcode == 1) text_seen = true;
    if (frame->opcode != 2) continue;
    const uint32_t number = picture_number(frame->payload);
    if (number == count) text_before_last = text_seen;
    if (!seen.empty()) {
      ASSERT_GT(number, seen.back());
    }
    seen.push_back(number);
  }
  // The pictures are those that the kernel held, the one being written, and the newest.
  EXPECT_LE(seen.size(), 8u);
  EXPECT_TRUE(text_before_last);
  EXPECT_EQ(seen.size() + link->pictures_dropped(), count);
}

TEST(SlowReader, does_not_hold_up_the_stop) {
  auto settings = quick_settings();
  settings.write_timeout = 60;
  House house(settings);
  RawClient stuck(house.port(), 4096);
  stuck.join();
  auto link = house.link();
  ASSERT_TRUE(link);
  for (int i = 0; i < 3; i++) {
    link->send_picture(picture_packet(1, 2'000'000));
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  house.server.stop();
  EXPECT_TRUE(link->closed());
  EXPECT_EQ(house.server.counters().open, 0u);
}

TEST(SlowReader, sixty_four_texts_behind_is_closed) {
  auto settings = quick_settings();
  settings.write_timeout = 0.5;
  House house(settings);
  RawClient stuck(house.port(), 4096);
  stuck.join();
  auto link = house.link();
  ASSERT_TRUE(link);
  for (size_t i = 0; i < 2 * Link::max_texts_out; i++) {
    link->send_text(std::string(50'000, 't'));
    if (i < 4) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  std::string reason;
  EXPECT_TRUE(link->close_requested(reason));
  EXPECT_TRUE(eventually([&] { return link->closed(); }));
}

}  // namespace
}  // namespace wellspring::test
