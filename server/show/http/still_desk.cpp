// SPDX-License-Identifier: Apache-2.0
#include "show/http/still_desk.h"

#include <fmt/core.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <oneapi/tbb/info.h>
#include <utility>

#include "base/clock.h"
#include "base/log.h"

namespace wellspring::show {

namespace {

constexpr double look_every = 0.25;   // seconds: whether those who wait are still there
constexpr int low_priority = 10;      // priority of the threads: if cores are short, a tenth of one
constexpr float newest_share = 0.3f;  // weight of the last picture in the speed
constexpr double unknown_network = 4e5;  // pixels a second, until it was measured

void smooth_speed(double& speed, double measured) {
  speed = speed > 0 ? speed + double(newest_share) * (measured - speed) : measured;
}

StillOutcome refusal(int status, const char* code, std::string problem, double retry = 0) {
  return {.status = status,
          .code = code,
          .problem = std::move(problem),
          .retry_seconds = retry,
          .picture = {}};
}

StillOutcome stopped() { return refusal(503, "stopping", "the server stops", 5); }

bool all_gone(const std::vector<StillDesk::Asker>& askers) {
  return std::ranges::all_of(askers, [](const StillDesk::Asker& one) { return one.gone(); });
}

}  // namespace

StillDesk::StillDesk(const StillLimits& limits, std::function<bool()> busy)
    : limits_(limits), busy_(std::move(busy)) {
  all_.rate = limits.all_rate;
  all_.burst = limits.all_pictures * limits.most_seconds;
}

void StillDesk::close() {
  std::list<Ticket> left;
  {
    std::lock_guard lock(mutex_);
    closed_ = true;
    left.swap(waiting_);
  }
  changed_.notify_all();
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
  for (Ticket& ticket : left)
    for (Asker& asker : ticket.askers) asker.take(stopped());
}

void StillDesk::open() {
  std::lock_guard lock(mutex_);
  closed_ = false;
}

StillDesk::Speed StillDesk::speed_of(StillRoom& room) {
  std::lock_guard measuring(measuring_);
  {
    std::lock_guard lock(mutex_);
    if (const Speed& known = speeds_[&room]; known.samples > 0) return known;
  }
  StillJob job;
  job.width = 96, job.height = 54, job.spp = 2, job.denoise = false;
  const StillCosts costs = room.measure(job);
  const double samples = job.pixels() * costs.spp / std::max(costs.trace_seconds, 1e-4);
  std::lock_guard lock(mutex_);
  speeds_[&room] = {samples, room.denoises() ? unknown_network : 0};
  return speeds_[&room];
}

void StillDesk::learn(const Ticket& ticket, const StillCosts& costs) {
  Speed& speed = speeds_[ticket.room];
  if (costs.trace_seconds > 0)
    smooth_speed(speed.samples, ticket.job.pixels() * costs.spp / costs.trace_seconds);
  if (costs.denoise_seconds > 0)
    smooth_speed(speed.denoised, ticket.job.pixels() / costs.denoise_seconds);
  status_.samples_per_second = speed.samples;
}

RateBound& StillDesk::bound_of(const std::string& address) {
  if (addresses_.size() >= limits_.most_addresses && !addresses_.contains(address)) {
    const double now = seconds_now();
    std::erase_if(addresses_, [&](const auto& one) {
      const RateBound& bound = one.second;
      return bound.spent <= bound.rate * (now - bound.last_time);
    });
    if (addresses_.size() >= limits_.most_addresses) addresses_.erase(addresses_.begin());
  }
  RateBound& bound = addresses_[address];
  bound.rate = limits_.address_rate;
  bound.burst = limits_.address_pictures * limits_.most_seconds;
  return bound;
}

// `least`: what it would cost with one sample a pixel.
StillOutcome StillDesk::judge(double cost, double least, double pixels, RateBound& own) {
  if (least > limits_.most_seconds) {
    status_.too_dear++;
    return refusal(
        400, "too_much_work",
        fmt::format("one sample a pixel would take {:.0f} s of this machine, and {:.0f} s "
                    "are given to one picture: {} pixels would fit",
                    least, limits_.most_seconds, int64_t(pixels * limits_.most_seconds / least)));
  }
  if (waiting_.size() >= limits_.most_waiting) {
    status_.too_many++;
    return refusal(503, "too_busy", "too many pictures are waited for", 5);
  }
  const double now = seconds_now();
  const bool fits = own.take(cost, now);
  if (fits && all_.take(cost, now)) return {};
  status_.too_many++;
  if (fits) own.give_back(cost);
  return refusal(429, "too_many_pictures",
                 fits ? "too many pictures are asked for at the moment"
                      : "too many pictures were asked for from this address",
                 fits ? all_.wait_for(cost) : own.wait_for(cost));
}

void StillDesk::ask(StillRoom& room, const StillJob& wanted, Asker asker) {
  StillJob job = wanted;
  job.seconds = std::min(job.seconds, limits_.most_seconds);
  if (std::optional<StillPicture> found = room.find(job)) {
    {
      std::lock_guard lock(mutex_);
      status_.shared++;
    }
    return asker.take({.picture = std::move(*found)});
  }
  const Speed speed = speed_of(room);
  const double one = job.pixels() / speed.samples;
  const double denoise = job.denoise && speed.denoised > 0 ? job.pixels() / speed.denoised : 0;
  const double wished = job.spp > 0 ? one * job.spp : limits_.most_seconds;
  const double cost = denoise + std::max(one, std::min(wished, job.seconds - denoise));
  StillOutcome outcome;
  {
    std::lock_guard lock(mutex_);
    for (std::list<Ticket>* list : {&current_, &waiting_})
      for (Ticket& ticket : *list)
        if (ticket.room == &room && ticket.job == job) {
          status_.shared++;
          ticket.askers.push_back(std::move(asker));
          return;
        }
    outcome =
        closed_ ? stopped() : judge(cost, one + denoise, job.pixels(), bound_of(asker.address));
    if (outcome.status == 200) {
      Ticket& ticket = waiting_.emplace_back();
      ticket.room = &room, ticket.job = job;
      ticket.cost = cost, ticket.denoise_seconds = denoise, ticket.since = seconds_now();
      ticket.askers.push_back(std::move(asker));
      for (double most : {limits_.most_seconds, limits_.cheap_seconds})
        if (threads_.size() < 2) threads_.emplace_back([this, most] { live(most); });
    }
  }
  if (outcome.status == 200) changed_.notify_all();
  else asker.take(std::move(outcome));
}

void StillDesk::give_back(const Ticket& ticket, double seconds) {
  bound_of(ticket.askers.front().address).give_back(seconds);
  all_.give_back(seconds);
}

void StillDesk::drop_gone() {
  std::erase_if(waiting_, [&](const Ticket& ticket) {
    if (!all_gone(ticket.askers)) return false;
    status_.given_up++;
    give_back(ticket, ticket.cost);
    return true;
  });
}

// With the lock held, but for what takes long. False: there is none.
bool StillDesk::make_next(std::unique_lock<std::mutex>& lock, double most) {
  const double now = seconds_now();
  auto next = waiting_.end();
  const auto patience = [&](const Ticket& one) { return one.cost - (now - one.since); };
  for (auto one = waiting_.begin(); one != waiting_.end(); one++)
    if (one->cost <= most && (next == waiting_.end() || patience(*one) < patience(*next)))
      next = one;
  if (next == waiting_.end()) return false;
  current_.splice(current_.begin(), waiting_, next);
  Ticket& ticket = current_.front();
  lock.unlock();
  const int cores =
      busy_ && busy_() ? 1 : std::max(1, oneapi::tbb::info::default_concurrency() / 2);
  const auto given_up = [&] {
    std::lock_guard look(mutex_);
    return closed_ || all_gone(ticket.askers);
  };
  StillCosts costs;
  StillOutcome outcome;
  try {
    outcome.picture =
        ticket.room->make(ticket.job, given_up, cores, ticket.denoise_seconds, &costs);
  } catch (const std::exception& error) {
    log::error("still picture: {}", error.what());
    outcome = refusal(500, "internal", "the picture could not be made");
  }
  lock.lock();
  const Ticket done = std::move(ticket);
  current_.erase(next);
  give_back(done, done.cost - costs.trace_seconds - costs.denoise_seconds);
  if (outcome.status == 200 && outcome.picture.jpeg.empty()) {
    if (!closed_ && !all_gone(done.askers)) {  // somebody has just come
      waiting_.push_back(done);
      return true;
    }
    status_.given_up++;
    outcome = stopped();
  } else if (outcome.status == 200) {
    status_.made++;
    learn(done, costs);
  }
  lock.unlock();
  for (const Asker& asker : done.askers) asker.take(outcome);
  lock.lock();
  return true;
}

void StillDesk::live(double most) {
  setpriority(PRIO_PROCESS, 0, low_priority);  // sets this thread's alone, on Linux
  std::unique_lock lock(mutex_);
  while (!closed_) {
    drop_gone();
    if (!make_next(lock, most)) changed_.wait_for(lock, std::chrono::duration<double>(look_every));
  }
}

StillStatus StillDesk::status() const {
  std::lock_guard lock(mutex_);
  StillStatus now = status_;
  now.waiting = waiting_.size() + current_.size();
  now.waiting_seconds = 0;
  for (const std::list<Ticket>* list : {&waiting_, &current_})
    for (const Ticket& ticket : *list) now.waiting_seconds += ticket.cost;
  return now;
}

}  // namespace wellspring::show
