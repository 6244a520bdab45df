// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "show/answer/answer.h"
#include "wire/json.h"

namespace wellspring {

// The machine-readable twin of the protocol's description in ARCHITECTURE.md. What a browser may
// say comes from the messages' own lists of fields (wire/messages.h).
std::string describe_api() {
  static const char* text = R"json({
  "name": "Wellspring", "version": "v1",
  "paths": [
    {"method": "GET", "path": "/", "answers": "the visitor's page"},
    {"method": "GET", "path": "/kiosk", "answers": "the kiosk's screen"},
    {"method": "GET", "path": "/status", "answers": "a page for the technician"},
    {"method": "GET", "path": "/healthz", "answers": "200 {\"status\":\"ok\"} once it can serve"},
    {"method": "GET", "path": "/metrics", "answers": "Prometheus text"},
    {"method": "GET", "path": "/api/v1/", "answers": "this description"},
    {"method": "GET", "path": "/api/v1/exhibits", "answers": "what there is to visit"},
    {"method": "GET", "path": "/api/v1/exhibits/ID", "answers": "title, languages, viewpoints, stories, tours, lamps"},
    {"method": "GET", "path": "/api/v1/exhibits/ID/still.jpg",
     "query": {"viewpoint": "name; the exhibit's start", "width": "1..3840; 640", "height": "1..3840; 360",
               "spp": "samples a pixel, 1..1024; 16", "denoise": "1, or 0: its samples as they are; 1"},
     "answers": "one finished picture; its JPEG comment says whether it was denoised"},
    {"method": "WS", "path": "/api/v1/visit", "subprotocol": "wellspring.v1", "answers": "a visit"},
    {"method": "WS", "path": "/api/v1/eye", "answers": "a kiosk's observations in"}],
  "server_to_browser": {
    "welcome": {"protocol": "wellspring.v1", "session": "number", "exhibit": "id", "title": "text",
                "languages": "tags", "width": "px", "height": "px", "walk_speed": "m/s",
                "viewpoints": "[{name, title}]", "tours": "[{id, title, stops}]", "stories": "[{id, title, teller: id or null}]",
                "lamps": "[{name, title, on}]: what may be switched",
                "storyteller": "{id, name, visible, position, viewpoint} or null: who is there",
                "storytellers": "[{id, name, position, viewpoint}]: who may be called"},
    "state": {"seq": "u32", "position": "[x, y, z]", "yaw": "radians", "pitch": "radians", "fov": "radians",
              "fps": "number", "converged": "0..1", "viewpoint": "name or null",
              "tour": "{id, state, stop, stops} or null",
              "lamps": "{name: whether it is on} where there are any; at once when somebody switches one"},
    "subtitle": {"text": "empty: it disappears", "lang": "tag", "speaker": "name", "seconds": "number"},
    "agent": {"mood": "idle, noticing, greeting, attending, telling or farewell",
              "teller": "id of who is there", "visible": "boolean",
              "humanlike": "boolean", "story": "id or null", "sentence": "number",
              "sentences": "number", "paused": "boolean",
              "looking_at": "[x, y, z] the storyteller's gaze target",
              "gaze": "[yaw, pitch] of its line of sight from straight ahead, radians", "guest": "id or 0",
              "mouth": "{utterance, seconds of it, viseme} as the next picture shows it, or null"},
    "speech": {"utterance": "number, grows", "action": "start or stop", "text": "what is said",
               "lang": "tag, the language spoken", "seconds": "number", "position": "[x, y, z] of the mouth",
               "words": "[{text, begin, end}] seconds from the first sample"},
    "kiosk": {"state": "absent, motion or person", "people": "number", "cameras": "number"},
    "error": {"code": "word, storyteller_busy among them: somebody at a kiosk is being told a story",
              "message": "sentence"}},
  "binary": {
    "picture": {"magic": "WSF1", "fields": [
      {"offset": 4, "type": "u32", "name": "frame"}, {"offset": 8, "type": "u32", "name": "seq"},
      {"offset": 12, "type": "u64", "name": "server time, microseconds"}, {"offset": 20, "type": "u16", "name": "width"},
      {"offset": 22, "type": "u16", "name": "height"}, {"offset": 24, "type": "u8", "name": "quality"},
      {"offset": 25, "type": "u8", "name": "flags: 1 still, 2 complete picture"},
      {"offset": 26, "type": "u16", "name": "header length, 28 or more"}], "payload": "JPEG"},
    "sound": {"magic": "WSA1", "fields": [
      {"offset": 4, "type": "u32", "name": "utterance"},
      {"offset": 8, "type": "u32", "name": "first sample of this piece within the utterance"},
      {"offset": 12, "type": "u64", "name": "server time in microseconds at which that sample is to sound: with the picture of that time"},
      {"offset": 20, "type": "u32", "name": "samples of the whole utterance"}, {"offset": 24, "type": "u8", "name": "channels: 1"},
      {"offset": 25, "type": "u8", "name": "flags: 1 heard the same everywhere"}, {"offset": 26, "type": "u16", "name": "header length, 56 or more"},
      {"offset": 28, "type": "u32", "name": "samples a second"}, {"offset": 32, "type": "3 x f64", "name": "world position of the mouth, m"}],
      "payload": "16-bit samples, in order; pieces come about a second before they are due"}},
  "eye_to_server": {
    "observation": {"time": "seconds", "presence": "boolean", "state": "absent, motion or person",
      "people": "[{id, position [x, y, z] m from the screen's centre, rotation [yaw, pitch, roll], confidence, expression?, gesture?}]"}}
})json";
  static const std::string body = [] {
    nlohmann::json api = nlohmann::json::parse(text);
    api["browser_to_server"] = describe_browser_messages();
    return api.dump();
  }();
  return body;
}

}  // namespace wellspring
