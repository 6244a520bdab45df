// SPDX-License-Identifier: Apache-2.0
// Defines the messages that cross a process boundary: from a browser or a kiosk to the server, and
// back. Plain values; json.h turns text into them and them into text. Golden files: tests/protocol.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/vec.h"
#include "json/text.h"
#include "wire/eye_messages.h"
#include "wire/limits.h"
#include "wire/wall_part.h"

namespace wellspring::wire {

// ---- browser to server ----
//
// A message is a struct with its `type` on the wire, its fields, and list(), which names each of
// them once: kind, name, limits, value, what it means, and whether it must be there. Reading,
// writing and GET /api/v1/ go through this list, so a new message is a struct here (and in
// BrowserMessage), its handler in show/answer/commands.cpp, and its rows in tests/protocol. The
// kinds are those of FieldReader (json/fields.h).

struct Hello {
  static constexpr const char* type = "hello";
  std::string exhibit, lang, role,
      kiosk;  // role: "visitor" or "kiosk"; empty exhibit: the default one
  int width = 1280, height = 720;
  std::string resume;         // token of the last `keep`; empty: a new visit
  std::string token;          // token of a kiosk (wire/tokens.h); empty: none
  std::optional<bool> parts;  // packet.h
  std::string display;        // "local" or "server"; empty: as "server"
  std::optional<WallPart> wall;
  static void list(auto& message, auto& fields) {
    fields.text("exhibit", message.exhibit, "id, empty for the one shown");
    fields.token("resume", message.resume,
                 "of the last keep of a visit that is to go on; optional");
    fields.text("lang", message.lang, "BCP 47");
    fields.text("kiosk", message.kiosk, "name, optional");
    fields.token("token", message.token, "of a kiosk on another machine than the server; optional");
    fields.word("role", {"visitor", "kiosk"}, message.role, "visitor or kiosk");
    fields.integer("width", min_side, max_side, message.width, "16..4096");
    fields.integer("height", min_side, max_side, message.height, "16..4096");
    fields.boolean("parts", message.parts,
                   "boolean: pictures may come as parts of the one before; optional");
    fields.word("display", {"server", "local"}, message.display,
                "local: pictures come as keyframes with depth, which the page shows from where its "
                "visitor is by then; server or left out: as they are to be shown");
    list_part("wall", message.wall, fields);
  }
  bool operator==(const Hello&) const = default;
};
struct Input {
  static constexpr const char* type = "input";
  uint32_t seq = 0;
  vec3 move{0};                 // right, up, forward, metres a second, kept until the next input
  vec2 look{0};                 // yaw, pitch to turn by now
  std::optional<vec2> pointer;  // place in the picture; absent: unchanged
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
  float yaw = 0, pitch = 0, roll = 0;
  static void list(auto& message, auto& fields) {
    fields.u32("seq", message.seq, "u32", Need::required);
    fields.vector("position", max_coordinate, message.position, "[x, y, z] m", Need::required);
    fields.number("yaw", -max_angle, max_angle, message.yaw, "radians, 0 looks down -Z");
    fields.number("pitch", -max_angle, max_angle, message.pitch, "radians");
    fields.number("roll", -max_angle, max_angle, message.roll, "radians, positive leans left");
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
// Sends the visitor to where it points: at a place of the picture, at the ground or an object. One
// of them.
struct GoTo {
  static constexpr const char* type = "go";
  uint32_t seq = 0;
  std::optional<vec2> at;
  std::optional<dvec3> to;
  std::string object;
  bool around = false;
  static void list(auto& message, auto& fields) {
    fields.u32("seq", message.seq, "u32", Need::required);
    fields.place("at", message.at,
                 "[x, y] of the picture, 0..1 from its upper left: to the ground that is seen "
                 "there, or to look closer at the object");
    fields.spot("to", max_coordinate, message.to, "[x, y, z] m on the ground");
    fields.text("object", message.object, "an object's id, to look closer at it");
    fields.boolean("around", message.around,
                   "boolean: to look at the object from all sides, where it says so; look turns it "
                   "and move goes nearer then, until the next go");
  }
  bool operator==(const GoTo&) const = default;
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
  std::string light{};  // one of the lamp's dial; empty: its own
  static void list(auto& message, auto& fields) {
    fields.text("name", message.name, "a lamp's name", Need::required);
    fields.boolean("on", message.on,
                   "boolean: for this visitor, or for everybody where it is shared",
                   Need::required);
    fields.text("light", message.light, "one of the lamp's dial; else its own");
  }
  bool operator==(const LampOrder&) const = default;
};
// Sets the hour of the day at which the visitor sees the exhibit.
struct HourOrder {
  static constexpr const char* type = "hour";
  std::optional<double> value;  // empty: the exhibit's own
  static void list(auto& message, auto& fields) {
    fields.number_or_null("value", 0, 24, message.value,
                          "0..24, 17.5 is half past five, within the exhibit's day; null or left "
                          "out: the exhibit's own");
  }
  bool operator==(const HourOrder&) const = default;
};
// Says how a second layer of a piece is shown.
enum class PieceBlend : uint8_t { none, curtain, fade, difference };
inline constexpr const char* piece_blends[] = {"none", "curtain", "fade", "difference"};
// Chooses what is seen at the place of a piece: one of its layers, or two of them.
struct PieceOrder {
  static constexpr const char* type = "piece";
  std::string name, layer, over;
  PieceBlend by = PieceBlend::none;
  float share = 0.5f;
  double turn = 0;  // degrees
  vec3 low{0}, high{1};
  vec4 plane{0};
  double tilt = 0;  // degrees; 0: as it is at first
  static void list(auto& message, auto& fields) {
    fields.text("name", message.name, "a piece's id", Need::required);
    fields.text("layer", message.layer, "id of the layer to be shown; the first without it");
    fields.text("over", message.over, "id of a second layer; optional");
    fields.choice("by", {"none", "curtain", "fade", "difference"}, message.by,
                  "how the second layer is shown: none, curtain (to the right of share), fade (as "
                  "much as share) or difference");
    fields.number("share", 0, 1, message.share, "0..1, of the picture's width or of the mixture");
    fields.number("turn", -720, 720, message.turn, "degrees that a volume is turned to the left");
    fields.vector("low", 1, message.low,
                  "[x, y, z], 0..1: a volume or scan is cut off before these shares of its width, "
                  "height and depth, counted from its left, bottom and back");
    fields.vector("high", 1, message.high, "[x, y, z], 0..1: likewise, and behind these");
    fields.vector("plane", 1000, message.plane,
                  "[x, y, z, m]: of a volume or scan only what lies that way of a plane is kept, m "
                  "metres from its middle");
    fields.number("tilt", 0, 90, message.tilt,
                  "degrees between a nebula's axis and the eye; 0: as it was found");
  }
  bool operator==(const PieceOrder&) const = default;
};
// Holds a round glass over the picture, or puts it down. Its content comes as pictures of their
// own.
struct LensOrder {
  static constexpr const char* type = "lens";
  uint32_t seq = 0;
  std::optional<vec2> at;
  float radius = 0.15f, zoom = 1;
  std::string name, layer;
  bool difference = false;
  float depth = 0;
  static void list(auto& message, auto& fields) {
    fields.u32("seq", message.seq, "u32, grows by one; the glass's pictures say it",
               Need::required);
    fields.place("at", message.at,
                 "[x, y] of its middle in the picture, 0..1 from its upper left; left out: it is "
                 "put down");
    fields.number("radius", 0.02, 0.5, message.radius, "share of the picture's height");
    fields.number("zoom", 0, 64, message.zoom,
                  "1: as large as beside it; 0: so that a very large picture's texels are pixels");
    fields.text("name", message.name, "id of a piece whose other layer is seen; optional");
    fields.text("layer", message.layer, "id of that layer");
    fields.boolean("difference", message.difference,
                   "boolean: by how much the layer differs from what is shown");
    fields.number("depth", 0, 1000, message.depth,
                  "metres of a volume that are cut away in it, from the side that is seen; of a "
                  "scan around the eye, from there");
  }
  bool operator==(const LensOrder&) const = default;
};
// Asks how far two places of the picture are from each other in the world.
struct MeasureOrder {
  static constexpr const char* type = "measure";
  uint32_t id = 0;
  std::optional<vec2> from, to;
  static void list(auto& message, auto& fields) {
    fields.u32("id", message.id, "u32, which the answer says");
    fields.place("from", message.from, "[x, y] of the picture, 0..1 from its upper left",
                 Need::required);
    fields.place("to", message.to, "[x, y] likewise", Need::required);
  }
  bool operator==(const MeasureOrder&) const = default;
};
// Starts an animation that is started by touch, or sends it back.
struct PlayOrder {
  static constexpr const char* type = "play";
  std::string name;
  bool on = true;
  static void list(auto& message, auto& fields) {
    fields.text("name", message.name, "an animation's id", Need::required);
    fields.boolean("on", message.on,
                   "boolean: for this visitor, or for everybody where it is shared",
                   Need::required);
  }
  bool operator==(const PlayOrder&) const = default;
};

// The content of a kiosk's page: the well or anything that lies under its water.
enum class Showing : uint8_t { well, book, topics, partners, slides, museum, story, tour, walk };
// Reports what a guest does at a kiosk's screen.
struct KioskTouch {
  static constexpr const char* type = "kiosk";
  bool touched = false;  // a finger was there just now
  Showing showing = Showing::well;
  bool playing = false;  // something goes on without touches
  static void list(auto& message, auto& fields) {
    fields.boolean("touched", message.touched, "boolean: a finger was there just now");
    fields.choice(
        "showing",
        {"well", "book", "topics", "partners", "slides", "museum", "story", "tour", "walk"},
        message.showing,
        "what the kiosk's page shows: well, book, topics, partners, slides, "
        "museum, story, tour or walk",
        Need::required);
    fields.boolean("playing", message.playing,
                   "boolean: something goes on there that needs no touches");
  }
  bool operator==(const KioskTouch&) const = default;
};
enum class GroupAction : uint8_t { lead, follow, rejoin, leave };
struct GroupOrder {
  static constexpr const char* type = "group";
  GroupAction action = GroupAction::lead;
  std::string code;  // leader's code, to follow
  static void list(auto& message, auto& fields) {
    fields.choice("action", {"lead", "follow", "rejoin", "leave"}, message.action,
                  "lead, follow, rejoin (after walking off) or leave", Need::required);
    fields.text("code", message.code, "the leader's code, to follow");
  }
  bool operator==(const GroupOrder&) const = default;
};
// Asks the storyteller a question, in the visitor's language.
struct Ask {
  static constexpr const char* type = "ask";
  std::string text;
  static void list(auto& message, auto& fields) {
    fields.text("text", message.text, "what is asked", Need::required);
  }
  bool operator==(const Ask&) const = default;
};
struct Settings {
  static constexpr const char* type = "settings";
  std::optional<float> fps;
  // False: samples are spread evenly. A number: weight of what the visitor looks at against what
  // catches the eye.
  std::optional<std::variant<bool, float>> attention;
  std::optional<bool> sound, comfort, saver;
  std::optional<int> quality, max_quality, bandwidth, width, height;
  std::string lang;
  std::string display;  // as in hello; empty: as before
  static void list(auto& message, auto& fields) {
    fields.number("fps", min_fps, max_fps, message.fps,
                  "pictures a second, 0 for the server's choice");
    fields.switch_or_number(
        "attention", 0, 1, message.attention,
        "boolean: samples go where they are needed and looked at, or evenly everywhere; or 0..1, "
        "from what catches the eye to what the visitor looks at");
    fields.boolean("sound", message.sound, "boolean: whether speech is to be sent; at first it is");
    fields.boolean("comfort", message.comfort,
                   "boolean: the camera leaps instead of gliding, on tours too");
    fields.integer("quality", min_jpeg_quality, max_jpeg_quality, message.quality,
                   "JPEG quality in motion");
    fields.integer("max_quality", min_jpeg_quality, max_jpeg_quality, message.max_quality,
                   "JPEG quality at rest");
    fields.integer("bandwidth", min_bandwidth, max_bandwidth, message.bandwidth,
                   "kbit/s for pictures at most, 0 for no limit");
    fields.boolean("saver", message.saver,
                   "boolean: nothing is sent that can be done without, as finer pictures at rest");
    fields.integer("width", min_side, max_side, message.width, "16..4096");
    fields.integer("height", min_side, max_side, message.height, "16..4096");
    fields.text("lang", message.lang, "BCP 47");
    fields.word("display", {"server", "local"}, message.display,
                "as of hello: a page that cannot keep up gives it up");
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
    fields.boolean("shown", message.shown,
                   "boolean; false: it could not be decoded, and a complete one is to follow");
  }
  bool operator==(const Ack&) const = default;
};
// Reports whether somebody looks at the page: false while it is hidden, true when it is seen again
// and in answer to the question whether somebody is still there.
struct PresenceNews {
  static constexpr const char* type = "presence";
  bool here = true;
  static void list(auto& message, auto& fields) {
    fields.boolean("here", message.here,
                   "boolean: somebody sees the page; false: no pictures until it is true",
                   Need::required);
  }
  bool operator==(const PresenceNews&) const = default;
};
struct Bye {
  static constexpr const char* type = "bye";
  static void list(auto&, auto&) {}
  bool operator==(const Bye&) const = default;
};

// ---- server to browser ----

// Tells a visitor who waits for a seat its place in the queue.
struct WaitingPlace {
  size_t place = 1, of = 1;       // place in the queue, and the queue's length
  std::optional<double> seconds;  // about how long until the visitor's turn
  bool operator==(const WaitingPlace&) const = default;
};

using BrowserMessage =
    std::variant<Hello, Input, CameraTo, ViewpointTo, GoTo, Tour, StorytellerOrder, LampOrder,
                 HourOrder, PieceOrder, LensOrder, MeasureOrder, PlayOrder, KioskTouch, GroupOrder,
                 Ask, Settings, Ack, PresenceNews, Bye>;

}  // namespace wellspring::wire
