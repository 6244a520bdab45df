// SPDX-License-Identifier: Apache-2.0
// Turns text into messages and back. Everything read here comes from strangers: size, nesting,
// count, types, ranges and finiteness are checked before a value exists. Nothing throws; nothing
// keeps state.
//
// Rules of reading: Unknown fields are ignored (older and newer peers understand each other); of
// equal names the last counts, as in every browser. A field of the wrong type, null included, is
// refused, not guessed. Whole numbers may be written 3 or 3.0. Absent fields keep the default of
// messages.h, except those that have no sensible one: seq (input, camera, viewpoint), position
// (camera), name (viewpoint), action (tour), frame (ack); and time, id, position, rotation and
// confidence of an observation; showing of a browser's kiosk, stage of a server's.
#pragma once
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <variant>

#include "json/text.h"
#include "wire/limits.h"
#include "wire/messages.h"

namespace wellspring::wire {

// Says why a message was refused: `code` is a fixed word for programs (bad_json, too_deep,
// too_large, unknown_type, bad_field), `message` a sentence naming the field.
using WireError = JsonError;

// Reads a browser's message. `values`: set to how many JSON values were read, good or not, unless
// it is null.
std::variant<BrowserMessage, WireError> read_browser_message(std::string_view text,
                                                             size_t* values = nullptr);
// Reads an observation. People come out nearest first whatever their order in the text. `state`
// rules; if only `presence` is given, true means person and false absent.
std::variant<Observation, WireError> read_observation(std::string_view text,
                                                      size_t* values = nullptr);
// Reads a server's order to an eye; needs that are left out are true.
std::variant<EyeOrder, WireError> read_eye_order(std::string_view text);

// These write compact text, numbers rounded to 4 decimals. A value that is not finite becomes null,
// which no reader takes.
std::string write_observation(const Observation& observation);
std::string write_eye_order(const EyeOrder& order);
std::string write_waiting(const WaitingPlace& waiting);
std::string write_error(const WireError& error);  // {"type":"error","code":..,"message":..}
// Writes browser messages as clients do (bench, tests): read_browser_message(write_message(m)) ==
// m.
std::string write_message(const BrowserMessage& message);
// Returns {type: {field: what it means}} of all of them, for GET /api/v1/.
nlohmann::json describe_browser_messages();

}  // namespace wellspring::wire
