// SPDX-License-Identifier: Apache-2.0
#include "show/answer/transcript.h"

#include <nlohmann/json.hpp>

namespace wellspring::show {

using nlohmann::json;

namespace {

json sentences(const LocalScript& script) {
  json all = json::object();
  for (const auto& [lang, lines] : script) {
    json& of = all[lang] = json::array();
    for (const StoryLine& line : lines) of.push_back(line.text);
  }
  return all;
}

}  // namespace

json describe_transcript(const Exhibit& exhibit) {
  json stories = json::array(), tours = json::array();
  for (const StoryText& story : exhibit.stories) {
    stories.push_back({{"id", story.id}, {"title", story.title}, {"text", sentences(story.text)}});
    if (story.storyteller_index >= 0)
      stories.back()["teller"] = exhibit.storytellers[size_t(story.storyteller_index)].name;
  }
  for (const TourPlan& tour : exhibit.tours) {
    json stops = json::array();
    for (const TourStop& stop : tour.stops)
      stops.push_back({{"title", exhibit.viewpoints[size_t(stop.viewpoint)].title},
                       {"way_text", sentences(stop.way_text)},
                       {"text", sentences(stop.text)}});
    tours.push_back({{"id", tour.id}, {"title", tour.title}, {"stops", stops}});
  }
  return {{"stories", stories}, {"tours", tours}};
}

}  // namespace wellspring::show
