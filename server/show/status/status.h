// SPDX-License-Identifier: Apache-2.0
// GET /api/v1/status: how the server is, for the page /status. Numbers and words, never pictures.
#pragma once
#include <functional>
#include <mutex>
#include <string>

#include "base/layers.h"
#include "ledger/sums.h"
#include "show/http/answer.h"
#include "show/status/judge.h"
#include "wire/http.h"

namespace wellspring::show {

// GET /api/v1/sums.csv?from=YYYY-MM-DD&to=YYYY-MM-DD: the daily sums, for a spreadsheet.

// Those of both days and all between; throws where the file cannot be read. Empty: none are kept.
using ReadSums = std::function<Sums(int64_t from, int64_t to)>;

// For who has Access::status (show/http/access.h): 404 where no sums are kept, 400 for what is no
// day, 503 where the file cannot be read.
HttpReply answer_sums(const ReadSums& read, const HttpQuestion& question);

// How one exhibit is.
struct Standing {
  std::string exhibit;
  ShowReport report;
  std::vector<Finding> findings;
};

// Writes {"fine", "findings": [{exhibit, about, grave, what, seconds (that it has been so), why,
// remedy}], "house": {open, quiet}, "kiosks": [{name, exhibit, stage, people, storyteller, screens,
// cameras}], "cameras": [{kiosk, name, state, seconds}], "workers": [{name, exhibit,
// cores, problem (why it is not asked; empty: it is), samples, samples_per_second, line_ms}],
// "sums": boolean: there are some}. A problem that several exhibits have alike is reported once;
// exhibits that failed to load are reported, too.
std::string write_status(const std::vector<Standing>& exhibits,
                         const std::vector<FailedExhibit>& failed, bool sums);

// One thread sees reports of an exhibit, others ask.
class StatusDesk {
 public:
  explicit StatusDesk(const std::string& exhibit) { standing_.exhibit = exhibit; }
  void see(const ShowReport& report);
  Standing tell() const;

 private:
  JudgeMemory memory_;
  mutable std::mutex mutex_;
  Standing standing_;
};

// GET /api/v1/speeds: speed against error of all techniques, from a file of `./wellspring bench`.

// {"date", "commit", "cpu", "cores", "points": [{technique, scene, spp, seconds (of all threads),
// flip}]}, or {"problem"}: why there are none. Reads the file each time.
std::string read_speeds(const std::string& file);

}  // namespace wellspring::show
