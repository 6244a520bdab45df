// SPDX-License-Identifier: Apache-2.0
// Seals bytes with a secret that machines share (HMAC-SHA-512/256, by libsodium), so that nobody
// else on the line can write them.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/layers.h"

namespace wellspring::workers {

// Holds the key that a secret makes; none: messages are not sealed.
using MessageKey = std::optional<std::array<uint8_t, 32>>;
MessageKey make_message_key(const std::string& secret);  // a secret of any length; empty: no key

std::string seal(std::string bytes, const MessageKey& key);
// Returns the bytes without their seal; nothing: the seal is not by this key, or broken.
std::optional<std::string_view> unseal(std::string_view bytes, const MessageKey& key);

}  // namespace wellspring::workers
