// SPDX-License-Identifier: Apache-2.0
// A visitor points at ground or at an object of its picture, and the camera goes there.
#pragma once
#include <optional>

#include "show/state/show.h"
#include "wire/json.h"

namespace wellspring::show {

// The visitor is on its way afterwards, and told so ("went"), or looks at an object from all sides
// ("state"); else the error: no_way,
// nothing_there, unknown_object or bad_field.
std::optional<WireError> go(Show& show, Visitor& visitor, const GoTo& order);

}  // namespace wellspring::show
