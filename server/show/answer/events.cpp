// SPDX-License-Identifier: Apache-2.0
#include "show/answer/events.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace wellspring {

using nlohmann::json;

namespace {

json triple(dvec3 v) {
  auto round = [](double x) { return std::round(x * 1e4) / 1e4; };
  return json::array({round(v.x), round(v.y), round(v.z)});
}

const char* tour_word(TourRide::State state) {
  switch (state) {
    case TourRide::State::playing: return "playing";
    case TourRide::State::paused: return "paused";
    default: return "none";
  }
}

}  // namespace

std::string welcome_message(const Show& show, const Visitor& visitor) {
  const Exhibit& exhibit = show.exhibit;
  auto text = [&](const LocalText& local) {
    return text_in(local, visitor.lang, exhibit.languages);
  };
  json message = {{"type", "welcome"},
                  {"protocol", "wellspring.v1"},
                  {"session", visitor.link->id},
                  {"exhibit", exhibit.id},
                  {"title", text(exhibit.title)},
                  {"description", text(exhibit.description)},
                  {"lang", visitor.lang},
                  {"languages", exhibit.languages},
                  {"width", visitor.wants.width},
                  {"height", visitor.wants.height},
                  {"walk_speed", exhibit.walk ? exhibit.walk->speed : 2.0f},
                  {"viewpoints", json::array()},
                  {"tours", json::array()},
                  {"stories", json::array()},
                  {"lamps", json::array()}};
  for (const ExhibitViewpoint& viewpoint : exhibit.viewpoints) {
    std::string title = text(viewpoint.title);
    message["viewpoints"].push_back(
        {{"name", viewpoint.view.name}, {"title", title.empty() ? viewpoint.view.name : title}});
  }
  for (const TourPlan& tour : exhibit.tours)
    message["tours"].push_back(
        {{"id", tour.id}, {"title", text(tour.title)}, {"stops", tour.stops.size()}});
  for (const StoryText& story : exhibit.stories) {
    json& entry =
        message["stories"].emplace_back(json{{"id", story.id}, {"title", text(story.title)}});
    entry["teller"] = story.storyteller_index < 0
                          ? json(nullptr)
                          : json(exhibit.storytellers[size_t(story.storyteller_index)].id);
  }
  for (size_t i = 0; i < exhibit.lamps.size(); i++)
    message["lamps"].push_back({{"name", exhibit.lamps[i].id},
                                {"title", text(exhibit.lamps[i].title)},
                                {"on", bool(show.switches.wanted[i])}});
  auto about = [&](const StorytellerPlace& storyteller_place) {
    std::string name = text(storyteller_place.name);
    return json{
        {"id", storyteller_place.id},
        {"name", name},
        {"position", triple(storyteller_place.position)},
        {"viewpoint", exhibit.viewpoints[size_t(storyteller_place.kiosk_viewpoint)].view.name}};
  };
  message["storyteller"] = nullptr;
  if (const StorytellerPlace* storyteller_place = storyteller_of(show)) {
    message["storyteller"] = about(*storyteller_place);
    message["storyteller"]["visible"] = show.storyteller_visible;
  }
  message["storytellers"] = json::array();
  for (const StorytellerPlace& storyteller_place : exhibit.storytellers)
    message["storytellers"].push_back(about(storyteller_place));
  return message.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string state_message(const Show& show, const Visitor& visitor) {
  const VisitorPlace& place = visitor.place;
  const Exhibit& exhibit = show.exhibit;
  json message = {{"type", "state"},
                  {"seq", place.seq},
                  {"position", triple(place.view.position)},
                  {"yaw", place.view.yaw},
                  {"pitch", place.view.pitch},
                  {"fov", place.view.fov},
                  {"fps", std::round(visitor.shown.measured_fps * 10) / 10},
                  {"converged", std::round(visitor.picture.stats.converged * 1000) / 1000},
                  {"viewpoint", nullptr},
                  {"tour", nullptr}};
  if (!exhibit.lamps.empty()) message["lamps"] = json::object();
  for (size_t i = 0; i < exhibit.lamps.size(); i++)
    message["lamps"][exhibit.lamps[i].id] = bool(show.switches.wanted[i]);
  if (place.viewpoint >= 0)
    message["viewpoint"] = exhibit.viewpoints[size_t(place.viewpoint)].view.name;
  if (place.tour.state != TourRide::State::none && place.tour.tour >= 0)
    message["tour"] = {{"id", exhibit.tours[size_t(place.tour.tour)].id},
                       {"state", tour_word(place.tour.state)},
                       {"stop", place.tour.stop},
                       {"stops", exhibit.tours[size_t(place.tour.tour)].stops.size()}};
  return message.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string subtitle_message(const std::string& text, const std::string& lang,
                             const std::string& speaker, float seconds) {
  json message = {{"type", "subtitle"},
                  {"text", text},
                  {"lang", lang},
                  {"speaker", speaker},
                  {"seconds", seconds}};
  return message.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string speech_message(uint32_t utterance, const Speech& speech, dvec3 mouth) {
  auto round = [](double x) { return std::round(x * 1e3) / 1e3; };
  json words = json::array();
  for (const SpeechWord& word : speech.words) {
    size_t end = std::min(size_t(word.text_end), speech.text.size()),
           begin = std::min(size_t(word.text_begin), end);
    words.push_back({{"text", speech.text.substr(begin, end - begin)},
                     {"begin", round(word.begin)},
                     {"end", round(word.end)}});
  }
  json message = {{"type", "speech"},          {"utterance", utterance},
                  {"action", "start"},         {"text", speech.text},
                  {"lang", speech.lang},       {"seconds", round(speech.duration)},
                  {"position", triple(mouth)}, {"words", std::move(words)}};
  return message.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string speech_stop_message(uint32_t utterance) {
  return json{{"type", "speech"}, {"utterance", utterance}, {"action", "stop"}}.dump();
}

// The mouth as the next picture shows it, in the utterance's own time.
json mouth_message(const Show& show) {
  const Speech* speech = show.sounding.going ? heard(show.voice) : nullptr;
  if (!speech) return nullptr;
  double at = double(show.voice.elapsed + show.picture_lead);
  VisemeWeights weights = mouth_shape(show.voice, show.picture_lead);
  size_t strongest = size_t(std::max_element(weights.begin(), weights.end()) - weights.begin());
  return {{"utterance", show.sounding.number},
          {"seconds", std::round(at * 1e3) / 1e3},
          {"viseme", viseme_names[strongest]}};
}

std::string agent_message(const Show& show) {
  json message = {
      {"type", "agent"},
      {"mood", to_string(show.mind.mood)},
      {"teller", storyteller_of(show) ? json(storyteller_of(show)->id) : json(nullptr)},
      {"visible", show.storyteller_visible},
      {"humanlike", show.humanlike},
      {"story", show.voice.story.empty() ? json(nullptr) : json(show.voice.story)},
      {"sentence", show.voice.story.empty() ? 0 : show.voice.sentence},
      {"sentences",
       show.voice.story.empty() ? 0 : show.voice.sentence + int(show.voice.queue.size())},
      {"paused", show.voice.paused}};
  StorytellerGaze gaze = eval_gaze(show.mind, show.storyteller, show.pose);
  message["looking_at"] = triple(dvec3(gaze.target) + show.exhibit.scene.origin);
  message["gaze"] = {std::round(gaze.yaw * 1e4) / 1e4, std::round(gaze.pitch * 1e4) / 1e4};
  message["guest"] = gaze.guest;
  message["mouth"] = mouth_message(show);
  return message.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string kiosk_message(const Audience& audience, size_t cameras) {
  json message = {{"type", "kiosk"},
                  {"state", to_string(audience.state)},
                  {"people", audience.guests.size()},
                  {"cameras", cameras}};
  return message.dump();
}

}  // namespace wellspring
