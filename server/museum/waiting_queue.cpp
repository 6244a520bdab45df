// SPDX-License-Identifier: Apache-2.0
#include "museum/waiting_queue.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "wire/json.h"

namespace wellspring::museum {
namespace {

constexpr double heartbeat = 4;       // seconds, after which the same is told again
constexpr double tell_interval = 2;   // seconds
constexpr double turns_kept = 600;    // seconds that a turn tells how long the next will take
constexpr double least_seconds = 10;  // since the first turn, that tell anything
constexpr size_t turns_counted = 16;

// Pictures of the same shape with no more pixels.
void ask_for_less(Newcomer& who, double pixels) {
  Hello hello = *said_as<Hello>(who.hello);
  const double scale = std::sqrt(pixels / (double(hello.width) * hello.height));
  hello.width = std::max(min_side, int(hello.width * scale));
  hello.height = std::max(min_side, int(hello.height * scale));
  who.hello = hear_visitor(write_message(hello));
  who.size.pixels = pixels;
}

}  // namespace

void WaitingQueue::join(Newcomer newcomer, double now) {
  Waiting& one = all_.emplace_back();
  one.who = std::move(newcomer);
  one.number = ++joined_;
  one.since = now;
}

bool WaitingQueue::listen(Waiting& one) {
  Newcomer& who = one.who;
  if (who.link->closed()) return false;
  for (Heard& heard : who.link->take_heard()) {
    if (said_as<Bye>(heard)) {
      who.link->close("bye");
      return false;
    }
    if (const Hello* hello = said_as<Hello>(heard)) {
      who.size = {double(hello->width) * hello->height, hello->display == "local"};
      who.hello = std::move(heard);
    }
  }
  return true;
}

void WaitingQueue::order(double now, const Capacity& capacity) {
  std::ranges::sort(all_, {}, &Waiting::number);
  std::map<std::string, int> rounds;  // of the next one of each address
  for (Waiting& one : all_) {
    const std::string& address = one.who.link->address;
    if (address.empty()) continue;  // shares with nobody
    const auto [next, is_first] = rounds.try_emplace(address, capacity.seats_of(address));
    one.round = is_first && now - one.since > patience ? 0 : next->second;
    next->second++;
  }
  std::ranges::stable_sort(all_, {}, &Waiting::round);
}

std::vector<Newcomer> WaitingQueue::let_in(double now, Capacity& capacity) {
  std::erase_if(all_, [&](Waiting& one) { return !listen(one); });
  order(now, capacity);
  std::vector<Newcomer> in;
  for (Waiting& one : all_) {
    Newcomer& who = one.who;
    const std::string& address = who.link->address;
    const bool local = who.size.local;
    who.seat = capacity.find_seat({std::min(who.size.pixels, most_pixels_), local}, address);
    if (!who.seat && now - one.since > patience && who.size.pixels > small_pixels) {
      who.seat = capacity.find_seat({small_pixels, local}, address);
      if (who.seat) ask_for_less(who, small_pixels);
    }
    if (!who.seat) continue;
    turns_.push_back(now);
    if (turns_.size() > turns_counted) turns_.pop_front();
    in.push_back(std::move(who));
  }
  std::erase_if(all_, [](const Waiting& one) { return !one.who.link; });
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

}  // namespace wellspring::museum
