// SPDX-License-Identifier: Apache-2.0
#include "wire/tokens.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <sodium.h>
#include <stdexcept>
#include <sys/stat.h>
#include <unistd.h>
#include <vector>

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

// Adds a token that stands at `place`.
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

// Returns the variable's value, and overwrites it in its memory, which /proc/PID/environ shows.
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

namespace {

constexpr int letters = sodium_base64_VARIANT_URLSAFE_NO_PADDING;
static_assert(crypto_auth_KEYBYTES == 32);

std::string encode(const uint8_t* bytes, size_t size) {
  std::string text(sodium_base64_encoded_len(size, letters), '\0');
  sodium_bin2base64(text.data(), text.size(), bytes, size, letters);
  text.pop_back();  // the terminating zero
  return text;
}

std::optional<std::vector<uint8_t>> decode(const std::string& text) {
  std::vector<uint8_t> bytes(text.size());
  if (bytes.empty()) return bytes;  // libsodium wants a place to write to
  size_t size = 0;
  const char* end = nullptr;
  if (sodium_base642bin(bytes.data(), bytes.size(), text.data(), text.size(), nullptr, &size, &end,
                        letters) != 0 ||
      end != text.data() + text.size())
    return {};
  bytes.resize(size);
  return bytes;
}

bool read_key(const std::string& file, std::array<uint8_t, 32>& key) {
  const int in = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (in < 0) return false;
  const bool whole = read(in, key.data(), key.size()) == ssize_t(key.size());
  close(in);
  return whole;
}

// Writes the key under a temporary name, then gives it its name: nobody sees it half written, and
// no key is replaced except one that is cut off. False: errno says why.
bool write_key(const std::string& file, const std::array<uint8_t, 32>& key, bool replaces) {
  std::string fresh = file + ".XXXXXX";
  const int out = mkostemp(fresh.data(), O_CLOEXEC);
  if (out < 0) return false;
  bool written = write(out, key.data(), key.size()) == ssize_t(key.size()) && fsync(out) == 0;
  written =
      close(out) == 0 && written &&
      (replaces ? rename(fresh.c_str(), file.c_str()) : link(fresh.c_str(), file.c_str())) == 0;
  const int problem = errno;
  unlink(fresh.c_str());
  errno = problem;
  return written;
}

}  // namespace

Seal::Seal(const std::string& file, bool is_own) {
  if (sodium_init() < 0) throw std::runtime_error("libsodium does not start");
  if (!file.empty() && read_key(file, key_)) return;
  crypto_auth_keygen(key_.data());
  std::error_code ec;
  std::filesystem::create_directories(std::filesystem::path(file).parent_path(), ec);
  const auto size = std::filesystem::file_size(file, ec);
  const bool cut_off = is_own && !file.empty() && !ec && size < key_.size();
  if (file.empty() || write_key(file, key_, cut_off)) {
    if (cut_off)
      log::warn("{}: was cut off, and is made anew: visits of before begin from the start", file);
    return;
  }
  if (errno == EEXIST && read_key(file, key_)) return;  // another process was faster
  log::warn("{}: holds no key and cannot be made ({}): visits end with this process", file,
            std::strerror(errno));
}

std::string Seal::close(const std::string& text) const {
  std::array<uint8_t, crypto_auth_BYTES> mark;
  const auto* bytes = reinterpret_cast<const uint8_t*>(text.data());
  crypto_auth(mark.data(), bytes, text.size(), key_.data());
  return encode(bytes, text.size()) + "." + encode(mark.data(), mark.size());
}

std::optional<std::string> Seal::open(const std::string& sealed) const {
  const size_t dot = sealed.find('.');
  if (dot == std::string::npos) return {};
  const auto bytes = decode(sealed.substr(0, dot)), mark = decode(sealed.substr(dot + 1));
  if (!bytes || !mark || mark->size() != crypto_auth_BYTES ||
      crypto_auth_verify(mark->data(), bytes->data(), bytes->size(), key_.data()) != 0)
    return {};
  return std::string(bytes->begin(), bytes->end());
}

}  // namespace wellspring::wire
