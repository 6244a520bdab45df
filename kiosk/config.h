// SPDX-License-Identifier: Apache-2.0
// A kiosk's configuration file: JSON, all of it optional.
//   cameras     a list, where there are several: source (as --camera takes it), name, mount, and
//               what camera has; what one leaves out is as camera and mount have it
//   camera      width (pixels), rate (frames a second), fov (degrees across), mirrored
//   mount       offset [right, up, towards the visitor] of the lens in metres, pitch (degrees up)
//   presence    wake_after, confirm_after, hold_person, hold_motion (seconds; kiosk/presence.h)
//   expression  true or false
//   hands       true or false
//   name        the kiosk's, as its page says it (/kiosk?kiosk=NAME)
//   server      where observations go: ws://HOST[:PORT][/PATH], or wss:// for TLS
//   ca_file     in PEM: who must have signed the server's certificate; else those of the system
//   token_file  of the token by which a server on another machine trusts it
#pragma once
#include <string>
#include <vector>

#include "kiosk/camera.h"
#include "kiosk/presence.h"

namespace wellspring::kiosk {

struct KioskConfig {
  CameraSettings camera;                // of every camera; the mount within counts
  std::vector<CameraSettings> cameras;  // empty: the file names none
  PresenceSettings presence;
  bool expression = false, hands = true;
  std::string name;        // the kiosk's; empty: the only one of the house
  std::string server;      // empty: the file names none
  std::string token_file;  // likewise
  std::string ca_file;     // likewise
};

// Changes what the file names. Throws LoadError naming the first thing that is unknown, of another
// type or out of range, and its line.
void load_config(const std::string& file, KioskConfig& config);
// Puts the mount of the camera `source` into the file, which keeps the rest and may be new: where
// the file lists that camera, there, else as that of every camera. Throws LoadError.
void save_mount(const std::string& file, const std::string& source, const Mount& mount);

}  // namespace wellspring::kiosk
