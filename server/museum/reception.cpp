// SPDX-License-Identifier: Apache-2.0
#include "museum/reception.h"

#include <algorithm>
#include <chrono>

#include "wire/json.h"

namespace wellspring {

namespace {

using Clock = std::chrono::steady_clock;

constexpr auto look_interval = std::chrono::milliseconds(5);  // at those who wait

}  // namespace

void turn_away(Link& link) {
  link.send_text(
      write_error({"full",
                   "this museum has as many visitors as it can serve; please come back in a "
                   "moment"}));
  link.close("full");
}

int find_door(const std::vector<ExhibitDoor>& doors, LinkKind kind, const std::string& first_text) {
  std::string kiosk;
  if (kind == LinkKind::eye) {
    auto said = read_observation(first_text);
    if (const Observation* observation = std::get_if<Observation>(&said))
      kiosk = observation->kiosk;
  } else {
    auto said = read_browser_message(first_text);
    const BrowserMessage* message = std::get_if<BrowserMessage>(&said);
    const Hello* hello = message ? std::get_if<Hello>(message) : nullptr;
    if (hello && !hello->exhibit.empty()) {
      auto found = std::ranges::find(doors, hello->exhibit, &ExhibitDoor::id);
      return found == doors.end() ? -1 : int(found - doors.begin());
    }
    if (hello) kiosk = hello->kiosk;
  }
  for (size_t i = 0; i < doors.size() && !kiosk.empty(); i++)
    if (std::ranges::find(doors[i].kiosks, kiosk) != doors[i].kiosks.end()) return int(i);
  return 0;
}

void Reception::enter(std::shared_ptr<Link> link) {
  {
    std::lock_guard lock(mutex_);
    if (waiting_.size() >= most_waiting_) {
      turn_away(*link);
      return;
    }
    waiting_.push_back(std::move(link));
  }
  somebody_.notify_one();
}

std::vector<Reception::Shown> Reception::find_ready() {
  std::vector<Shown> ready;
  std::erase_if(waiting_, [&](std::shared_ptr<Link>& link) {
    if (link->closed()) return true;
    while (auto text = link->first_text()) {
      const int door = find_door(doors_, link->kind, *text);
      if (door >= 0) {
        ready.push_back({size_t(door), std::move(link)});
        return true;
      }
      link->drop_first_text();
      link->send_text(write_error({"unknown_exhibit", "there is no such exhibit here"}));
    }
    return false;
  });
  return ready;
}

std::vector<Reception::Shown> Reception::show_in(double seconds) {
  const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                      std::chrono::duration<double>(seconds));
  std::unique_lock lock(mutex_);
  for (;;) {
    std::vector<Shown> ready = find_ready();
    if (!ready.empty() || Clock::now() >= end) return ready;
    if (waiting_.empty()) somebody_.wait_until(lock, end);
    else somebody_.wait_until(lock, std::min(end, Clock::now() + look_interval));
  }
}

}  // namespace wellspring
