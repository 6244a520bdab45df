// SPDX-License-Identifier: Apache-2.0
// The words that cross a process boundary: what a browser or a kiosk may say to the server.
// Plain values; json.h turns text into them and them into text. Golden files: tests/protocol.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/vec.h"

namespace wellspring {

// ---- kiosk to server ----

struct Expression {  // 0..1 each
  float joy = 0, sadness = 0, anger = 0, fear = 0, disgust = 0, surprise = 0;
  bool operator==(const Expression&) const = default;
};

// One person. position: metres from the screen's centre, +x to the right as the
// visitor sees the screen, +y up, +z out of the screen towards the visitor. rotation: yaw, pitch,
// roll of the head, radians; 0 faces the screen squarely; yaw positive: turned to the screen's
// right as the visitor sees it; pitch positive: looking up; roll positive: head tilted towards the
// visitor's right shoulder.
struct Person {
  uint32_t id = 0;
  vec3 position{0, 0, 1};
  vec3 rotation{0};
  float confidence = 0;
  std::optional<Expression> expression;  // absent where the kiosk does not estimate it
  std::string gesture;                   // empty: none
  bool operator==(const Person&) const = default;
};

enum class Presence : uint8_t { absent, motion, person };
const char* to_string(Presence presence);

struct Observation {
  double time = 0;  // seconds, the kiosk's clock (a video file's own time)
  Presence state = Presence::absent;
  std::vector<Person> people;  // nearest first
  bool operator==(const Observation&) const = default;
};

// ---- browser to server ----

struct Hello {
  std::string exhibit, lang, role,
      kiosk;  // role: "visitor" or "kiosk"; empty exhibit: the default one
  int width = 1280, height = 720;
  bool operator==(const Hello&) const = default;
};
struct Input {
  uint32_t seq = 0;
  vec3 move{0};  // right, up, forward, metres a second, kept until the next input
  vec2 look{0};  // yaw, pitch to turn by now
  bool operator==(const Input&) const = default;
};
struct CameraTo {
  uint32_t seq = 0;
  dvec3 position{0};
  float yaw = 0, pitch = 0;
  bool operator==(const CameraTo&) const = default;
};
struct ViewpointTo {
  uint32_t seq = 0;
  std::string name;
  bool operator==(const ViewpointTo&) const = default;
};
enum class TourAction : uint8_t { play, pause, stop };
struct Tour {
  TourAction action = TourAction::play;
  std::string name;  // empty: the first
  bool operator==(const Tour&) const = default;
};
struct StorytellerOrder {
  std::optional<bool> visible, humanlike;
  std::string teller{};  // id of the storyteller that shall be there; empty: no change
  std::string story;   // id of a story to tell; empty: no change
  std::string action;  // "play", "pause", "stop", "restart", "skip" or empty
  bool operator==(const StorytellerOrder&) const = default;
};
struct LampOrder {
  std::string name;
  bool on = true;
  bool operator==(const LampOrder&) const = default;
};
struct Settings {
  std::optional<float> fps;
  std::optional<bool> attention, sound;
  std::optional<int> quality, max_quality, width, height;
  std::string lang;
  bool operator==(const Settings&) const = default;
};
struct Ack {
  uint32_t frame = 0;
  float decoded_ms = 0;
  bool shown = true;
  bool operator==(const Ack&) const = default;
};
struct Bye {
  bool operator==(const Bye&) const = default;
};

using BrowserMessage = std::variant<Hello, Input, CameraTo, ViewpointTo, Tour, StorytellerOrder,
                                    LampOrder, Settings, Ack, Bye>;

}  // namespace wellspring
