// SPDX-License-Identifier: Apache-2.0
#include "show/http/access.h"

#include <nlohmann/json.hpp>

namespace wellspring::show {

namespace {

HttpReply refuse(const char* code, const std::string& message) {
  HttpReply reply;
  reply.status = 401;
  reply.body = nlohmann::json{{"error", {{"code", code}, {"message", message}}}}.dump();
  reply.headers["Cache-Control"] = "no-store";
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
    return refuse("no_admin_token",
                  "this is told on the server's own machine alone; elsewhere once the server is "
                  "started with WELLSPRING_ADMIN_TOKEN or --admin-token-file, to who has that "
                  "token");
  return refuse("wrong_token", "the admin token is needed: Authorization: Bearer TOKEN");
}

UpgradeAnswer admit(const AccessRules& rules, const HttpQuestion& question) {
  if (question.path != "/api/v1/eye") return {};
  const std::string_view shown = bearer_of(question.authorization);
  if (const Token* token = find_token(rules.kiosk_tokens, shown)) return {{}, token->name};
  if (question.local) return {};
  return {refuse("not_trusted",
                 "a kiosk's camera on another machine needs a kiosk token: Authorization: Bearer "
                 "TOKEN, one of the server's WELLSPRING_KIOSK_TOKEN or --kiosk-token-file")};
}

}  // namespace wellspring::show
