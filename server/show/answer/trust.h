// SPDX-License-Identifier: Apache-2.0
// Who is believed to be a kiosk of the house: whoever comes from the machine that serves, and
// whoever shows a kiosk's token. A token that is for one kiosk by name is good for no other.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "wire/json.h"
#include "wire/link.h"
#include "wire/tokens.h"

namespace wellspring::show {

// Of a `hello` with the role kiosk; any other needs no trust. `kiosk`: becomes the name of the
// kiosk that it speaks for. Else `not_trusted`, and what to do.
std::optional<WireError> check_page(const std::vector<Token>& kiosk_tokens, const Link& link,
                                    const Hello& hello, std::string& kiosk);
// Of a camera, which was let in. One whose token names its kiosk need not name it.
std::optional<WireError> check_camera(const Link& link, Observation& seen);

}  // namespace wellspring::show
