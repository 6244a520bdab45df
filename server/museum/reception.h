// SPDX-License-Identifier: Apache-2.0
// Where peers are until they are shown something: until they have said which exhibit they want;
// until there is a seat for a visitor's pictures, in a queue; and while nobody is at a page any
// more (show/answer/idle.h). Such links cost a socket and no pictures. Kiosks and their cameras
// never wait, once they are believed to be some.
#pragma once
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "show/state/capacity.h"
#include "wire/link.h"
#include "wire/messages.h"
#include "wire/tokens.h"

namespace wellspring::museum {

// Visitors who wait for a seat and are let in by turn. Times are seconds of a clock that does not
// run backwards; not for several threads at once.
//
// Turns go round among addresses, and then among the visits of each: the second of an address comes
// after the first of all others, and one whose address has seats already after as many rounds as it
// has seats. Whoever waits first of its address for `patience` is not put back for these. Among
// those who have the same turn, who came first comes first. Who does not fit is passed over, and
// after `patience` let in with smaller pictures as soon as these fit.

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

// What the reception knows of an exhibit.
struct ExhibitDoor {
  std::string id;
  std::vector<std::string> kiosks;  // their names
};

// Which of the doors the first words of a peer lead to: the exhibit that a `hello` names; else the
// one that has the kiosk of that name; else the first. -1: there is no exhibit of that name.
int find_door(const std::vector<ExhibitDoor>& doors, const Heard& first);

struct ReceptionSettings {
  size_t most_waiting = 2000;        // in the queue; more are told to come back
  size_t most_resting = 2000;        // more: who came first is told to come back
  size_t most_strangers = 2000;      // who have not said hello; likewise
  double most_pixels = 1920 * 1200;  // of a visitor's pictures, whatever it asks for
  std::vector<Token> kiosk_tokens;   // show/answer/cameras.h
};

class Reception {
 public:
  // At least one door.
  Reception(std::vector<ExhibitDoor> doors, std::shared_ptr<Capacity> capacity,
            const ReceptionSettings& settings = {});

  void enter(std::shared_ptr<Link> link);  // from any thread; does not block
  // Nobody is at its page. `link`'s first text is the hello by which its visit goes on as soon as
  // its page says that somebody is there, or does anything that a visitor does.
  void rest(std::shared_ptr<Link> link);
  struct Shown {
    size_t door = 0;
    std::shared_ptr<Link> link;  // its texts are still to be read
    std::unique_ptr<Seat> seat;  // of visitors and kiosks
  };
  // Who may go in by now, after at most `seconds` in which nobody does. Those who ask for what is
  // not there are told so and may ask again; those who are gone are forgotten.
  std::vector<Shown> show_in(double seconds);
  struct Standing {
    size_t waiting = 0, resting = 0;  // now
    uint64_t turned_away = 0;         // ever
  };
  Standing standing() const;

 private:
  struct Resting {
    std::shared_ptr<Link> link;
    Heard hello;
  };
  // All with the lock held.
  std::vector<Shown> find_ready(double now);
  bool receive(const std::shared_ptr<Link>& link, std::vector<Shown>& ready);
  bool place(std::shared_ptr<Link>& link, Heard hello, size_t door, std::vector<Shown>& ready);
  void look_at_resting();
  void turn_away(Link& link);
  const std::vector<ExhibitDoor> doors_;
  const std::shared_ptr<Capacity> capacity_;
  const ReceptionSettings settings_;
  mutable std::mutex mutex_;
  std::condition_variable somebody_;
  std::vector<std::shared_ptr<Link>> strangers_;
  WaitingQueue queue_;
  std::vector<Resting> resting_;
  double looked_at_ = -1e9;  // at the queue and those who rest
  uint64_t turned_away_ = 0;
};

}  // namespace wellspring::museum
