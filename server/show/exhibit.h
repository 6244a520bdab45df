// SPDX-License-Identifier: Apache-2.0
// An exhibit package as loaded: what content/<id>/exhibit.json says, with its scene and its storyteller's
// figure. Immutable once loaded; borrowed by the Show for as long as it runs.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "avatar/character.h"
#include "world/scene.h"

namespace wellspring {

using LocalText = std::map<std::string, std::string>;                // language tag -> text
using LocalLines = std::map<std::string, std::vector<std::string>>;  // language tag -> sentences

// The text in `lang`, else in its base language ("de" for "de-AT"), else in the first of `languages`
// that has one, else any; "" when there is none at all.
const std::string& text_in(const LocalText& text, const std::string& lang,
                           const std::vector<std::string>& languages);
// The language tag of the text that text_in gives; "" when there is none.
std::string tag_in(const LocalText& text, const std::string& lang, const std::vector<std::string>& languages);
const std::vector<std::string>& lines_in(const LocalLines& lines, const std::string& lang,
                                         const std::vector<std::string>& languages);

struct ExhibitViewpoint {
  Viewpoint view;
  LocalText title;
};

struct TourStop {
  int viewpoint = 0;  // index into Exhibit::viewpoints
  float travel_seconds = 5, stay_seconds = 6;
  LocalText text;
};
struct TourPlan {
  std::string id;
  LocalText title;
  std::vector<TourStop> stops;
};

struct StoryText {
  std::string id;
  LocalText title;
  LocalLines text;
};

// How visitors may move. Without one they fly freely.
struct WalkRules {
  float eye_height = 1.65f;  // metres above the ground under the visitor
  float speed = 1.4f;        // metres a second, for the page's keys
  float radius = 0.25f;      // distance kept from walls
  std::optional<Bounds> bounds;
};

struct StorytellerPlace {
  std::string figure;  // file beside exhibit.json
  LocalText name;
  dvec3 position{0};  // of the feet
  float yaw = 0;      // as Viewpoint: 0 faces -Z
  LocalLines greetings, farewells;
  int kiosk_viewpoint = 0;
};

struct PointOfInterest {
  std::string id, node;
  uint32_t object = 0;  // index into Scene::objects
  LocalText title;
};

struct Exhibit {
  std::string id, folder;
  LocalText title, description;
  std::vector<std::string> languages{"en"};
  float exposure = 1;
  std::optional<WalkRules> walk;
  std::vector<ExhibitViewpoint> viewpoints;  // never empty
  int start = 0;
  std::optional<StorytellerPlace> storyteller;
  std::vector<TourPlan> tours;
  std::vector<StoryText> stories;
  std::vector<PointOfInterest> points;
  Scene scene;
  std::optional<Character> character;
};

int find_viewpoint(const Exhibit& exhibit, std::string_view name);  // -1: none

}  // namespace wellspring
