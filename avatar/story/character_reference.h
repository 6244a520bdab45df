// SPDX-License-Identifier: Apache-2.0
// Character references of HTML, as stories and subtitles may have them: &amp;, &eacute; and all
// other names of HTML 4, &apos;, and numbers (&#8211;, &#x2013;).
#pragma once
#include <string>
#include <string_view>

namespace wellspring::avatar {

// Appends what the reference at the beginning of `text` stands for. Returns its bytes; 0 when none
// begins there.
size_t read_character_reference(std::string_view text, std::string& to);

}  // namespace wellspring::avatar
