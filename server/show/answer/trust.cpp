// SPDX-License-Identifier: Apache-2.0
#include "show/answer/trust.h"

namespace wellspring::show {

namespace {

// `own`: of the only kiosk that a token is for; empty: of any.
std::optional<WireError> check_name(const std::string& own, std::string& kiosk) {
  if (own.empty() || kiosk == own) return {};
  if (!kiosk.empty())
    return WireError{"not_trusted", "this token is for another kiosk than the one that is named"};
  kiosk = own;
  return {};
}

}  // namespace

std::optional<WireError> check_page(const std::vector<Token>& kiosk_tokens, const Link& link,
                                    const Hello& hello, std::string& kiosk) {
  kiosk = hello.kiosk;
  if (hello.role != "kiosk") return {};
  const Token* token = find_token(kiosk_tokens, hello.token);
  if (token) return check_name(token->name, kiosk);
  if (link.local) return {};
  return WireError{
      "not_trusted",
      "a kiosk's screen on another machine needs a kiosk token: open /kiosk#token=..."};
}

std::optional<WireError> check_camera(const Link& link, Observation& seen) {
  return check_name(link.kiosk, seen.kiosk);
}

}  // namespace wellspring::show
