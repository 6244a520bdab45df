// SPDX-License-Identifier: Apache-2.0
// Bounds how large a message, and each of its fields, may be.
#pragma once
#include <cstddef>

namespace wellspring::wire {

inline constexpr size_t max_message_bytes = 64 * 1024;
// Texts of browsers are read only up to the size that they need: a hello with its two tokens, any
// other message, and the values of JSON in either.
inline constexpr size_t max_hello_bytes = 16 * 1024, max_order_bytes = 2 * 1024;
inline constexpr size_t max_order_values = 256, max_observation_values = 8192;

// Limits of single fields; outside of them a message is refused with bad_field.
inline constexpr double max_speed = 20;            // m/s, length of input.move
inline constexpr double max_angle = 100;           // radians, every angle; the user wraps it
inline constexpr double max_coordinate = 1e6;      // metres, camera.position
inline constexpr double max_kiosk_distance = 100;  // metres, each coordinate of a person's position
inline constexpr double max_mark = 20;             // metres of a calibration's mark from the screen
inline constexpr double max_time = 1e12;           // seconds, observation.time, both signs
inline constexpr double max_decoded_ms = 600e3;    // ack.decoded_ms, from 0
inline constexpr int min_side = 16, max_side = 4096;  // width and height in pixels
inline constexpr double min_fps = 0, max_fps = 240;   // settings.fps; 0: the server chooses
inline constexpr int min_jpeg_quality = 1,
                     max_jpeg_quality = 100;  // settings.quality and .max_quality
inline constexpr int min_bandwidth = 0, max_bandwidth = 10'000'000;  // settings.bandwidth, kbit/s
inline constexpr int max_wall_side = 8;   // screens of a wall beside, and above, one another
inline constexpr size_t max_people = 32;  // most people in one observation
inline constexpr size_t max_languages = 16,
                        max_language = 16;  // texts by language; bytes of a name

}  // namespace wellspring::wire
