// SPDX-License-Identifier: Apache-2.0
// Makes the finished pictures that are asked for over HTTP. One is made at a time, and beside it a
// cheap one, at low priority, and while visitors need the cores by one thread each; equal questions
// share one. The cost of a picture is known before it is begun, in seconds of this machine: those
// that it is given, or fewer or more by the speed that earlier ones had. Costs bound requests:
//
// - one that takes too long with a single sample a pixel is refused, and told what would fit;
// - each address, and all together, have so many seconds, which come back slowly;
// - cheap ones come before dear ones, which gain a second's worth of patience each second;
// - one that nobody waits for any more is given up, and what is left of its seconds given back.
#pragma once
#include <condition_variable>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "base/clock.h"
#include "show/http/still.h"

namespace wellspring::show {

struct StillLimits {
  double most_seconds = 120;    // time of the machine, for one picture
  double cheap_seconds = 4;     // up to which a picture never waits for a dearer one
  double address_rate = 0.25;   // seconds of the machine that come back each second, to an address
  double address_pictures = 2;  // number of the dearest, at once after a pause
  double all_rate = 0.5;        // likewise, to all together
  double all_pictures = 10;
  size_t most_waiting = 64;
  size_t most_addresses = 4096;  // addresses that are remembered
};

struct StillOutcome {
  int status = 200;  // 400: too dear; 429: too many; 503: the server stops, or the queue is full
  std::string code, problem;
  double retry_seconds = 0;  // 0: not to be tried again
  StillPicture picture;
};

struct StillStatus {  // since the start, but for the first three: now
  size_t waiting = 0;
  double waiting_seconds = 0;     // time of the machine until all of these are made
  double samples_per_second = 0;  // speed in the last scene
  uint64_t made = 0, shared = 0;  // shared: answered by a picture that was there, or being made
  uint64_t too_dear = 0, too_many = 0, given_up = 0;
};

class StillDesk {
 public:
  // `busy`, from any thread: visitors need the cores.
  explicit StillDesk(const StillLimits& limits, std::function<bool()> busy = {});
  ~StillDesk() { close(); }

  struct Asker {
    std::function<void(StillOutcome)> take;  // called once, perhaps within ask()
    std::function<bool()> gone;              // nobody waits any more: it need not be called
    std::string address;
  };
  // Does not wait for the picture. The first question to a room measures its speed, which takes
  // some tenths of a second.
  void ask(StillRoom& room, const StillJob& job, Asker asker);
  // Whoever waits is told that the server stops, as is whoever asks from then on, and nothing is at
  // work any more: rooms may go. Until open().
  void close();
  void open();
  StillStatus status() const;

 private:
  struct Speed {
    double samples = 0, denoised = 0;  // a second; pixels, 0: not known yet
  };
  struct Ticket {
    StillRoom* room = nullptr;
    StillJob job;
    double cost = 0, since = 0;  // seconds of the machine; when it was asked for
    double denoise_seconds = 0;  // share of its cost
    std::vector<Asker> askers;
  };
  // Whose pictures a thread makes: of at most so many seconds.
  void live(double most);
  bool make_next(std::unique_lock<std::mutex>& lock, double most);
  void drop_gone();
  Speed speed_of(StillRoom& room);  // without the lock
  void learn(const Ticket& ticket, const StillCosts& costs);
  StillOutcome judge(double cost, double least, double pixels, RateBound& own);
  RateBound& bound_of(const std::string& address);
  void give_back(const Ticket& ticket, double seconds);

  const StillLimits limits_;
  const std::function<bool()> busy_;
  std::mutex measuring_;
  mutable std::mutex mutex_;  // guards the members below
  std::condition_variable changed_;
  std::map<StillRoom*, Speed>
      speeds_;  // speeds of rooms that have gone, too: never read but as a guess
  std::list<Ticket> waiting_;
  std::list<Ticket> current_;  // at work
  std::map<std::string, RateBound> addresses_;
  RateBound all_;
  StillStatus status_;
  bool closed_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace wellspring::show
