// SPDX-License-Identifier: Apache-2.0
// Holds what the measuring programs of kiosk/ share: means, and results as the bench reads them.
#pragma once
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

namespace wellspring::test {

struct Mean {
  double sum = 0;
  int count = 0;
  void add(double value) { sum += value, count++; }
  double value() const { return count ? sum / count : NAN; }
};

// Prints a result; nothing for a value that is no number.
inline void tell(const std::string& name, double value, const std::string& unit,
                 const nlohmann::json& fields = {}) {
  if (std::isnan(value)) return;
  nlohmann::json out{{"name", name}, {"value", value}, {"unit", unit}};
  if (!fields.is_null()) out.update(fields);
  std::puts(out.dump().c_str());
  std::fflush(stdout);
}

}  // namespace wellspring::test
