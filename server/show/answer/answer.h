// SPDX-License-Identifier: Apache-2.0
// HTTP questions to replies: no sockets, no state of its own. Runs on stream's answer threads.
#pragma once
#include <functional>
#include <map>
#include <string>

#include "show/exhibit/exhibit.h"
#include "show/answer/pages.h"
#include "show/answer/report.h"
#include "show/answer/still.h"
#include "wire/http.h"

namespace wellspring {

// What replies are made from; all borrowed, all safe to read from any thread.
struct AnswerSources {
  const Exhibit* exhibit = nullptr;
  const std::map<std::string, PageFile>* pages = nullptr;
  const ReportBoard* board = nullptr;
  std::function<std::string(const StillJob&)> make_still;
  std::function<std::string()> stream_metrics;  // further Prometheus lines; may be empty
};

// Never throws; unknown paths are 404, bad parameters 400 with {"error":{"code","message"}}.
HttpReply answer(const AnswerSources& sources, const HttpQuestion& question);

// GET /api/v1/: what this server answers and the messages it speaks.
std::string describe_api();
// GET /metrics: Prometheus text exposition format 0.0.4.
std::string write_metrics(const ShowReport& report);

}  // namespace wellspring
