// SPDX-License-Identifier: Apache-2.0
// Text to messages and back. Everything read here comes from strangers: size, nesting, types, ranges and
// finiteness are checked before a value exists. Nothing throws; nothing keeps state.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <variant>

#include "wire/messages.h"

namespace wellspring {

inline constexpr size_t max_message_bytes = 64 * 1024;
inline constexpr int max_message_depth = 32;

// Why a message was refused: `code` is a fixed word for programs (bad_json, too_deep, too_large,
// unknown_type, bad_field), `message` a sentence naming the field.
struct WireError {
  std::string code, message;
};

std::variant<BrowserMessage, WireError> read_browser_message(std::string_view text);
std::variant<Observation, WireError> read_observation(std::string_view text);

std::string write_observation(const Observation& observation);
std::string write_error(const WireError& error);  // {"type":"error","code":..,"message":..}
// Browser messages as clients write them (bench, tests): read_browser_message(write_message(m)) == m.
std::string write_message(const BrowserMessage& message);

// Parses with the depth limit (nlohmann's own parser has none that survives copying). nullptr-safe use:
// returns a WireError for bad or too deep text.
std::variant<nlohmann::json, WireError> parse_json(std::string_view text, int max_depth = max_message_depth);

}  // namespace wellspring
