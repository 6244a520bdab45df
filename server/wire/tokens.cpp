// SPDX-License-Identifier: Apache-2.0
#include "wire/tokens.h"

#include <sodium.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include "base/load_error.h"
#include "base/log.h"

namespace wellspring::wire {

namespace {

constexpr std::string_view blank = " \t\r";

using Hash = std::array<uint8_t, crypto_generichash_BYTES>;

Hash hash_of(std::string_view text) {
  Hash hash;
  crypto_generichash(hash.data(), hash.size(), reinterpret_cast<const uint8_t*>(text.data()),
                     text.size(), nullptr, 0);
  return hash;
}

std::string_view trim(std::string_view text) {
  const size_t begin = text.find_first_not_of(blank);
  if (begin == text.npos) return {};
  return text.substr(begin, text.find_last_not_of(blank) + 1 - begin);
}

// Adds a token of `place`.
void add(std::vector<Token>& tokens, Token token, const std::string& file,
         const std::string& place) {
  if (token.secret.size() < least_token_bytes)
    throw LoadError(file, place, "a token has at least 16 characters");
  if (std::ranges::any_of(token.secret, [](unsigned char c) { return c < 32 || c == 127; }))
    throw LoadError(file, place, "a token has no control characters");
  if (std::ranges::any_of(tokens, [&](const Token& one) { return one.secret == token.secret; }))
    throw LoadError(file, place, "this token is there already");
  tokens.push_back(std::move(token));
}

std::vector<Token> read_file(const std::string& file) {
  std::ifstream in(file);
  if (!in) throw LoadError(file, "", "cannot be read");
  struct stat about {};
  if (stat(file.c_str(), &about) == 0 && (about.st_mode & (S_IRGRP | S_IROTH)))
    log::warn("{}: others may read these tokens; chmod 600 keeps them for its owner", file);
  std::vector<Token> tokens;
  std::string line;
  for (int number = 1; std::getline(in, line); number++) {
    const std::string_view words = trim(line);
    if (words.empty() || words.front() == '#') continue;
    const size_t last = words.find_last_of(blank);
    Token token;
    if (last != words.npos) token.name = trim(words.substr(0, last));
    token.secret = words.substr(last == words.npos ? 0 : last + 1);
    add(tokens, std::move(token), file, "line " + std::to_string(number));
  }
  if (tokens.empty()) throw LoadError(file, "", "holds no token");
  return tokens;
}

// The variable's value, which is overwritten where it stands: /proc/PID/environ shows that place.
std::string take_variable(const char* variable) {
  char* value = getenv(variable);
  if (!value) return {};
  std::string text = value;
  explicit_bzero(value, text.size());
  unsetenv(variable);
  return text;
}

}  // namespace

std::vector<Token> read_tokens(const std::string& file, const char* variable) {
  const std::string value = take_variable(variable);
  if (!file.empty()) return read_file(file);
  std::vector<Token> tokens;
  if (!value.empty()) add(tokens, {{}, value}, variable, "");
  return tokens;
}

std::string read_token(const std::string& file, const char* variable) {
  const std::vector<Token> tokens = read_tokens(file, variable);
  if (tokens.empty()) return {};
  if (tokens.size() > 1 || !tokens[0].name.empty())
    throw LoadError(file, "", "holds more than one token");
  return tokens[0].secret;
}

bool is_token(std::string_view shown, std::string_view secret) {
  const Hash a = hash_of(shown), b = hash_of(secret);
  return sodium_memcmp(a.data(), b.data(), a.size()) == 0 && !secret.empty();
}

const Token* find_token(const std::vector<Token>& tokens, std::string_view shown) {
  const Token* found = nullptr;
  for (const Token& token : tokens)
    if (is_token(shown, token.secret)) found = &token;
  return found;
}

std::string_view bearer_of(std::string_view authorization) {
  constexpr std::string_view scheme = "bearer ";
  if (authorization.size() <= scheme.size()) return {};
  for (size_t i = 0; i < scheme.size(); i++)
    if ((authorization[i] | 0x20) != scheme[i]) return {};
  return authorization.substr(scheme.size());
}

}  // namespace wellspring::wire
