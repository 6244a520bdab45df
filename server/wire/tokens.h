// SPDX-License-Identifier: Apache-2.0
// Reads and compares secrets that an operator hands out: whoever shows one is trusted. They come
// from files or from the environment, never from a command line, which every user of a machine can
// read.
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
  std::string name;  // the only kiosk that may use it; empty: any
  std::string secret;
};

// Returns the tokens of a file, else of the environment's `variable`, which is wiped: programs that
// are started afterwards, and /proc, do not show it. A line of the file is TOKEN, or NAME TOKEN (a
// name may have spaces); empty lines and those that begin with # are skipped. The variable is one
// token as it stands. Neither: none. If others may read the file, there is a warning. Throws
// LoadError, which never holds the token: for a file that cannot be read or holds none, and for a
// token that is too short or comes twice.
std::vector<Token> read_tokens(const std::string& file, const char* variable);
// Does the same for a single token without a name; empty: there is none.
std::string read_token(const std::string& file, const char* variable);

// The time of these two does not depend on how much of the shown token is right.
bool is_token(std::string_view shown, std::string_view secret);  // false if `secret` is empty
const Token* find_token(const std::vector<Token>& tokens, std::string_view shown);  // or null

// Returns the token of an Authorization header with "Bearer"; empty: there is none.
std::string_view bearer_of(std::string_view authorization);

// Seals texts that are handed out and come back unchanged: with a key (HMAC-SHA-512/256, by
// libsodium), not secret. Letters of a sealed text need no escapes in JSON or an address.

class Seal {
 public:
  // Uses the key of that file, which is made, for its owner alone, if there is none: if several
  // processes make it at the same time, on other machines, too, all have the key of the first. An
  // empty name, or a file that cannot be used (which is logged): a key that ends with the process.
  // `is_own`: nobody else put the file there, so a key that is cut off is made anew.
  explicit Seal(const std::string& file = "", bool is_own = false);
  std::string close(const std::string& text) const;
  // Returns the text; empty: the seal is not by this key, or broken.
  std::optional<std::string> open(const std::string& sealed) const;

 private:
  std::array<uint8_t, 32> key_;
};

}  // namespace wellspring::wire
