// SPDX-License-Identifier: Apache-2.0
// What a browser asks for, carried out on the show. Refusals are answers to that browser alone.
#pragma once
#include <optional>

#include "show/state/show.h"
#include "wire/json.h"

namespace wellspring::show {

// Applies one message; the error to send back, if any.
std::optional<WireError> handle(Show& show, Visitor& visitor, const BrowserMessage& message);

}  // namespace wellspring::show
