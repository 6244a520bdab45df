// SPDX-License-Identifier: Apache-2.0
#include "show/state/capacity.h"

#include <algorithm>
#include <thread>

namespace wellspring {
namespace {

constexpr double usable = 0.85;        // of the cores: sockets, ticks and the system take the rest
constexpr double keyframe_rate = 3;    // a second for each visitor: the floor under load
constexpr double keyframe_cost = 0.5;  // of one of full resolution, with its samples, then
constexpr double fixed_pixels = 30e3;
constexpr int guessed = 30;      // pictures that the first guess counts for
constexpr int remembered = 400;  // pictures that the mean goes over

}  // namespace

double cores_a_pixel(const PictureCost& cost, double rate) {
  return rate * cost.shown + keyframe_rate * keyframe_cost * cost.drawn;
}

double weighed_pixels(double pixels) { return pixels + fixed_pixels; }

Seat::~Seat() { capacity_->weigh(-weight_, -1); }

void Seat::resize(double pixels) {
  const double weight = weighed_pixels(pixels);
  capacity_->weigh(weight - weight_, 0);
  weight_ = weight;
}

Capacity::Capacity(const CapacitySettings& settings)
    : settings_(settings),
      cores_(usable * (settings.cores > 0 ? settings.cores
                                          : std::max(1u, std::thread::hardware_concurrency()))) {}

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

void Capacity::weigh(double more, int seats) {
  std::lock_guard lock(mutex_);
  weight_ += more;
  seats_ += seats;
}

std::unique_ptr<Seat> Capacity::seat(double pixels, bool always) {
  const double weight = weighed_pixels(pixels);
  std::lock_guard lock(mutex_);
  const double each = cores_a_pixel({shown_.value, drawn_.value}, settings_.rate);
  const bool fits = seats_ < settings_.most && each * (weight_ + weight) <= cores_;
  if (!fits && !always && seats_ > 0) return nullptr;
  weight_ += weight;
  seats_++;
  return std::unique_ptr<Seat>(new Seat(shared_from_this(), weight));
}

std::unique_ptr<Seat> Capacity::find_seat(double pixels) { return seat(pixels, false); }

std::unique_ptr<Seat> Capacity::give_seat(double pixels) { return seat(pixels, true); }

int Capacity::seats_for(double pixels) const {
  std::lock_guard lock(mutex_);
  const double each = cores_a_pixel({shown_.value, drawn_.value}, settings_.rate);
  const double fit = cores_ / (each * weighed_pixels(pixels));
  return int(std::clamp(fit, 1.0, double(std::max(settings_.most, 1))));
}

Capacity::Standing Capacity::standing() const {
  std::lock_guard lock(mutex_);
  const PictureCost cost{shown_.value, drawn_.value};
  return {seats_, cores_a_pixel(cost, settings_.rate) * weight_, cores_, cost};
}

}  // namespace wellspring
