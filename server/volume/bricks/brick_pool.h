// SPDX-License-Identifier: Apache-2.0
// Keeps bricks of volumes (brick_file.h) that somebody looks at, in slots of one piece of memory,
// so that eight rays read eight bricks with 32-bit offsets from one place. Who follows rays looks
// bricks up without waiting: where one is not there, the next coarser one that is serves, and
// looking it up is the wish for it. A thread loads wished bricks, most urgent first, into slots
// that nobody has looked at for longest.
//
// It is no PieceStore: that gives each piece memory of its own, and finds it by a hash; rays would
// pay for both at every step.
#pragma once
#include <array>
#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "base/clock.h"
#include "base/vec.h"
#include "volume/bricks/brick_file.h"

namespace wellspring::volume {

class ResidentBricks;

struct BrickStats {
  int slots = 0, used = 0;  // used: they hold a brick
  uint64_t loaded = 0, dropped = 0, failed = 0;
};

class BrickPool {
 public:
  // `budget`: bytes of all slots. `threads`: 0 or 1; 0: only load_some() loads. `clock`: seconds.
  explicit BrickPool(size_t budget, int threads = 1, std::function<double()> clock = seconds_now);
  ~BrickPool();
  BrickPool(const BrickPool&) = delete;
  BrickPool& operator=(const BrickPool&) = delete;

  // Loads the most urgent bricks, a few, on the calling thread. False: none is wished, or all slots
  // hold what somebody looks at.
  bool load_some();
  BrickStats stats() const;

  // All slots, one after the other; brick_file.h says how a brick lies in its own.
  const uint16_t* codes() const { return codes_.get(); }
  const uint32_t* normals() const { return normals_.get(); }
  int samples() const { return slot_count_ * stored_samples; }

 private:
  friend class ResidentBricks;
  friend class BrickReader;
  struct Slot {
    ResidentBricks* whose = nullptr;
    size_t brick = 0;
    bool stays = false;
  };
  struct alignas(64) Reading {
    std::atomic<uint64_t> epoch{0};  // 0: nobody reads here
  };
  struct Wish {
    ResidentBricks* whose;
    size_t brick;
    uint32_t rank;  // the lowest first
  };

  enum class Load : uint8_t { done, no_room, nothing };

  uint32_t ticks_now() const;
  void live(std::stop_token stop);
  Load load();
  std::vector<Wish> find_wishes(uint32_t now) const;
  std::vector<int> free_slots(size_t count, uint32_t unused_for, uint32_t now);
  void wait_for_readers();
  void give(int slot, ResidentBricks& whose, size_t brick, bool stays);
  void add(ResidentBricks& bricks);
  void remove(ResidentBricks& bricks);

  const int slot_count_;
  const std::function<double()> clock_;
  const double began_;
  std::unique_ptr<uint16_t[]> codes_;
  std::unique_ptr<uint32_t[]> normals_;
  mutable std::array<Reading, 128> reading_;
  std::atomic<uint64_t> epoch_{1};
  std::atomic<uint32_t> wanted_{1};  // whether wishes may have come
  std::atomic<int> used_{0};
  std::atomic<uint64_t> loaded_{0}, dropped_{0}, failed_{0};

  std::mutex mutex_;  // guards what follows, also while files are read
  std::vector<Slot> slots_;
  std::vector<ResidentBricks*> volumes_;
  std::condition_variable_any pause_;
  std::jthread thread_;  // last: it ends before the rest
};

// Returns the pool of 512 MiB that all volumes of the process share.
std::shared_ptr<BrickPool> shared_brick_pool();

// Holds which bricks of a volume are in the pool. The coarsest one always is.
class ResidentBricks {
 public:
  // Throws LoadError: the file cannot be read, or there is no room in the pool.
  ResidentBricks(BrickFile file, std::shared_ptr<BrickPool> pool);
  // Nobody may read any more.
  ~ResidentBricks();
  ResidentBricks(const ResidentBricks&) = delete;
  ResidentBricks& operator=(const ResidentBricks&) = delete;

  const BrickFile& file() const { return file_; }
  BrickPool& pool() const { return *pool_; }
  // Returns how many wished bricks have come so far. Any thread.
  uint64_t arrivals() const { return arrivals_.load(std::memory_order_relaxed); }

 private:
  friend class BrickPool;
  friend class BrickReader;
  static constexpr int32_t absent = -1, unreadable = -2;
  const BrickFile file_;
  const std::shared_ptr<BrickPool> pool_;
  // For each brick: the place of its first stored sample in the pool, or one of the above; and when
  // it was last looked for, in ticks, 0: never.
  std::vector<std::atomic<int32_t>> places_;
  mutable std::vector<std::atomic<uint32_t>> looked_;
  std::atomic<uint64_t> arrivals_{0};
};

// Says where a brick lies: `place` of its first stored sample in the pool.
struct FoundBrick {
  int place = 0;
  int level = 0;
  glm::ivec3 brick{0};
};

// Looks bricks up on one thread for as long as it lives, which is to be short (rays of a few
// pixels): what it has found stays valid until then. Never waits.
class BrickReader {
 public:
  explicit BrickReader(const ResidentBricks& bricks);
  ~BrickReader();
  BrickReader(const BrickReader&) = delete;
  BrickReader& operator=(const BrickReader&) = delete;
  // Returns the brick, or the next coarser one around it that is there.
  FoundBrick find(int level, glm::ivec3 brick) const;
  // Returns the coarsest one, without wishing for it.
  FoundBrick coarsest() const;

 private:
  const ResidentBricks& bricks_;
  const uint32_t now_;
  std::atomic<uint64_t>* reading_ = nullptr;
};

}  // namespace wellspring::volume
