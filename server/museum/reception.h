// SPDX-License-Identifier: Apache-2.0
// Keeps links that are not shown anything: until they have said which exhibit they want; in a queue
// until there is a seat for a visitor's pictures; and while nobody is at a page any more
// (show/answer/idle.h). Such links cost a socket and no pictures. Kiosks and their cameras never
// wait, once their tokens are checked.
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

// Keeps visitors who wait for a seat, and lets them in by turn. Times are seconds of a clock that
// does not run backwards; not for several threads at once.
//
// Turns go round among addresses, and then among the visits of each: the second visitor of an
// address comes after the first of all others, and a visitor whose address has seats already comes
// after as many rounds as it has seats. The first visitor of an address who has waited for
// `patience` is not put back for these seats. Among visitors of the same round, the first to come
// is the first to enter. A visitor whose pictures do not fit is passed over, and after `patience`
// let in with smaller pictures as soon as these fit.

// Holds a visitor who enters as soon as there is a seat.
struct Newcomer {
  std::shared_ptr<Link> link;
  Heard hello;       // the visitor's hello, for the show to read
  size_t door = 0;   // index of the exhibit
  SeatSize size{0};  // size of the visitor's pictures
  std::unique_ptr<Seat> seat;
};

class WaitingQueue {
 public:
  static constexpr double patience = 60;             // seconds
  static constexpr double small_pixels = 640 * 360;  // pixels after `patience`

  WaitingQueue(size_t most, double most_pixels) : most_(most), most_pixels_(most_pixels) {}
  bool full() const { return all_.size() >= most_; }
  size_t size() const { return all_.size(); }
  uint64_t joined() const { return joined_; }  // visitors since the start
  void join(Newcomer newcomer, double now);    // not while it is full
  // Returns the visitors whose turn it is and for whom there is a seat. Messages that came
  // meanwhile are left out, except for another hello, which counts instead, and bye.
  std::vector<Newcomer> let_in(double now, Capacity& capacity);
  // Sends each visitor its place: at once; when it has changed, at most every two seconds; and else
  // every four, so that pages see that the connection works.
  void tell_places(double now);

 private:
  struct Waiting {
    Newcomer who;
    uint64_t number = 0;  // number in the order of joining
    double since = 0;
    int round = 0;  // round in which the visitor's turn comes
    std::optional<WaitingPlace> told;
    double told_at = 0;
  };
  bool listen(Waiting& one);  // reads a visitor's messages; false: the visitor is gone
  void order(double now, const Capacity& capacity);
  std::optional<double> seconds_for(size_t place, double now) const;
  const size_t most_;
  const double most_pixels_;
  std::deque<Waiting> all_;  // in the order of turns
  uint64_t joined_ = 0;
  std::deque<double> turns_;  // seconds; times of the last entries
};

// Holds an exhibit's id and kiosks, by which links find it.
struct ExhibitDoor {
  std::string id;
  std::vector<std::string> kiosks;  // names of its kiosks
};

// Returns to which exhibit the first message of a link leads: the one that a `hello` names; else
// the one that has the kiosk of that name; else the first. -1: there is no exhibit of that name.
int find_door(const std::vector<ExhibitDoor>& doors, const Heard& first);

struct ReceptionSettings {
  size_t most_waiting = 2000;        // links in the queue; more are asked to come back
  size_t most_resting = 2000;        // links at rest; beyond, the first one is asked to come back
  size_t most_strangers = 2000;      // links without a hello; more are asked to come back
  double most_pixels = 1920 * 1200;  // most pixels of a visitor's picture, whatever it asks for
  std::vector<Token> kiosk_tokens;   // show/answer/cameras.h
};

class Reception {
 public:
  // `doors`: at least one.
  Reception(std::vector<ExhibitDoor> doors, std::shared_ptr<Capacity> capacity,
            const ReceptionSettings& settings = {});

  void enter(std::shared_ptr<Link> link);  // from any thread; does not block
  // Takes a link whose page nobody is at. The link's first text is the hello by which its visit
  // goes on as soon as its page reports that somebody is there, or sends what a visitor does.
  void rest(std::shared_ptr<Link> link);
  struct Shown {
    size_t door = 0;
    std::shared_ptr<Link> link;  // link whose texts are still to be read
    std::unique_ptr<Seat> seat;  // seat of a visitor or kiosk; null for cameras
  };
  // Returns the links that may join their exhibits now; waits at most `seconds` for one. Links that
  // ask for an unknown exhibit get an error and may ask again; links that are closed are forgotten.
  std::vector<Shown> show_in(double seconds);
  struct Standing {
    size_t waiting = 0, resting = 0;  // counts at this moment
    uint64_t turned_away = 0;         // count since the start
  };
  Standing standing() const;

 private:
  struct Resting {
    std::shared_ptr<Link> link;
    Heard hello;
  };
  // All of these are called with the lock held.
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
  double looked_at_ = -1e9;  // time of the last look at the queue and resting links
  uint64_t turned_away_ = 0;
};

}  // namespace wellspring::museum
