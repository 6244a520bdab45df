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
#include "wire/limits.h"

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
//
// A message is a struct with its `type` on the wire, its fields, and list(), which names each of
// them once: kind, name, limits, value, what it means, and whether it must be there. Reading,
// writing and GET /api/v1/ go through this list, so a new message is a struct here (and in
// BrowserMessage), its handler in show/answer/commands.cpp, and its rows in tests/protocol. The
// kinds are those of MessageReader (read_messages.cpp). A std::optional is there or is not; a text
// that is empty is not written, unless it is required.

enum class Need : uint8_t { optional, required };

struct Hello {
  static constexpr const char* type = "hello";
  std::string exhibit, lang, role,
      kiosk;  // role: "visitor" or "kiosk"; empty exhibit: the default one
  int width = 1280, height = 720;
  static void list(auto& message, auto& fields) {
    fields.text("exhibit", message.exhibit, "id, empty for the one shown");
    fields.text("lang", message.lang, "BCP 47");
    fields.text("kiosk", message.kiosk, "name, optional");
    fields.word("role", {"visitor", "kiosk"}, message.role, "visitor or kiosk");
    fields.integer("width", min_side, max_side, message.width, "16..4096");
    fields.integer("height", min_side, max_side, message.height, "16..4096");
  }
  bool operator==(const Hello&) const = default;
};
struct Input {
  static constexpr const char* type = "input";
  uint32_t seq = 0;
  vec3 move{0};                 // right, up, forward, metres a second, kept until the next input
  vec2 look{0};                 // yaw, pitch to turn by now
  std::optional<vec2> pointer;  // in the picture; absent: no news of it
  static void list(auto& message, auto& fields) {
    fields.u32("seq", message.seq, "u32, grows by one", Need::required);
    fields.vector("look", max_angle, message.look,
                  "[yaw, pitch] radians to turn by now; yaw positive turns left, pitch positive "
                  "up");
    fields.speed("move", max_speed, message.move,
                 "[right, up, forward] m/s, kept until the next input");
    fields.place("pointer", message.pointer,
                 "[x, y] of the pointer or finger in the picture, 0..1 from its upper left");
  }
  bool operator==(const Input&) const = default;
};
struct CameraTo {
  static constexpr const char* type = "camera";
  uint32_t seq = 0;
  dvec3 position{0};
  float yaw = 0, pitch = 0;
  static void list(auto& message, auto& fields) {
    fields.u32("seq", message.seq, "u32", Need::required);
    fields.vector("position", max_coordinate, message.position, "[x, y, z] m", Need::required);
    fields.number("yaw", -max_angle, max_angle, message.yaw, "radians, 0 looks down -Z");
    fields.number("pitch", -max_angle, max_angle, message.pitch, "radians");
  }
  bool operator==(const CameraTo&) const = default;
};
struct ViewpointTo {
  static constexpr const char* type = "viewpoint";
  uint32_t seq = 0;
  std::string name;
  static void list(auto& message, auto& fields) {
    fields.u32("seq", message.seq, "u32", Need::required);
    fields.text("name", message.name, "a viewpoint's name", Need::required);
  }
  bool operator==(const ViewpointTo&) const = default;
};
enum class TourAction : uint8_t { play, pause, stop };
struct Tour {
  static constexpr const char* type = "tour";
  TourAction action = TourAction::play;
  std::string name;  // empty: the first
  static void list(auto& message, auto& fields) {
    fields.choice("action", {"play", "pause", "stop"}, message.action, "play, pause or stop",
                  Need::required);
    fields.text("name", message.name, "a tour's id, optional");
  }
  bool operator==(const Tour&) const = default;
};
struct StorytellerOrder {
  static constexpr const char* type = "storyteller";
  std::optional<bool> visible, humanlike;
  std::string teller{};  // id of the storyteller that shall be there; empty: no change
  std::string story;     // id of a story to tell; empty: no change
  std::string action;    // "play", "pause", "stop", "restart", "skip" or empty
  static void list(auto& message, auto& fields) {
    fields.boolean("visible", message.visible, "boolean");
    fields.boolean("humanlike", message.humanlike, "boolean");
    fields.text("teller", message.teller, "a storyteller's id: who shall be there");
    fields.text("story", message.story, "a story's id");
    fields.word("action", {"play", "pause", "stop", "restart", "skip"}, message.action,
                "play, pause, stop, restart or skip");
  }
  bool operator==(const StorytellerOrder&) const = default;
};
struct LampOrder {
  static constexpr const char* type = "lamp";
  std::string name;
  bool on = true;
  static void list(auto& message, auto& fields) {
    fields.text("name", message.name, "a lamp's name", Need::required);
    fields.boolean("on", message.on, "boolean: for everybody who is there", Need::required);
  }
  bool operator==(const LampOrder&) const = default;
};
struct Settings {
  static constexpr const char* type = "settings";
  std::optional<float> fps;
  // False: samples are spread evenly. A number: how much what the visitor looks at counts beside
  // what catches the eye.
  std::optional<std::variant<bool, float>> attention;
  std::optional<bool> sound;
  std::optional<int> quality, max_quality, width, height;
  std::string lang;
  static void list(auto& message, auto& fields) {
    fields.number("fps", min_fps, max_fps, message.fps,
                  "pictures a second, 0 for the server's choice");
    fields.switch_or_number(
        "attention", 0, 1, message.attention,
        "boolean: samples go where they are needed and looked at, or evenly everywhere; or 0..1, "
        "from what catches the eye to what the visitor looks at");
    fields.boolean("sound", message.sound, "boolean: whether speech is to be sent; at first it is");
    fields.integer("quality", min_jpeg_quality, max_jpeg_quality, message.quality,
                   "JPEG quality in motion");
    fields.integer("max_quality", min_jpeg_quality, max_jpeg_quality, message.max_quality,
                   "JPEG quality at rest");
    fields.integer("width", min_side, max_side, message.width, "16..4096");
    fields.integer("height", min_side, max_side, message.height, "16..4096");
    fields.text("lang", message.lang, "BCP 47");
  }
  bool operator==(const Settings&) const = default;
};
struct Ack {
  static constexpr const char* type = "ack";
  uint32_t frame = 0;
  float decoded_ms = 0;
  bool shown = true;
  static void list(auto& message, auto& fields) {
    fields.u32("frame", message.frame, "u32 frame number", Need::required);
    fields.number("decoded_ms", 0, max_decoded_ms, message.decoded_ms, "milliseconds");
    fields.boolean("shown", message.shown, "boolean");
  }
  bool operator==(const Ack&) const = default;
};
struct Bye {
  static constexpr const char* type = "bye";
  static void list(auto&, auto&) {}
  bool operator==(const Bye&) const = default;
};

using BrowserMessage = std::variant<Hello, Input, CameraTo, ViewpointTo, Tour, StorytellerOrder,
                                    LampOrder, Settings, Ack, Bye>;

}  // namespace wellspring
