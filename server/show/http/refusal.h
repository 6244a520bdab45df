// SPDX-License-Identifier: Apache-2.0
// Makes the answer to a question that is refused.
#pragma once
#include <string>

#include "base/layers.h"
#include "wire/http.h"

namespace wellspring::show {

// Returns {"error": {"code", "message"}} with that HTTP status, which no cache keeps.
HttpReply refuse(int status, const char* code, const std::string& message);

}  // namespace wellspring::show
