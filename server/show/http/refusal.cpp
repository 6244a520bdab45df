// SPDX-License-Identifier: Apache-2.0
#include "show/http/refusal.h"

#include <nlohmann/json.hpp>

namespace wellspring::show {

HttpReply refuse(int status, const char* code, const std::string& message) {
  using nlohmann::json;
  HttpReply reply;
  reply.status = status;
  reply.body = json{{"error", {{"code", code}, {"message", message}}}}.dump(
      -1, ' ', false, json::error_handler_t::replace);
  reply.headers["Cache-Control"] = "no-store";
  return reply;
}

}  // namespace wellspring::show
