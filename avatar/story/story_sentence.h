// SPDX-License-Identifier: Apache-2.0
// Where the sentences of a paragraph end, in any language that ends them with . ! ? or an ellipsis.
#pragma once
#include <cstdint>
#include <string_view>
#include <vector>

namespace wellspring::avatar {

struct TextSpan {
  uint32_t begin = 0, end = 0;  // bytes, without spaces around
};

// A full stop after a number of one or two digits ("13. Jahrhundert") or a single letter ("z. B.")
// ends nothing, nor does one that a small letter follows; closing quotes and brackets belong to the
// sentence.
std::vector<TextSpan> find_sentences(std::string_view text);

}  // namespace wellspring::avatar
