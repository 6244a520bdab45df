// SPDX-License-Identifier: Apache-2.0
#include "stream/admission.h"

#include <algorithm>

namespace wellspring::stream {

// Addresses without a connection are remembered for their rates until there are too many.
static constexpr size_t most_remembered = 16384;

Admission::Admission(const Limits& limits)
    : limits_(limits),
      reserve_(size_t(std::clamp(limits.reserve, 0, std::max(0, limits.connections / 4)))),
      all_requests_{limits.all_requests_a_second, limits.all_requests_at_once},
      all_frames_{limits.all_frames_a_second, limits.all_frames_at_once},
      all_bytes_{limits.all_bytes_a_second, limits.all_bytes_at_once} {}

Admission::Guest& Admission::guest(const Address& part) {
  auto found = guests_.find(part);
  if (found == guests_.end()) {
    if (guests_.size() >= most_remembered)
      std::erase_if(guests_, [](const auto& one) {
        return one.second.connections == 0 && one.second.websockets == 0;
      });
    found = guests_.emplace(part, Guest{}).first;
    Guest& made = found->second;
    made.new_connections = {limits_.new_connections_a_second, limits_.new_connections_at_once};
    made.requests = {limits_.requests_a_second, limits_.requests_at_once};
    made.frames = {limits_.frames_a_second, limits_.frames_at_once};
    made.bytes = {limits_.bytes_a_second, limits_.bytes_at_once};
  }
  return found->second;
}

void Admission::stop_waiting(Place& place) {
  if (place.waits == 0) return;
  queue_.erase(place.waits);
  if (const auto found = guests_.find(place.part); found != guests_.end())
    found->second.waiting.erase(place.waits);
  place.waits = 0;
}

std::optional<uint64_t> Admission::take_oldest(const std::set<uint64_t>& numbers) {
  if (numbers.empty()) return std::nullopt;
  const uint64_t id = queue_.at(*numbers.begin());
  stop_waiting(places_.at(id));
  return id;
}

std::optional<uint64_t> Admission::take_oldest() {
  if (queue_.empty()) return std::nullopt;
  const uint64_t id = queue_.begin()->second;
  stop_waiting(places_.at(id));
  return id;
}

Admission::Entry Admission::enter(uint64_t id, const Address& from, Standing standing, double now) {
  std::lock_guard lock(mutex_);
  Entry entry;
  const Address part = limited_part(from);
  const size_t all = size_t(std::max(0, limits_.connections));
  const size_t for_strangers = all - reserve_;
  if (standing == Standing::stranger) {
    Guest& one = guest(part);
    if (!one.new_connections.take(1, now)) return {Answer::too_many, {}, false};
    if (one.connections >= limits_.connections_an_address) {
      entry.drop = take_oldest(one.waiting);
      if (!entry.drop) return {Answer::too_many, {}, false};
    }
  }
  entry.reserved = standing != Standing::stranger && places_.size() >= for_strangers;
  // A connection that has been asked to end keeps its place for the moment that this takes.
  if (!entry.drop && places_.size() >= (standing == Standing::stranger ? for_strangers : all)) {
    entry.drop = take_oldest();
    if (!entry.drop) return {Answer::full, {}, false};
  }
  Place& place = places_[id] = {part, standing, 0};
  if (standing != Standing::stranger) return entry;
  guest(part).connections++;
  place.waits = next_number_++;
  queue_[place.waits] = id;
  guest(part).waiting.insert(place.waits);
  return entry;
}

void Admission::leave(uint64_t id) {
  std::lock_guard lock(mutex_);
  const auto found = places_.find(id);
  if (found == places_.end()) return;
  stop_waiting(found->second);
  if (found->second.standing == Standing::stranger)
    if (const auto one = guests_.find(found->second.part); one != guests_.end())
      one->second.connections--;
  places_.erase(found);
}

void Admission::begin_waiting(uint64_t id) {
  std::lock_guard lock(mutex_);
  const auto found = places_.find(id);
  if (found == places_.end() || found->second.standing != Standing::stranger) return;
  Place& place = found->second;
  if (place.waits != 0) return;
  place.waits = next_number_++;
  queue_[place.waits] = id;
  guests_.at(place.part).waiting.insert(place.waits);
}

void Admission::end_waiting(uint64_t id) {
  std::lock_guard lock(mutex_);
  if (const auto found = places_.find(id); found != places_.end()) stop_waiting(found->second);
}

Admission::Taken Admission::take_request(const Address& from, double now) {
  std::lock_guard lock(mutex_);
  if (!guest(limited_part(from)).requests.take(1, now)) return Taken::too_many;
  return all_requests_.take(1, now) ? Taken::yes : Taken::too_many_in_all;
}

Admission::Taken Admission::take_input(const Address& from, const WireInput& input, bool modest,
                                       double now) {
  std::lock_guard lock(mutex_);
  Guest& one = guest(limited_part(from));
  const bool own = one.frames.take(input.frames, now) && one.bytes.take(input.bytes, now);
  if (!own) return Taken::too_many;
  const bool all = all_frames_.take(input.frames, now) && all_bytes_.take(input.bytes, now);
  return all || modest ? Taken::yes : Taken::too_many_in_all;
}

Admission::Taken Admission::open_websocket(const Address& from, double now) {
  std::lock_guard lock(mutex_);
  Guest& one = guest(limited_part(from));
  if (one.websockets >= limits_.websockets_an_address) return Taken::too_many;
  if (!all_frames_.take(1, now)) return Taken::too_many_in_all;
  one.websockets++;
  return Taken::yes;
}

void Admission::close_websocket(const Address& from) {
  std::lock_guard lock(mutex_);
  if (const auto one = guests_.find(limited_part(from)); one != guests_.end())
    one->second.websockets--;
}

size_t Admission::connections() const {
  std::lock_guard lock(mutex_);
  return places_.size();
}

size_t Admission::addresses() const {
  std::lock_guard lock(mutex_);
  return guests_.size();
}

}  // namespace wellspring::stream
