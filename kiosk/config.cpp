// SPDX-License-Identifier: Apache-2.0
#include "kiosk/config.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string_view>
#include <unistd.h>

#include "base/load_error.h"
#include "json/fields.h"
#include "kiosk/process/eye_process.h"
#include "wire/json.h"
#include "wire/tokens.h"

namespace wellspring::kiosk {
namespace {

using nlohmann::json;

constexpr float degree = pi / 180;
constexpr size_t most_cameras = 100;
constexpr size_t longest_path = 4000;  // bytes, of addresses too

void read_lens(FieldReader& fields, CameraSettings& camera) {
  fields.integer("width", 160, 1920, camera.width, "pixels across");
  fields.number("rate", 1, 120, camera.rate, "pictures a second");
  fields.degrees("fov", 10, 170, camera.mount.fov, "horizontal field of view, degrees");
  fields.boolean("mirrored", camera.mount.mirrored, "the camera delivers a mirror image");
}

void read_mount(FieldReader& fields, Mount& mount) {
  fields.part("mount", "how the camera sits", [&](FieldReader& part) {
    part.vector("offset", 10, mount.offset, "[right, up, out] m of the screen's centre");
    part.degrees("pitch", -80, 80, mount.pitch, "degrees, upwards positive");
    part.degrees("roll", -180, 180, mount.roll, "degrees, clockwise as the camera looks");
  });
}

void read_presence(FieldReader& fields, PresenceSettings& presence) {
  constexpr double longest = 600;  // seconds
  fields.number("wake_after", 0, longest, presence.wake_after);
  fields.number("confirm_after", 0, longest, presence.confirm_after);
  fields.number("hold_person", 0, longest, presence.hold_person);
  fields.number("hold_motion", 0, longest, presence.hold_motion);
}

void read_camera(FieldReader& fields, CameraSettings& camera) {
  fields.text("source", camera.source, "as --camera has it", Need::required, longest_path);
  fields.text("name", camera.name);
  read_lens(fields, camera);
  read_mount(fields, camera.mount);
}

}  // namespace

void load_config(const std::string& file, KioskConfig& config) {
  const std::string text = read_json_text(file, FileKind::regular_or_pipe);
  const json root = parse_json_file(file, text);
  Faults faults(file, true, text);
  FieldReader fields(root, faults);
  fields.text("name", config.name);
  fields.text("station", config.station, "file of a recognition tree", Need::optional,
              longest_path);
  fields.text("server", config.server, "its address", Need::optional, longest_path);
  fields.text("token_file", config.token_file, "", Need::optional, longest_path);
  fields.text("ca_file", config.ca_file, "", Need::optional, longest_path);
  fields.part("camera", "what cameras have in common",
              [&](FieldReader& part) { read_lens(part, config.camera); });
  read_mount(fields, config.camera.mount);
  fields.part("presence", "seconds",
              [&](FieldReader& part) { read_presence(part, config.presence); });
  fields.boolean("expression", config.expression);
  fields.boolean("hands", config.hands);
  fields.boolean("bodies", config.bodies);
  if (const auto cameras = fields.take("cameras"))
    for (const JsonValue& one : cameras->list(1, most_cameras, "cameras"))
      fields.read_object(one, [&](FieldReader& part) {
        read_camera(part, config.cameras.emplace_back(config.camera));
      });
  fields.finish();
}

void save_mount(const std::string& file, const std::string& source, const Mount& mount) {
  json root = std::filesystem::exists(file)
                  ? parse_json_file(file, read_json_text(file, FileKind::regular_or_pipe))
                  : json::object();
  auto rounded = [](double v) { return std::round(1000 * v) / 1000; };
  json *lens = &root["camera"], *place = &root["mount"];
  if (root.contains("cameras"))
    for (json& camera : root["cameras"])
      if (camera["source"] == source) lens = &camera, place = &camera["mount"];
  (*lens)["fov"] = rounded(double(mount.fov / degree));
  (*place)["pitch"] = rounded(double(mount.pitch / degree));
  (*place)["offset"] = {rounded(double(mount.offset.x)), rounded(double(mount.offset.y)),
                        rounded(double(mount.offset.z))};
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out << root.dump(2) << '\n';
  if (!out.flush()) throw LoadError(file, "", "cannot be written");
}

namespace {

constexpr float one_degree = pi / 180;

// Returns the file that --config names, before anything else is read.
std::string config_of(int argc, char** argv) {
  constexpr std::string_view name = "--config";
  for (int i = 1; i < argc; i++) {
    std::string_view word = argv[i];
    if (word == name && i + 1 < argc) return argv[i + 1];
    if (word.starts_with(name) && word.size() > name.size() && word[name.size()] == '=')
      return std::string(word.substr(name.size() + 1));
  }
  return "";
}

// Holds cameras as people write them; each list has one value for all, or one for each.
struct Written {
  std::vector<std::string> sources, offsets;
  std::vector<double> fovs, pitches, rolls;
  std::string expression;
  int width = 640;
  double rate = 30;
  bool mirrored = false, loop = false;
};

vec3 read_place(const std::string& text) {
  vec3 place{0};
  int end = -1;
  if (std::sscanf(text.c_str(), "%f,%f,%f%n", &place.x, &place.y, &place.z, &end) != 3 ||
      end != int(text.size()) || !(glm::length(place) <= 10))
    throw CLI::ValidationError("--mount-offset", "'" + text + "' is not x,y,z within 10 metres");
  return place;
}

void add_camera(CLI::App& app, KioskOptions& options, Written& written) {
  app.add_flag("!--no-pace", options.pace, "read a file as fast as possible, every frame of it");
  app.add_flag("--loop", written.loop, "start a file or a folder again at its end");
  app.add_option("--fov", written.fovs, "horizontal field of view, degrees")
      ->allow_extra_args(false)
      ->check(CLI::Range(10.0, 170.0))
      ->default_str("60");
  app.add_option("--mount-offset", written.offsets,
                 "x,y,z: the lens from the screen's centre, metres: right as the visitor sees it, "
                 "up, towards the visitor")
      ->allow_extra_args(false)
      ->default_str("0,0,0");
  app.add_option("--mount-pitch", written.pitches, "tilt of the camera, degrees, upwards positive")
      ->allow_extra_args(false)
      ->check(CLI::Range(-80.0, 80.0))
      ->default_str("0");
  app.add_option("--mount-roll", written.rolls,
                 "turn of the camera about the way it looks, degrees, clockwise positive: 90 if it "
                 "is mounted with its right side down")
      ->allow_extra_args(false)
      ->check(CLI::Range(-180.0, 180.0))
      ->default_str("0");
  app.add_flag("--mirrored", written.mirrored, "the camera delivers a mirror image");
  app.add_option("--width", written.width,
                 "pixels across: asked of a webcam; wider frames are reduced")
      ->check(CLI::Range(160, 1920))
      ->capture_default_str();
  app.add_option("--rate", written.rate, "frames a second at most; all of a file with --no-pace")
      ->check(CLI::Range(1.0, 120.0))
      ->capture_default_str();
}

// Chooses the file's cameras that are asked for, else all; one that the file does not list has its
// common values.
std::vector<CameraSettings> choose(const std::vector<std::string>& sources,
                                   const KioskConfig& config) {
  if (sources.empty()) return config.cameras;
  std::vector<CameraSettings> listed = config.cameras, chosen;
  for (const std::string& source : sources) {
    auto found = std::find_if(listed.begin(), listed.end(),
                              [&](const auto& camera) { return camera.source == source; });
    chosen.push_back(found == listed.end() ? config.camera : *found);
    if (found != listed.end()) listed.erase(found);
    chosen.back().source = source;
  }
  return chosen;
}

template <class Value, class Set>
void put_each(std::vector<CameraSettings>& cameras, const char* option,
              const std::vector<Value>& values, const Set& set) {
  if (values.empty()) return;
  if (values.size() > 1 && values.size() != cameras.size())
    throw CLI::ValidationError(option, "one value is needed, or one for each camera");
  for (size_t i = 0; i < cameras.size(); i++) set(cameras[i], values[values.size() > 1 ? i : 0]);
}

// Cuts a name to what a message may have, and replaces what cannot be printed.
std::string printable(std::string name) {
  for (char& c : name)
    if (uint8_t(c) < 32 || c == 127) c = ' ';
  constexpr size_t longest = 100;  // bytes
  if (name.size() > longest) {
    size_t end = longest;
    while (end > 0 && (uint8_t(name[end]) & 0xc0) == 0x80) end--;  // whole characters
    name.resize(end);
  }
  return name;
}

// Names cameras "kiosk", or "kiosk, camera"; no two are alike.
void put_names(std::vector<CameraSettings>& cameras, std::string kiosk) {
  char machine[256] = "kiosk";
  if (kiosk.empty() && gethostname(machine, sizeof machine - 1) == 0) kiosk = machine;
  std::vector<std::string> taken;
  for (CameraSettings& camera : cameras) {
    if (camera.name.empty() && cameras.size() > 1)
      camera.name = std::filesystem::path(camera.source).filename().string();
    const std::string name =
        printable(kiosk) + (camera.name.empty() ? "" : ", " + printable(camera.name));
    camera.name = name;
    for (int count = 2; std::count(taken.begin(), taken.end(), camera.name); count++)
      camera.name = name + " " + std::to_string(count);
    taken.push_back(camera.name);
  }
}

void add_eye(CLI::App& app, KioskOptions& options, Written& written) {
  app.add_option("--cascades", options.observer.face.cascades, "folder of OpenCV's cascades")
      ->capture_default_str();
  app.add_option("--weights", options.observer.face.weights,
                 "folder of the face networks' weights; without them cascades find faces");
  app.add_option("--expression", written.expression,
                 "on: estimate what faces express (visitors must be told); off")
      ->check(CLI::IsMember({"on", "off"}))
      ->capture_default_str();
  app.add_option("--station", options.station,
                 "file that `wellspring station` wrote: what visitors hold to the camera is told");
  app.add_flag("!--no-hands", options.hands, "do not look for hands and their gestures");
  app.add_flag("!--no-bodies", options.observer.bodies,
               "do not look for bodies, who may be far away or turned away");
  app.add_flag("!--no-sandbox", options.sandbox,
               "let the process that sees pictures write files and use the network");
  app.add_option(observe_to, options.observe_to)->group("");
  app.add_option(of_camera, options.eye)->group("");
}

}  // namespace

KioskOptions parse_options(int argc, char** argv, CLI::App& app) {
  KioskOptions options;
  KioskConfig config;
  const std::string file = config_of(argc, argv);
  bool calibrates = false;
  for (int i = 1; i < argc; i++) calibrates |= std::string_view(argv[i]) == "--calibrate";
  // --calibrate may create the file.
  if (!file.empty() && (!calibrates || std::ifstream(file))) load_config(file, config);
  options.observer.presence = config.presence;
  options.hands = config.hands;
  options.observer.bodies = config.bodies;
  options.station = config.station;
  options.name = config.name;
  if (!config.server.empty()) options.server = config.server;
  options.ca_file = config.ca_file;
  std::string token_file = config.token_file;
  Written written;
  written.expression = config.expression ? "on" : "off";

  auto* camera = app.add_option("--camera", written.sources,
                                "number of a webcam, a device's path, a video file, a folder of "
                                "pictures, or 'synthetic'; once for each camera")
                     ->allow_extra_args(false);
  auto* replay =
      app.add_option("--replay", options.replay, "instead of a camera: a file that --record wrote")
          ->excludes(camera);
  auto* recordings =
      app.add_option("--train", options.recordings,
                     "instead of watching: learn gestures from this folder of recordings, or from "
                     "'generated' ones, and write them to the file of --gestures")
          ->excludes(camera)
          ->excludes(replay);
  auto* gestures = app.add_option("--gestures", options.gestures,
                                  "what --train wrote; without it gestures that are built in");
  recordings->needs(gestures);
  auto* server = app.add_option("--server", options.server,
                                "where observations go; without it and with --print nowhere")
                     ->capture_default_str();
  app.add_option("--ca-file", options.ca_file,
                 "of a wss:// server: file in PEM of who must have signed its certificate; without "
                 "it one whom this system believes");
  app.add_option(
      "--token-file", token_file,
      "file of the token by which a server on another machine trusts this kiosk; without "
      "it WELLSPRING_KIOSK_TOKEN");
  app.add_option("--name", options.name,
                 "the kiosk's, as its page says it (/kiosk?kiosk=NAME); without it the only one");
  app.add_flag("--print", options.print, "one JSON observation a line on stdout");
  app.add_option("--record", options.record, "a file for the observations, a line each");
  auto* configured =
      app.add_option("--config", options.config, "the kiosk's configuration file; flags win");
  auto* calibrate = app.add_flag("--calibrate", options.calibrate,
                                 "instead of watching: find out how the camera sits from a person "
                                 "at two marks, and write it to the file of --config")
                        ->needs(configured);
  auto* eyes =
      app.add_option("--eyes", options.eyes, "of that person, metres above the screen's centre")
          ->needs(calibrate);
  add_camera(app, options, written);
  add_eye(app, options, written);
  app.parse(argc, argv);
  options.cameras = choose(written.sources, config);
  const bool watches = !*recordings && !*replay;
  if (watches && options.cameras.empty()) throw CLI::RequiredError("--camera, --replay or --train");
  if (watches && options.eye >= options.cameras.size())
    throw CLI::ValidationError(of_camera, "there is no such camera");
  for (const auto& [option, asked] : {std::pair("--calibrate", options.calibrate),
                                      std::pair("--record", !options.record.empty())})
    if (asked && options.cameras.size() > 1)
      throw CLI::ValidationError(option, "takes one camera; say which with --camera");
  Observation named;
  named.kiosk = options.name;
  const auto read = read_observation(write_observation(named));
  if (const WireError* error = std::get_if<WireError>(&read))
    throw CLI::ValidationError("--name", error->message);
  options.server_given = server->count() > 0 || !config.server.empty();
  // An eye needs no token, and its environment has none.
  if (options.observe_to < 0) options.token = read_token(token_file, "WELLSPRING_KIOSK_TOKEN");
  options.eyes_given = eyes->count() > 0;
  put_each(options.cameras, "--fov", written.fovs,
           [](CameraSettings& to, double fov) { to.mount.fov = float(fov) * one_degree; });
  put_each(options.cameras, "--mount-pitch", written.pitches,
           [](CameraSettings& to, double pitch) { to.mount.pitch = float(pitch) * one_degree; });
  put_each(options.cameras, "--mount-roll", written.rolls,
           [](CameraSettings& to, double roll) { to.mount.roll = float(roll) * one_degree; });
  put_each(options.cameras, "--mount-offset", written.offsets,
           [](CameraSettings& to, const std::string& text) { to.mount.offset = read_place(text); });
  for (CameraSettings& one : options.cameras) {
    if (app.count("--width") > 0) one.width = written.width;
    if (app.count("--rate") > 0) one.rate = written.rate;
    one.mount.mirrored |= written.mirrored;
    one.loop = written.loop;
    one.synthetic_ends = !options.pace && !written.loop;
  }
  put_names(options.cameras, options.name);
  options.observer.expression = written.expression == "on";
  return options;
}

}  // namespace wellspring::kiosk
