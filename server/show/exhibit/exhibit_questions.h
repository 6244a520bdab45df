// SPDX-License-Identifier: Apache-2.0
// Questions that a curator has answered, out of exhibit.json: see content/README.md.
#pragma once
#include "show/exhibit/json_fields.h"

namespace wellspring::show {

void read_questions(Exhibit& exhibit, Fields& root);  // fills exhibit.questions

}  // namespace wellspring::show
