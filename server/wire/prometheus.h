// SPDX-License-Identifier: Apache-2.0
// Appends lines of Prometheus' text format (version 0.0.4) to a text. Names get the prefix
// wellspring_; those that end in _total are counters, all others gauges.
#pragma once
#include <charconv>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <type_traits>

namespace wellspring::wire {

// Holds a number in as few digits as it needs in its own type; whole ones without an exponent.
struct MetricValue {
  std::string text;
  template <class Number>
  requires std::is_arithmetic_v<Number> MetricValue(Number number) {
    constexpr double most_whole = 1e15;
    if constexpr (std::same_as<Number, bool>) {
      put(int(number));
    } else if constexpr (std::is_floating_point_v<Number>) {
      const bool whole = std::abs(number) < most_whole && std::trunc(number) == number;
      if (whole) put(int64_t(number));
      else put(number);
    } else {
      put(number);
    }
  }

 private:
  template <class Number>
  void put(Number number) {
    char digits[64];
    text.assign(digits, std::to_chars(digits, digits + sizeof digits, number).ptr);
  }
};

// Holds a label: quotes, backslashes and line ends of its value become apostrophes. A label without
// a value is left out.
struct MetricLabel {
  std::string_view name;
  std::string value;
};

// Appends the comments with which a family of samples begins.
void begin_metric(std::string& out, std::string_view name, std::string_view help);
void add_sample(std::string& out, std::string_view name, std::initializer_list<MetricLabel> labels,
                const MetricValue& value);
// Appends a family of one sample without labels.
void add_metric(std::string& out, std::string_view name, std::string_view help,
                const MetricValue& value);

}  // namespace wellspring::wire
