// SPDX-License-Identifier: Apache-2.0
#include "show/answer/events.h"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "frame/tonemap.h"
#include "show/answer/cameras.h"
#include "show/answer/objects.h"
#include "show/exhibit/exhibit_collection.h"
#include "show/exhibit/pieces/exhibit_scans.h"
#include "show/exhibit/pieces/exhibit_volumes.h"
#include "show/state/visitor_world.h"
#include "show/state/renderer.h"
#include "show/state/in_view.h"
#include "show/state/lamps.h"
#include "show/state/visitor_picture.h"

namespace wellspring::show {

using nlohmann::json;

namespace {

json triple(dvec3 v) {
  auto round = [](double x) { return std::round(x * 1e4) / 1e4; };
  return json::array({round(v.x), round(v.y), round(v.z)});
}

// Describes the colours of a comparison, from the scale's low end to its high one, and how far both
// are off, in millimetres.
json describe_scale(const volume::Comparison& comparison) {
  const volume::ColorScale& scale = comparison.scale;
  json colors = json::array();
  constexpr int steps = 8;
  for (int i = 0; i <= steps; i++) {
    const vec3 color =
        volume::scale_color(scale, scale.low + (scale.high - scale.low) * double(i) / steps);
    const auto code = [](float light) {
      return int(std::lround(255 * frame::encode_srgb(all_lanes(light))[0]));
    };
    colors.push_back(
        fmt::format("#{:02x}{:02x}{:02x}", code(color.x), code(color.y), code(color.z)));
  }
  json ticks = json::array();
  for (const volume::ColorTick& tick : scale.ticks)
    ticks.push_back({{"value", tick.value}, {"at", tick.position}});
  const auto mm = [](double metres) { return std::round(1e5 * metres) / 100; };
  json percentiles = json::array();
  for (const auto& one : comparison.summary.percentiles)
    percentiles.push_back({{"percent", one.percent}, {"mm", mm(one.distance)}});
  return {{"unit", scale.unit},
          {"colors", std::move(colors)},
          {"ticks", std::move(ticks)},
          {"percentiles", std::move(percentiles)},
          {"mean", mm(comparison.summary.mean_absolute)}};
}

const char* tour_word(TourRide::State state) {
  switch (state) {
    case TourRide::State::playing: return "playing";
    case TourRide::State::paused: return "paused";
    default: return "none";
  }
}

// Returns the name of the light that a lamp with a dial has.
const std::string& light_of(const ExhibitLamp& lamp, LampSwitch is) {
  return is > 1 ? lamp.dial[is - 2u].spectrum : lamp.spectrum;
}

}  // namespace

std::string welcome_message(const Show& show, const Visitor& visitor, bool resumed) {
  const Exhibit& exhibit = show.stage.exhibit;
  auto text = [&](const LocalText& local) {
    return text_in(local, visitor.lang, exhibit.languages);
  };
  json message = {{"type", "welcome"},
                  {"protocol", "wellspring.v1"},
                  {"session", visitor.link->id},
                  {"exhibit", exhibit.id},
                  {"title", text(exhibit.title)},
                  {"description", text(exhibit.description)},
                  {"resumed", resumed},
                  {"lang", visitor.lang},
                  {"languages", exhibit.languages},
                  {"width", visitor.wants.width},
                  {"height", visitor.wants.height},
                  {"walk_speed", exhibit.walk ? exhibit.walk->speed : 2.0f},
                  {"viewpoints", json::array()},
                  {"tours", json::array()},
                  {"stories", json::array()},
                  {"lamps", json::array()},
                  {"animations", json::array()}};
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
  const std::vector<LampSwitch> lamps = switches_of(show.stage, show.visits, visitor);
  for (size_t i = 0; i < exhibit.lamps.size(); i++) {
    json& entry = message["lamps"].emplace_back(json{{"name", exhibit.lamps[i].id},
                                                     {"title", text(exhibit.lamps[i].title)},
                                                     {"on", bool(lamps[i])},
                                                     {"shared", exhibit.lamps[i].shared}});
    for (const DialLight& light : exhibit.lamps[i].dial)
      entry["dial"].push_back({{"light", light.spectrum}, {"title", text(light.title)}});
    if (entry.contains("dial")) entry["light"] = light_of(exhibit.lamps[i], lamps[i]);
  }
  message["pieces"] = json::array();
  for (const ExhibitPiece& piece : exhibit.pieces) {
    if (piece.layers.size() < 2 && !piece.has_inside()) continue;
    json layers = json::array();
    for (const PieceLayer& layer : piece.layers) {
      json& one = layers.emplace_back(
          json{{"id", layer.id}, {"label", text(layer.label)}, {"text", text(layer.text)}});
      if (layer.year) one["year"] = *layer.year;
      if (layer.comparison) one["scale"] = describe_scale(*layer.comparison);
    }
    json& told =
        message["pieces"].emplace_back(json{{"id", piece.id}, {"layers", std::move(layers)}});
    if (piece.volume) told["volume"] = {{"size", triple(size_of(piece))}};
    if (piece.is_scan()) told["scan"] = {{"size", triple(scan_size(piece))}};
    if (piece.nebula)
      told["volume"]["tilt"] = std::round(10 * glm::degrees(piece.nebula->tilt)) / 10;
  }
  message["collection"] =
      exhibit.collection ? json(text(exhibit.collection->title)) : json(nullptr);
  message["day"] = nullptr;
  if (const std::optional<Day>& day = exhibit.day)
    message["day"] = {{"from", day->settings.from},
                      {"to", day->settings.to},
                      {"at", day->settings.at},
                      {"hour", hour_of(show, visitor).value_or(day->settings.at)}};
  for (size_t i = 0; i < exhibit.animations.size(); i++) {
    const ExhibitAnimation& animation = exhibit.animations[i];
    if (animation.start != ExhibitAnimation::Start::touch) continue;
    message["animations"].push_back({{"id", animation.id},
                                     {"title", text(animation.title)},
                                     {"object", exhibit.points[size_t(animation.point)].id},
                                     {"on", is_on(show, visitor, i)},
                                     {"shared", animation.shared}});
  }
  message["sounds"] = describe_sounds(exhibit);
  message["objects"] = describe_objects(exhibit, visitor.lang);
  message["map"] = show.stage.roads.map.has_value();
  if (show.settings.watched) message["watched"] = true;
  message["questions"] = json::array();
  for (const AnsweredQuestion& one : exhibit.questions)
    message["questions"].push_back(text(one.question.front()));
  auto about = [&](const StorytellerPlace& storyteller_place) {
    std::string name = text(storyteller_place.name);
    return json{
        {"id", storyteller_place.id},
        {"name", name},
        {"position", triple(storyteller_place.position)},
        {"viewpoint", exhibit.viewpoints[size_t(storyteller_place.kiosk_viewpoint)].view.name}};
  };
  message["storyteller"] = nullptr;
  const Teller& teller = teller_of(show.cast, show.visits, visitor);
  if (const StorytellerPlace* storyteller_place = storyteller_of(show.stage, show.cast, teller)) {
    message["storyteller"] = about(*storyteller_place);
    message["storyteller"]["visible"] = teller.visible;
  }
  message["storytellers"] = json::array();
  for (const StorytellerPlace& storyteller_place : exhibit.storytellers)
    message["storytellers"].push_back(about(storyteller_place));
  return message.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string state_message(const Show& show, const Visitor& visitor) {
  const VisitorPlace& place = visitor.place;
  const Exhibit& exhibit = show.stage.exhibit;
  json message = {{"type", "state"},
                  {"seq", place.seq},
                  {"position", triple(place.view.position)},
                  {"yaw", place.view.yaw},
                  {"pitch", place.view.pitch},
                  {"roll", place.view.roll},
                  {"fov", place.view.fov},
                  {"fps", std::round(visitor.shown.measured_fps * 10) / 10},
                  {"converged", std::round(visitor.picture->stats.converged * 1000) / 1000},
                  {"limit", limit_names[size_t(limit(visitor.shown.way))]},
                  {"viewpoint", nullptr},
                  {"around", nullptr},
                  {"tour", nullptr}};
  if (place.around.point >= 0 && !place.around.leaves)
    message["around"] = exhibit.points[size_t(place.around.point)].id;
  if (!exhibit.lamps.empty()) message["lamps"] = json::object();
  const std::vector<LampSwitch> lamps = switches_of(show.stage, show.visits, visitor);
  for (size_t i = 0; i < exhibit.lamps.size(); i++) {
    message["lamps"][exhibit.lamps[i].id] = bool(lamps[i]);
    if (!exhibit.lamps[i].dial.empty())
      message["lights"][exhibit.lamps[i].id] = light_of(exhibit.lamps[i], lamps[i]);
  }
  const PieceChoices& choices = pieces_of(show.visits, visitor);
  for (size_t i = 0; i < choices.size(); i++) {
    const std::vector<PieceLayer>& layers = exhibit.pieces[i].layers;
    if (layers.size() < 2 && !exhibit.pieces[i].has_inside()) continue;
    const PieceChoice& choice = choices[i];
    json& told =
        message["pieces"][exhibit.pieces[i].id] = {{"layer", layers[size_t(choice.layer)].id},
                                                   {"over", layers[size_t(choice.over)].id},
                                                   {"by", piece_blends[size_t(choice.by)]},
                                                   {"share", choice.share}};
    if (!exhibit.pieces[i].has_inside()) continue;
    told["turn"] = std::round(10 * glm::degrees(choice.turn)) / 10;
    if (exhibit.pieces[i].nebula) told["tilt"] = choice.tilt;
    told["low"] = triple(choice.low), told["high"] = triple(choice.high);
    told["plane"] = {choice.plane.x, choice.plane.y, choice.plane.z, choice.plane.w};
  }
  if (exhibit.day) message["hour"] = hour_of(show, visitor).value_or(exhibit.day->settings.at);
  for (size_t i = 0; i < exhibit.animations.size(); i++)
    if (exhibit.animations[i].start == ExhibitAnimation::Start::touch)
      message["animations"][exhibit.animations[i].id] = is_on(show, visitor, i);
  if (place.viewpoint >= 0)
    message["viewpoint"] = exhibit.viewpoints[size_t(place.viewpoint)].view.name;
  if (place.tour.state != TourRide::State::none && place.tour.tour >= 0)
    message["tour"] = {{"id", exhibit.tours[size_t(place.tour.tour)].id},
                       {"state", tour_word(place.tour.state)},
                       {"stop", place.tour.stop},
                       {"stops", exhibit.tours[size_t(place.tour.tour)].stops.size()}};
  return message.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string pose_message(const ExhibitStage& stage, const ShowVisits& visits,
                         const Visitor& visitor) {
  const VisitorPlace& place = visitor.place;
  const View& view = place.last_view;
  const vec3 forward = view.forward;
  const float yaw = std::atan2(-forward.x, -forward.z);
  const vec3 level(std::cos(yaw), 0, -std::sin(yaw));
  const bool led = place.around.point >= 0 || place.glide.path || leader_of(visits, visitor) ||
                   place.tour.state == TourRide::State::playing || place.tour.pace > 0 ||
                   visitor.window.place != visitor.window.aim;
  return json{{"type", "pose"},
              {"seq", place.seq},
              {"position", triple(stage.exhibit.scene.origin + dvec3(view.position))},
              {"yaw", yaw},
              {"pitch", std::asin(std::clamp(forward.y, -1.0f, 1.0f))},
              {"roll", std::atan2(dot(view.right, cross(level, forward)), dot(view.right, level))},
              {"fov", 2 * std::atan(view.tan_half_fov)},
              {"middle", json::array({view.middle.x, view.middle.y})},
              {"width", view.width},
              {"height", view.height},
              {"cut", place.camera_cuts},
              {"led", led}}
      .dump();
}

std::string measured_message(uint32_t id, double metres, const std::optional<ScanPlaces>& places) {
  json message{{"type", "measured"}, {"id", id}, {"metres", metres}};
  auto list = [](const dvec3& place) { return json{place.x, place.y, place.z}; };
  if (places)
    message["scan"] = {
        {"name", places->piece}, {"from", list(places->from)}, {"to", list(places->to)}};
  return message.dump();
}

std::string went_message(uint32_t seq, const std::string& object, dvec3 place, double seconds) {
  json message = {{"type", "went"},
                  {"seq", seq},
                  {"object", object.empty() ? json(nullptr) : json(object)},
                  {"place", triple(place)},
                  {"seconds", std::round(seconds * 100) / 100}};
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
json mouth_message(const ShowDrawing& drawing, const Teller& teller) {
  const Speech* speech = teller.sounding.going ? heard(teller.voice) : nullptr;
  if (!speech) return nullptr;
  double at = double(teller.voice.elapsed + drawing.picture_lead);
  VisemeWeights weights = mouth_shape(teller.voice, drawing.picture_lead);
  size_t strongest = size_t(std::max_element(weights.begin(), weights.end()) - weights.begin());
  return {{"utterance", teller.sounding.number},
          {"seconds", std::round(at * 1e3) / 1e3},
          {"viseme", viseme_names[strongest]}};
}

// The emotions that its face shows, as far as anybody would see them.
json face_message(const FaceState& face) {
  constexpr float least = 0.05f;
  json shown = json::object();
  for (size_t i = 0; i < emotion_count; i++)
    if (face.emotion[i].value >= least)
      shown[std::string(emotion_names[i])] = std::round(100 * double(face.emotion[i].value)) / 100;
  return shown;
}

std::string agent_message(const Show& show, const Teller& teller) {
  const StorytellerPlace* place = storyteller_of(show.stage, show.cast, teller);
  json message = {
      {"type", "agent"},
      {"mood", to_string(teller.mind.mood)},
      {"teller", place ? json(place->id) : json(nullptr)},
      {"visible", teller.visible},
      {"humanlike", teller.humanlike},
      {"story", teller.voice.story.empty() ? json(nullptr) : json(teller.voice.story)},
      {"sentence", teller.voice.story.empty() ? 0 : teller.voice.sentence},
      {"sentences",
       teller.voice.story.empty() ? 0 : teller.voice.sentence + int(teller.voice.queue.size())},
      {"paused", teller.voice.paused}};
  StorytellerGaze gaze = eval_gaze(teller.mind, teller.storyteller, teller.pose);
  message["looking_at"] = triple(dvec3(gaze.target) + show.stage.exhibit.scene.origin);
  message["gaze"] = {std::round(gaze.yaw * 1e4) / 1e4, std::round(gaze.pitch * 1e4) / 1e4};
  message["guest"] = gaze.guest;
  message["face"] = face_message(teller.mind.face);
  message["mouth"] = mouth_message(*show.drawing, teller);
  return message.dump(-1, ' ', false, json::error_handler_t::replace);
}

namespace {

// Tenths of a metre, so that nobody's breath is news.
void put_distance(json& message, float nearest) {
  if (nearest > 0) message["distance"] = std::round(10 * double(nearest)) / 10;
}

double hundredths(float value) { return std::round(100 * double(value)) / 100; }

}  // namespace

std::string kiosk_message(const ShowKiosks& kiosks) {
  Presence state = Presence::absent;
  size_t people = 0;
  float nearest = 0;
  for (const Kiosk& kiosk : kiosks.all) {
    const Audience& audience = kiosk.audience;
    state = std::max(state, audience.state);
    people += audience.guests.size();
    if (!audience.guests.empty() && (nearest == 0 || audience.nearest < nearest))
      nearest = audience.nearest;
  }
  json message = {{"type", "kiosk"},
                  {"state", to_string(state)},
                  {"people", people},
                  {"cameras", connected_cameras(kiosks)}};
  put_distance(message, nearest);
  return message.dump();
}

std::string kiosk_message(const Show& show, const Kiosk& kiosk) {
  const std::string& name = kiosk.settings.name;
  const Audience& audience = kiosk.audience;
  json message = {
      {"type", "kiosk"},
      {"kiosk", name},
      {"state", to_string(audience.state)},
      {"stage", to_string(kiosk.stage.now)},
      {"people", audience.guests.size()},
      {"cameras",
       std::ranges::count_if(show.kiosks.eyes,
                             [&](const Eye& eye) { return eye.kiosk == name && !is_lost(eye); })},
      {"storyteller", !show.kiosks.her_kiosk           ? "none"
                      : *show.kiosks.her_kiosk == name ? "here"
                                                       : "elsewhere"},
      {"volume",
       hundredths(kiosk_volume(show.settings.house, show.house.state, kiosk.settings.volume))},
      {"heard", kiosk.visit.heard}};
  put_distance(message, audience.guests.empty() ? 0 : audience.nearest);
  if (!audience.guests.empty()) message["aside"] = std::round(10 * double(audience.aside)) / 10;
  if (const auto& step = audience.calibration)
    message["calibration"] = {{"step", calibration_steps[size_t(step->what)]},
                              {"metres", std::round(10 * double(step->metres)) / 10},
                              {"progress", std::round(20 * double(step->progress)) / 20}};
  if (const auto& holding = audience.holding) {
    // Its place changes all the time and is not shown.
    json& out = message["holding"];
    out = {{"title", holding->title}, {"hint", holding->hint}};
    if (!holding->id.empty()) out["id"] = holding->id;
    if (!holding->of_class.empty()) out["class"] = holding->of_class;
  }
  if (const ScreenSize& screen = kiosk.settings.screen; audience.points_at && screen.known())
    message["points_at"] = {hundredths(0.5f + audience.points_at->x / screen.width),
                            hundredths(0.5f - audience.points_at->y / screen.height)};
  if (kiosk.gesture_number > 0 && turns_pages(kiosk.showing))
    message["gesture"] = {{"name", kiosk.gesture}, {"number", kiosk.gesture_number}};
  return message.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string house_message(const Show& show, bool reload) {
  const HouseSettings& settings = show.settings.house;
  return json{{"type", "house"},
              {"open", show.house.state.open},
              {"quiet", show.house.state.quiet},
              {"headphones", show.house.state.quiet && settings.headphones},
              {"volume", hundredths(kiosk_volume(settings, show.house.state, 1))},
              {"reload", reload},
              {"take_along", !settings.address.empty()}}
      .dump();
}

std::string idle_message(const char* state, double seconds) {
  json message = {{"type", "idle"}, {"state", state}};
  if (message["state"] == "asked") message["seconds"] = seconds;
  return message.dump();
}

std::string announce_message(const Announcement& announcement, double seconds) {
  return json{{"type", "announce"},
              {"id", announcement.id},
              {"text", announcement.text},
              {"seconds", seconds},
              {"urgent", announcement.urgent}}
      .dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string reply_message(const ExhibitStage& stage, const Visitor& visitor,
                          const std::string& question, const FoundAnswer& found,
                          const LocalScript& said) {
  constexpr const char* kinds[] = {"none", "partly", "sure"};
  const Exhibit& exhibit = stage.exhibit;
  std::string text;
  for (size_t i = 0; i < line_count(said); i++) {
    const LocalLine line = line_at(said, i);
    if (const auto* spoken = line_in(line, visitor.lang, exhibit.languages))
      text += (text.empty() ? "" : " ") + spoken->second.text;
  }
  json message = {{"type", "reply"},
                  {"question", question},
                  {"text", text},
                  {"found", kinds[int(found.kind)]},
                  {"words", found.words},
                  {"score", std::round(found.score * 100) / 100},
                  {"share", std::round(found.share * 100) / 100}};
  if (found.passage >= 0) {
    const Passage& passage = stage.questions.passages[size_t(found.passage)];
    message["from"] = {{"kind", passage_kinds[int(passage.kind)]},
                       {"id", passage.id},
                       {"title", text_in(passage.title, visitor.lang, exhibit.languages)}};
  }
  return message.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace wellspring::show
