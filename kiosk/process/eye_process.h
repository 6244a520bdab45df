// SPDX-License-Identifier: Apache-2.0
// Two processes: the eye sees pictures and has no network (kiosk/process/eye_process.h); the one
// that starts it has the network and sees lines of text alone, and tells the eye what is needed of
// it. The eye is this program, started again with the same arguments and two more. Each camera has
// an eye of its own.
#pragma once
#include <optional>
#include <string>
#include <sys/types.h>
#include <vector>

#include "wire/messages.h"

namespace wellspring::kiosk {

// The arguments: the open file that lines are written to, and which of the cameras it is of.
inline constexpr const char* observe_to = "--observe-to";
inline constexpr int observe_fd = 3;
inline constexpr const char* of_camera = "--of-camera";
// Writes a line to it. False: nobody reads any more.
bool write_line(int fd, const std::string& line);

// What the other process says, a line each, read from stdin as it comes.
class Orders {
 public:
  // The newest that was not taken yet. Never waits; lines that are no order are left out.
  std::optional<EyeOrder> take();

 private:
  std::string text_;  // of a line that has not ended
};

class EyeProcess {
 public:
  // `eye`: 0, 1, ... Throws std::runtime_error where it cannot be started.
  EyeProcess(std::vector<std::string> arguments, size_t eye);
  ~EyeProcess();  // asks it to end, and ends it after two seconds
  EyeProcess(const EyeProcess&) = delete;
  EyeProcess& operator=(const EyeProcess&) = delete;

  enum class Heard { line, nothing, ended };
  // A line for its Orders. Never waits: an eye that hangs does not hear it.
  void tell(const std::string& line);
  // The next line, without its end. Waits up to `seconds`. Lines of more than 64 KiB are left out.
  Heard take(std::string& line, double seconds);
  // After Heard::ended: its exit code, or minus the signal that ended it.
  int status();

 private:
  pid_t process_ = -1;
  int lines_ = -1, orders_ = -1;
  std::string text_;       // read and not taken yet
  bool too_long_ = false;  // the line that text_ begins with
  int status_ = 0;
};

// What the process that sees pictures gives up, once its camera and its weights are open: it can
// open no file to write, no network, no other program, and leaves no memory image behind. What it
// has open already it keeps. Enforced by the kernel (seccomp), for all threads and for good.

struct SandboxSettings {
  // A camera device has to be opened to read and write; also again, when it was unplugged.
  bool device = false;
};

// Throws std::runtime_error where the kernel does not do it.
void enter_sandbox(const SandboxSettings& settings = {});

}  // namespace wellspring::kiosk
