// SPDX-License-Identifier: Apache-2.0
#include "workers/sealed.h"

#include <sodium.h>

namespace wellspring::workers {

MessageKey make_message_key(const std::string& secret) {
  if (secret.empty()) return std::nullopt;
  std::array<uint8_t, 32> key;
  static_assert(crypto_auth_KEYBYTES == 32);
  crypto_generichash(key.data(), key.size(), reinterpret_cast<const uint8_t*>(secret.data()),
                     secret.size(), nullptr, 0);
  return key;
}

std::string seal(std::string bytes, const MessageKey& key) {
  if (!key) return bytes;
  std::array<uint8_t, crypto_auth_BYTES> seal;
  crypto_auth(seal.data(), reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size(),
              key->data());
  bytes.append(reinterpret_cast<const char*>(seal.data()), seal.size());
  return bytes;
}

std::optional<std::string_view> unseal(std::string_view bytes, const MessageKey& key) {
  if (!key) return bytes;
  if (bytes.size() < crypto_auth_BYTES) return {};
  const auto* begin = reinterpret_cast<const uint8_t*>(bytes.data());
  const size_t size = bytes.size() - crypto_auth_BYTES;
  if (crypto_auth_verify(begin + size, begin, size, key->data()) != 0) return {};
  return bytes.substr(0, size);
}

}  // namespace wellspring::workers
