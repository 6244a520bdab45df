// SPDX-License-Identifier: Apache-2.0
// Answers orders to trace, at a worker: an exhibit as a server loads it, without visitors. Whatever
// would not give the samples that the server itself would find is refused, with the reason.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "show/state/show.h"
#include "workers/message.h"

namespace wellspring::show {

class Workshop {
 public:
  // `version` of this program; `worker`: its name in answers.
  Workshop(std::string version, std::string worker);
  void add(std::unique_ptr<Show> show);  // an exhibit: make_show() without a baker
  size_t exhibits() const { return rooms_.size(); }

  // Traces on all cores. `waited`: seconds since the order came.
  TraceAnswer answer(const TraceOrder& order, double waited);

 private:
  struct Room {
    std::unique_ptr<Show> show;
    uint64_t scene = 0, light = 0;
    std::string state;  // state of the world by the last order; empty: none yet
  };
  Refusal prepare(const TraceOrder& order, double waited, Room*& room);
  std::string version_, worker_;
  std::vector<Room> rooms_;
};

}  // namespace wellspring::show
