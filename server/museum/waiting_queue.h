// SPDX-License-Identifier: Apache-2.0
// Visitors who wait for a seat and are let in by turn. Times are seconds of a clock that does not
// run backwards; not for several threads at once.
//
// Turns go round among addresses, and then among the visits of each: the second of an address comes
// after the first of all others, and one whose address has seats already after as many rounds as it
// has seats. Whoever waits first of its address for `patience` is not put back for these. Among
// those who have the same turn, who came first comes first. Who does not fit is passed over, and
// after `patience` let in with smaller pictures as soon as these fit.
#pragma once
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "show/state/capacity.h"
#include "wire/link.h"
#include "wire/messages.h"

namespace wellspring::museum {

// Who is welcomed as soon as there is a seat.
struct Newcomer {
  std::shared_ptr<Link> link;
  Heard hello;       // what they said, for the show to read
  size_t door = 0;   // of the exhibit that they want
  SeatSize size{0};  // of their pictures
  std::unique_ptr<Seat> seat;
};

class WaitingQueue {
 public:
  static constexpr double patience = 60;             // seconds
  static constexpr double small_pixels = 640 * 360;  // of who has waited so long

  WaitingQueue(size_t most, double most_pixels) : most_(most), most_pixels_(most_pixels) {}
  bool full() const { return all_.size() >= most_; }
  size_t size() const { return all_.size(); }
  uint64_t joined() const { return joined_; }  // ever
  void join(Newcomer newcomer, double now);    // not while it is full
  // Those whose turn it is and for whom there is a seat. What they say meanwhile is left out, but
  // for another hello, which counts instead, and bye.
  std::vector<Newcomer> let_in(double now, Capacity& capacity);
  // Tells each their place: at once; when it has changed, at most every two seconds; and every
  // four, so that pages know that the line is good.
  void tell_places(double now);

 private:
  struct Waiting {
    Newcomer who;
    uint64_t number = 0;  // of who joins
    double since = 0;
    int round = 0;  // of turns
    std::optional<WaitingPlace> told;
    double told_at = 0;
  };
  bool listen(Waiting& one);  // false: they are gone
  void order(double now, const Capacity& capacity);
  std::optional<double> seconds_for(size_t place, double now) const;
  const size_t most_;
  const double most_pixels_;
  std::deque<Waiting> all_;  // in the order of their turns
  uint64_t joined_ = 0;
  std::deque<double> turns_;  // when the last ones were let in
};

}  // namespace wellspring::museum
