// SPDX-License-Identifier: Apache-2.0
// Text as gzip (RFC 1952), as it goes over HTTP.
#pragma once
#include <string>
#include <string_view>

namespace wellspring::wire {

// Whether gzip makes a body of this Content-Type smaller: pictures, sound and films are packed.
bool is_text(std::string_view content_type);

// The same text gives the same bytes. Empty where they would not be fewer than the text's.
std::string gzip(std::string_view text);

}  // namespace wellspring::wire
