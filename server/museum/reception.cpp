// SPDX-License-Identifier: Apache-2.0
#include "museum/reception.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <utility>

#include "base/clock.h"
#include "show/answer/cameras.h"
#include "wire/json.h"

namespace wellspring::museum {
namespace {

constexpr double heartbeat = 4;       // seconds after which an unchanged place is sent again
constexpr double tell_interval = 2;   // seconds
constexpr double turns_kept = 600;    // seconds for which a turn counts in the estimate
constexpr double least_seconds = 10;  // least seconds since the first turn for an estimate
constexpr size_t turns_counted = 16;

// Changes the newcomer's hello to pictures of the same shape with no more than `pixels` pixels.
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
  std::map<std::string, int> rounds;  // round of the next visitor of each address
  for (Waiting& one : all_) {
    const std::string& address = one.who.link->address;
    if (address.empty()) continue;  // an unknown address shares with nobody
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

// Estimates the wait from the mean time that the last turns took.
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

namespace {

using Clock = std::chrono::steady_clock;

// Between looks at links that have said nothing yet.
constexpr auto look_interval = std::chrono::milliseconds(5);
// Between looks at links that wait or rest.
constexpr auto queue_interval = std::chrono::milliseconds(50);

// Returns whether the message shows that somebody is at the page; pages send the others by
// themselves.
bool tells_of_somebody(const BrowserMessage& message) {
  if (const PresenceNews* news = std::get_if<PresenceNews>(&message)) return news->here;
  return !std::holds_alternative<Settings>(message) && !std::holds_alternative<Ack>(message) &&
         !std::holds_alternative<KioskTouch>(message) && !std::holds_alternative<Bye>(message);
}

}  // namespace

int find_door(const std::vector<ExhibitDoor>& doors, const Heard& first) {
  std::string kiosk;
  if (const Observation* observation = std::get_if<Observation>(&first.said)) {
    kiosk = observation->kiosk;
  } else if (const Hello* hello = said_as<Hello>(first)) {
    if (!hello->exhibit.empty()) {
      auto found = std::ranges::find(doors, hello->exhibit, &ExhibitDoor::id);
      return found == doors.end() ? -1 : int(found - doors.begin());
    }
    kiosk = hello->kiosk;
  }
  for (size_t i = 0; i < doors.size() && !kiosk.empty(); i++)
    if (std::ranges::find(doors[i].kiosks, kiosk) != doors[i].kiosks.end()) return int(i);
  return 0;
}

Reception::Reception(std::vector<ExhibitDoor> doors, std::shared_ptr<Capacity> capacity,
                     const ReceptionSettings& settings)
    : doors_(std::move(doors)),
      capacity_(std::move(capacity)),
      settings_(settings),
      queue_(settings.most_waiting, settings.most_pixels) {}

void Reception::turn_away(Link& link) {
  turned_away_++;
  link.send_text(
      write_error({"full", "as many wait as there is room for; please come back in a moment"}));
  link.close("full");
}

void Reception::enter(std::shared_ptr<Link> link) {
  {
    std::lock_guard lock(mutex_);
    if (strangers_.size() >= settings_.most_strangers) return turn_away(*link);
    strangers_.push_back(std::move(link));
  }
  somebody_.notify_one();
}

void Reception::rest(std::shared_ptr<Link> link) {
  std::lock_guard lock(mutex_);
  auto hello = link->first_heard();
  if (!hello) return;
  link->drop_first_heard();
  if (resting_.size() >= settings_.most_resting) {
    turn_away(*resting_.front().link);
    resting_.erase(resting_.begin());
  }
  resting_.push_back({std::move(link), std::move(*hello)});
}

// Puts a visitor into the exhibit, or into the queue; false: the queue is full. Takes the hello
// that receive() has taken from the link.
bool Reception::place(std::shared_ptr<Link>& link, Heard heard, size_t door,
                      std::vector<Shown>& ready) {
  const Hello& hello = *said_as<Hello>(heard);
  const double pixels = std::min(double(hello.width) * hello.height, settings_.most_pixels);
  const SeatSize size(pixels, hello.display == "local");
  std::unique_ptr<Seat> seat;
  if (hello.role == "kiosk" || hello.wall) seat = capacity_->give_seat(size);
  else if (queue_.size() == 0) seat = capacity_->find_seat(size, link->address);
  if (seat) {
    link->put_back(std::move(heard));
    ready.push_back({door, std::move(link), std::move(seat)});
    return true;
  }
  if (queue_.full()) return false;
  queue_.join({std::move(link), std::move(heard), door, size, {}}, seconds_now());
  return true;
}

// Reads a stranger's first messages. False: the link stays among strangers.
bool Reception::receive(const std::shared_ptr<Link>& stranger, std::vector<Shown>& ready) {
  std::shared_ptr<Link> link = stranger;
  if (link->closed()) return true;
  while (auto heard = link->first_heard()) {
    const int door = find_door(doors_, *heard);
    if (link->kind == LinkKind::eye) {
      ready.push_back({size_t(door), std::move(link), {}});
      return true;
    }
    link->drop_first_heard();
    if (const WireError* wrong = std::get_if<WireError>(&heard->said)) {
      link->send_text(write_error(*wrong));
      continue;
    }
    if (said_as<Bye>(*heard)) {
      link->close("bye");
      return true;
    }
    const Hello* hello = said_as<Hello>(*heard);
    std::string kiosk;
    const auto distrusted =
        hello ? check_page(settings_.kiosk_tokens, *link, *hello, kiosk) : std::nullopt;
    if (!hello) {
      link->send_text(write_error({"hello_first", "the first message must be hello"}));
    } else if (distrusted) {
      link->send_text(write_error(*distrusted));
    } else if (door < 0) {
      link->send_text(
          write_error({"unknown_exhibit", "there is no exhibit '" + hello->exhibit + "' here"}));
    } else {
      if (!place(link, std::move(*heard), size_t(door), ready)) turn_away(*link);
      return true;
    }
  }
  return false;
}

void Reception::look_at_resting() {
  std::erase_if(resting_, [&](Resting& one) {
    if (one.link->closed()) return true;
    for (Heard& heard : one.link->take_heard()) {
      const BrowserMessage* message = std::get_if<BrowserMessage>(&heard.said);
      if (!message) continue;
      if (said_as<Bye>(heard)) {
        one.link->close("bye");
        return true;
      }
      if (!tells_of_somebody(*message)) continue;
      one.link->put_back(said_as<Hello>(heard) ? std::move(heard) : std::move(one.hello));
      strangers_.push_back(std::move(one.link));
      return true;
    }
    return false;
  });
}

std::vector<Reception::Shown> Reception::find_ready(double now) {
  std::vector<Shown> ready;
  const bool looks = now - looked_at_ >= std::chrono::duration<double>(queue_interval).count();
  if (looks) looked_at_ = now, look_at_resting();
  const uint64_t joined = queue_.joined();
  std::erase_if(strangers_,
                [&](const std::shared_ptr<Link>& link) { return receive(link, ready); });
  if (looks || queue_.joined() != joined)
    for (Newcomer& who : queue_.let_in(now, *capacity_)) {
      who.link->put_back(std::move(who.hello));
      ready.push_back({who.door, std::move(who.link), std::move(who.seat)});
    }
  queue_.tell_places(now);
  return ready;
}

std::vector<Reception::Shown> Reception::show_in(double seconds) {
  const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                      std::chrono::duration<double>(seconds));
  std::unique_lock lock(mutex_);
  for (;;) {
    std::vector<Shown> ready = find_ready(seconds_now());
    if (!ready.empty() || Clock::now() >= end) return ready;
    auto until = end;
    if (!strangers_.empty()) until = Clock::now() + look_interval;
    else if (queue_.size() > 0 || !resting_.empty()) until = Clock::now() + queue_interval;
    somebody_.wait_until(lock, std::min(end, until));
  }
}

Reception::Standing Reception::standing() const {
  std::lock_guard lock(mutex_);
  return {queue_.size(), resting_.size(), turned_away_};
}

}  // namespace wellspring::museum
