// SPDX-License-Identifier: Apache-2.0
// What crosses the line arrives with all its bits; whatever else comes is refused.
#include "workers/message.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "unit/workers/messages.h"

namespace wellspring::test {
namespace {

const MessageKey none;

TEST(WorkerMessage, KeepsAnOrder) {
  const TraceOrder order = make_order();
  TraceOrder read;
  ASSERT_TRUE(read_message(write_message(order, none), none, read));
  EXPECT_EQ(read.server, order.server);
  EXPECT_EQ(read.number, order.number);
  EXPECT_EQ(read.worth_ms, order.worth_ms);
  EXPECT_EQ(read.exhibit, order.exhibit);
  EXPECT_EQ(read.same, order.same);
  EXPECT_EQ(read.exact, order.exact);
  EXPECT_EQ(read.technique, order.technique);
  EXPECT_EQ(read.plain, order.plain);
  EXPECT_EQ(read.transport.max_depth, 6);
  EXPECT_EQ(read.transport.clamp, 4);
  EXPECT_TRUE(read.transport.sees_volumes);
  EXPECT_EQ(read.state, order.state);
  ASSERT_EQ(read.requests.size(), order.requests.size());
  for (size_t i = 0; i < read.requests.size(); i++) {
    const Request &a = read.requests[i], &b = order.requests[i];
    EXPECT_EQ(a.ray.origin, b.ray.origin);
    EXPECT_EQ(a.ray.direction, b.ray.direction);
    EXPECT_EQ(a.ray.t_min, b.ray.t_min);
    EXPECT_EQ(a.ray.t_max, b.ray.t_max);
    EXPECT_EQ(a.ray.from_eye, b.ray.from_eye);
    EXPECT_EQ(a.ray.width, b.ray.width);
    EXPECT_EQ(a.ray.spread, b.ray.spread);
    EXPECT_EQ(a.seed, b.seed);
    EXPECT_EQ(a.index, b.index);
  }
}

TEST(WorkerMessage, KeepsAllBitsOfSamples) {
  const TraceAnswer answer = make_answer();
  TraceAnswer read;
  ASSERT_TRUE(read_message(write_message(answer, none), none, read));
  EXPECT_EQ(read.worker, "north-2");
  EXPECT_EQ(read.waited, answer.waited);
  EXPECT_EQ(read.traced, answer.traced);
  ASSERT_EQ(read.samples.size(), answer.samples.size());
  for (size_t i = 0; i < read.samples.size(); i++) {
    const Sample &a = read.samples[i], &b = answer.samples[i];
    EXPECT_EQ(a.position, b.position);
    EXPECT_EQ(a.normal, b.normal);
    EXPECT_EQ(a.distance, b.distance);
    EXPECT_EQ(a.object, b.object);
    EXPECT_EQ(a.instance, b.instance);
    EXPECT_EQ(a.triangle, b.triangle);
    EXPECT_EQ(a.barycentric, b.barycentric);
    EXPECT_EQ(a.albedo, b.albedo);
    EXPECT_EQ(a.smooth, b.smooth);
    EXPECT_EQ(a.rest, b.rest);
    EXPECT_EQ(a.glow, b.glow);
    EXPECT_EQ(a.known, b.known);
    EXPECT_EQ(a.raised, b.raised);
    EXPECT_EQ(a.flags, b.flags);
  }
}

TEST(WorkerMessage, KeepsRefusalsAndCalls) {
  TraceAnswer read;
  ASSERT_TRUE(read_message(write_message(TraceAnswer{1, 2, "a", Refusal::light, 0, 0, {}}, none),
                           none, read));
  EXPECT_STREQ(to_word(read.refusal), "light");
  RollCall call;
  ASSERT_TRUE(read_message(write_message(RollCall{3, 4}, none), none, call));
  EXPECT_EQ(call.number, 4u);
  CallAnswer here;
  ASSERT_TRUE(
      read_message(write_message(CallAnswer{3, 4, "a", "0.1.0", "avx2", 8}, none), none, here));
  EXPECT_EQ(here.cores, 8u);
}

TEST(CrewTotals, TellOtherLightFromOtherBits) {
  CrewTotals totals;
  const auto add = [&](double off) {
    totals.alike++, totals.alike_difference += off, totals.alike_squares += off * off;
  };
  EXPECT_EQ(totals.alike_deviation(), 0);
  for (int i = 0; i < 5000; i++) add(i % 2 ? 0.1 : -0.1), add(0);
  EXPECT_LT(std::abs(totals.alike_deviation()), 3);
  for (int i = 0; i < 10000; i++) add(i % 100 == 0 ? 0.4 : 0);
  EXPECT_GT(totals.alike_deviation(), 3);
}

TEST(WorkerMessage, KeepsPartsOfFiles) {
  const FileHash hash = hash_bytes("abc");
  FileQuestion question;
  ASSERT_TRUE(read_message(write_message(FileQuestion{1, hash, 4096}, none), none, question));
  EXPECT_EQ(question.offset, 4096u);
  EXPECT_EQ(question.hash, hash);
  FilePart part;
  const auto is_read = [&](uint64_t offset, uint64_t size, const std::string& bytes) {
    return read_message(write_message(FilePart{1, hash, offset, size, bytes}, none), none, part);
  };
  ASSERT_TRUE(is_read(4096, 4099, "abc"));
  EXPECT_EQ(part.bytes, "abc");
  EXPECT_EQ(part.size, 4099u);
  EXPECT_FALSE(is_read(4096, 4098, "abc"));
  EXPECT_FALSE(is_read(9, 4, ""));
  EXPECT_FALSE(is_read(0, uint64_t(1) << 40, "abc"));
  EXPECT_FALSE(is_read(0, 1 << 20, std::string(most_part_bytes + 1, 'a')));
}

TEST(WorkerMessage, RefusesWhatIsCutOffOrLonger) {
  const std::string order = write_message(make_order(), none);
  const std::string answer = write_message(make_answer(), none);
  TraceOrder read_order;
  TraceAnswer read_answer;
  for (size_t size = 0; size < order.size(); size++)
    EXPECT_FALSE(read_message(order.substr(0, size), none, read_order)) << size;
  for (size_t size = 0; size < answer.size(); size++)
    EXPECT_FALSE(read_message(answer.substr(0, size), none, read_answer)) << size;
  EXPECT_FALSE(read_message(order + "x", none, read_order));
  EXPECT_FALSE(read_message(answer + "x", none, read_answer));
}

TEST(WorkerMessage, TellsKindsApart) {
  TraceAnswer answer;
  TraceOrder order;
  EXPECT_FALSE(read_message(write_message(make_order(), none), none, answer));
  EXPECT_FALSE(read_message(write_message(make_answer(), none), none, order));
}

TEST(WorkerMessage, RefusesValuesThatCannotBe) {
  const auto reads = [](auto change) {
    TraceAnswer answer = make_answer(), read;
    change(answer);
    return read_message(write_message(answer, none), none, read);
  };
  const float nan = std::nanf("");
  EXPECT_TRUE(reads([](TraceAnswer&) {}));
  EXPECT_FALSE(reads([&](TraceAnswer& a) { a.samples[1].smooth.y = nan; }));
  EXPECT_FALSE(reads([&](TraceAnswer& a) { a.samples[1].position.x = nan; }));
  EXPECT_FALSE(reads([](TraceAnswer& a) { a.samples[1].rest.x = 1e30f; }));
  EXPECT_FALSE(reads([](TraceAnswer& a) { a.samples[1].distance = -1; }));
  EXPECT_FALSE(reads([](TraceAnswer& a) { a.samples[1].flags = 0xff; }));
  EXPECT_FALSE(reads([](TraceAnswer& a) { a.worker = "no spaces"; }));
  EXPECT_FALSE(reads([](TraceAnswer& a) { a.samples.clear(); }));
  EXPECT_FALSE(reads([](TraceAnswer& a) { a.refusal = Refusal::late; }));
  EXPECT_FALSE(reads([](TraceAnswer& a) { a.traced = 1e9f; }));
}

TEST(WorkerMessage, RefusesRaysThatCannotBe) {
  const auto reads = [](auto change) {
    TraceOrder order = make_order(), read;
    change(order);
    return read_message(write_message(order, none), none, read);
  };
  EXPECT_FALSE(reads([](TraceOrder& o) { o.requests[0].ray.direction = vec3(0); }));
  EXPECT_FALSE(reads([](TraceOrder& o) { o.requests[0].ray.origin.x = INFINITY; }));
  EXPECT_FALSE(reads([](TraceOrder& o) { o.requests[2].ray.t_max = -1; }));
  EXPECT_FALSE(reads([](TraceOrder& o) { o.requests.clear(); }));
  EXPECT_FALSE(reads([](TraceOrder& o) { o.requests.resize(most_requests + 1, o.requests[0]); }));
  EXPECT_FALSE(reads([](TraceOrder& o) { o.transport.max_depth = 0; }));
  EXPECT_FALSE(reads([](TraceOrder& o) { o.worth_ms = longest_worth_ms + 1; }));
  EXPECT_FALSE(reads([](TraceOrder& o) { o.exhibit = std::string(100, 'x'); }));
}

TEST(WorkerMessage, IsSealedByTheKeyAlone) {
  const MessageKey key = make_message_key("a secret of the house"), other = make_message_key("b");
  ASSERT_TRUE(key);
  const std::string sealed = write_message(make_answer(), key);
  TraceAnswer read;
  EXPECT_TRUE(read_message(sealed, key, read));
  EXPECT_FALSE(read_message(sealed, other, read));
  EXPECT_FALSE(read_message(sealed, none, read));
  EXPECT_FALSE(read_message(write_message(make_answer(), none), key, read));
  for (size_t i = 0; i < sealed.size(); i += 7) {
    std::string changed = sealed;
    changed[i] ^= 1;
    EXPECT_FALSE(read_message(changed, key, read)) << i;
  }
}

TEST(WorkerMessage, ChecksSamplesAgainstTheirWorld) {
  const std::vector<Sample> samples = make_answer().samples;
  EXPECT_TRUE(are_within(samples, {3, {4, 10}}));
  EXPECT_FALSE(are_within(samples, {2, {4, 10}}));  // no such object
  EXPECT_FALSE(are_within(samples, {3, {4, 9}}));   // no such triangle of a moving mesh
  EXPECT_FALSE(are_within(samples, {3, {4}}));      // no such instance
}

}  // namespace
}  // namespace wellspring::test
