// SPDX-License-Identifier: Apache-2.0
// Has the libraries of expressions and gestures that come with the program, and reads what their
// files have in common.
#pragma once
#include <string_view>

#include "json/fields.h"

namespace wellspring::avatar {

// Returns the data in avatar/library/ as compiled into the program, so that no installation lacks
// it.

std::string_view default_gestures_json();
std::string_view default_expressions_json();

// Reads the head of a file: it calls itself `format`, version 1.
inline void read_library_head(FieldReader& root, const char* format) {
  int version = 0;
  root.choice("format", {format}, version, "", Need::required);
  root.integer("version", 1, 1, version, "", Need::required);
  root.take("about");
}

}  // namespace wellspring::avatar
