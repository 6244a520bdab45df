// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "show/http/answer.h"
#include "wire/json.h"

namespace wellspring::show {

// Writes the machine-readable twin of the protocol's description in ARCHITECTURE.md. The messages
// of browsers come from their own lists of fields (wire/messages.h).
std::string describe_api() {
  static const char* text = R"json({
  "name": "Wellspring", "version": "v1",
  "paths": [
    {"method": "GET", "path": "/", "answers": "the visitor's page"},
    {"method": "GET", "path": "/kiosk", "answers": "the kiosk's screen"},
    {"method": "GET", "path": "/status", "answers": "a page for the technician"},
    {"method": "GET", "path": "/healthz", "answers": "200 {\"status\":\"ok\"} while it can serve; 503 and loading, starting or draining"},
    {"method": "GET", "path": "/metrics", "headers": "as /api/v1/status", "answers": "Prometheus text"},
    {"method": "GET", "path": "/api/v1/", "answers": "this description; like all text that is not short, as gzip to who accepts that"},
    {"method": "GET", "path": "/e/ID", "answers": "the visitor's page of one of several exhibits, which / lists then"},
    {"method": "GET", "path": "/api/v1/exhibits", "answers": "what there is to visit; failed: [{id, problems: for who may read /api/v1/status}]"},
    {"method": "GET", "path": "/api/v1/exhibits/ID", "answers": "title, languages, poster: address of a picture, viewpoints, stories, tours, lamps, credits; objects: [{id, title, position, text, story, provenance: [{element of Dublin Core, value}], manifest: IIIF, around: true, door: {exhibit, viewpoint}}]; animations: [{id, title, play: loop or touch, object, shared}]; day: {from, to, at} hours or null; book: {topics, partners, presentations} or null"},
    {"method": "GET", "path": "/api/v1/exhibits/ID/transcript", "answers": "all that is told, to be read: {stories: [{id, title, teller, text: {lang: [sentence]}}], tours: [{id, title, stops: [{title, way_text, text}]}]}"},
    {"method": "GET", "path": "/read", "answers": "the page of these texts, and of whose models they are; ?exhibit=ID"},
    {"method": "GET", "path": "/api/v1/exhibits/ID/map", "answers": "the ground from above: {cell: m, corner: [x, z], eye_height, rows: texts of o (room to walk), x (something stands there) and . (no ground), viewpoints, objects}; 404 where visitors fly"},
    {"method": "GET", "path": "/api/v1/exhibits/ID/qr.svg", "query": {"story": "id; none", "lang": "tag; the phone's"},
      "answers": "a QR code that opens the exhibit, with the story, on a phone; 404 without an address in the house file"},
    {"method": "GET", "path": "/api/v1/exhibits/ID/files/NAME", "answers": "a file that the poster, the book or a sound names, or a range of its bytes"},
    {"method": "GET", "path": "/api/v1/exhibits/ID/still.jpg",
     "query": {"viewpoint": "name; the exhibit's start", "width": "1..3840; 640", "height": "1..3840; 360",
               "seconds": "that it is given, 0.1..3600 or what one picture may take; 8: as many samples as fit, at least one a pixel",
               "spp": "samples a pixel at most, 1..1024", "denoise": "1, or 0: its samples as they are; 1",
               "position": "x,y,z m, in place of the viewpoint's", "yaw": "radians, likewise", "pitch": "radians, likewise",
               "roll": "radians, likewise", "fov": "radians of its height, 0.02..3, likewise"},
     "answers": "one finished picture. Its JPEG comment says what it has, as do the headers Still-Samples, a pixel, and Still-Denoised: yes, no, or no and why. 400 too_much_work: even one sample a pixel takes longer than a picture may; how many pixels would fit. With Retry-After 503: the machine is busy, and 429: too many were asked for, by this address or by all"},
    {"method": "GET", "path": "/api/v1/status", "headers": "Authorization: Bearer, with the admin token; needed elsewhere than on the server's own machine, but for --open-status (401)",
     "answers": "{fine, findings: [{about, grave, what, seconds: that it has been so, why, remedy}], house, kiosks, cameras, sums: boolean, there are some}"},
    {"method": "GET", "path": "/api/v1/speeds", "headers": "as /api/v1/status", "answers": "speed against error, as last measured on this machine: {date, commit, cpu, cores, points: [{technique, scene, spp, seconds, flip}]} or {problem}"},
    {"method": "GET", "path": "/api/v1/sums.csv", "query": {"from": "YYYY-MM-DD; the first day", "to": "likewise; the last"},
     "headers": "as /api/v1/status", "answers": "sums of each local day: day,what,key,value"},
    {"method": "POST", "path": "/api/v1/admin/announce", "headers": "Authorization: Bearer TOKEN, Content-Type: application/json",
     "body": {"text": "text, or texts by language tag, up to 2000 bytes each; empty: the last is taken back", "seconds": "1..86400; 60",
              "urgent": "boolean: over everything; false"},
     "answers": "{id}; the words are on all pages, and on those that come later, while it lasts"},
    {"method": "WS", "path": "/api/v1/visit", "subprotocol": "wellspring.v1", "answers": "a visit"},
    {"method": "WS", "path": "/api/v1/eye", "headers": "Authorization: Bearer, with a kiosk token; needed elsewhere than on the server's own machine (401)",
     "answers": "a kiosk's observations in"}],
  "server_to_browser": {
    "welcome": {"protocol": "wellspring.v1", "session": "number", "resumed": "boolean: it goes on where it was", "exhibit": "id", "title": "text",
                "languages": "tags", "width": "px", "height": "px", "walk_speed": "m/s",
                "viewpoints": "[{name, title}]", "tours": "[{id, title, stops}]", "stories": "[{id, title, teller: id or null}]",
                "lamps": "[{name, title, on}]: what may be switched",
                "day": "{from, to, at: its own, hour: this visitor's} hours, or null: which hour of the day may be chosen",
                "animations": "[{id, title, object, on, shared}]: what may be started by play, or by a click on the object",
                "sounds": "[{id, kind: fire, water, room or wind, or file: address, position: [x, y, z] or left out, gain: 0..1, radius: m}]",
                "objects": "[{id, title, position, text, story, provenance, manifest, around: true where it may be looked at from all sides, door: {exhibit, viewpoint}}]: what may be looked at closer; but for the first three left out where there is none",
                "map": "boolean: there is one", "questions": "texts: some to ask",
                "watched": "true: a curator works at the exhibit; else left out",
                "storyteller": "{id, name, visible, position, viewpoint} or null: who is there",
                "storytellers": "[{id, name, position, viewpoint}]: who may be called"},
    "state": {"seq": "u32", "position": "[x, y, z]", "yaw": "radians", "pitch": "radians",
              "roll": "radians, positive leans to the left", "fov": "radians", "fps": "number", "limit": "none, network, server or browser: why pictures are fewer, or less fine, than asked for",
              "converged": "0..1", "viewpoint": "name or null",
              "tour": "{id, state, stop, stops} or null",
              "around": "id of what is looked at from all sides, or null",
              "lamps": "{name: whether it is on} where there are any; at once when somebody switches one",
              "hour": "of the day, 17.5: half past five; where there is a day; likewise",
              "animations": "{id: whether it has been started} likewise"},
    "went": {"seq": "u32, of the go that it answers", "object": "id of what is looked at closer, or null",
             "place": "[x, y, z] of the eye when it is there", "seconds": "that takes; 0: it has leapt"},
    "subtitle": {"text": "empty: it disappears", "lang": "tag", "speaker": "name", "seconds": "number"},
    "agent": {"mood": "idle, noticing, greeting, attending, telling or farewell",
              "teller": "id of who is there", "visible": "boolean",
              "humanlike": "boolean", "story": "id or null", "sentence": "number",
              "sentences": "number", "paused": "boolean",
              "looking_at": "[x, y, z] the storyteller's gaze target",
              "gaze": "[yaw, pitch] of its line of sight from straight ahead, radians", "guest": "id or 0",
              "face": "{emotion: 0..1} that it shows, of its own story or with its guest; MPEG-4's six",
              "mouth": "{utterance, seconds of it, viseme} as the next picture shows it, or null"},
    "speech": {"utterance": "number, grows", "action": "start or stop", "text": "what is said",
               "lang": "tag, the language spoken", "seconds": "number", "position": "[x, y, z] of the mouth",
               "words": "[{text, begin, end}] seconds from the first sample"},
    "group": {"role": "leader, follower or none", "code": "by which others follow", "followers": "number",
              "away": "boolean: a follower who has walked off"},
    "kiosk": {"state": "absent, motion or person", "people": "number", "cameras": "number",
              "distance": "metres of the nearest from the screen; left out: nobody is there",
              "kiosk": "to a kiosk's page, of that kiosk alone, as all that follows: its name",
              "stage": "sleep, awake, person, engaged or farewell",
              "storyteller": "here, elsewhere (with another kiosk's guests) or none",
              "aside": "metres, how far right of the screen's middle that one stands",
              "volume": "0..1", "heard": "[ids of the stories told to these guests]",
              "calibration": "as the kiosk's observation has it; left out: there is none",
              "gesture": "{name, number: grows with each} while the page shows book, topics, partners or slides"},
    "house": {"open": "to a kiosk's page: boolean; closed, nothing is shown", "quiet": "boolean",
              "headphones": "boolean: they are to be offered", "volume": "0..1, of a kiosk with no own",
              "reload": "boolean: once a night, while nobody is there: load the page anew",
              "take_along": "boolean: there is a qr.svg for phones"},
    "reply": {"question": "as it was asked", "text": "what the storyteller says to it", "found": "sure, partly or none",
              "from": {"kind": "answer, object, story, tour or topic", "id": "of that", "title": "text"},
              "words": "of the question that led there", "score": "BM25", "share": "0..1 of the question's words, by weight"},
    "waiting": {"place": "number: in the queue of those who come in by turn; then a welcome follows", "of": "its length",
                "seconds": "until then, about; left out: not known"},
    "idle": {"state": "asked: presence is to say that somebody is there, within seconds; here: they were; paused: presence brings the visit back, with a welcome",
             "seconds": "of asked"},
    "keep": {"token": "where the visit is, sealed: with it in hello.resume it goes on there"},
    "problems": {"list": "[{file, where, what}]: what is wrong with the files of a watched exhibit, which goes on as it was; empty: nothing any more"},
    "announce": {"id": "number, grows", "text": "{language tag: text}; empty: the last is taken back",
                 "seconds": "that it stays", "urgent": "boolean: over everything"},
    "pose": {"seq": "of the last input that it includes", "position": "[x, y, z] m", "yaw": "radians", "pitch": "radians", "roll": "radians", "fov": "radians of the picture's height",
             "middle": "[x, y] of the picture's middle, to the right of the axis and above it, at a depth of 1 m",
             "width": "px", "height": "px: of the picture to be shown",
             "cut": "number: another one, another place", "led": "boolean: a tour, a glide or a leader moves the visitor, not their own input (only after hello.display local)"},
    "error": {"code": "word, full (so many wait already) and storyteller_busy among them: the one storyteller of all visitors is taken; no_way, nothing_there, unknown_object: to go; not_trusted: a kiosk's token is needed; no_room: for larger pictures, which stay as they are",
              "message": "sentence"}},
  "binary": {
    "picture": {"magic": "WSF1", "fields": [
      {"offset": 4, "type": "u32", "name": "frame"}, {"offset": 8, "type": "u32", "name": "seq"},
      {"offset": 12, "type": "u64", "name": "server time, microseconds"}, {"offset": 20, "type": "u16", "name": "width"},
      {"offset": 22, "type": "u16", "name": "height"}, {"offset": 24, "type": "u8", "name": "quality"},
      {"offset": 25, "type": "u8", "name": "flags: 1 still, 2 complete picture, 4 a keyframe with depth, 8 a wide one for what lies around, 16 what moves, to be laid over still ones: it is where its disparity is not 0"},
      {"offset": 26, "type": "u16", "name": "header length, 28 or more"}], "payload": "JPEG, perhaps smaller than was asked for: it is shown as large all the same",
      "parts": {"when": "the picture is not complete (only after hello.parts): all else is as in the picture before, scaled to this width and height", "fields": [
        {"offset": 28, "type": "u16", "name": "number of parts; 0: nothing is new but seq"},
        {"offset": 30, "type": "12 bytes a part", "name": "u16 x, u16 y, u16 width, u16 height, u32 bytes"}], "payload": "their JPEGs, one after the other"},
      "keyframe": {"when": "flag 4 (only after hello.display local): a complete picture that the page shows from where its visitor is by then", "fields": [
        {"offset": 28, "type": "u32", "name": "bytes of the JPEG"}, {"offset": 32, "type": "u32", "name": "camera cuts so far: another number, another place"},
        {"offset": 36, "type": "u16", "name": "width of the depth"}, {"offset": 38, "type": "u16", "name": "height of the depth"},
        {"offset": 40, "type": "3 x f64", "name": "place of the eye, m"}, {"offset": 64, "type": "9 x f32", "name": "its axes to the right, up and forward, 1 long"},
        {"offset": 100, "type": "f32", "name": "half of the picture's height at a depth of 1"}, {"offset": 104, "type": "2 x f32", "name": "where the picture's middle lies at a depth of 1, to the right of the axis and above it"},
        {"offset": 112, "type": "f32", "name": "disparity (1 / depth along the axis, 1/m) of one unit"}],
        "payload": "the JPEG, then the disparities' code: u32 runs, planes, values and long lengths, then a zlib stream of arrays (numbers of 16 bits: all their low bytes, then all their high bytes): u8 kind of each run, u8 length of each run, u16 long lengths, of each plane u16 units at its first pixel and s16 slopes across and down in units / 256, u16 values. Rows are cut into runs. Kind, by what the row above has over the run's first pixel: 0 the plane of the run there, 1 of the run after that, 2 the plane of the run before the last one in this row, 3 the next plane, which begins here, 4 none: its pixels are the next values. Length of kinds 0 and 1: how much farther it ends than that run above, zigzag; else pixels less one; 255: the next long length"}},
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
      "people": "[{id, position [x, y, z] m from the screen's centre, rotation [yaw, pitch, roll], confidence, expression?, gesture?}]",
      "camera_state": "good (or left out), dark, frozen, missing or slow",
      "camera_name": "of kiosk and camera, optional: who comes back under it is the same camera",
      "calibration": "{step: near, far, done or failed, metres of that mark from the screen, progress 0..1}, while the person is asked to stand at two marks; then nobody is a guest",
      "kiosk": "its kiosk's name; left out: the only one of the house",
      "networks": "all (or left out), no_expression (asked for, and its weights are not installed) or none (cascades find faces)"}},
  "server_to_eye": {
    "kiosk": {"stage": "sleep, awake, person, engaged or farewell",
      "needs": "{faces, expression, gestures}: booleans, what is used at the moment",
      "idle": "true while the house is closed: a look now and then is enough"}}
})json";
  static const std::string body = [] {
    nlohmann::json api = nlohmann::json::parse(text);
    api["browser_to_server"] = describe_browser_messages();
    return api.dump();
  }();
  return body;
}

}  // namespace wellspring::show
