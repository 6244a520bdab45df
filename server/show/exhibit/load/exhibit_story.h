// SPDX-License-Identifier: Apache-2.0
// Texts of an exhibit that are told: read from exhibit.json or from files beside it, their marks
// checked against what the exhibit has. Problems are noted with file, line and column.
#pragma once
#include "show/exhibit/exhibit.h"
#include "show/exhibit/json_fields.h"

namespace wellspring::show {

// A text for each language: a sentence list (each a line), or the name of a .story, .ssml, .xml,
// .txt or .vtt file of the package. Also one text with markup, whose sentences are lines, where
// `may_be_text`.
LocalScript read_script(const Exhibit& exhibit, FieldReader& fields, const char* name,
                        bool may_be_text, std::vector<Problem>& problems,
                        Need need = Need::optional);

// Recordings of such texts: for each language a sound file of the package; their paths.
LocalText read_sounds(const Exhibit& exhibit, FieldReader& fields, const char* name,
                      const LocalScript& script);

VoiceManner read_manner(FieldReader& fields, const char* name, const VoiceManner& otherwise);

// Checks, after everything is read, whether emotions, gestures, objects, props, viewpoints and
// pieces of all marks are there, and whether languages have as many sentences as each other. A
// fault is not fatal.
void check_marks(const Exhibit& exhibit, std::vector<Problem>& problems);

// Questions that a curator has answered, out of exhibit.json: see content/README.md.

void read_questions(Exhibit& exhibit, FieldReader& root);  // fills exhibit.questions

// The kiosks of a package.

// `kiosks` of exhibit.json, or of a house's file, which is read after it: what it says of a kiosk
// takes the place of what was said. The viewpoints and storytellers that they name are read
// already.
void read_kiosks(Exhibit& exhibit, FieldReader& root);

}  // namespace wellspring::show
