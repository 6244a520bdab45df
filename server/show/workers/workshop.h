// SPDX-License-Identifier: Apache-2.0
// Answers orders to trace, at a worker: an exhibit as a server loads it, without visitors. Whatever
// would not give the samples that the server itself would find is refused, with the reason.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "show/state/show.h"
#include "workers/message.h"

namespace wellspring::show {

class Workshop {
 public:
  // `version` of this program; `worker`: its name in answers; `cache`: folder for maps that servers
  // send.
  Workshop(std::string version, std::string worker, std::string cache);
  void add(std::unique_ptr<Show> show);  // an exhibit: make_show() without a baker
  size_t exhibits() const { return rooms_.size(); }

  // Traces on all cores. `waited`: seconds since the order came.
  TraceAnswer answer(const TraceOrder& order, double waited);

  // An order that was refused for its light makes the workshop fetch the server's maps.

  // Returns what is to be asked now of MapQuestion::server; none: nothing. `now`: seconds.
  std::optional<MapQuestion> ask_for_maps(double now);
  void take(const MapPart& part);

 private:
  struct Room {
    std::unique_ptr<Show> show;
    uint64_t scene = 0, light = 0;
    std::string state;  // state of the world by the last order; empty: none yet
  };
  // Holds maps that are on their way.
  struct Fetch {
    MapQuestion next;  // light 0: none are
    size_t room = 0;
    std::string bytes;
    double asked = -1e9, ended = -1e9;  // seconds
  };
  void begin_fetch(const TraceOrder& order, const Room& room);
  bool use_fetched();
  Refusal prepare(const TraceOrder& order, double waited, Room*& room);
  std::string version_, worker_, cache_;
  std::vector<Room> rooms_;
  Fetch fetch_;
};

}  // namespace wellspring::show
