// SPDX-License-Identifier: Apache-2.0
// Serves all exhibits of one process, each a show that ticks on a thread of its own.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "ledger/sums.h"
#include "show/http/answer.h"
#include "show/state/capacity.h"
#include "show/state/show_settings.h"
#include "show/storyteller/recordings.h"

namespace wellspring::museum {

struct MuseumSettings {
  std::string content = "content";  // folder of exhibit packages
  std::string exhibit;              // id of the only exhibit; empty: all of the folder, by name
  ShowSettings show;
  CapacitySettings capacity;
  size_t most_waiting = 2000;  // most visitors who wait for a seat; more are asked to come back
  RecordingOptions recordings;
  std::string house;  // house file, whose kiosks belong to the first exhibit; empty: none
  std::string sums;   // file of daily sums; empty: no sums are kept
  StillLimits stills;
  // File of the key that seals visits, for servers that share them; empty: a file in the cache.
  std::string seal_key;
};

// Returns the ids of the packages in a folder, sorted.
std::vector<std::string> exhibits_in(const std::string& content);

class Museum {
 public:
  // Loads all exhibits that are to be served, one after the other. Exhibits that cannot be shown
  // are logged and listed in sources().failed. Throws ExhibitError or std::runtime_error if none
  // can be shown, naming the exhibits that there are, or if the house file is wrong.
  explicit Museum(const MuseumSettings& settings);
  ~Museum();
  // Returns the sources of HTTP answers. The caller adds its pages, access, stream_metrics and
  // door_counts.
  AnswerSources& sources();
  void join(std::shared_ptr<Link> link);  // from any thread
  std::string status() const;             // text of GET /api/v1/status; from any thread
  // Returns Prometheus lines about all exhibits together. From any thread.
  std::string metrics() const;
  // Returns how many visitors at 1280x720 this machine serves, as measured so far. From any thread.
  int seats() const;
  Sums read_sums(int64_t from, int64_t to) const;  // Ledger::read(); nothing if none are kept
  // Ticks all shows. Returns false when `ended`, which is asked ten times a second, returns true.
  // Returns true when files of an exhibit have changed, if they are watched or reload() was called.
  // Then take_over() shows the new version; while it runs nobody may ask sources() or join. Sums
  // are written before the return.
  bool run(const std::function<bool()>& ended);
  void give_up_stills();  // stills that somebody waits for; after run()
  void take_over();
  // Checks once whether files of an exhibit or of the house have changed. Called within `ended`.
  void reload();
  // Returns whether all shows have gone on since it last returned true (museum/upkeep.h). Called
  // within `ended`.
  bool has_gone_on();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace wellspring::museum
