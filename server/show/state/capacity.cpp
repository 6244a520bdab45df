// SPDX-License-Identifier: Apache-2.0
#include "show/state/capacity.h"

#include <algorithm>
#include <thread>

#include "base/memory_limit.h"

namespace wellspring {
namespace {

constexpr double usable = 0.85;        // of the cores: sockets, ticks and the system take the rest
constexpr double keyframe_rate = 3;    // a second for each visitor: the floor under load, at most
constexpr double keyframe_cost = 0.5;  // of one of full resolution, with its samples, then
constexpr double fixed_pixels = 30e3;
constexpr double bytes_a_pixel = 64, fixed_bytes = 1e6;
// This share of the cores is given beyond all of them to who comes from an address that has no
// seat. Everybody has so much less then.
constexpr double spare_cores = 0.25;
constexpr double kept_memory = 1.0 / 8;  // of the memory, for such newcomers
constexpr int kept_seats = 8;            // one in so many is for them
constexpr int guessed = 30;              // pictures that the first guess counts for
constexpr int remembered = 400;          // pictures that the mean goes over

}  // namespace

double cores_a_pixel(const PictureCost& cost, double rate) {
  return rate * cost.shown + std::min(keyframe_rate, rate) * keyframe_cost * cost.drawn;
}

double weighed_pixels(double pixels) { return pixels + fixed_pixels; }

double visitor_bytes(double pixels) { return bytes_a_pixel * pixels + fixed_bytes; }

Seat::~Seat() {
  std::lock_guard lock(capacity_->mutex_);
  capacity_->add(pixels_, address_, -1);
}

bool Seat::resize(double pixels) {
  std::lock_guard lock(capacity_->mutex_);
  if (pixels > pixels_ && !always_ && !capacity_->may_grow(*this, pixels)) return false;
  capacity_->add(pixels_, address_, -1);
  capacity_->add(pixels, address_, 1);
  pixels_ = pixels;
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

void Capacity::Part::add(double pixels, int count) {
  seats += count;
  weight += count * weighed_pixels(pixels);
  bytes += count * visitor_bytes(pixels);
}

void Capacity::add(double pixels, const std::string& address, int count) {
  all_.add(pixels, count);
  if (address.empty()) return;
  const auto part = parts_.try_emplace(address).first;
  part->second.add(pixels, count);
  if (part->second.seats == 0) parts_.erase(part);
}

double Capacity::each() const {
  return cores_a_pixel({shown_.value, drawn_.value}, settings_.rate);
}

// For who comes from an address without seats no other one counts for more than all the cores: the
// first visitor of a slow machine may have taken more.
double Capacity::taken_cores(bool from_elsewhere) const {
  double most = 0;
  for (const auto& [address, part] : parts_) most = std::max(most, each() * part.weight);
  return each() * all_.weight - (from_elsewhere ? std::max(0.0, most - cores_) : 0);
}

bool Capacity::fits(double pixels, const std::string& address) const {
  const auto part = parts_.find(address);
  const bool has_some = part != parts_.end(), from_elsewhere = !address.empty() && !has_some;
  if (all_.seats >= settings_.most) return false;
  if (has_some && part->second.seats >= settings_.most - settings_.most / kept_seats) return false;
  const double cores = cores_ * (from_elsewhere ? 1 + spare_cores : 1);
  const double memory = memory_ * (has_some ? 1 - kept_memory : 1);
  return taken_cores(from_elsewhere) + each() * weighed_pixels(pixels) <= cores &&
         all_.bytes + visitor_bytes(pixels) <= memory;
}

bool Capacity::may_grow(const Seat& seat, double pixels) const {
  if (all_.seats == 1) return true;
  const double memory = memory_ * (seat.address_.empty() ? 1 : 1 - kept_memory);
  return each() * (all_.weight + pixels - seat.pixels_) <= cores_ &&
         all_.bytes + visitor_bytes(pixels) - visitor_bytes(seat.pixels_) <= memory;
}

std::unique_ptr<Seat> Capacity::seat(double pixels, const std::string& address, bool always) {
  std::lock_guard lock(mutex_);
  if (!always && all_.seats > 0 && !fits(pixels, address)) return nullptr;
  add(pixels, address, 1);
  return std::unique_ptr<Seat>(new Seat(shared_from_this(), pixels, address, always));
}

std::unique_ptr<Seat> Capacity::find_seat(double pixels, const std::string& address) {
  return seat(pixels, address, false);
}

std::unique_ptr<Seat> Capacity::give_seat(double pixels) { return seat(pixels, {}, true); }

int Capacity::seats_of(const std::string& address) const {
  std::lock_guard lock(mutex_);
  const auto part = parts_.find(address);
  return part == parts_.end() ? 0 : part->second.seats;
}

int Capacity::seats_for(double pixels) const {
  std::lock_guard lock(mutex_);
  const double fit =
      std::min(cores_ / (each() * weighed_pixels(pixels)), memory_ / visitor_bytes(pixels));
  return int(std::clamp(fit, 1.0, double(std::max(settings_.most, 1))));
}

Capacity::Standing Capacity::standing() const {
  std::lock_guard lock(mutex_);
  const PictureCost cost{shown_.value, drawn_.value};
  return {all_.seats, each() * all_.weight, cores_, all_.bytes, memory_, cost};
}

}  // namespace wellspring
