// SPDX-License-Identifier: Apache-2.0
#include "wire/seal.h"

#include <fcntl.h>
#include <sodium.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <vector>

#include "base/log.h"

namespace wellspring::wire {

namespace {

constexpr int letters = sodium_base64_VARIANT_URLSAFE_NO_PADDING;
static_assert(crypto_auth_KEYBYTES == 32);

std::string encode(const uint8_t* bytes, size_t size) {
  std::string text(sodium_base64_encoded_len(size, letters), '\0');
  sodium_bin2base64(text.data(), text.size(), bytes, size, letters);
  text.pop_back();  // its terminating zero
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

// Under a name of its own, then by its name: nobody sees it half written, and none is replaced but
// one that is cut off. False: errno says why.
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
