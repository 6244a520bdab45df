// SPDX-License-Identifier: Apache-2.0
// All that is told in an exhibit, to be read.
#pragma once
#include <nlohmann/json_fwd.hpp>

#include "show/exhibit/exhibit.h"

namespace wellspring::show {

// {stories: [{id, title, teller, text: {lang: [sentence]}}], tours: [{id, title, stops: [{title,
// way_text, text}]}]}, without marks, in all languages; `teller` where the story has one.
nlohmann::json describe_transcript(const Exhibit& exhibit);

}  // namespace wellspring::show
