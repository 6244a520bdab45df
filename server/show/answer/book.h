// SPDX-License-Identifier: Apache-2.0
// The exhibit's book and sounds as pages are told of them, and their files.
#pragma once
#include <nlohmann/json_fwd.hpp>

#include "show/exhibit/exhibit.h"
#include "wire/http.h"

namespace wellspring::show {

nlohmann::json describe_book(const Exhibit& exhibit);  // null: there is none
nlohmann::json describe_sounds(const Exhibit& exhibit);
// Where the exhibit's picture on the front page is: its poster, or, without one, a still of few
// samples.
std::string poster_address(const Exhibit& exhibit);

// `tail`: what comes after the exhibit's id in an address, "/files/NAME". Null unless exhibit.json
// names the file: no other file of the disk can be asked for.
const ServedFile* find_served_file(const Exhibit& exhibit, const std::string& tail);
// The file, 404 when it is not there any more as it was checked.
HttpReply answer_file(const ServedFile& file);

}  // namespace wellspring::show
