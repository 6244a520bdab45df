// SPDX-License-Identifier: Apache-2.0
// Keeps what is known at the moment (the paper's context store): what sensors and solvers found,
// each value with a type and a quality. Solvers read and write it; others may read it.
#pragma once
#include <map>
#include <string>
#include <variant>

#include "kiosk/tree/tree.h"

namespace wellspring::kiosk {

using ContextValue = std::variant<double, std::string, vec3, mat3>;

class ContextStore {
 public:
  void set(const std::string& name, ContextValue value, double quality = 1) {
    values_[name] = {std::move(value), quality};
  }
  void forget(const std::string& name) { values_.erase(name); }
  bool has(const std::string& name) const { return values_.contains(name); }
  // Returns the value, or null: it is not known, or of another type.
  template <class T>
  const T* get(const std::string& name) const {
    const auto found = values_.find(name);
    return found == values_.end() ? nullptr : std::get_if<T>(&found->second.value);
  }
  // Returns 0 for a value that is not known.
  double quality(const std::string& name) const {
    const auto found = values_.find(name);
    return found == values_.end() ? 0 : found->second.quality;
  }
  bool holds(const Conditions& conditions) const {
    for (const Condition& one : conditions) {
      const auto found = values_.find(one.value);
      if (found == values_.end() || found->second.quality < one.quality) return false;
      if (const double* number = std::get_if<double>(&found->second.value))
        if (!(*number >= one.least && *number <= one.most)) return false;
      if (one.is.empty()) continue;
      const std::string* text = std::get_if<std::string>(&found->second.value);
      if (!text || *text != one.is) return false;
    }
    return true;
  }

 private:
  struct Entry {
    ContextValue value;
    double quality = 1;
  };
  std::map<std::string, Entry> values_;
};

}  // namespace wellspring::kiosk
