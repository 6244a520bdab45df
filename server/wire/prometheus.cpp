// SPDX-License-Identifier: Apache-2.0
#include "wire/prometheus.h"

#include <fmt/core.h>

#include <algorithm>

namespace wellspring::wire {

void begin_metric(std::string& out, std::string_view name, std::string_view help) {
  out += fmt::format("# HELP wellspring_{0} {1}\n# TYPE wellspring_{0} {2}\n", name, help,
                     name.ends_with("_total") ? "counter" : "gauge");
}

void add_sample(std::string& out, std::string_view name, std::initializer_list<MetricLabel> labels,
                const MetricValue& value) {
  std::string all;
  for (const MetricLabel& label : labels) {
    if (label.value.empty()) continue;
    std::string text = label.value;
    std::ranges::replace_if(
        text, [](char c) { return c == '"' || c == '\\' || c == '\n'; }, '\'');
    all += fmt::format("{}{}=\"{}\"", all.empty() ? "" : ",", label.name, text);
  }
  out += all.empty() ? fmt::format("wellspring_{} {}\n", name, value.text)
                     : fmt::format("wellspring_{}{{{}}} {}\n", name, all, value.text);
}

void add_metric(std::string& out, std::string_view name, std::string_view help,
                const MetricValue& value) {
  begin_metric(out, name, help);
  add_sample(out, name, {}, value);
}

}  // namespace wellspring::wire
