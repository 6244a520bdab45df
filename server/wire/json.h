// SPDX-License-Identifier: Apache-2.0
// Text to messages and back. Everything read here comes from strangers: size, nesting, types,
// ranges and finiteness are checked before a value exists. Nothing throws; nothing keeps state.
//
// Rules of reading. Unknown fields are ignored (older and newer peers understand each other); of
// equal names the last counts, as in every browser. A field of the wrong type, null included, is
// refused, not guessed. Whole numbers may be written 3 or 3.0. Absent fields keep the default of
// messages.h, but for those that have no sensible one: seq (input, camera, viewpoint), position
// (camera), name (viewpoint), action (tour), frame (ack); and time, id, position, rotation and
// confidence of an observation.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <variant>

#include "wire/messages.h"

namespace wellspring {

inline constexpr size_t max_message_bytes = 64 * 1024;
inline constexpr int max_message_depth = 32;

// Limits of single fields; outside of them a message is refused with bad_field.
inline constexpr size_t max_name_bytes = 200;    // every string: UTF-8 without control characters
inline constexpr double max_speed = 20;          // m/s, length of input.move
inline constexpr double max_angle = 100;         // radians, every angle; the user wraps it
inline constexpr double max_coordinate = 1e6;    // metres, camera.position
inline constexpr double max_kiosk_distance = 100;  // metres, each coordinate of a person's position
inline constexpr double max_time = 1e12;         // seconds, observation.time, both signs
inline constexpr double max_decoded_ms = 600e3;  // ack.decoded_ms, from 0
inline constexpr int min_side = 16, max_side = 4096;  // width and height in pixels
inline constexpr double min_fps = 0, max_fps = 240;   // settings.fps; 0: as the server likes
inline constexpr int min_jpeg_quality = 1,
                     max_jpeg_quality = 100;     // settings.quality and .max_quality
inline constexpr size_t max_people = 32;         // in one observation

// Why a message was refused: `code` is a fixed word for programs (bad_json, too_deep, too_large,
// unknown_type, bad_field), `message` a sentence naming the field.
struct WireError {
  std::string code, message;
};

std::variant<BrowserMessage, WireError> read_browser_message(std::string_view text);
// People come out nearest first whatever their order in the text. `state` rules; where only
// `presence` is given, true means person and false absent.
std::variant<Observation, WireError> read_observation(std::string_view text);

// Compact, numbers rounded to 4 decimals. A value that is not finite becomes null, which no reader
// takes.
std::string write_observation(const Observation& observation);
std::string write_error(const WireError& error);  // {"type":"error","code":..,"message":..}
// Browser messages as clients write them (bench, tests): read_browser_message(write_message(m)) ==
// m.
std::string write_message(const BrowserMessage& message);

// Parses with a depth limit: nlohmann's own parser takes any depth, but copying or dumping what it
// made of 100,000 brackets overflows the stack. Stops at the first bracket too many (depth of
// `[[1]]` is 2). Returns a WireError (bad_json, too_deep; bad_field for a number no double can
// hold) naming the place.
std::variant<nlohmann::json, WireError> parse_json(std::string_view text,
                                                   int max_depth = max_message_depth);

}  // namespace wellspring
