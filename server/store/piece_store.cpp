// SPDX-License-Identifier: Apache-2.0
#include "store/piece_store.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/load_error.h"

namespace wellspring::store {
namespace {

constexpr int buckets = 1 << 13;
// Seconds: a piece that could not be fetched counts as absent for so long; what is waited for is
// looked through again for what has expired.
constexpr double failed_for = 10, queue_again_after = 0.25;

inline uint64_t scatter(uint64_t bits) {
  bits ^= bits >> 29;
  bits *= 0xbf58476d1ce4e5b9u;
  bits ^= bits >> 32;
  return bits;
}

}  // namespace

PieceStore::PieceStore(size_t budget, int threads, std::function<double()> clock)
    : budget_(budget),
      most_of_a_source_(std::max(1, threads / 2)),
      clock_(std::move(clock)),
      slots_(new Slot[size_t(buckets) * ways]) {
  stats_.budget = budget;
  for (int i = 0; i < threads; i++)
    threads_.emplace_back([this](std::stop_token stop) { live(stop); });
}

PieceStore::~PieceStore() {
  for (std::jthread& thread : threads_) thread.request_stop();
  wanted_.notify_all();
}

PieceStore::Slot* PieceStore::slots_of(PieceKey key) const {
  return &slots_[(scatter(key.bits) & (buckets - 1)) * ways];
}

int PieceStore::add(std::shared_ptr<const PieceSource> source) {
  std::lock_guard lock(mutex_);
  for (int i = 1; i <= most_sources; i++) {
    Source& place = sources_[size_t(i)];
    if (place.source || place.under_way > 0) continue;
    place.source = std::move(source);
    place.made = ++sources_made_;
    stats_.sources++;
    return i;
  }
  throw std::length_error("more than " + std::to_string(most_sources) + " sources");
}

void PieceStore::remove(int source) {
  std::lock_guard lock(mutex_);
  Source& place = sources_[size_t(source)];
  if (!place.source) return;
  place.source = nullptr;
  stats_.sources--;
  std::vector<PieceKey> keys;
  for (const auto& [bits, entry] : entries_)
    if (entry->key.source() == source) keys.push_back(entry->key);
  for (PieceKey key : keys) drop(key);
  collect();
}

bool PieceStore::is_fresh(PieceKey key, double now) const {
  auto found = entries_.find(key.bits);
  return found != entries_.end() && now < found->second->soft && now < found->second->hard;
}

void PieceStore::hold(const std::vector<Wish>& wishes, int change) {
  for (const Wish& wish : wishes) {
    auto held = held_.try_emplace(wish.key.bits).first;
    held->second[size_t(wish.urgency)] += change;
    if (held->second == std::array<int, urgency_count>{}) held_.erase(held);
  }
}

// Lists what of the client's wishes is not there, or not good for much longer.
void PieceStore::queue(Client& client, double now) {
  for (auto& waiting : client.waiting) waiting.clear();
  for (const Wish& wish : client.wishes)
    if (sources_[size_t(wish.key.source())].source && !is_fresh(wish.key, now) &&
        !under_way_.contains(wish.key.bits))
      client.waiting[size_t(wish.urgency)].push_back(wish.key);
}

void PieceStore::queue_again(double now) {
  if (now < queued_at_ + queue_again_after) return;
  queued_at_ = now;
  for (auto& [whose, client] : clients_) queue(client, now);
}

PieceClient::PieceClient(std::shared_ptr<PieceStore> store) : store_(std::move(store)) {
  std::lock_guard lock(store_->mutex_);
  store_->clients_[this];
}

PieceClient::~PieceClient() {
  std::lock_guard lock(store_->mutex_);
  auto found = store_->clients_.find(this);
  store_->hold(found->second.wishes, -1);
  store_->clients_.erase(found);
}

void PieceClient::want(std::vector<Wish> wishes) {
  {
    std::lock_guard lock(store_->mutex_);
    PieceStore::Client& asking = store_->clients_[this];
    store_->hold(wishes, 1);
    store_->hold(asking.wishes, -1);
    asking.wishes = std::move(wishes);
    store_->queue(asking, store_->clock_());
    store_->wants_++;
    store_->fit_detail();
  }
  store_->wanted_.notify_all();
}

void PieceClient::fetch() const {
  // Pieces that do not fit are tried once, and not waited for.
  auto is_tried = [&] {
    std::lock_guard lock(store_->mutex_);
    const PieceStore::Client& client = store_->clients_.at(this);
    return client.waiting[size_t(Urgency::shown)].empty() &&
           std::ranges::none_of(client.wishes, [&](const Wish& wish) {
             return store_->under_way_.contains(wish.key.bits);
           });
  };
  while (!is_tried())
    if (!store_->fetch_next()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

// Finds whether all that is shown fits into the budget, with a tenth to spare.
void PieceStore::fit_detail() {
  constexpr size_t usual_bytes = 256 * 256 * 4;  // a piece's that has not come yet
  size_t shown = 0;
  there_ = {};
  for (const auto& [bits, held] : held_) {
    auto found = entries_.find(bits);
    const bool is_there = found != entries_.end();
    PieceKey key;
    key.bits = bits;
    if (is_there) there_[size_t(rank_of(key))] += found->second->bytes;
    if (held[size_t(Urgency::shown)] > 0) shown += is_there ? found->second->bytes : usual_bytes;
  }
  // Without that, what was shown more coarsely would be as much more.
  const float had = std::exp2(2 * coarser());
  const float over = had * float(shown) / (0.9f * float(std::max<size_t>(budget_, 1)));
  coarser_.store(over > 1 ? std::min(0.5f * std::log2(over), 8.0f) : 0, std::memory_order_relaxed);
}

// Takes the next piece to fetch: by urgency, and among clients whoever was served longest ago.
bool PieceStore::choose(Job& job) {
  queue_again(clock_());
  for (int urgency = 0; urgency < urgency_count; urgency++) {
    // Nothing is fetched for which there is no place beside what is as urgent or more.
    size_t kept = 0;
    for (int i = 0; i <= urgency; i++) kept += there_[size_t(i)];
    if (Urgency(urgency) != Urgency::shown && kept > budget_ - budget_ / 8) break;
    std::vector<Client*> order;
    for (auto& [whose, client] : clients_)
      if (!client.waiting[size_t(urgency)].empty()) order.push_back(&client);
    std::sort(order.begin(), order.end(),
              [](const Client* a, const Client* b) { return a->served < b->served; });
    for (Client* client : order) {
      auto& waiting = client->waiting[size_t(urgency)];
      for (auto key = waiting.begin(); key != waiting.end();) {
        Source& from = sources_[size_t(key->source())];
        if (!from.source || under_way_.contains(key->bits) || is_fresh(*key, clock_())) {
          key = waiting.erase(key);
          continue;
        }
        if (from.under_way >= most_of_a_source_) {
          ++key;
          continue;
        }
        job = {*key, from.source, from.made};
        waiting.erase(key);
        client->served = ++turn_;
        from.under_way++;
        under_way_.insert(job.key.bits);
        return true;
      }
    }
  }
  return false;
}

bool PieceStore::fetch_next() {
  Job job;
  {
    std::lock_guard lock(mutex_);
    if (!choose(job)) return false;
  }
  const double began = clock_();
  Fetched fetched;
  std::string error;
  try {
    fetched = job.source->fetch(job.key);
  } catch (const LoadError& wrong) {
    error = wrong.what();
  } catch (const std::exception& wrong) {
    error = std::string("a piece cannot be fetched: ") + wrong.what();
  }
  std::lock_guard lock(mutex_);
  stats_.fetch_seconds += clock_() - began;
  under_way_.erase(job.key.bits);
  Source& source = sources_[size_t(job.key.source())];
  source.under_way--;
  if (!source.source || source.made != job.made) return true;
  const double now = clock_();
  if (!error.empty()) {
    stats_.failed++;
    stats_.last_error = error;
    auto old = entries_.find(job.key.bits);
    if (old != entries_.end() && old->second->piece && now < old->second->hard) {
      old->second->soft = now + failed_for;
      return true;
    }
    fetched = {nullptr, failed_for, failed_for};
  }
  insert(job.key, std::move(fetched));
  return true;
}

// Returns the greatest urgency with which anybody lists a piece, as a number; nobody: one more.
int PieceStore::rank_of(PieceKey key) const {
  auto held = held_.find(key.bits);
  if (held == held_.end()) return urgency_count;
  int rank = 0;
  while (rank < urgency_count && held->second[size_t(rank)] <= 0) rank++;
  return rank;
}

// Drops the least urgent pieces, first those that were looked at longest ago, until `bytes` more
// fit. More urgent ones stay. False: there is no place.
bool PieceStore::make_room(size_t bytes, int rank) {
  if (stats_.bytes + bytes <= budget_) return true;
  struct Candidate {
    int rank;
    double used;
    PieceKey key;
    size_t bytes;
  };
  std::vector<Candidate> candidates;
  for (const auto& [bits, entry] : entries_) {
    const int of = rank_of(entry->key);
    if (of >= rank) candidates.push_back({of, entry->used.load(), entry->key, entry->bytes});
  }
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return a.rank != b.rank ? a.rank > b.rank : a.used < b.used;
  });
  // A sixteenth more than is asked for, so that the next pieces do not sort everything again.
  const size_t wanted = std::min(bytes + budget_ / 16, budget_);
  for (const Candidate& c : candidates) {
    const bool enough = stats_.bytes + bytes <= budget_;
    if (stats_.bytes + wanted <= budget_ || (enough && c.rank < urgency_count)) break;
    drop(c.key);
    stats_.dropped++;
  }
  return stats_.bytes + bytes <= budget_;
}

void PieceStore::drop(PieceKey key) {
  auto found = entries_.find(key.bits);
  if (found == entries_.end()) return;
  Slot* slots = slots_of(key);
  for (int i = 0; i < ways; i++)
    if (slots[i].entry.load() == found->second.get()) {
      slots[i].key.store(0);
      slots[i].entry.store(nullptr);
    }
  stats_.bytes -= found->second->bytes;
  if (const int rank = rank_of(key); rank < urgency_count)
    there_[size_t(rank)] -= std::min(there_[size_t(rank)], found->second->bytes);
  retired_.emplace_back(std::move(found->second), epoch_.fetch_add(1) + 1);
  entries_.erase(found);
}

// Frees what no reader can have found.
void PieceStore::collect() {
  uint64_t oldest = ~uint64_t(0);
  for (const Reading& reading : reading_)
    if (uint64_t epoch = reading.epoch.load()) oldest = std::min(oldest, epoch);
  std::erase_if(retired_, [&](const auto& retired) { return retired.second <= oldest; });
}

void PieceStore::insert(PieceKey key, Fetched fetched) {
  const double now = clock_();
  // A piece that was fetched again and is the same changes nothing for anybody.
  if (auto old = entries_.find(key.bits);
      old != entries_.end() && old->second->piece && fetched.piece && now < old->second->hard &&
      (old->second->piece == fetched.piece || old->second->piece->bytes == fetched.piece->bytes)) {
    old->second->soft = now + fetched.soft, old->second->hard = now + fetched.hard;
    stats_.fetched++;
    return;
  }
  auto entry = std::make_unique<Entry>();
  entry->key = key;
  entry->bytes = sizeof(Entry) + (fetched.piece ? fetched.piece->bytes.size() : 0);
  entry->soft = now + fetched.soft, entry->hard = now + fetched.hard;
  entry->used = now;
  entry->piece = std::move(fetched.piece);
  (entry->piece ? stats_.fetched : stats_.absent)++;
  const bool shows = entry->piece != nullptr;
  drop(key);
  const int rank = rank_of(key);
  if (!make_room(entry->bytes, rank)) {
    collect();
    return;
  }
  Slot* slots = slots_of(key);
  Slot* place = slots;
  for (int i = 0; i < ways; i++) {
    const Entry* there = slots[i].entry.load();
    const Entry* worst = place->entry.load();
    if (!worst) break;
    if (!there || there->used < worst->used) place = &slots[i];
  }
  if (const Entry* there = place->entry.load()) {
    drop(there->key);
    stats_.dropped++;
  }
  stats_.bytes += entry->bytes;
  if (rank < urgency_count) there_[size_t(rank)] += entry->bytes;
  place->entry.store(entry.get());
  place->key.store(key.bits);
  entries_[key.bits] = std::move(entry);
  collect();
  if (shows && held_.contains(key.bits))
    for (auto& [whose, client] : clients_)
      if (std::any_of(client.wishes.begin(), client.wishes.end(), [&](const Wish& wish) {
            return wish.key == key && wish.urgency == Urgency::shown;
          }))
        whose->arrivals_++;
}

StoreStats PieceStore::stats() const {
  std::lock_guard lock(mutex_);
  StoreStats stats = stats_;
  stats.pieces = int(entries_.size());
  stats.under_way = int(under_way_.size());
  stats.coarser = coarser();
  stats.looked = looked_, stats.looked_coarse = looked_coarse_;
  for (const auto& [whose, client] : clients_)
    for (const auto& waiting : client.waiting) stats.waiting += int(waiting.size());
  return stats;
}

void PieceStore::live(std::stop_token stop) {
  while (!stop.stop_requested()) {
    if (fetch_next()) continue;
    std::unique_lock lock(mutex_);
    const bool waits = std::any_of(clients_.begin(), clients_.end(), [](const auto& client) {
      return !client.second.wishes.empty();
    });
    const auto woken = [&, before = wants_] { return wants_ != before; };
    // Wishes are looked through now and then, since pieces expire.
    if (waits) wanted_.wait_for(lock, stop, std::chrono::milliseconds(100), woken);
    else wanted_.wait(lock, stop, woken);
  }
}

namespace {

std::atomic<size_t> shared_budget = size_t(256) << 20;
constexpr int shared_threads = 4;

}  // namespace

std::shared_ptr<PieceStore> shared_store() {
  static const auto store = std::make_shared<PieceStore>(shared_budget, shared_threads);
  return store;
}

void set_shared_budget(size_t bytes) { shared_budget = bytes; }

PieceReader::PieceReader(const PieceStore& store) : store_(store), now_(store.clock_()) {
  static std::atomic<uint32_t> threads = 0;
  thread_local const uint32_t first = threads.fetch_add(1);
  // The epoch is announced before anything is looked up: what is dropped afterwards is kept.
  for (uint32_t i = first;; i++) {
    std::atomic<uint64_t>& place = store.reading_[i % store.reading_.size()].epoch;
    uint64_t free = 0;
    if (!place.compare_exchange_strong(free, store.epoch_.load())) continue;
    reading_ = &place;
    return;
  }
}

PieceReader::~PieceReader() { reading_->store(0); }

const Piece* PieceReader::find(PieceKey key) const {
  const PieceStore::Slot* slots = store_.slots_of(key);
  for (int i = 0; i < PieceStore::ways; i++) {
    if (slots[i].key.load() != key.bits) continue;
    const PieceStore::Entry* entry = slots[i].entry.load();
    if (!entry || entry->key != key || now_ >= entry->hard.load(std::memory_order_relaxed))
      continue;
    if (entry->used.load(std::memory_order_relaxed) != now_)
      entry->used.store(now_, std::memory_order_relaxed);
    return entry->piece.get();
  }
  return nullptr;
}

}  // namespace wellspring::store
