// SPDX-License-Identifier: Apache-2.0
#include "show/status/sums.h"

#include <nlohmann/json.hpp>

namespace wellspring::show {

namespace {

HttpReply refuse(int status, const char* code, const std::string& message) {
  HttpReply reply;
  reply.status = status;
  reply.body = nlohmann::json{{"error", {{"code", code}, {"message", message}}}}.dump(
      -1, ' ', false, nlohmann::json::error_handler_t::replace);
  reply.headers["Cache-Control"] = "no-store";
  return reply;
}

// The day that the question names, or `otherwise` where it names none.
std::optional<int64_t> day_of(const HttpQuestion& question, const char* name, int64_t otherwise) {
  auto found = question.query.find(name);
  if (found == question.query.end() || found->second.empty()) return otherwise;
  return parse_day(found->second);
}

}  // namespace

HttpReply answer_sums(const ReadSums& read, const HttpQuestion& question) {
  if (!read) return refuse(404, "no_sums", "this server was started without --sums: it keeps none");
  const auto from = day_of(question, "from", *parse_day("0000-01-01")),
             to = day_of(question, "to", *parse_day("9999-12-31"));
  if (!from || !to)
    return refuse(400, "bad_parameter", "from, to: a day such as 2026-05-31 is expected");
  HttpReply reply;
  reply.content_type = "text/csv; charset=utf-8";
  reply.headers["Cache-Control"] = "no-store";
  reply.headers["Content-Disposition"] = "attachment; filename=\"sums.csv\"";
  try {
    reply.body = write_csv(read(*from, *to));
  } catch (const std::exception& error) {
    return refuse(503, "unreadable", error.what());
  }
  return reply;
}

}  // namespace wellspring::show
