// SPDX-License-Identifier: Apache-2.0
#include "avatar/story/story_load.h"

#include <fstream>

#include "base/load_error.h"

namespace wellspring::avatar {

StoryScript load_story(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw LoadError(file, "", "cannot be read");
  std::string text(most_markup_bytes + 1, '\0');
  in.read(text.data(), std::streamsize(text.size()));
  text.resize(size_t(std::max<std::streamsize>(in.gcount(), 0)));
  if (text.size() > most_markup_bytes)
    throw LoadError(file, "", "is larger than " + std::to_string(most_markup_bytes >> 20) + " MiB");
  if (file.ends_with(".txt")) return read_plain_story(text, file);
  if (file.ends_with(".vtt")) return read_subtitle_story(text, file);
  return read_story(text, file);
}

}  // namespace wellspring::avatar
