// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/exhibit.h"

#include <algorithm>

#include "base/unicode.h"

namespace wellspring::show {

namespace {
// The entry for `lang`, its base language, or the first of `languages` that has one, else any.
template <class Map>
const typename Map::value_type* entry_in(const Map& map, const std::string& lang,
                                         const std::vector<std::string>& languages) {
  if (auto found = map.find(lang); found != map.end()) return &*found;
  if (auto found = map.find(lang.substr(0, lang.find('-'))); found != map.end()) return &*found;
  for (const std::string& other : languages)
    if (auto found = map.find(other); found != map.end()) return &*found;
  return map.empty() ? nullptr : &*map.begin();
}
}  // namespace

const std::string& text_in(const LocalText& text, const std::string& lang,
                           const std::vector<std::string>& languages) {
  static const std::string none;
  const auto* found = entry_in(text, lang, languages);
  return found ? found->second : none;
}

const LocalLine::value_type* line_in(const LocalLine& line, const std::string& lang,
                                     const std::vector<std::string>& languages) {
  return entry_in(line, lang, languages);
}

LocalLine plain_line(const LocalText& text) {
  LocalLine line;
  for (const auto& [lang, words] : text) line[lang].text = words;
  return line;
}

LocalLine line_at(const LocalScript& script, size_t index) {
  LocalLine line;
  for (const auto& [lang, lines] : script)
    if (index < lines.size()) line[lang] = lines[index];
  return line;
}

size_t line_count(const LocalScript& script) {
  size_t count = 0;
  for (const auto& [lang, lines] : script) count = std::max(count, lines.size());
  return count;
}

int find_viewpoint(const Exhibit& exhibit, std::string_view name) {
  for (size_t i = 0; i < exhibit.viewpoints.size(); i++)
    if (exhibit.viewpoints[i].view.name == name) return int(i);
  return -1;
}

int find_storyteller(const Exhibit& exhibit, std::string_view id) {
  for (size_t i = 0; i < exhibit.storytellers.size(); i++)
    if (exhibit.storytellers[i].id == id) return int(i);
  return -1;
}

int find_lamp(const Exhibit& exhibit, std::string_view id) {
  for (size_t i = 0; i < exhibit.lamps.size(); i++)
    if (exhibit.lamps[i].id == id) return int(i);
  return -1;
}

int find_prop(const Exhibit& exhibit, std::string_view id) {
  for (size_t i = 0; i < exhibit.props.size(); i++)
    if (exhibit.props[i].id == id) return int(i);
  return -1;
}

const PointOfInterest* find_point(const Exhibit& exhibit, std::string_view id) {
  for (const PointOfInterest& point : exhibit.points)
    if (point.id == id) return &point;
  return nullptr;
}

namespace {
template <class List, class Name>
std::string nothing_called(const char* kind, const std::string& name, const List& list,
                           const Name& name_of) {
  std::vector<std::string> names;
  for (const auto& one : list) names.push_back(name_of(one));
  return std::string("there is no ") + kind + " '" + name + "'" + did_you_mean(name, names);
}
}  // namespace

std::string unknown_viewpoint(const Exhibit& exhibit, const std::string& name) {
  return nothing_called("viewpoint", name, exhibit.viewpoints,
                        [](const ExhibitViewpoint& one) { return one.view.name; });
}

std::string unknown_storyteller(const Exhibit& exhibit, const std::string& id) {
  return nothing_called("storyteller", id, exhibit.storytellers,
                        [](const StorytellerPlace& one) { return one.id; });
}

std::string unknown_prop(const Exhibit& exhibit, const std::string& id) {
  return nothing_called("prop", id, exhibit.props, [](const ExhibitProp& one) { return one.id; });
}

std::string unknown_object(const Exhibit& exhibit, const std::string& id) {
  return nothing_called("object", id, exhibit.points,
                        [](const PointOfInterest& one) { return one.id; });
}

}  // namespace wellspring::show
