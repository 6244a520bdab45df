// SPDX-License-Identifier: Apache-2.0
// Hands new links and announcements from the threads of the server to that of the show.
#pragma once
#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "show/house/house.h"
#include "show/state/capacity.h"
#include "wire/link.h"

namespace wellspring::show {

// Holds a new visitor's link and seat.
struct Arrival {
  std::shared_ptr<Link> link;
  std::unique_ptr<Seat> seat;  // seat for the visitor's pictures; may be null
};

// Holds new links and announcements, handed over by the threads of the server.
class Arrivals {
 public:
  void put(std::shared_ptr<Link> link, std::unique_ptr<Seat> seat = nullptr) {
    std::lock_guard lock(mutex_);
    all_.push_back({std::move(link), std::move(seat)});
  }
  std::vector<Arrival> take() {
    std::lock_guard lock(mutex_);
    return std::exchange(all_, {});
  }
  // Returns the announcement's number.
  uint32_t announce(Announcement announcement) {
    std::lock_guard lock(mutex_);
    announcement.id = ++announced_;
    announcements_.push_back(std::move(announcement));
    return announced_;
  }
  std::vector<Announcement> take_announcements() {
    std::lock_guard lock(mutex_);
    return std::exchange(announcements_, {});
  }

 private:
  std::mutex mutex_;
  std::vector<Arrival> all_;
  std::vector<Announcement> announcements_;
  uint32_t announced_ = 0;
};

}  // namespace wellspring::show
