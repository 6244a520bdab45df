// SPDX-License-Identifier: Apache-2.0
// The book of an exhibit and the sounds of its rooms, out of exhibit.json: see content/README.md.
#pragma once
#include "show/exhibit/json_fields.h"

namespace wellspring::show {

inline constexpr size_t most_topics = 40, most_partners = 40, most_presentations = 20,
                        most_slides = 60, most_paragraphs = 20, most_sounds = 16;
// Seconds that a slide may be shown.
inline constexpr double shortest_slide = 1, longest_slide = 600;
// A page can make these sounds by itself.

// Fill exhibit.book and exhibit.sounds, and exhibit.files with what they name. Problems are noted
// with their place: what the page could not show is fatal; a text that a language lacks is not.
void read_book(Exhibit& exhibit, FieldReader& root);
void read_ambient_sounds(Exhibit& exhibit, FieldReader& root);

}  // namespace wellspring::show
