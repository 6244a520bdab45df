// SPDX-License-Identifier: Apache-2.0
// HTTP questions to replies: no sockets, no state of its own. Runs on stream's answer threads.
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "show/exhibit/exhibit.h"
#include "show/http/access.h"
#include "show/http/map_desk.h"
#include "show/http/pages.h"
#include "show/http/picture_desk.h"
#include "show/http/report.h"
#include "show/http/still_desk.h"
#include "show/visit/walk_map.h"
#include "store/piece_store.h"
#include "wire/http.h"

namespace wellspring::show {

// One exhibit; all borrowed, all safe to read from any thread.
struct ServedExhibit {
  const Exhibit* exhibit = nullptr;
  const ReportBoard* board = nullptr;
  StillRoom* stills = nullptr;
  const WalkMap* walk_map = nullptr;  // null: visitors fly
  std::string address = {};           // HouseSettings::address
};

// One that cannot be shown.
struct FailedExhibit {
  std::string id;
  std::vector<std::string> problems;  // each with file and place
};

// Holds what replies are made from.
struct AnswerSources {
  std::vector<ServedExhibit> exhibits;  // the first: of whom asks for none by name
  std::vector<FailedExhibit> failed;
  const std::map<std::string, PageFile>* pages = nullptr;
  std::function<std::string()> stream_metrics;  // further Prometheus lines; may be empty
  std::function<DoorCounts()> door_counts;      // from any thread; may be empty
  AccessRules access;
  StillDesk* stills = nullptr;
  MapDesk* maps = nullptr;
  PictureDesk* pictures = nullptr;
  AnnouncementDesk desk;
  std::function<HttpReply(const HttpQuestion&)>
      sums;                             // GET /api/v1/sums.csv (show/status/status.h)
  std::function<std::string()> status;  // GET /api/v1/status: JSON (show/status/status.h)
  std::function<std::string()> speeds;  // GET /api/v1/speeds: JSON (show/status/status.h)
  std::function<bool()> drains;         // visitors are to go elsewhere; empty: never
  bool changes = false;                 // exhibits may: nothing of them is kept by browsers
};

// Never throws; unknown paths are 404, bad parameters 400 with {"error":{"code","message"}}.
HttpReply answer(const AnswerSources& sources, const HttpQuestion& question);

// Before there are any: 503, but for what pages are made of.
HttpReply answer_while_loading(const std::map<std::string, PageFile>& pages,
                               const HttpQuestion& question);

// Takes a question for a finished picture, a collection's map or a record's picture, and answers
// when that is made; false: it is none, or a wrong one, for answer().
bool answer_later(const AnswerSources& sources, const HttpQuestion& question,
                  const std::shared_ptr<HttpAsker>& asker);

// GET /api/v1/: what this server answers and the messages it speaks.
std::string describe_api();
// GET /metrics: Prometheus text exposition format 0.0.4.
std::string write_metrics(const ShowReport& report);
// Joins the metrics of several exhibits, by id: each sample gets the label `exhibit`, each name its
// help once.
std::string join_metrics(const std::vector<std::pair<std::string, std::string>>& texts);
std::string failure_metrics(const std::vector<FailedExhibit>& failed);
std::string still_metrics(const StillStatus& stills);
std::string store_metrics(const StoreStats& store);

}  // namespace wellspring::show
