// SPDX-License-Identifier: Apache-2.0
// All exhibits that one process serves, each a show that ticks on a thread of its own.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "ledger/sums.h"
#include "show/http/answer.h"
#include "show/state/show.h"
#include "show/storyteller/recordings.h"

namespace wellspring::museum {

struct MuseumSettings {
  std::string content = "content";  // folder of exhibit packages
  std::string exhibit;              // id of the only one; empty: all of the folder, by name
  ShowSettings show;
  CapacitySettings capacity;
  size_t most_waiting = 2000;  // visitors, for a seat; more are told to come back
  RecordingOptions recordings;
  std::string house;  // house file, whose kiosks are the first exhibit's; empty: none
  std::string sums;   // file of daily sums; empty: none are kept
  StillLimits stills;
  // Of the key that seals visits, for servers that share them; empty: a file in the cache.
  std::string seal_key;
};

// Ids of the packages in a folder, sorted.
std::vector<std::string> exhibits_in(const std::string& content);

class Museum {
 public:
  // Loads all that is to be served, one after the other. What cannot be shown is logged and listed
  // in sources().failed. Throws ExhibitError or std::runtime_error where nothing can be shown,
  // naming the exhibits that there are, or where the house file is wrong.
  explicit Museum(const MuseumSettings& settings);
  ~Museum();
  // What answers are made from. Its pages, access, stream_metrics and door_counts
  // are the caller's to add.
  AnswerSources& sources();
  void join(std::shared_ptr<Link> link);  // from any thread
  std::string status() const;             // GET /api/v1/status; from any thread
  // Prometheus lines of what all exhibits have together. From any thread.
  std::string metrics() const;
  // How many visitors at 1280x720 this machine serves, as measured so far. From any thread.
  int seats() const;
  Sums read_sums(int64_t from, int64_t to) const;  // Ledger::read(); nothing where none are kept
  // Ticks all shows until `ended`, which is asked ten times a second, says so: false. Or until one
  // of them has changed, where they are watched or reload() was called: true. Then take_over()
  // shows it as it is now, when nobody asks sources() or joins. Sums are written by then.
  bool run(const std::function<bool()>& ended);
  void give_up_stills();  // that somebody waits for, after run()
  void take_over();
  // Looks once whether files of an exhibit or of the house have changed. From within `ended`.
  void reload();
  // Whether all shows have gone on since it last said so (museum/upkeep.h). From within `ended`.
  bool has_gone_on();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace wellspring::museum
