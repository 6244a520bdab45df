// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit.h"

namespace wellspring {

namespace {
// The entry for `lang`, its base language, or the first of `languages` that has one, else any.
template <class Map>
const typename Map::mapped_type* entry_in(const Map& map, const std::string& lang,
                                          const std::vector<std::string>& languages) {
  if (auto found = map.find(lang); found != map.end()) return &found->second;
  if (auto found = map.find(lang.substr(0, lang.find('-'))); found != map.end()) return &found->second;
  for (const std::string& other : languages)
    if (auto found = map.find(other); found != map.end()) return &found->second;
  return map.empty() ? nullptr : &map.begin()->second;
}
}  // namespace

const std::string& text_in(const LocalText& text, const std::string& lang,
                           const std::vector<std::string>& languages) {
  static const std::string none;
  const std::string* found = entry_in(text, lang, languages);
  return found ? *found : none;
}

const std::vector<std::string>& lines_in(const LocalLines& lines, const std::string& lang,
                                         const std::vector<std::string>& languages) {
  static const std::vector<std::string> none;
  const std::vector<std::string>* found = entry_in(lines, lang, languages);
  return found ? *found : none;
}

int find_viewpoint(const Exhibit& exhibit, std::string_view name) {
  for (size_t i = 0; i < exhibit.viewpoints.size(); i++)
    if (exhibit.viewpoints[i].view.name == name) return int(i);
  return -1;
}

}  // namespace wellspring
