// SPDX-License-Identifier: Apache-2.0
#include "show/storyteller/sounding.h"

namespace wellspring::show {

SpeechSource make_speech_source(std::shared_ptr<Speaker> speaker) {
  SpeechSource source;
  source.speak = [speaker](const SpeechRequest& request) { return speaker->speak(request); };
  source.find = [speaker](const SpeechRequest& request) { return speaker->find(request); };
  source.prepare = [speaker](const std::vector<SpeechRequest>& lines) { speaker->prepare(lines); };
  source.counts = [speaker] { return speaker->counts(); };
  return source;
}

SpeechRequest request_of(const StoryLine& line, const std::string& lang,
                         const VoiceManner& manner) {
  SpeechRequest request;
  request.text = line.text;
  request.lang = lang;
  request.words_per_minute = manner.words_per_minute;
  request.pitch = manner.pitch;
  request.variant = manner.variant;
  request.styles = line.styles;
  return request;
}

std::vector<SpeechRequest> lines_of(const Exhibit& exhibit) {
  std::vector<SpeechRequest> lines;
  auto add = [&](const LocalScript& script, const VoiceManner& manner) {
    for (const std::string& lang : exhibit.languages)
      if (auto found = script.find(lang); found != script.end())
        for (const StoryLine& line : found->second)
          if (!line.recording) lines.push_back(request_of(line, lang, manner));
  };
  for (size_t i = 0; i < exhibit.storytellers.size(); i++) {
    const StorytellerPlace& storyteller_place = exhibit.storytellers[i];
    add(storyteller_place.greetings, storyteller_place.voice);
    for (const StoryText& story : exhibit.stories)
      if (story.storyteller_index < 0 ? i == 0 : story.storyteller_index == int(i))
        add(story.text, storyteller_place.voice);
    add(storyteller_place.farewells, storyteller_place.voice);
  }
  const VoiceManner narrator =
      exhibit.storytellers.empty() ? VoiceManner{} : exhibit.storytellers.front().voice;
  for (const TourPlan& tour : exhibit.tours)
    for (const TourStop& stop : tour.stops) {
      add(stop.way_text, narrator);
      add(stop.text, narrator);
    }
  return lines;
}

}  // namespace wellspring::show
