// SPDX-License-Identifier: Apache-2.0
// Defines the error that every load_ function throws for wrong input: which file, which place in
// it, and the reason.
#pragma once
#include <stdexcept>
#include <string>

#include "base/layers.h"

namespace wellspring {

struct LoadError : std::runtime_error {
  std::string file;   // path as the caller gave it
  std::string where;  // place inside: a JSON pointer, "line 12", "byte 80"; may be empty
  std::string what_;  // one sentence, no full stop needed
  LoadError(std::string file_, std::string where_, std::string what__)
      : std::runtime_error(file_ + (where_.empty() ? "" : ": " + where_) + ": " + what__),
        file(std::move(file_)),
        where(std::move(where_)),
        what_(std::move(what__)) {}
};

}  // namespace wellspring
