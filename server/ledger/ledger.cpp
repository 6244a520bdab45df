// SPDX-License-Identifier: Apache-2.0
#include "ledger/ledger.h"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

#include "base/log.h"
#include "ledger/sums.h"

namespace wellspring::ledger {

static constexpr int64_t first_day = 18262;  // 2020-01-01

struct Ledger::Impl {
  const LedgerSettings settings;
  mutable std::mutex mutex;  // guards the next fields
  std::condition_variable changed;
  Sums waiting, undated;
  std::string problem;
  int64_t last_day = 0;
  bool hurry = false, end = false;
  mutable std::mutex file;  // held while the file is used; taken before `mutex`
  std::thread thread;

  explicit Impl(LedgerSettings given) : settings(std::move(given)) {
    thread = std::thread([this] { live(); });
  }
  ~Impl() {
    {
      std::lock_guard lock(mutex);
      end = true;
    }
    changed.notify_all();
    thread.join();
    if (!write()) log::error("the last sums are lost");
    if (!undated.empty()) log::error("sums are lost, as the clock was never set");
  }

  void live() {
    std::unique_lock lock(mutex);
    while (!end) {
      changed.wait_for(lock, std::chrono::duration<double>(settings.seconds),
                       [this] { return end || hurry; });
      if (end) return;  // the destructor writes the rest
      hurry = false;
      lock.unlock();
      write();
      lock.lock();
    }
  }

  bool write() {
    std::lock_guard use(file);
    Sums sums;
    {
      std::lock_guard lock(mutex);
      sums.swap(waiting);
    }
    if (sums.empty()) return true;
    std::string wrong;
    try {
      add_to_file(settings.file, sums, settings.patience);
    } catch (const std::exception& error) {
      wrong = error.what();
    }
    std::lock_guard lock(mutex);
    if (!wrong.empty()) wellspring::ledger::add(waiting, sums);  // they wait for the next write
    if (!wrong.empty() && problem.empty()) log::warn("sums cannot be written: {}", wrong);
    if (wrong.empty() && !problem.empty()) log::info("sums are written again");
    problem = wrong;
    return wrong.empty();
  }
};

Ledger::Ledger(LedgerSettings settings) : impl_(std::make_unique<Impl>(std::move(settings))) {}
Ledger::~Ledger() = default;

void Ledger::add(const Sums& sums) {
  if (sums.empty()) return;
  {
    std::lock_guard lock(impl_->mutex);
    const int64_t day = sums.rbegin()->first.day;
    for (const auto& [key, value] : sums)
      (key.day < first_day ? impl_->undated : impl_->waiting)[key] += value;
    if (day < first_day) return;
    for (const auto& [key, value] : std::exchange(impl_->undated, {}))
      impl_->waiting[{day, key.what, key.key}] += value;
    impl_->hurry |= impl_->last_day != 0 && day > impl_->last_day;
    impl_->last_day = std::max(impl_->last_day, day);
    if (!impl_->hurry) return;
  }
  impl_->changed.notify_all();
}

bool Ledger::write() { return impl_->write(); }

Sums Ledger::read(int64_t from, int64_t to) const {
  std::lock_guard use(impl_->file);  // now no sums are between memory and the file
  Sums sums = read_from_file(impl_->settings.file, from, to, impl_->settings.patience);
  std::lock_guard lock(impl_->mutex);
  for (const auto& [key, value] : impl_->waiting)
    if (key.day >= from && key.day <= to) sums[key] += value;
  return sums;
}

std::string Ledger::problem() const {
  std::lock_guard lock(impl_->mutex);
  return impl_->problem;
}

}  // namespace wellspring::ledger
