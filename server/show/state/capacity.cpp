// SPDX-License-Identifier: Apache-2.0
#include "show/state/capacity.h"

#include <algorithm>
#include <thread>

#include "base/memory.h"

namespace wellspring::show {
namespace {

constexpr double usable = 0.85;  // share of the cores; sockets, ticks and the system take the rest
// keyframes a second for each visitor, the floor under load, at most
constexpr double keyframe_rate = 3;
constexpr double local_rate = 2;  // likewise for pages that draw by themselves in between
// cost then, over that of a keyframe of full resolution with its samples
constexpr double keyframe_cost = 0.5;
constexpr double fixed_pixels = 30e3;
constexpr double bytes_a_pixel = 64, fixed_bytes = 1e6;
// A newcomer from an address that has no seat may take this share of the cores beyond all of them.
// Everybody then has so much less.
constexpr double spare_cores = 0.25;
constexpr double kept_memory = 1.0 / 8;  // share of the memory, for such newcomers
constexpr int kept_seats = 8;            // one seat in so many is for such newcomers
constexpr int guessed = 30;              // number of pictures that the first guess counts for
constexpr int remembered = 400;          // number of pictures that the mean goes over

}  // namespace

double cores_a_pixel(const PictureCost& cost, double rate, bool local) {
  if (local) return std::min(local_rate, rate) * (keyframe_cost * cost.drawn + cost.sent);
  return rate * cost.shown + std::min(keyframe_rate, rate) * keyframe_cost * cost.drawn;
}

double weighed_pixels(double pixels) { return pixels + fixed_pixels; }

double visitor_bytes(double pixels) { return bytes_a_pixel * pixels + fixed_bytes; }

Seat::~Seat() {
  std::lock_guard lock(capacity_->mutex_);
  capacity_->add(size_, address_, -1);
}

bool Seat::resize(SeatSize size) {
  std::lock_guard lock(capacity_->mutex_);
  if (size.pixels > size_.pixels && !always_ && !capacity_->may_grow(*this, size)) return false;
  capacity_->add(size_, address_, -1);
  capacity_->add(size, address_, 1);
  size_ = size;
  return true;
}

Capacity::Capacity(const CapacitySettings& settings)
    : settings_(settings),
      cores_(usable * (settings.cores > 0 ? settings.cores
                                          : std::max(1u, std::thread::hardware_concurrency()))),
      memory_(settings.memory > 0 ? settings.memory : memory_share * usable_memory()) {}

void Capacity::Measured::note(double sample) {
  count = std::min(count + 1, remembered);
  value += (sample - value) / std::min(guessed + count, remembered);
}

void Capacity::note_shown(double pixels, double seconds) {
  std::lock_guard lock(mutex_);
  shown_.note(seconds / weighed_pixels(pixels));
}

void Capacity::note_drawn(double pixels, double seconds) {
  std::lock_guard lock(mutex_);
  drawn_.note(seconds / weighed_pixels(pixels));
}

void Capacity::note_sent(double pixels, double seconds) {
  std::lock_guard lock(mutex_);
  sent_.note(seconds / weighed_pixels(pixels));
}

void Capacity::Part::add(SeatSize size, int count) {
  seats += count;
  (size.local ? local_weight : shown_weight) += count * weighed_pixels(size.pixels);
  bytes += count * visitor_bytes(size.pixels);
}

void Capacity::add(SeatSize size, const std::string& address, int count) {
  all_.add(size, count);
  if (address.empty()) return;
  const auto part = parts_.try_emplace(address).first;
  part->second.add(size, count);
  if (part->second.seats == 0) parts_.erase(part);
}

double Capacity::cores_of(const Part& part) const {
  return cores_a_pixel(cost(), settings_.rate, false) * part.shown_weight +
         cores_a_pixel(cost(), settings_.rate, true) * part.local_weight;
}

double Capacity::cores_of(SeatSize size) const {
  return cores_a_pixel(cost(), settings_.rate, size.local) * weighed_pixels(size.pixels);
}

// Returns the cores that visitors take. For a newcomer from an address without seats, no other
// address counts for more than all the cores: the first visitor of a slow machine may have taken
// more.
double Capacity::taken_cores(bool from_elsewhere) const {
  double most = 0;
  for (const auto& [address, part] : parts_) most = std::max(most, cores_of(part));
  return cores_of(all_) - (from_elsewhere ? std::max(0.0, most - cores_) : 0);
}

bool Capacity::fits(SeatSize size, const std::string& address) const {
  const auto part = parts_.find(address);
  const bool has_some = part != parts_.end(), from_elsewhere = !address.empty() && !has_some;
  if (all_.seats >= settings_.most) return false;
  if (has_some && part->second.seats >= settings_.most - settings_.most / kept_seats) return false;
  const double cores = cores_ * (from_elsewhere ? 1 + spare_cores : 1);
  const double memory = memory_ * (has_some ? 1 - kept_memory : 1);
  return taken_cores(from_elsewhere) + cores_of(size) <= cores &&
         all_.bytes + visitor_bytes(size.pixels) <= memory;
}

bool Capacity::may_grow(const Seat& seat, SeatSize size) const {
  if (all_.seats == 1) return true;
  const double memory = memory_ * (seat.address_.empty() ? 1 : 1 - kept_memory);
  return cores_of(all_) + cores_of(size) - cores_of(seat.size_) <= cores_ &&
         all_.bytes + visitor_bytes(size.pixels) - visitor_bytes(seat.size_.pixels) <= memory;
}

std::unique_ptr<Seat> Capacity::seat(SeatSize size, const std::string& address, bool always) {
  std::lock_guard lock(mutex_);
  if (!always && all_.seats > 0 && !fits(size, address)) return nullptr;
  add(size, address, 1);
  return std::unique_ptr<Seat>(new Seat(shared_from_this(), size, address, always));
}

std::unique_ptr<Seat> Capacity::find_seat(SeatSize size, const std::string& address) {
  return seat(size, address, false);
}

std::unique_ptr<Seat> Capacity::give_seat(SeatSize size) { return seat(size, {}, true); }

int Capacity::seats_of(const std::string& address) const {
  std::lock_guard lock(mutex_);
  const auto part = parts_.find(address);
  return part == parts_.end() ? 0 : part->second.seats;
}

int Capacity::seats_for(SeatSize size) const {
  std::lock_guard lock(mutex_);
  const double fit = std::min(cores_ / cores_of(size), memory_ / visitor_bytes(size.pixels));
  return int(std::clamp(fit, 1.0, double(std::max(settings_.most, 1))));
}

Capacity::Standing Capacity::standing() const {
  std::lock_guard lock(mutex_);
  return {all_.seats, cores_of(all_), cores_, all_.bytes, memory_, cost()};
}

}  // namespace wellspring::show
