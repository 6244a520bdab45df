// SPDX-License-Identifier: Apache-2.0
// Files of tokens, and headers that show one.
#include <cstdlib>

#include "fuzz/fuzz.h"
#include "wire/tokens.h"

namespace wellspring::fuzz {
namespace {

constexpr const char* variable = "WELLSPRING_FUZZ_TOKEN";

void check(const std::vector<Token>& tokens) {
  for (const Token& token : tokens) {
    require(token.secret.size() >= least_token_bytes, "tokens are long");
    require(find_token(tokens, token.secret) == &token, "a token is found again");
    require(bearer_of("Bearer " + token.secret) == token.secret, "a header can carry it");
  }
  require(!find_token(tokens, ""), "nothing is no token");
}

}  // namespace

void fuzz_tokens(Bytes bytes) {
  const std::string text = text_of(bytes), file = write_file("fuzz.tokens", bytes);
  std::filesystem::permissions(file, std::filesystem::perms(0600));
  load([&] { check(read_tokens(file, variable)); });
  load([&] { read_token(file, variable); });
  setenv(variable, text.c_str(), 1);
  load([&] { check(read_tokens("", variable)); });
  require(!getenv(variable), "the variable is wiped");
  require(text.ends_with(bearer_of(text)), "what is shown is the header's end");
}

}  // namespace wellspring::fuzz
