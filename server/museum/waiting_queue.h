// SPDX-License-Identifier: Apache-2.0
// Visitors who wait for a seat and are let in by turn. Times are seconds of a clock that does not
// run backwards; not for several threads at once.
#pragma once
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "show/state/capacity.h"
#include "wire/link.h"
#include "wire/messages.h"

namespace wellspring {

// Who is welcomed as soon as there is a seat.
struct Newcomer {
  std::shared_ptr<Link> link;
  Heard hello;        // what they said, for the show to read
  size_t door = 0;    // of the exhibit that they want
  double pixels = 0;  // of their pictures
  std::unique_ptr<Seat> seat;
};

class WaitingQueue {
 public:
  explicit WaitingQueue(size_t most) : most_(most) {}
  bool full() const { return all_.size() >= most_; }
  size_t size() const { return all_.size(); }
  size_t size_of(size_t door) const;
  void join(Newcomer newcomer);  // not while it is full
  // Those whose turn it is: from its beginning, while `find_seat` finds one. What they say
  // meanwhile is left out, but for another hello, which counts instead, and bye.
  std::vector<Newcomer> let_in(
      double now, const std::function<std::unique_ptr<Seat>(const Newcomer&)>& find_seat);
  // Tells each their place: at once; when it has changed, at most every two seconds; and every
  // four, so that pages know that the line is good.
  void tell_places(double now);

 private:
  struct Waiting {
    Newcomer who;
    std::optional<WaitingPlace> told;
    double told_at = 0;
  };
  bool listen(Waiting& one);  // false: they are gone
  std::optional<double> seconds_for(size_t place, double now) const;
  const size_t most_;
  std::deque<Waiting> all_;
  std::deque<double> turns_;  // when the last ones were let in
};

}  // namespace wellspring
