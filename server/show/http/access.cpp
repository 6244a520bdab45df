// SPDX-License-Identifier: Apache-2.0
#include "show/http/access.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "show/exhibit/json_fields.h"
#include "show/http/refusal.h"
#include "wire/json.h"

namespace wellspring::show {

namespace {

HttpReply refuse_token(const char* code, const std::string& message) {
  HttpReply reply = refuse(401, code, message);
  reply.headers["WWW-Authenticate"] = "Bearer";
  return reply;
}

}  // namespace

Access access_of(const AccessRules& rules, const HttpQuestion& question) {
  Access access;
  access.admin = is_token(bearer_of(question.authorization), rules.admin_token);
  access.has_token = !rules.admin_token.empty();
  access.status = access.admin || question.local || rules.open_status;
  return access;
}

HttpReply refuse_access(const Access& access) {
  if (!access.has_token)
    return refuse_token(
        "no_admin_token",
        "this is told on the server's own machine alone; elsewhere once the server is "
        "started with WELLSPRING_ADMIN_TOKEN or --admin-token-file, to who has that "
        "token");
  return refuse_token("wrong_token", "the admin token is needed: Authorization: Bearer TOKEN");
}

UpgradeAnswer admit(const AccessRules& rules, const HttpQuestion& question) {
  if (question.path != "/api/v1/eye") return {};
  const std::string_view shown = bearer_of(question.authorization);
  if (const Token* token = find_token(rules.kiosk_tokens, shown)) return {{}, token->name};
  if (question.local) return {};
  return {
      refuse_token("not_trusted",
                   "a kiosk's camera on another machine needs a kiosk token: Authorization: Bearer "
                   "TOKEN, one of the server's WELLSPRING_KIOSK_TOKEN or --kiosk-token-file")};
}

using nlohmann::json;

namespace {

HttpReply reply_of(int status, const json& body) {
  HttpReply reply;
  reply.status = status;
  reply.body = body.dump(-1, ' ', false, json::error_handler_t::replace);
  reply.headers["Cache-Control"] = "no-store";
  return reply;
}

Announcement read_announcement(const json& body, std::vector<Problem>& problems) {
  Announcement announcement;
  announcement.seconds = 60;
  read_fields(body, "body", problems, [&](FieldReader& fields) {
    announcement.text = read_local_text(fields, "text", "", Need::required);
    fields.number("seconds", 1, longest_announcement, announcement.seconds);
    fields.boolean("urgent", announcement.urgent);
    for (const auto& [lang, text] : announcement.text)
      if (text.size() > most_announced_bytes)
        fields.fail("text", "is longer than 2000 bytes in '" + lang + "'");
  });
  std::erase_if(announcement.text, [](const auto& one) { return one.second.empty(); });
  return announcement;
}

}  // namespace

HttpReply answer_announce(const AnnouncementDesk& desk, const Access& access,
                          const HttpQuestion& question) {
  if (question.method != "POST") {
    HttpReply reply = refuse(405, "method_not_allowed", "POST only");
    reply.headers["Allow"] = "POST";
    return reply;
  }
  if (!access.has_token)
    return refuse(403, "no_admin_token",
                  "this server was started without WELLSPRING_ADMIN_TOKEN and --admin-token-file");
  if (!access.admin) return refuse_access(access);
  const auto body = parse_json(question.body);
  if (const WireError* error = std::get_if<WireError>(&body))
    return refuse(400, error->code.c_str(), error->message);
  std::vector<Problem> problems;
  Announcement announcement = read_announcement(std::get<json>(body), problems);
  std::string wrong;
  for (const Problem& problem : problems) wrong += (wrong.empty() ? "" : "; ") + to_string(problem);
  if (!wrong.empty()) return refuse(400, "bad_field", wrong);
  return reply_of(200, {{"id", desk.put(std::move(announcement))}});
}

}  // namespace wellspring::show
