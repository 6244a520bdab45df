// SPDX-License-Identifier: Apache-2.0
// Who is let in and how much one address may have: rules without sockets.
#include <gtest/gtest.h>

#include "base/layers.h"
#include "stream/address.h"
#include "stream/admission.h"
#include "stream/frame_counter.h"
#include "unit/stream/raw_client.h"

namespace wellspring::test {
namespace {

static Address at(const char* text) { return read_address(text).value(); }

TEST(Address, is_read_with_and_without_a_port) {
  EXPECT_EQ(to_string(at("192.0.2.7")), "192.0.2.7");
  EXPECT_EQ(at("192.0.2.7:8080"), at("192.0.2.7"));
  EXPECT_EQ(at("::ffff:192.0.2.7"), at("192.0.2.7"));
  EXPECT_EQ(to_string(at("[2001:db8::1]:80")), "2001:db8::1");
  EXPECT_EQ(at("fe80::1%eth0"), at("[fe80::1]"));
  for (const char* bad : {"", "museum", "192.0.2", "192.0.2.256", "1.2.3.4:", "1.2.3.4:x",
                          "[1.2.3.4]", "[::1", "[::1]x", "::1]", "unknown", "1.2.3.4, 5.6.7.8"})
    EXPECT_FALSE(read_address(bad)) << bad;
}

TEST(Address, is_nobodys_own_in_the_log) {
  EXPECT_EQ(shortened(at("192.0.2.77")), "192.0.2.0/24");
  EXPECT_EQ(shortened(at("2001:db8:1:2::7")), "2001:db8:1::/48");
}

TEST(Address, networks_hold_what_their_prefix_says) {
  EXPECT_TRUE(read_network("10.0.0.0/8").holds(at("10.255.0.1")));
  EXPECT_FALSE(read_network("10.0.0.0/8").holds(at("11.0.0.1")));
  EXPECT_TRUE(read_network("10.1.2.128/25").holds(at("10.1.2.200")));
  EXPECT_FALSE(read_network("10.1.2.128/25").holds(at("10.1.2.127")));
  EXPECT_FALSE(read_network("192.0.2.7").holds(at("192.0.2.8")));
  EXPECT_TRUE(read_network("0.0.0.0/0").holds(at("8.8.8.8")));
  EXPECT_FALSE(read_network("0.0.0.0/0").holds(at("2001:db8::1")));
  EXPECT_TRUE(read_network("2001:db8::/32").holds(at("2001:db8:1::1")));
  for (const char* bad :
       {"10.0.0.0/33", "10.0.0.0/", "10.0.0.0/-1", "10.0.0.0/8x", "::/129", "a/8"})
    EXPECT_THROW(read_network(bad), std::runtime_error) << bad;
}

TEST(Address, behind_proxies_the_last_hop_that_is_none_counts) {
  const std::vector<Network> proxies{read_network("10.0.0.1"), read_network("10.0.0.2")};
  const auto client = [&](const char* peer, const char* forwarded) {
    const auto found = find_client(at(peer), forwarded, proxies);
    return found ? to_string(*found) : "bad";
  };
  EXPECT_EQ(client("203.0.113.9", ""), "203.0.113.9");
  EXPECT_EQ(client("203.0.113.9", "127.0.0.1"), "203.0.113.9");  // no proxy of ours says so
  EXPECT_EQ(client("10.0.0.1", ""), "10.0.0.1");
  EXPECT_EQ(client("10.0.0.1", "203.0.113.9"), "203.0.113.9");
  EXPECT_EQ(client("10.0.0.1", "127.0.0.1, 203.0.113.9"), "203.0.113.9");
  EXPECT_EQ(client("10.0.0.1", "127.0.0.1, 203.0.113.9 ,10.0.0.2"), "203.0.113.9");
  EXPECT_EQ(client("10.0.0.1", "[2001:db8::1]:4711"), "2001:db8::1");
  EXPECT_EQ(client("10.0.0.1", "10.0.0.2, 10.0.0.1"), "10.0.0.2");
  for (const char* bad : {"unknown", "203.0.113.9,", "203.0.113.9, x", ","})
    EXPECT_EQ(client("10.0.0.1", bad), "bad") << bad;
}

TEST(Frames, are_counted_whatever_they_are_and_however_they_come) {
  std::string bytes;
  for (int i = 0; i < 1000; i++) bytes += RawClient::frame_bytes(0x00, "");
  bytes += RawClient::frame_bytes(0x81, std::string(125, 'x')) +
           RawClient::frame_bytes(0x81, std::string(126, 'x')) + RawClient::frame_bytes(0x89, "") +
           RawClient::frame_bytes(0x82, std::string(70000, 'x')) +
           RawClient::frame_bytes(0x8a, "p", false);
  const auto* begin = reinterpret_cast<const uint8_t*>(bytes.data());
  FrameCounter whole;
  EXPECT_EQ(whole.count({begin, bytes.size()}), 1005u);
  for (const size_t step : {1, 2, 3, 7, 1000}) {
    FrameCounter parts;
    size_t frames = 0;
    for (size_t i = 0; i < bytes.size(); i += step)
      frames += parts.count({begin + i, std::min(step, bytes.size() - i)});
    EXPECT_EQ(frames, 1005u) << step;
  }
}

using Answer = Admission::Answer;
using Taken = Admission::Taken;

TEST(Admission, strangers_leave_the_reserve_to_those_who_are_trusted) {
  Admission admission({.connections = 8, .reserve = 2, .connections_an_address = 100});
  for (uint64_t id = 1; id <= 6; id++) {
    EXPECT_EQ(admission.enter(id, at("203.0.113.1"), Standing::stranger, 0).answer,
              Answer::welcome);
    admission.end_waiting(id);
  }
  EXPECT_EQ(admission.enter(7, at("203.0.113.2"), Standing::stranger, 0).answer, Answer::full);
  const auto first = admission.enter(8, at("127.0.0.1"), Standing::trusted, 0);
  EXPECT_EQ(first.answer, Answer::welcome);
  EXPECT_TRUE(first.reserved);
  EXPECT_EQ(admission.enter(9, at("127.0.0.1"), Standing::trusted, 0).answer, Answer::welcome);
  EXPECT_EQ(admission.enter(10, at("127.0.0.1"), Standing::trusted, 0).answer, Answer::full);
  admission.leave(1);
  admission.leave(8);
  EXPECT_EQ(admission.enter(11, at("203.0.113.2"), Standing::stranger, 0).answer, Answer::full);
  admission.leave(2);
  EXPECT_EQ(admission.enter(12, at("203.0.113.2"), Standing::stranger, 0).answer, Answer::welcome);
}

TEST(Admission, who_has_waited_longest_makes_place) {
  Admission admission({.connections = 4, .reserve = 1, .connections_an_address = 100});
  for (uint64_t id = 1; id <= 3; id++)
    EXPECT_FALSE(admission.enter(id, at("203.0.113.1"), Standing::stranger, 0).drop);
  admission.end_waiting(1);  // its request is whole
  admission.end_waiting(2);
  admission.begin_waiting(2);  // for its next one, after the third
  EXPECT_EQ(admission.enter(4, at("203.0.113.2"), Standing::stranger, 0).drop, 3u);
  admission.leave(3);
  EXPECT_EQ(admission.enter(5, at("203.0.113.2"), Standing::stranger, 0).drop, 2u);
  admission.leave(2);
  admission.end_waiting(4);
  admission.end_waiting(5);
  EXPECT_EQ(admission.enter(6, at("203.0.113.2"), Standing::stranger, 0).answer, Answer::full);
  EXPECT_EQ(admission.connections(), 3u);
}

TEST(Admission, an_address_makes_place_for_its_own) {
  Admission admission({.connections_an_address = 2, .new_connections_at_once = 100});
  EXPECT_FALSE(admission.enter(1, at("203.0.113.9"), Standing::stranger, 0).drop);
  for (uint64_t id = 2; id <= 3; id++)
    EXPECT_FALSE(admission.enter(id, at("2001:db8::1"), Standing::stranger, 0).drop);
  EXPECT_EQ(admission.enter(4, at("2001:db8::2"), Standing::stranger, 0).drop, 2u);  // the same /64
  admission.leave(2);
  admission.end_waiting(3);
  admission.end_waiting(4);
  EXPECT_EQ(admission.enter(5, at("2001:db8::3"), Standing::stranger, 0).answer, Answer::too_many);
  EXPECT_EQ(admission.enter(6, at("2001:db8:0:1::1"), Standing::stranger, 0).answer,
            Answer::welcome);
  for (uint64_t id = 10; id < 20; id++) {
    EXPECT_EQ(admission.enter(id, at("127.0.0.1"), Standing::trusted, 0).answer, Answer::welcome);
    EXPECT_EQ(admission.enter(id + 10, at("10.0.0.1"), Standing::proxy, 0).answer, Answer::welcome);
  }
}

TEST(Admission, rates_of_an_address_recover_with_time) {
  Admission admission({.new_connections_a_second = 2,
                       .new_connections_at_once = 3,
                       .websockets_an_address = 2,
                       .requests_a_second = 10,
                       .requests_at_once = 20,
                       .frames_a_second = 5,
                       .frames_at_once = 10});
  const Address one = at("203.0.113.1"), other = at("203.0.113.2");
  for (uint64_t id = 1; id <= 3; id++)
    EXPECT_EQ(admission.enter(id, one, Standing::stranger, 0).answer, Answer::welcome);
  EXPECT_EQ(admission.enter(4, one, Standing::stranger, 0).answer, Answer::too_many);
  EXPECT_EQ(admission.enter(5, other, Standing::stranger, 0).answer, Answer::welcome);
  EXPECT_EQ(admission.enter(6, one, Standing::stranger, 0.6).answer, Answer::welcome);
  for (int i = 0; i < 20; i++) EXPECT_EQ(admission.take_request(one, 0), Taken::yes);
  EXPECT_EQ(admission.take_request(one, 0.05), Taken::too_many);
  EXPECT_EQ(admission.take_request(other, 0.05), Taken::yes);
  EXPECT_EQ(admission.take_request(one, 0.2), Taken::yes);
  EXPECT_EQ(admission.take_input(one, {10, 0}, true, 0), Taken::yes);
  EXPECT_EQ(admission.take_input(one, {1, 0}, true, 0), Taken::too_many);
  EXPECT_EQ(admission.take_input(one, {5, 0}, true, 1), Taken::yes);
  EXPECT_EQ(admission.open_websocket(one, 1), Taken::yes);
  EXPECT_EQ(admission.open_websocket(one, 1), Taken::yes);
  EXPECT_EQ(admission.open_websocket(one, 1), Taken::too_many);
  EXPECT_EQ(admission.open_websocket(other, 1), Taken::yes);
  admission.close_websocket(one);
  EXPECT_EQ(admission.open_websocket(one, 1), Taken::yes);
}

TEST(Admission, many_addresses_together_are_bounded_too) {
  Admission admission({.all_requests_a_second = 10,
                       .all_requests_at_once = 20,
                       .all_frames_a_second = 100,
                       .all_frames_at_once = 200});
  const Address loud = at("203.0.113.1"), modest = at("203.0.113.2");
  for (int i = 0; i < 20; i++) {
    const Address one = at(("198.51.100." + std::to_string(i)).c_str());
    EXPECT_EQ(admission.take_request(one, 0), Taken::yes);
  }
  EXPECT_EQ(admission.take_request(modest, 0), Taken::too_many_in_all);
  EXPECT_EQ(admission.take_request(modest, 0.2), Taken::yes);
  EXPECT_EQ(admission.take_input(loud, {200, 0}, false, 0), Taken::yes);
  EXPECT_EQ(admission.take_input(loud, {1, 0}, false, 0), Taken::too_many_in_all);
  EXPECT_EQ(admission.take_input(modest, {1, 0}, true, 0), Taken::yes)
      << "says no more than a page";
  EXPECT_EQ(admission.open_websocket(modest, 0), Taken::too_many_in_all);
  EXPECT_EQ(admission.open_websocket(modest, 0.5), Taken::yes);
  EXPECT_EQ(admission.take_input(loud, {40, 0}, false, 0.5), Taken::yes);
}

// The numbers of connections, files and messages are those that Limits promises.
TEST(Admission, a_school_class_behind_one_address_gets_in) {
  Admission admission({});
  const Address school = at("198.51.100.1");
  uint64_t id = 0;
  for (int pupil = 0; pupil < 40; pupil++) {
    for (int i = 0; i < 7; i++) {
      const auto entry = admission.enter(++id, school, Standing::stranger, 0);
      EXPECT_EQ(entry.answer, Answer::welcome);
      EXPECT_FALSE(entry.drop);
    }
    for (int file = 0; file < 30; file++) EXPECT_EQ(admission.take_request(school, 0), Taken::yes);
    EXPECT_EQ(admission.open_websocket(school, 0), Taken::yes);
  }
  for (int second = 1; second < 60; second++)
    EXPECT_EQ(admission.take_input(school, {40 * 120, 40 * 120 * 300}, true, second), Taken::yes);
}

TEST(Admission, what_is_said_is_bounded_in_bytes_by_address_and_in_all) {
  Admission admission({.bytes_a_second = 100,
                       .bytes_at_once = 1000,
                       .all_bytes_a_second = 150,
                       .all_bytes_at_once = 1500});
  const Address loud = at("203.0.113.1"), other = at("203.0.113.2"), third = at("203.0.113.3");
  EXPECT_EQ(admission.take_input(loud, {1, 1000}, false, 0), Taken::yes);
  EXPECT_EQ(admission.take_input(loud, {1, 1}, true, 0), Taken::too_many);
  EXPECT_EQ(admission.take_input(other, {1, 500}, false, 0), Taken::yes);
  EXPECT_EQ(admission.take_input(third, {1, 1}, false, 0), Taken::too_many_in_all);
  EXPECT_EQ(admission.take_input(third, {1, 1}, true, 0), Taken::yes) << "says no more than a page";
  EXPECT_EQ(admission.take_input(loud, {1, 100}, false, 1), Taken::yes);
}

TEST(Admission, addresses_that_left_are_forgotten) {
  Admission admission({});
  admission.enter(1, at("203.0.113.1"), Standing::stranger, 0);
  for (int i = 0; i < 40000; i++) {
    Address guest = at("2001:db8::");
    guest.bytes[6] = uint8_t(i >> 8);
    guest.bytes[7] = uint8_t(i);
    guest.bytes[5] = 1;
    admission.take_request(guest, i);
  }
  EXPECT_LT(admission.addresses(), 20000u);
  admission.leave(1);
  EXPECT_EQ(admission.connections(), 0u);
}

}  // namespace
}  // namespace wellspring::test
