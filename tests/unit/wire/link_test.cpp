// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <thread>

#include "wire/link.h"

using namespace wellspring;

using namespace wellspring::test;

static std::shared_ptr<const Packet> packet(uint8_t value) {
  return std::make_shared<const Packet>(Packet{value});
}

static std::vector<std::string> take_texts(Link& link) {
  std::vector<std::string> texts;
  for (Heard& heard : link.take_heard()) texts.push_back(std::move(heard.text));
  return texts;
}

TEST(Link, texts_arrive_in_order_and_once) {
  Link link(7, LinkKind::eye, "peer");
  EXPECT_EQ(link.id, 7u);
  EXPECT_EQ(link.kind, LinkKind::eye);
  link.push_text_in("a");
  link.push_text_in("b");
  EXPECT_EQ(take_texts(link), (std::vector<std::string>{"a", "b"}));
  EXPECT_TRUE(take_texts(link).empty());
}

TEST(Link, beyond_the_bound_the_oldest_text_is_dropped_and_counted) {
  Link link(1, LinkKind::visit, "");
  for (size_t i = 0; i < Link::max_texts_in + 3; i++) link.push_text_in(std::to_string(i));
  const auto texts = take_texts(link);
  ASSERT_EQ(texts.size(), Link::max_texts_in);
  EXPECT_EQ(texts.front(), "3");
  EXPECT_EQ(link.texts_dropped(), 3u);
}

TEST(Link, unread_texts_are_bounded_in_bytes_too) {
  Link link(1, LinkKind::visit, "");
  for (int i = 0; i < 40; i++) link.push_text_in(std::string(60'000, char('A' + i)));
  const auto texts = take_texts(link);
  ASSERT_EQ(texts.size(), Link::max_bytes_in / 60'000);
  EXPECT_EQ(texts.back()[0], 'A' + 39);
  EXPECT_EQ(link.texts_dropped(), 40 - texts.size());
  link.push_text_in("later");
  EXPECT_EQ(take_texts(link).size(), 1u);
}

TEST(Link, texts_and_sounds_in_order_then_the_newest_picture) {
  Link link(1, LinkKind::visit, "");
  link.send_picture(packet(1));
  link.send_text("first");
  link.send_sound(packet(9));
  link.send_picture(packet(2));
  link.send_text("second");
  EXPECT_TRUE(link.picture_pending());
  EXPECT_EQ(link.pictures_dropped(), 1u);
  Link::Out out;
  ASSERT_TRUE(link.take_out(out));
  EXPECT_FALSE(out.binary);
  EXPECT_EQ(out.text, "first");
  ASSERT_TRUE(link.take_out(out));
  EXPECT_TRUE(out.binary);
  EXPECT_EQ((*out.packet)[0], 9);
  ASSERT_TRUE(link.take_out(out));
  EXPECT_EQ(out.text, "second");
  EXPECT_FALSE(out.binary);
  ASSERT_TRUE(link.take_out(out));
  EXPECT_TRUE(out.binary);
  EXPECT_EQ((*out.packet)[0], 2);
  EXPECT_FALSE(link.picture_pending());
  EXPECT_FALSE(link.take_out(out));
}

TEST(Link, a_reader_128_texts_behind_is_closed) {
  Link link(1, LinkKind::visit, "");
  std::string reason;
  for (size_t i = 0; i < Link::max_texts_out; i++) link.send_text("t");
  EXPECT_FALSE(link.close_requested(reason));
  link.send_text("one too many");
  EXPECT_TRUE(link.close_requested(reason));
  EXPECT_EQ(reason, "too slow");
  size_t kept = 0;
  for (Link::Out out; link.take_out(out);) kept++;
  EXPECT_EQ(kept, Link::max_texts_out);
}

TEST(Link, every_send_and_close_wakes_the_socket_side) {
  Link link(1, LinkKind::visit, "");
  int wakes = 0;
  link.set_wake([&] {
    wakes++;
    Link::Out out;
    link.take_out(out);  // calling back must not deadlock
  });
  link.send_text("t");
  link.send_picture(packet(1));
  link.send_sound(packet(1));
  EXPECT_EQ(wakes, 3);
  link.close("enough");
  EXPECT_EQ(wakes, 4);
  link.close("again");
  EXPECT_EQ(wakes, 4);
  std::string reason;
  EXPECT_TRUE(link.close_requested(reason));
  EXPECT_EQ(reason, "enough");
}

TEST(Link, after_the_socket_is_gone_nothing_is_kept_or_woken) {
  Link link(1, LinkKind::visit, "");
  int wakes = 0;
  link.set_wake([&] { wakes++; });
  link.push_text_in("last words");
  auto picture = packet(1);
  link.send_picture(picture);
  wakes = 0;
  EXPECT_FALSE(link.closed());
  link.mark_closed();
  EXPECT_TRUE(link.closed());
  EXPECT_EQ(picture.use_count(), 1);
  link.send_text("t");
  link.send_picture(packet(2));
  link.send_sound(packet(2));
  EXPECT_EQ(wakes, 0);
  Link::Out out;
  EXPECT_FALSE(link.take_out(out));
  EXPECT_EQ(take_texts(link), std::vector<std::string>{"last words"});
}

TEST(Link, two_threads_lose_no_text_and_see_pictures_only_get_newer) {
  Link link(1, LinkKind::visit, "");
  constexpr int count = 20'000;
  std::thread show([&] {
    for (int i = 1; i <= count; i++)
      link.send_picture(std::make_shared<const Packet>(Packet{uint8_t(i), uint8_t(i >> 8)}));
    link.send_text("end");
  });
  int last = 0, seen = 0;
  bool newer = true, ended = false;
  Link::Out out;
  while (!ended || link.picture_pending()) {
    if (!link.take_out(out)) continue;
    if (!out.binary) {
      ended = true;
      continue;
    }
    const int number = (*out.packet)[0] + 256 * (*out.packet)[1];
    newer = newer && number > last;
    last = number;
    seen++;
  }
  show.join();
  EXPECT_TRUE(newer);
  EXPECT_EQ(last, count);
  EXPECT_EQ(uint64_t(seen) + link.pictures_dropped(), uint64_t(count));
}

TEST(Link, sound_that_is_not_taken_is_dropped_as_a_whole_and_texts_stay) {
  Link link(1, LinkKind::visit, "");
  const auto piece = std::make_shared<const Packet>(Packet(Link::max_sound_out / 4));
  link.send_text("before");
  for (int i = 0; i < 4; i++) EXPECT_TRUE(link.send_sound(piece));
  link.send_text("after");
  EXPECT_FALSE(link.send_sound(piece));
  EXPECT_EQ(link.sounds_dropped(), 5u);
  Link::Out out;
  for (const char* text : {"before", "after"}) {
    ASSERT_TRUE(link.take_out(out));
    EXPECT_EQ(out.text, text);
  }
  EXPECT_FALSE(link.take_out(out));
  for (int i = 0; i < 20; i++) {  // one that is taken makes room again
    EXPECT_TRUE(link.send_sound(piece));
    EXPECT_TRUE(link.take_out(out));
  }
  EXPECT_TRUE(link.send_sound(piece));
  link.drop_sound();
  EXPECT_FALSE(link.take_out(out));
  std::string reason;
  EXPECT_FALSE(link.close_requested(reason));
}
