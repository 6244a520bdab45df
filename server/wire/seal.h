// SPDX-License-Identifier: Apache-2.0
// Texts that are handed out and come back unchanged: sealed with a key (HMAC-SHA-512/256, by
// libsodium), not secret. Letters of a sealed text need no escapes in JSON or an address.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace wellspring::wire {

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
