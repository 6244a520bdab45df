// SPDX-License-Identifier: Apache-2.0
// Values of attributes of a story's markup, as SSML 1.1 writes them. Empty: it is none.
#pragma once
#include <optional>
#include <string>

namespace wellspring::avatar {

std::optional<float> read_seconds(const std::string& text);         // "500ms", "1.5s"; at most 10 s
std::optional<float> read_break_strength(const std::string& text);  // seconds; none .. x-strong
// As a factor of the speaker's own: "80%", "+10%", "-2st", "slow", "1.2"; cut to 0.3 .. 3.
std::optional<float> read_rate(const std::string& text);
std::optional<float> read_pitch(const std::string& text);
std::optional<float> read_volume(const std::string& text);  // "+6dB", "loud", "80%"
std::optional<float> read_weight(const std::string& text);  // 0 .. 1, or "60%"
std::optional<int> read_emphasis(const std::string& text);  // -1 .. 2

}  // namespace wellspring::avatar
