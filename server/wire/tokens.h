// SPDX-License-Identifier: Apache-2.0
// Secrets that an operator hands out: whoever shows one is trusted. They come from files or from
// the environment, never from a command line, which every user of a machine can read.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace wellspring::wire {

inline constexpr size_t least_token_bytes = 16;

struct Token {
  std::string name;  // of the only kiosk that it is for; empty: for any
  std::string secret;
};

// Tokens of a file, else of the environment's `variable`, which is wiped: programs that are started
// afterwards, and /proc, do not tell it. A line of the file is TOKEN, or NAME TOKEN (a name may
// have spaces); empty ones and those that begin with # count for nothing. The variable is one token
// as it stands. Neither: none. A file that others may read is warned of. Throws LoadError, which
// never tells the token: a file that cannot be read or holds none, one that is too short or comes
// twice.
std::vector<Token> read_tokens(const std::string& file, const char* variable);
// Likewise where there is to be one without a name; empty: there is none.
std::string read_token(const std::string& file, const char* variable);

// Their time does not depend on how much of what is shown is right.
bool is_token(std::string_view shown, std::string_view secret);  // false where `secret` is empty
const Token* find_token(const std::vector<Token>& tokens, std::string_view shown);  // or null

// What an Authorization header carries by "Bearer"; empty: nothing.
std::string_view bearer_of(std::string_view authorization);

// Texts that are handed out and come back unchanged: sealed with a key (HMAC-SHA-512/256, by
// libsodium), not secret. Letters of a sealed text need no escapes in JSON or an address.

class Seal {
 public:
  // The key of that file, which is made, for its owner alone, where there is none: of those who
  // make it at the same time, on other machines, too, all have the key of the first. An empty name,
  // or a file that cannot be used (which is logged): a key that ends with the process.
  // `is_own`: nobody else put the file there, so one that is cut off is made anew.
  explicit Seal(const std::string& file = "", bool is_own = false);
  std::string close(const std::string& text) const;
  // The text; empty where the seal is not by this key, or broken.
  std::optional<std::string> open(const std::string& sealed) const;

 private:
  std::array<uint8_t, 32> key_;
};

}  // namespace wellspring::wire
