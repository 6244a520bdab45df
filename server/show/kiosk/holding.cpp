// SPDX-License-Identifier: Apache-2.0
#include "show/kiosk/holding.h"

#include <algorithm>
#include <cmath>

#include "show/exhibit/exhibit_objects.h"

namespace wellspring::show {
namespace {

// Says what is asked for or named, as one word that can be compared.
std::string key_of(const Holding& holding) {
  if (!holding.id.empty()) return "object " + holding.id;
  std::string key;
  for (const auto& [language, words] : holding.hint) key += "hint " + words;
  return key;
}

// The story about an object: the one that the exhibit gives it, or the one of its name.
std::string story_of(const Exhibit& exhibit, const std::string& id) {
  const PointOfInterest* point = find_point(exhibit, id);
  const std::string& name = point && !point->story.empty() ? point->story : id;
  const auto found = std::ranges::find(exhibit.stories, name, &StoryText::id);
  return found == exhibit.stories.end() ? "" : found->id;
}

void add_line(const LocalText& text, LocalScript& to) {
  for (const auto& [lang, words] : text)
    if (!words.empty()) to[lang].emplace_back().text = words;
}

// Its title, and what the exhibit says of it where there is no story.
LocalScript name_of(const Exhibit& exhibit, const Holding& holding) {
  LocalScript out;
  add_line(holding.title, out);
  const PointOfInterest* point = find_point(exhibit, holding.id);
  if (!point) return out;
  if (out.empty()) add_line(point->title, out);
  if (story_of(exhibit, holding.id).empty()) add_line(point->text, out);
  return out;
}

}  // namespace

HoldingWords choose_words(HoldingTalk& talk, const std::optional<Holding>& holding,
                          const Exhibit& exhibit, const std::vector<std::string>& heard, bool talks,
                          double now) {
  const std::string seen = holding ? key_of(*holding) : "";
  if (seen != talk.seen) talk.seen = seen, talk.seen_since = now;
  if (talks) talk.silent_since = now;
  if (seen.empty() || talks) return {};
  const bool named = !holding->id.empty();
  HoldingWords words;
  if (named && talk.named == holding->id && talk.said == seen) {
    const std::string story = story_of(exhibit, holding->id);
    const bool new_one = !story.empty() && std::ranges::find(heard, story) == heard.end();
    if (new_one && now - std::max(talk.silent_since, talk.seen_since) >= story_pause)
      words.story = story;
    if (!words.story.empty() || now - talk.said_at < repeat_pause) return words;
    if (talk.seen_since <= talk.said_at) return words;  // it has been held all the time
  }
  if (now - talk.seen_since < (named ? name_settles : hint_settles)) return {};
  if (now - talk.said_at < (seen == talk.said ? repeat_pause : talk_pause)) return {};
  if (named) words.text = name_of(exhibit, *holding);
  else add_line(holding->hint, words.text);
  if (words.text.empty()) return {};
  talk.said = seen, talk.said_at = talk.silent_since = now;
  if (named) talk.named = holding->id;
  return words;
}

namespace {

constexpr float follow_seconds = 0.12f;  // in which it comes two thirds of the way
constexpr float grow_seconds = 0.3f;
constexpr float least_away = 0.1f, most_away = 1.2f;  // metres from the screen

// A rotation as the camera tells it (a head's, wire/messages.h) as the mirror shows it: right and
// left change places for the object's place and turn, but not on the object itself.
quat mirror_turn(vec3 angles) {
  auto about = [](float angle, vec3 axis) { return glm::angleAxis(angle, axis); };
  const mat3 seen(about(-angles.x, {0, 1, 0}) * about(angles.y, {1, 0, 0}) *
                  about(-angles.z, {0, 0, 1}));
  const mat3 front(vec3(-1, 0, 0), vec3(0, 1, 0), vec3(0, 0, -1));  // from a head's axes to its own
  const mat3 mirror(vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, -1));
  const mat3 legible(vec3(-1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1));
  return glm::quat_cast(mirror * seen * front * legible);
}

}  // namespace

void follow_held(HeldObject& held, int model, const std::optional<Holding>& holding, double now) {
  constexpr double longest_step = 0.25;  // seconds; the first step takes none
  const float dt = held.time < 0 ? 0 : float(std::clamp(now - held.time, 0.0, longest_step));
  held.time = now;
  const bool seen = model >= 0 && holding && holding->position && holding->rotation;
  const bool other = seen && held.size > 0 && held.model != model;  // the other goes first
  const float wanted = seen && !other ? 1.0f : 0.0f;
  if (seen && !other) {
    const quat turn = mirror_turn(*holding->rotation);
    vec3 place = *holding->position;
    place.z = std::clamp(place.z, least_away, most_away);
    const bool begins = held.size <= 0;
    const float share = begins ? 1 : 1 - std::exp(-dt / follow_seconds);
    held.model = model;
    held.place += (place - held.place) * share;
    held.turn = glm::normalize(glm::slerp(held.turn, turn, share));
  }
  const float step = dt / grow_seconds;
  held.size = std::clamp(held.size + std::clamp(wanted - held.size, -step, step), 0.0f, 1.0f);
  if (held.size <= 0 && wanted <= 0) held.model = -1;
}

mat4 place_held(const HeldObject& held, const View& view, float away) {
  const vec3 at = view.position + view.right * held.place.x + view.up * held.place.y +
                  view.forward * (away + held.place.z);
  const mat3 turn = mat3(view.right, view.up, -view.forward) * mat3(held.turn);
  return {vec4(turn[0], 0), vec4(turn[1], 0), vec4(turn[2], 0), vec4(at, 1)};
}

}  // namespace wellspring::show
