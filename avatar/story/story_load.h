// SPDX-License-Identifier: Apache-2.0
// Story files: .txt is plain text, .vtt are subtitles, all else is markup.
#pragma once
#include <string>

#include "avatar/story/story_script.h"

namespace wellspring::avatar {

// Throws LoadError naming the file: it cannot be read, it is larger than most_markup_bytes, and
// what read_story, read_plain_story and
// read_subtitle_story throw.
StoryScript load_story(const std::string& file);

}  // namespace wellspring::avatar
