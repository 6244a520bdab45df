// SPDX-License-Identifier: Apache-2.0
// Objects in words: label, provenance and links of each, and the map on which they stand.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "show/exhibit/exhibit.h"
#include "show/visit/walk_map.h"
#include "wire/http.h"

namespace wellspring::show {

// [{id, title, position, text, story, provenance, manifest, around}], texts in all languages; of
// the last five those that there are. provenance: [{element, value}] in the order of the Dublin
// Core.
nlohmann::json describe_objects(const Exhibit& exhibit);
// The same with texts in one language; those that have a title.
nlohmann::json describe_objects(const Exhibit& exhibit, const std::string& lang);

// GET .../map: the ground from above, JSON. rows[i][j] is the cell at corner + cell * (j, i) of x
// and z: 'o' where there is room to walk, 'x' where something stands, '.' elsewhere.
std::string describe_map(const Exhibit& exhibit, const WalkMap& map);

// The exhibit's book and sounds as pages are told of them, and their files.

nlohmann::json describe_book(const Exhibit& exhibit);  // null: there is none
nlohmann::json describe_sounds(const Exhibit& exhibit);
// Returns the address of the exhibit's picture on the front page: its poster, or, without one, a
// still of few samples.
std::string poster_address(const Exhibit& exhibit);

// `tail`: what comes after the exhibit's id in an address, "/files/NAME". Null unless exhibit.json
// names the file: no other file of the disk can be asked for.
const ServedFile* find_served_file(const Exhibit& exhibit, const std::string& tail);
// The file, 404 when it is not there any more as it was checked.
HttpReply answer_file(const ServedFile& file);

// All that is told in an exhibit, to be read.

// {stories: [{id, title, teller, text: {lang: [sentence]}}], tours: [{id, title, stops: [{title,
// way_text, text}]}]}, without marks, in all languages; `teller` where the story has one.
nlohmann::json describe_transcript(const Exhibit& exhibit);

}  // namespace wellspring::show
