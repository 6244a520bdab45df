// SPDX-License-Identifier: Apache-2.0
#include "avatar/story/story_value.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <initializer_list>
#include <string_view>
#include <utility>

namespace wellspring::avatar {

namespace {

using Words = std::initializer_list<std::pair<std::string_view, float>>;

std::optional<float> find_word(const std::string& text, Words words) {
  for (auto [word, value] : words)
    if (text == word) return value;
  return {};
}

// A number at the beginning of `text`, and what follows it.
std::optional<float> read_number(std::string_view text, std::string_view& unit) {
  if (!text.empty() && text[0] == '+') text.remove_prefix(1);
  float value = 0;
  auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || !std::isfinite(value)) return {};
  unit = text.substr(size_t(end - text.data()));
  return value;
}

std::optional<float> in_reach(std::optional<float> factor) {
  if (!factor || !std::isfinite(*factor) || *factor <= 0) return {};
  return std::clamp(*factor, 0.3f, 3.0f);
}

// "+10%" and "110%" are 1.1, "+2st" two semitones, "+6dB" twice the amplitude; a bare number is a
// factor.
std::optional<float> read_factor(const std::string& text, bool decibels) {
  std::string_view unit;
  std::optional<float> number = read_number(text, unit);
  if (!number) return {};
  bool relative = text[0] == '+' || text[0] == '-';
  if (unit == "%") return in_reach(relative ? 1 + *number / 100 : *number / 100);
  if (unit == "st" && !decibels) return in_reach(std::pow(2.0f, *number / 12));
  if (unit == "dB" && decibels) return in_reach(std::pow(10.0f, *number / 20));
  if (unit.empty() && !relative) return in_reach(number);
  return {};
}

}  // namespace

std::optional<float> read_seconds(const std::string& text) {
  std::string_view unit;
  std::optional<float> number = read_number(text, unit);
  if (!number || *number < 0) return {};
  float seconds = unit == "ms" ? *number / 1000 : unit == "s" ? *number : -1;
  return seconds >= 0 && seconds <= 10 ? std::optional(seconds) : std::nullopt;
}

std::optional<float> read_break_strength(const std::string& text) {
  return find_word(text, {{"none", 0.0f},
                          {"x-weak", 0.1f},
                          {"weak", 0.2f},
                          {"medium", 0.35f},
                          {"strong", 0.7f},
                          {"x-strong", 1.2f}});
}

std::optional<float> read_rate(const std::string& text) {
  auto word = find_word(text, {{"x-slow", 0.6f},
                               {"slow", 0.8f},
                               {"medium", 1.0f},
                               {"default", 1.0f},
                               {"fast", 1.25f},
                               {"x-fast", 1.6f}});
  return word ? word : read_factor(text, false);
}

std::optional<float> read_pitch(const std::string& text) {
  auto word = find_word(text, {{"x-low", 0.7f},
                               {"low", 0.85f},
                               {"medium", 1.0f},
                               {"default", 1.0f},
                               {"high", 1.15f},
                               {"x-high", 1.35f}});
  return word ? word : read_factor(text, false);
}

std::optional<float> read_volume(const std::string& text) {
  auto word = find_word(text, {{"silent", 0.3f},
                               {"x-soft", 0.4f},
                               {"soft", 0.7f},
                               {"medium", 1.0f},
                               {"default", 1.0f},
                               {"loud", 1.4f},
                               {"x-loud", 2.0f}});
  return word ? word : read_factor(text, true);
}

std::optional<float> read_weight(const std::string& text) {
  std::string_view unit;
  std::optional<float> number = read_number(text, unit);
  if (!number || (!unit.empty() && unit != "%")) return {};
  float weight = unit == "%" ? *number / 100 : *number;
  return weight >= 0 && weight <= 1 ? std::optional(weight) : std::nullopt;
}

std::optional<int> read_emphasis(const std::string& text) {
  auto word =
      find_word(text, {{"none", 0.0f}, {"reduced", -1.0f}, {"moderate", 1.0f}, {"strong", 2.0f}});
  return word ? std::optional(int(*word)) : std::nullopt;
}

}  // namespace wellspring::avatar
