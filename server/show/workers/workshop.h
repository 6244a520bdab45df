// SPDX-License-Identifier: Apache-2.0
// Answers orders to trace, at a worker: exhibits as a server loads them, without visitors. Whatever
// would not give the samples that the server itself would find is refused, with the reason; an
// exhibit or maps that are not here are fetched from the server, if that is allowed.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/worker.h"
#include "show/state/show.h"
#include "workers/message.h"
#include "workers/package/fetch.h"

namespace wellspring::show {

// Loads the exhibit of a package's folder as a worker needs it; `cache`: folder of kept maps.
using LoadShow =
    std::function<std::unique_ptr<Show>(const std::string& folder, const std::string& cache)>;

class Workshop {
 public:
  // `version` of this program; `worker`: its name in answers; `cache`: folder for what is fetched,
  // at most `most_bytes` of an exhibit.
  Workshop(std::string version, std::string worker, const std::string& cache, uint64_t most_bytes,
           LoadShow load);
  // Loads the exhibit of a folder. Throws ExhibitError.
  void add(const std::string& folder, const std::string& cache);
  size_t exhibits() const { return rooms_.size(); }

  // Traces on all cores. `waited`: seconds since the order came.
  TraceAnswer answer(const TraceOrder& order, double waited);

  // It says what servers are asked for, and takes their answers, on any thread.
  PackageFetch& fetch() { return fetch_; }
  // Puts to use what has been fetched: an exhibit is loaded on a thread of its own.
  void advance();

 private:
  struct Room {
    std::unique_ptr<Show> show;
    uint64_t scene = 0, light = 0;
    std::string state;  // state of the world by the last order; empty: none yet
    std::string from;   // folder of what was fetched; empty: it was here
    double used = 0;    // seconds
  };
  Refusal prepare(const TraceOrder& order, double waited, Room*& room);
  Refusal begin_fetch(const TraceOrder& order, PackageFetch::What what, Refusal why);
  void use_maps(const PackageFetch::Result& fetched);
  void add_room(std::unique_ptr<Show> show, std::string from);
  std::string version_, worker_;
  LoadShow load_;
  std::vector<Room> rooms_;
  PackageFetch fetch_;
  uint64_t light_ = 0, scene_ = 0;  // numbers that what is being fetched should have
  uint64_t other_scene_ = 0;        // number that the server's files do not have
  struct Loading {
    std::string folder, exhibit;
    std::unique_ptr<Show> show;
    std::string problem;
  };
  std::optional<Loading> loading_;  // loader_'s while it is busy
  Worker loader_;                   // the last member
};

}  // namespace wellspring::show
