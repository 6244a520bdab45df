// SPDX-License-Identifier: Apache-2.0
// Keeps pieces of large data that somebody looks at, up to a budget of bytes: the second cache of
// Taibo, Seoane and Hernandez ("Dynamic Virtual Textures", sections 4.4 and 5), for all visitors
// and all kinds of data. Who draws looks pieces up without waiting, and tells afterwards which ones
// it would have liked; threads of the store fetch them, most needed first.
#pragma once
#include <array>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "base/clock.h"
#include "store/piece.h"

namespace wellspring::store {

// Says what a piece is needed for: the paper's regions A, B and C. The first two are not dropped
// while somebody lists them.
enum class Urgency : uint8_t { shown, ahead, wished };
inline constexpr int urgency_count = 3;

struct Wish {
  PieceKey key;
  Urgency urgency = Urgency::shown;
};

struct StoreStats {
  size_t bytes = 0, budget = 0;
  int pieces = 0, sources = 0, waiting = 0, under_way = 0;
  uint64_t fetched = 0, absent = 0, failed = 0, dropped = 0;
  float coarser = 0;  // as PieceStore::coarser()
  // Look-ups by pixels, and those of them that were more than a level too coarse.
  uint64_t looked = 0, looked_coarse = 0;
  double fetch_seconds = 0;  // all fetches together
  std::string last_error;    // a source's; empty: none
};

class PieceClient;

class PieceStore {
 public:
  // `threads`: how many fetch; a source keeps at most half of them, so that one whose disk stands
  // still does not stop the others. 0: only fetch_next() fetches. `clock`: seconds.
  explicit PieceStore(size_t budget, int threads, std::function<double()> clock = seconds_now);
  ~PieceStore();
  PieceStore(const PieceStore&) = delete;
  PieceStore& operator=(const PieceStore&) = delete;

  // Returns the number of the new source, 1 or more. Throws std::length_error beyond most_sources.
  int add(std::shared_ptr<const PieceSource> source);
  // Drops the source with its pieces; its number may be given to another one.
  void remove(int source);

  // Returns levels by which everybody looks up more coarsely, because what is shown is more than
  // the budget holds.
  float coarser() const { return coarser_.load(std::memory_order_relaxed); }

  // Counts look-ups of pixels, and those whose texels were more than one level too coarse.
  void count_looks(uint64_t looks, uint64_t coarse) const {
    looked_.fetch_add(looks, std::memory_order_relaxed);
    looked_coarse_.fetch_add(coarse, std::memory_order_relaxed);
  }

  // Fetches the next piece on the calling thread. False: nobody wants one.
  bool fetch_next();
  StoreStats stats() const;

 private:
  friend class PieceReader;
  friend class PieceClient;
  struct Entry {
    PieceKey key;
    std::shared_ptr<const Piece> piece;  // null: absent
    std::atomic<double> soft, hard;      // seconds of the clock
    mutable std::atomic<double> used{0};
    size_t bytes = 0;
  };
  struct Slot {
    std::atomic<uint64_t> key{0};
    std::atomic<const Entry*> entry{nullptr};
  };
  static constexpr int ways = 8;
  struct alignas(64) Reading {
    std::atomic<uint64_t> epoch{0};  // 0: nobody reads here
  };
  struct Client {
    std::vector<Wish> wishes;
    std::array<std::deque<PieceKey>, urgency_count> waiting;
    uint64_t served = 0;
  };
  struct Source {
    std::shared_ptr<const PieceSource> source;
    int under_way = 0;
    uint64_t made = 0;  // tells apart sources that had the same number
  };
  struct Job {
    PieceKey key;
    std::shared_ptr<const PieceSource> source;
    uint64_t made = 0;
  };

  Slot* slots_of(PieceKey key) const;
  void live(std::stop_token stop);
  void queue(Client& client, double now);
  void queue_again(double now);
  bool is_fresh(PieceKey key, double now) const;
  bool choose(Job& job);
  bool make_room(size_t bytes, int rank);
  void insert(PieceKey key, Fetched fetched);
  void drop(PieceKey key);
  void collect();
  void hold(const std::vector<Wish>& wishes, int change);
  int rank_of(PieceKey key) const;
  void fit_detail();

  const size_t budget_;
  const int most_of_a_source_;  // fetches of one source at a time
  const std::function<double()> clock_;
  std::unique_ptr<Slot[]> slots_;
  mutable std::array<Reading, 128> reading_;
  std::atomic<uint64_t> epoch_{1};
  std::atomic<float> coarser_{0};
  mutable std::atomic<uint64_t> looked_{0}, looked_coarse_{0};

  mutable std::mutex mutex_;  // guards what follows
  std::condition_variable_any wanted_;
  std::unordered_map<uint64_t, std::unique_ptr<Entry>> entries_;
  std::vector<std::pair<std::unique_ptr<Entry>, uint64_t>> retired_;   // with the epoch after it
  std::unordered_map<uint64_t, std::array<int, urgency_count>> held_;  // how many clients list it
  std::unordered_set<uint64_t> under_way_;                             // keys
  std::unordered_map<const PieceClient*, Client> clients_;
  std::array<Source, most_sources + 1> sources_;
  std::array<size_t, urgency_count> there_{};  // bytes of pieces that clients list, by rank_of()
  uint64_t turn_ = 0, sources_made_ = 0;
  uint64_t wants_ = 0;  // wakes those who wait for work
  double queued_at_ = 0;
  StoreStats stats_;
  std::vector<std::jthread> threads_;  // last: they end before the rest
};

// Needs pieces: a visitor, for what its pictures show.
class PieceClient {
 public:
  explicit PieceClient(std::shared_ptr<PieceStore> store);
  ~PieceClient();
  PieceClient(const PieceClient&) = delete;
  PieceClient& operator=(const PieceClient&) = delete;

  // Replaces what it needs: of one urgency the most important first. Pieces that are there count,
  // too: they are kept for it.
  void want(std::vector<Wish> wishes);
  // Fetches what it needs to show, with the store's threads, and returns when all of that is there,
  // absent, cannot be read, or does not fit.
  void fetch() const;
  // Returns how many pieces that it needs to show have come so far. Any thread.
  uint64_t arrivals() const { return arrivals_.load(std::memory_order_relaxed); }

 private:
  friend class PieceStore;
  const std::shared_ptr<PieceStore> store_;
  mutable std::atomic<uint64_t> arrivals_{0};
};

// Returns the store that all exhibits of the process share.
std::shared_ptr<PieceStore> shared_store();
// Sets its budget, before it is first asked for; 256 MiB otherwise.
void set_shared_budget(size_t bytes);

// Looks pieces up on one thread for as long as it lives, which is to be short: what it has found
// stays valid until then. Never waits.
class PieceReader {
 public:
  explicit PieceReader(const PieceStore& store);
  ~PieceReader();
  PieceReader(const PieceReader&) = delete;
  PieceReader& operator=(const PieceReader&) = delete;
  // Returns the piece, or null: it is not there, absent, or expired.
  const Piece* find(PieceKey key) const;

 private:
  const PieceStore& store_;
  const double now_;
  std::atomic<uint64_t>* reading_ = nullptr;
};

}  // namespace wellspring::store
