// SPDX-License-Identifier: Apache-2.0
// A day in the museum on an accelerated clock, and two visitors at once.
#include <gtest/gtest.h>

#include <cmath>

#include "frame/jpeg.h"
#include "show/state/make_show.h"
#include "show/state/show.h"
#include "show/tick.h"
#include "tiny_exhibit.h"
#include "wire/packet.h"

namespace wellspring {
namespace {

struct House {
  std::unique_ptr<Show> show;
  Arrivals arrivals;
  std::vector<std::shared_ptr<Link>> links;
  std::vector<size_t> pictures;
  Packet last;
  double now = 0;
  explicit House(int visitors) : pictures(size_t(visitors), 0) {
    ShowSettings settings;
    settings.fps = 50;
    settings.background = false;
    settings.technique = settings.still_technique = "direct";
    show = make_show(make_tiny_exhibit(), settings);
    for (int i = 0; i < visitors; i++) {
      links.push_back(std::make_shared<Link>(uint64_t(i + 1), LinkKind::visit, "test"));
      arrivals.put(links.back());
      say(i,
          R"({"type":"hello","exhibit":"","width":48,"height":32,"lang":"en","role":"visitor"})");
    }
  }
  void say(int visitor, const std::string& text) { links[size_t(visitor)]->push_text_in(text); }
  void step(double seconds) {
    tick(*show, arrivals, now += seconds);
    for (Visitor& visitor : show->visitors) visitor.shown.encoder->task.wait();
    for (size_t i = 0; i < links.size(); i++) {
      Link::Out out;
      while (links[i]->take_out(out))
        if (out.binary) pictures[i]++, last = *out.packet;
    }
  }
};

TEST(LongShow, ADayOfIdlingAndWalkingNeitherGrowsNorDrifts) {
  House house(1);
  size_t memory = 0;
  constexpr double step = 120, day = 24 * 3600;
  int seq = 0;
  for (int i = 0; i * step < day; i++) {
    // Most of an hour of rest, a quarter of walking and looking round, a jump.
    int phase = i % 31;
    if (phase == 20 || phase == 25)
      house.say(0, R"({"type":"input","seq":)" + std::to_string(++seq) +
                       R"(,"move":[0.3,0,1],"look":[0.7,0.05]})");
    if (phase == 29)
      house.say(0, R"({"type":"input","seq":)" + std::to_string(++seq) +
                       R"(,"move":[0,0,0],"look":[0,-0.1]})");
    if (phase == 30)
      house.say(0,
                R"({"type":"viewpoint","seq":)" + std::to_string(++seq) + R"(,"name":"corner"})");
    house.step(step);
    house.step(0.02);
    const Visitor& visitor = house.show->visitors.front();
    vec3 place(visitor.place.view.position);
    ASSERT_TRUE(is_finite(place) && std::abs(place.x) < 4 && std::abs(place.z) < 4) << i;
    for (vec3 c : house.show->renderer.work.frame.color) ASSERT_TRUE(is_finite(c)) << i;
    if (i == 62) memory = visitor.picture.cache_bytes;
    if (i > 62) {
      // Lists keep room for the most that they ever held, and how much that is depends on the
      // machine.
      ASSERT_LE(visitor.picture.cache_bytes, memory + memory / 8) << i;
      ASSERT_LE(visitor.picture.memory_bytes, memory + (1 << 19)) << i;
      ASSERT_LE(visitor.place.heading.past.size(), 64u);
      ASSERT_LE(visitor.shown.flow.in_flight.size(), 4096u);
    }
  }
  EXPECT_GT(house.pictures[0], 900u);
  auto packet = read_packet(house.last);
  ASSERT_TRUE(packet);
  EXPECT_EQ(decode_jpeg(packet->payload, "picture").width, 48);
}

TEST(LongShow, TwoVisitorsGetPicturesAndSamplesAlike) {
  House house(2);
  for (int i = 0; i < 100; i++) {
    if (i % 10 == 0)
      for (int v : {0, 1})
        house.say(v, R"({"type":"input","seq":)" + std::to_string(i + 1) +
                         R"(,"move":[0,0,0.2],"look":[0.02,0]})");
    house.step(0.02);
  }
  EXPECT_EQ(house.pictures[0], house.pictures[1]);
  const Visitor &one = house.show->visitors.front(), &other = house.show->visitors.back();
  EXPECT_GT(one.picture.broker.stats().asked, 0u);
  double share = double(one.picture.broker.stats().asked) /
                 double(one.picture.broker.stats().asked + other.picture.broker.stats().asked);
  EXPECT_NEAR(share, 0.5, 0.2);
}

}  // namespace
}  // namespace wellspring
