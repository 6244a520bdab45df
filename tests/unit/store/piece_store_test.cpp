// SPDX-License-Identifier: Apache-2.0
#include "store/piece_store.h"

#include <gtest/gtest.h>

#include <future>
#include <thread>

#include "base/load_error.h"
#include "unit/store/address_picture.h"

namespace wellspring::test {
namespace {

constexpr size_t tile_bytes = 256 * 256 * 4;

// A store whose time is set by hand, with one source.
struct Timed {
  double now = 0;
  std::shared_ptr<AddressPicture> picture = std::make_shared<AddressPicture>(1 << 20, 1 << 20);
  std::shared_ptr<PieceStore> store;
  int source = 0;
  explicit Timed(size_t budget = 64 * tile_bytes, int threads = 0)
      : store(std::make_shared<PieceStore>(budget, threads, [this] { return now; })),
        source(store->add(picture)) {}
  PieceKey key(uint32_t column, int level = 0) const { return {source, level, column, 0}; }
  std::vector<Wish> wishes(uint32_t first, uint32_t count, Urgency urgency = Urgency::shown) const {
    std::vector<Wish> all;
    for (uint32_t i = 0; i < count; i++) all.push_back({key(first + i), urgency});
    return all;
  }
  bool there(PieceKey which) const { return PieceReader(*store).find(which) != nullptr; }
  int fetch_all() const {
    int fetched = 0;
    while (store->fetch_next()) fetched++;
    return fetched;
  }
};

TEST(PieceStore, FetchesWhatIsWantedInThatOrder) {
  Timed timed;
  PieceClient client(timed.store);
  client.want({{timed.key(7), Urgency::ahead}, {timed.key(3)}, {timed.key(5)}});
  EXPECT_FALSE(timed.there(timed.key(3)));
  for (uint32_t column : {3u, 5u, 7u}) {
    EXPECT_TRUE(timed.store->fetch_next());
    EXPECT_TRUE(timed.there(timed.key(column))) << column;
  }
  EXPECT_FALSE(timed.store->fetch_next());
  EXPECT_EQ(client.arrivals(), 2u) << "a piece that is only ahead is in nobody's picture yet";
  EXPECT_EQ(timed.store->stats().pieces, 3);
}

TEST(PieceStore, ManyWhoWantAPieceFetchItOnce) {
  Timed timed;
  PieceClient one(timed.store), other(timed.store);
  one.want({{timed.key(3)}}), other.want({{timed.key(3)}});
  EXPECT_EQ(timed.fetch_all(), 1);
  EXPECT_EQ(one.arrivals(), 1u);
  EXPECT_EQ(other.arrivals(), 1u);
}

TEST(PieceStore, ClientsTakeTurns) {
  Timed timed;
  PieceClient one(timed.store), other(timed.store);
  one.want(timed.wishes(0, 10)), other.want(timed.wishes(100, 10));
  for (int i = 0; i < 6; i++) timed.store->fetch_next();
  EXPECT_EQ(one.arrivals(), 3u);
  EXPECT_EQ(other.arrivals(), 3u);
}

TEST(PieceStore, KeepsItsBudgetAndWhatIsShown) {
  Timed timed(10 * (tile_bytes + 200));
  PieceClient looker(timed.store);
  looker.want(timed.wishes(0, 4));
  timed.fetch_all();
  PieceClient walker(timed.store);
  for (uint32_t at = 100; at < 160; at += 4) {
    timed.now += 1;
    walker.want(timed.wishes(at, 4));
    timed.fetch_all();
    EXPECT_LE(timed.store->stats().bytes, timed.store->stats().budget);
    for (uint32_t i = 0; i < 4; i++) {
      EXPECT_TRUE(timed.there(timed.key(i))) << at;
      EXPECT_TRUE(timed.there(timed.key(at + i))) << at;
    }
  }
}

TEST(PieceStore, WishesPushNothingOut) {
  Timed timed(10 * (tile_bytes + 200));
  PieceClient looker(timed.store), wisher(timed.store);
  looker.want(timed.wishes(0, 6));
  timed.fetch_all();
  wisher.want(timed.wishes(50, 40, Urgency::wished));
  timed.fetch_all();
  for (uint32_t i = 0; i < 6; i++) EXPECT_TRUE(timed.there(timed.key(i))) << i;
  EXPECT_LE(timed.store->stats().bytes, timed.store->stats().budget);
}

TEST(PieceStore, WishesTakeThePlaceOfWhatNobodyListsAndThenStop) {
  Timed timed(16 * (tile_bytes + 200));
  PieceClient client(timed.store);
  client.want(timed.wishes(0, 14));
  timed.fetch_all();
  client.want(timed.wishes(50, 40, Urgency::wished));
  EXPECT_NEAR(timed.fetch_all(), 15, 1);
  EXPECT_TRUE(timed.there(timed.key(50)));
  EXPECT_EQ(timed.fetch_all(), 0) << "all that fits is there";
}

TEST(PieceStore, WhoWaitsForMoreThanFitsWaitsNotForEver) {
  Timed timed(4 * (tile_bytes + 200), 2);
  PieceClient client(timed.store);
  client.want(timed.wishes(0, 30));
  client.fetch();
  EXPECT_LE(timed.store->stats().pieces, 4);
}

TEST(PieceStore, ShowsMoreCoarselyWhenTooMuchIsShown) {
  Timed timed(16 * tile_bytes);
  PieceClient client(timed.store);
  client.want(timed.wishes(0, 4));
  EXPECT_EQ(timed.store->coarser(), 0);
  client.want(timed.wishes(0, 64));
  const float coarser = timed.store->coarser();
  EXPECT_NEAR(coarser, 0.5f * std::log2(64 / (0.9f * 16)), 0.05f);
  client.want(timed.wishes(0, 14));  // which is what is looked for at that detail
  EXPECT_NEAR(timed.store->coarser(), coarser, 0.1f);
  client.want(timed.wishes(0, 1));
  EXPECT_EQ(timed.store->coarser(), 0);
}

TEST(PieceStore, SoftExpiryFetchesAgainAndShowsTheOldOne) {
  Timed timed;
  timed.picture->soft = 1, timed.picture->hard = 2;
  PieceClient client(timed.store);
  client.want({{timed.key(3)}});
  EXPECT_EQ(timed.fetch_all(), 1);
  timed.now = 0.9;
  client.want({{timed.key(3)}});
  EXPECT_EQ(timed.fetch_all(), 0);
  timed.now = 1.5;
  EXPECT_TRUE(timed.there(timed.key(3)));
  EXPECT_EQ(timed.fetch_all(), 1);
  timed.now = 2.4;  // the second one is good until 2.5, and shown until 3.5
  EXPECT_TRUE(timed.there(timed.key(3)));
  timed.now = 3.6;
  EXPECT_FALSE(timed.there(timed.key(3)));
  EXPECT_EQ(timed.fetch_all(), 1);
  EXPECT_TRUE(timed.there(timed.key(3)));
}

TEST(PieceStore, WhatIsFetchedAgainAndIsTheSameIsNoNews) {
  Timed timed;
  timed.picture->soft = 1;
  PieceClient client(timed.store);
  client.want({{timed.key(3)}});
  timed.fetch_all();
  timed.now = 2;
  EXPECT_EQ(timed.fetch_all(), 1);
  EXPECT_EQ(client.arrivals(), 1u);
  timed.now = 2.5;
  EXPECT_EQ(timed.fetch_all(), 0) << "it is good for another second";
}

// Answers that there is nothing, for two seconds; later it breaks.
struct EmptySource : PieceSource {
  bool broken = false;
  Fetched fetch(PieceKey) const override {
    if (broken) throw LoadError("a.tif", "tile 3, 0", "is damaged");
    return {nullptr, 2, 2};
  }
};

TEST(PieceStore, AbsentPiecesAreAskedForAgainAfterTheirLife) {
  Timed timed;
  auto empty = std::make_shared<EmptySource>();
  const int source = timed.store->add(empty);
  PieceClient client(timed.store);
  client.want({{PieceKey(source, 0, 3, 0)}});
  EXPECT_EQ(timed.fetch_all(), 1);
  EXPECT_FALSE(timed.there({source, 0, 3, 0}));
  timed.now = 1;
  EXPECT_EQ(timed.fetch_all(), 0);
  timed.now = 3;
  EXPECT_EQ(timed.fetch_all(), 1);
  EXPECT_EQ(timed.store->stats().absent, 2u);
  EXPECT_EQ(client.arrivals(), 0u);
  empty->broken = true;
  timed.now = 6;
  EXPECT_EQ(timed.fetch_all(), 1);
  EXPECT_EQ(timed.store->stats().last_error, "a.tif: tile 3, 0: is damaged");
  EXPECT_EQ(timed.fetch_all(), 0);  // not at once again
}

TEST(PieceStore, AFailedSecondFetchKeepsTheFirst) {
  Timed timed;
  timed.picture->soft = 1, timed.picture->hard = 100;
  PieceClient client(timed.store);
  client.want({{timed.key(1)}});
  timed.fetch_all();
  timed.picture->before = [](PieceKey) { throw LoadError("a.tif", "", "is gone"); };
  timed.now = 2;
  EXPECT_EQ(timed.fetch_all(), 1);
  EXPECT_TRUE(timed.there(timed.key(1)));
}

TEST(PieceStore, RemovedSourcesLeaveNothing) {
  Timed timed;
  PieceClient client(timed.store);
  client.want({{timed.key(1)}, {timed.key(2)}});
  timed.store->fetch_next();
  timed.store->remove(timed.source);
  EXPECT_FALSE(timed.there(timed.key(1)));
  EXPECT_EQ(timed.fetch_all(), 0);
  EXPECT_EQ(timed.store->stats().bytes, 0u);
  auto other = std::make_shared<AddressPicture>(64, 64);
  EXPECT_EQ(timed.store->add(other), timed.source);
}

TEST(PieceStore, TakesAsManySourcesAsItNumbers) {
  PieceStore store(1 << 20, 0);
  auto picture = std::make_shared<AddressPicture>(64, 64);
  for (int i = 0; i < most_sources; i++) store.add(picture);
  EXPECT_THROW(store.add(picture), std::length_error);
}

TEST(PieceStore, ASourceThatStandsStillHoldsUpNobodyElse) {
  Timed timed(64 * tile_bytes, 4);
  std::promise<void> goes_on;
  std::shared_future<void> when = goes_on.get_future().share();
  timed.picture->before = [when](PieceKey) { when.wait(); };
  auto quick = std::make_shared<AddressPicture>(1 << 16, 1 << 16);
  const int source = timed.store->add(quick);
  PieceClient stuck(timed.store), other(timed.store);
  stuck.want(timed.wishes(0, 20));
  other.want({{PieceKey(source, 0, 1, 0)}, {PieceKey(source, 0, 2, 0)}});
  while (other.arrivals() < 2) std::this_thread::yield();
  EXPECT_EQ(stuck.arrivals(), 0u);
  goes_on.set_value();
  while (stuck.arrivals() < 20) std::this_thread::yield();
}

TEST(PieceStore, ReadersSeeWholePiecesWhileOthersComeAndGo) {
  Timed timed(8 * (tile_bytes + 200), 2);
  std::atomic<bool> ends = false;
  std::atomic<uint64_t> found = 0, wrong = 0;
  std::vector<std::thread> readers;
  for (int t = 0; t < 3; t++)
    readers.emplace_back([&] {
      while (!ends) {
        PieceReader reader(*timed.store);
        for (uint32_t column = 0; column < 40; column++)
          if (const Piece* piece = reader.find(timed.key(column))) {
            found++;
            wrong += piece->bytes.size() != tile_bytes || piece->bytes[1] != column ||
                     piece->bytes[tile_bytes - 3] != column;
          }
      }
    });
  PieceClient client(timed.store);
  for (uint32_t round = 0; round < 30; round++) {
    client.want(timed.wishes(round * 7 % 36, 4));
    const uint64_t before = client.arrivals();
    for (int wait = 0; client.arrivals() == before && wait < 50; wait++) std::this_thread::yield();
  }
  while (found == 0) std::this_thread::yield();
  ends = true;
  for (std::thread& reader : readers) reader.join();
  EXPECT_EQ(wrong, 0u);
}

}  // namespace
}  // namespace wellspring::test
