// SPDX-License-Identifier: Apache-2.0
// Makes maps of collections that are asked for over HTTP, on a thread of its own, and keeps the
// last ones: going back costs nothing.
#pragma once
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "collection/level.h"
#include "show/exhibit/exhibit.h"
#include "show/exhibit/exhibit_collection.h"
#include "wire/http.h"

namespace wellspring::show {

struct MapQuestion {
  std::vector<MapStep> steps;
  int shown = 600;      // objects on a map
  std::string problem;  // not empty: the question is wrong
};
// Reads ?trail=12@0.35;c0,2&shown=600.
MapQuestion read_map_question(const std::map<std::string, std::string>& query);

class MapDesk {
 public:
  MapDesk() = default;
  ~MapDesk();
  MapDesk(const MapDesk&) = delete;
  MapDesk& operator=(const MapDesk&) = delete;

  // Answers when the map is there: at once when it is kept; 404 for steps that maps do not have,
  // 503 when too many wait. `exhibit` must have a collection and is read within the call alone.
  void ask(const Exhibit& exhibit, const MapQuestion& question,
           const std::shared_ptr<wire::HttpAsker>& asker);
  // Makes the map of the whole collection when nobody asks for another, so that whoever asks first
  // does not wait for it. `exhibit` is as above.
  void prepare(const Exhibit& exhibit);

 private:
  struct Ticket {
    std::shared_ptr<const ExhibitCollection> collection;
    std::vector<std::string> object_ids;  // by record; empty: it stands nowhere
    std::string pictures;                 // address of the records' pictures, without their number
    std::vector<std::string> hosts;       // Exhibit::allowed_hosts
    MapQuestion question;
    std::shared_ptr<wire::HttpAsker> asker;  // null: nobody waits for it
  };
  struct Kept {
    std::shared_ptr<const ExhibitCollection> collection;
    std::string steps;
    std::shared_ptr<const MapLevel> level;
  };
  void live();
  bool put(Ticket ticket);
  std::shared_ptr<const MapLevel> level_of(const Ticket& ticket);
  wire::HttpReply reply_to(const Ticket& ticket);

  std::mutex mutex_;  // guards the queue
  std::condition_variable changed_;
  std::list<Ticket> waiting_;
  bool end_ = false;
  std::thread thread_;
  std::list<Kept> kept_;  // the thread's alone; the newest first
};

}  // namespace wellspring::show
