// SPDX-License-Identifier: Apache-2.0
// The kiosk program's command line, over its configuration file.
#pragma once
#include <string>
#include <vector>

#include "kiosk/camera.h"
#include "kiosk/observe.h"

namespace CLI {
class App;
}

namespace wellspring::kiosk {

struct KioskOptions {
  std::vector<CameraSettings> cameras;  // one or more, but for --replay and --train
  ObserverSettings observer;            // the mount is its camera's
  std::string server = "ws://127.0.0.1:8080";
  std::string ca_file;  // of ServerLinkSettings
  bool server_given = false, print = false, pace = true;
  std::string token;           // shown to the server; empty: none
  std::string config;          // file; empty: none
  std::string name;            // the kiosk's; empty: the only one of the house
  std::string recordings;      // folder to learn gestures from; empty: watch
  std::string gestures;        // file of learnt ones; empty: those that are built in
  bool hands = true;           // follow them
  bool sandbox = true;         // kiosk/process/sandbox.h
  std::string record, replay;  // files of observations; empty: none
  bool calibrate = false;      // instead of watching: how the camera sits, into `config`
  float eyes = 0;              // of who stands there then, metres above the screen's centre
  bool eyes_given = false;
  int observe_to = -1;  // kiosk/process/eye_process.h; -1: this is not an eye's process
  size_t eye = 0;       // else: of which camera
};

// Flags win over the file of --config. A wrong command line throws CLI::ParseError, a wrong file
// LoadError.
KioskOptions parse_options(int argc, char** argv, CLI::App& app);

}  // namespace wellspring::kiosk
