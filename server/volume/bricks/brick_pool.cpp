// SPDX-License-Identifier: Apache-2.0
#include "volume/bricks/brick_pool.h"

#include <algorithm>
#include <map>

#include "base/load_error.h"
#include "base/log.h"

namespace wellspring::volume {
namespace {

constexpr double ticks_a_second = 64;
// A brick is wished, and one that is there is kept, for so long after somebody has looked for it.
// Both are one time: else what is dropped would be wished at once.
constexpr uint32_t kept_ticks = 128;
constexpr uint32_t fresh_ticks = 16;  // wishes of about one picture
constexpr size_t loaded_at_once = 32, expected_at_once = 96;
constexpr int most_even_slots = 4;  // for bricks of one code alone, which are many
constexpr size_t shared_budget = size_t(512) << 20;

int slots_in(size_t budget) {
  constexpr size_t most = size_t(INT32_MAX) / stored_samples;
  return int(std::clamp(budget / record_bytes, size_t(1), most));
}

}  // namespace

BrickPool::BrickPool(size_t budget, int threads, std::function<double()> clock)
    : slot_count_(slots_in(budget)),
      clock_(std::move(clock)),
      began_(clock_()),
      codes_(new uint16_t[size_t(samples())]),
      normals_(new uint32_t[size_t(samples())]),
      slots_(size_t(slot_count_)) {
  if (threads > 0) thread_ = std::jthread([this](std::stop_token stop) { live(stop); });
}

BrickPool::~BrickPool() {
  thread_.request_stop();
  wanted_ = 1;
  wanted_.notify_all();
}

uint32_t BrickPool::ticks_now() const {
  return uint32_t(uint64_t((clock_() - began_) * ticks_a_second)) + 1;
}

void BrickPool::live(std::stop_token stop) {
  while (!stop.stop_requested()) {
    wanted_ = 0;
    const Load load_was = load();
    if (load_was == Load::nothing && !stop.stop_requested()) wanted_.wait(0);
    if (load_was != Load::no_room) continue;
    std::unique_lock lock(mutex_);
    pause_.wait_for(lock, stop, std::chrono::milliseconds(20), [] { return false; });
  }
}

bool BrickPool::load_some() { return load() == Load::done; }

BrickPool::Load BrickPool::load() {
  std::lock_guard lock(mutex_);
  const uint32_t now = ticks_now();
  const std::vector<Wish> wishes = find_wishes(now);
  if (wishes.empty()) return Load::nothing;
  const std::vector<int> slots =
      free_slots(std::min(wishes.size(), loaded_at_once), kept_ticks, now);
  if (slots.empty()) return Load::no_room;
  for (const Wish& wish : wishes) wish.whose->file_.expect(wish.whose->file_.entries[wish.brick]);
  for (size_t i = 0; i < slots.size(); i++) {
    ResidentBricks& whose = *wishes[i].whose;
    try {
      give(slots[i], whose, wishes[i].brick, false);
      whose.arrivals_.fetch_add(1, std::memory_order_relaxed);
    } catch (const LoadError& error) {
      log::warn("{}", error.what());
      whose.places_[wishes[i].brick] = ResidentBricks::unreadable;
      failed_++;
    }
  }
  return Load::done;
}

std::vector<BrickPool::Wish> BrickPool::find_wishes(uint32_t now) const {
  std::vector<Wish> wishes;
  for (ResidentBricks* volume : volumes_) {
    const std::vector<BrickLevel>& levels = volume->file_.levels;
    for (size_t k = 0; k < levels.size(); k++)
      for (size_t i = levels[k].first; i < levels[k].first + levels[k].count(); i++) {
        const uint32_t looked = volume->looked_[i];
        if (looked == 0 || now - looked > kept_ticks) continue;
        if (volume->places_[i] != ResidentBricks::absent) continue;
        // Newest first, of these the coarsest: they serve where finer ones are missing.
        const uint32_t rank = (now - looked) / fresh_ticks * 64 + uint32_t(levels.size() - k);
        wishes.push_back({volume, i, rank});
      }
  }
  const size_t count = std::min(wishes.size(), expected_at_once);
  std::ranges::partial_sort(wishes, wishes.begin() + ptrdiff_t(count), {},
                            [](const Wish& wish) { return std::pair(wish.rank, wish.brick); });
  wishes.resize(count);
  return wishes;
}

// Returns slots that nobody reads any more: free ones, then those that were looked at longest ago,
// more than `unused_for` ticks.
std::vector<int> BrickPool::free_slots(size_t count, uint32_t unused_for, uint32_t now) {
  std::vector<int> slots;
  std::vector<std::pair<uint32_t, int>> old;
  for (int i = 0; i < slot_count_ && slots.size() < count; i++) {
    const Slot& slot = slots_[size_t(i)];
    if (!slot.whose) {
      slots.push_back(i);
    } else if (const uint32_t age = now - slot.whose->looked_[slot.brick];
               !slot.stays && age > unused_for) {
      old.push_back({age, i});
    }
  }
  const size_t dropped = std::min(count - slots.size(), old.size());
  if (dropped == 0) return slots;
  std::ranges::partial_sort(old, old.begin() + ptrdiff_t(dropped), std::greater<>{});
  for (size_t i = 0; i < dropped; i++) {
    Slot& slot = slots_[size_t(old[i].second)];
    slot.whose->places_[slot.brick] = ResidentBricks::absent;
    slot = {};
    slots.push_back(old[i].second);
  }
  used_ -= int(dropped), dropped_ += dropped;
  wait_for_readers();
  return slots;
}

// Waits until all who may have found what was dropped before have ended.
void BrickPool::wait_for_readers() {
  const uint64_t now = epoch_.fetch_add(1) + 1;
  for (const Reading& reading : reading_)
    for (uint64_t epoch; (epoch = reading.epoch.load()) != 0 && epoch < now;)
      std::this_thread::sleep_for(std::chrono::microseconds(50));
}

// Loads a brick into a slot that nobody reads. Throws LoadError.
void BrickPool::give(int slot, ResidentBricks& whose, size_t brick, bool stays) {
  const size_t place = size_t(slot) * stored_samples;
  whose.file_.read(whose.file_.entries[brick], &codes_[place], &normals_[place]);
  slots_[size_t(slot)] = {&whose, brick, stays};
  whose.places_[brick] = int32_t(place);
  used_++, loaded_++;
}

// Loads what of a new volume stays: its coarsest brick, and one for each of the commonest codes of
// which whole bricks consist.
void BrickPool::add(ResidentBricks& bricks) {
  std::lock_guard lock(mutex_);
  const std::vector<BrickEntry>& entries = bricks.file_.entries;
  std::map<uint16_t, std::vector<size_t>> even;
  for (size_t i = 0; i + 1 < entries.size(); i++)
    if (entries[i].record == no_record) even[entries[i].least].push_back(i);
  std::vector<std::vector<size_t>> shared;
  for (auto& [code, numbers] : even) shared.push_back(std::move(numbers));
  std::ranges::sort(shared, std::greater<>{}, &std::vector<size_t>::size);
  shared.resize(std::min(shared.size(), size_t(std::min(most_even_slots, slot_count_ / 64))));
  const std::vector<int> slots = free_slots(1 + shared.size(), 0, ticks_now());
  if (slots.empty())
    throw LoadError(bricks.file_.path, "", "finds no room: all bricks in memory are in use");
  give(slots[0], bricks, entries.size() - 1, true);
  for (size_t i = 0; i < shared.size() && i + 1 < slots.size(); i++) {
    give(slots[i + 1], bricks, shared[i][0], true);
    for (const size_t brick : shared[i])
      bricks.places_[brick] = bricks.places_[shared[i][0]].load();
  }
  volumes_.push_back(&bricks);
}

void BrickPool::remove(ResidentBricks& bricks) {
  std::lock_guard lock(mutex_);
  std::erase(volumes_, &bricks);
  for (Slot& slot : slots_)
    if (slot.whose == &bricks) slot = {}, used_--;
}

BrickStats BrickPool::stats() const { return {slot_count_, used_, loaded_, dropped_, failed_}; }

std::shared_ptr<BrickPool> shared_brick_pool() {
  static const auto pool = std::make_shared<BrickPool>(shared_budget);
  return pool;
}

ResidentBricks::ResidentBricks(BrickFile file, std::shared_ptr<BrickPool> pool)
    : file_(std::move(file)),
      pool_(std::move(pool)),
      places_(file_.entries.size()),
      looked_(file_.entries.size()) {
  for (std::atomic<int32_t>& place : places_) place = absent;
  pool_->add(*this);
}

ResidentBricks::~ResidentBricks() { pool_->remove(*this); }

BrickReader::BrickReader(const ResidentBricks& bricks)
    : bricks_(bricks), now_(bricks.pool_->ticks_now()) {
  static std::atomic<uint32_t> threads = 0;
  thread_local const uint32_t first = threads.fetch_add(1);
  const BrickPool& pool = *bricks.pool_;
  // The epoch is announced before anything is looked up: what is dropped afterwards is kept.
  for (uint32_t i = first;; i++) {
    std::atomic<uint64_t>& place = pool.reading_[i % pool.reading_.size()].epoch;
    uint64_t free = 0;
    if (!place.compare_exchange_strong(free, pool.epoch_.load())) continue;
    reading_ = &place;
    return;
  }
}

BrickReader::~BrickReader() { reading_->store(0); }

FoundBrick BrickReader::find(int level, glm::ivec3 brick) const {
  const std::vector<BrickLevel>& levels = bricks_.file_.levels;
  for (;; level++, brick = glm::min(brick >> 1, levels[size_t(level)].bricks - 1)) {
    const size_t number = levels[size_t(level)].number_of(brick);
    std::atomic<uint32_t>& looked = bricks_.looked_[number];
    const int32_t place = bricks_.places_[number];
    if (place >= 0) {
      if (looked.load(std::memory_order_relaxed) != now_)
        looked.store(now_, std::memory_order_relaxed);
      return {place, level, brick};
    }
    if (looked.load(std::memory_order_relaxed) != now_) looked = now_;
    // Either the thread that loads sees the wish, or this one sees that it has begun to look.
    std::atomic<uint32_t>& wanted = bricks_.pool_->wanted_;
    if (place == ResidentBricks::absent && wanted.load() == 0) {
      wanted = 1;
      wanted.notify_one();
    }
  }
}

FoundBrick BrickReader::coarsest() const {
  return {bricks_.places_.back(), int(bricks_.file_.levels.size()) - 1, glm::ivec3(0)};
}

}  // namespace wellspring::volume
