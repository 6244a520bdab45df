// SPDX-License-Identifier: Apache-2.0
#include "museum/waiting_queue.h"

#include <algorithm>

#include "wire/json.h"

namespace wellspring {
namespace {

constexpr double heartbeat = 4;       // seconds, after which the same is told again
constexpr double tell_interval = 2;   // seconds
constexpr double turns_kept = 600;    // seconds that a turn tells how long the next will take
constexpr double least_seconds = 10;  // since the first turn, that tell anything
constexpr size_t turns_counted = 16;

}  // namespace

size_t WaitingQueue::size_of(size_t door) const {
  return size_t(
      std::ranges::count_if(all_, [&](const Waiting& one) { return one.who.door == door; }));
}

void WaitingQueue::join(Newcomer newcomer) { all_.push_back({std::move(newcomer), {}, 0}); }

bool WaitingQueue::listen(Waiting& one) {
  Newcomer& who = one.who;
  if (who.link->closed()) return false;
  for (Heard& heard : who.link->take_heard()) {
    if (said_as<Bye>(heard)) {
      who.link->close("bye");
      return false;
    }
    if (const Hello* hello = said_as<Hello>(heard)) {
      who.pixels = double(hello->width) * hello->height;
      who.hello = std::move(heard);
    }
  }
  return true;
}

std::vector<Newcomer> WaitingQueue::let_in(
    double now, const std::function<std::unique_ptr<Seat>(const Newcomer&)>& find_seat) {
  std::erase_if(all_, [&](Waiting& one) { return !listen(one); });
  std::vector<Newcomer> in;
  while (!all_.empty()) {
    Newcomer& who = all_.front().who;
    who.seat = find_seat(who);
    if (!who.seat) break;
    in.push_back(std::move(who));
    all_.pop_front();
    turns_.push_back(now);
    if (turns_.size() > turns_counted) turns_.pop_front();
  }
  while (!turns_.empty() && now - turns_.front() > turns_kept) turns_.pop_front();
  return in;
}

// As long a time for each as the last ones took.
std::optional<double> WaitingQueue::seconds_for(size_t place, double now) const {
  if (turns_.empty() || now - turns_.front() < least_seconds) return {};
  return double(place) * (now - turns_.front()) / double(turns_.size());
}

void WaitingQueue::tell_places(double now) {
  for (size_t i = 0; i < all_.size(); i++) {
    Waiting& one = all_[i];
    const WaitingPlace place{i + 1, all_.size(), seconds_for(i + 1, now)};
    if (one.told) {
      const bool news = one.told->place != place.place || one.told->of != place.of;
      if (now - one.told_at < (news ? tell_interval : heartbeat)) continue;
    }
    one.told = place;
    one.told_at = now;
    one.who.link->send_text(write_waiting(place));
  }
}

}  // namespace wellspring
