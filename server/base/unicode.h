// SPDX-License-Identifier: Apache-2.0
// Names that look the same are the same: "é" may be one letter, or "e" and an accent, as disks and
// exporters of some systems write it.
#pragma once
#include <string>
#include <string_view>

namespace wellspring {

// Unicode's normalisation form C (UAX #15), by which names are compared. What is no UTF-8 stays.
std::string nfc(std::string_view text);

}  // namespace wellspring
