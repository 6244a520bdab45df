// SPDX-License-Identifier: Apache-2.0
// Reads a kiosk's configuration file: JSON, all of it optional.
//   cameras     a list, if there are several: source (as --camera takes it), name, mount, and
//               camera's fields; fields left out are as camera and mount have them
//   camera      width (pixels), rate (frames a second), fov (degrees across), mirrored
//   mount       offset [right, up, towards the visitor] of the lens in metres, pitch (degrees up)
//   presence    wake_after, confirm_after, hold_person, hold_motion (seconds; kiosk/observe.h)
//   expression  true or false
//   hands       true or false
//   bodies      true or false: bodies are seen from afar
//   station     file of a recognition tree: what visitors hold is told (kiosk/station)
//   name        the kiosk's, as its page says it (/kiosk?kiosk=NAME)
//   server      address for observations: ws://HOST[:PORT][/PATH], or wss:// for TLS
//   ca_file     PEM file of who must have signed the server's certificate; else the system's
//   token_file  file of the token by which a server on another machine trusts it
#pragma once
#include <string>
#include <vector>

#include "kiosk/camera.h"
#include "kiosk/observe.h"

namespace wellspring::kiosk {

struct KioskConfig {
  CameraSettings camera;                // common to all cameras; the mount within counts
  std::vector<CameraSettings> cameras;  // empty: the file names none
  PresenceSettings presence;
  bool expression = false, hands = true, bodies = true;
  std::string station;     // file; empty: none
  std::string name;        // the kiosk's; empty: the only one of the house
  std::string server;      // address; empty: the file names none
  std::string token_file;  // file; empty: none
  std::string ca_file;     // file; empty: none
};

// Changes what the file names. Throws LoadError naming the first value that is unknown, of another
// type or out of range, and its line.
void load_config(const std::string& file, KioskConfig& config);
// Puts the mount of the camera `source` into the file, which keeps the rest and may be new: into
// that camera's entry if the file lists it, else as that of every camera. Throws LoadError.
void save_mount(const std::string& file, const std::string& source, const Mount& mount);

}  // namespace wellspring::kiosk

namespace CLI {

// Reads the kiosk program's command line, over its configuration file.

class App;
}  // namespace CLI

namespace wellspring::kiosk {

struct KioskOptions {
  std::vector<CameraSettings> cameras;  // one or more, but for --replay and --train
  ObserverSettings observer;            // the mount is its camera's
  std::string server = "ws://127.0.0.1:8080";
  std::string ca_file;  // ServerLinkSettings::ca_file
  bool server_given = false, print = false, pace = true;
  std::string token;           // shown to the server; empty: none
  std::string config;          // file; empty: none
  std::string name;            // the kiosk's; empty: the house's only one
  std::string recordings;      // folder to learn gestures from; empty: watch
  std::string gestures;        // file of learnt gestures; empty: the built-in ones
  std::string station;         // file of a recognition tree; empty: nobody holds anything
  bool hands = true;           // hands are followed
  bool sandbox = true;         // kiosk/process/eye_process.h
  std::string record, replay;  // files of observations; empty: none
  bool calibrate = false;      // writes how the camera sits into `config`, instead of watching
  float eyes = 0;  // height of the eyes of who stands there then, metres above the screen's centre
  bool eyes_given = false;
  int observe_to = -1;  // kiosk/process/eye_process.h; -1: this is not an eye's process
  size_t eye = 0;       // index of the eye's camera
};

// Reads the command line; flags win over the file of --config. A wrong command line throws
// CLI::ParseError, a wrong file LoadError.
KioskOptions parse_options(int argc, char** argv, CLI::App& app);

}  // namespace wellspring::kiosk
