// SPDX-License-Identifier: Apache-2.0
// Divides the kiosk into two processes: the eye sees pictures and has no network
// (kiosk/process/eye_process.h); the process that starts it has the network, sees lines of text
// alone, and sends orders about what is needed. The eye is this program, started again with the
// same arguments and two more. Each camera has an eye of its own.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "base/child.h"
#include "wire/messages.h"

namespace wellspring::kiosk {

// These arguments are the open file that lines are written to, and the index of the eye's camera.
inline constexpr const char* observe_to = "--observe-to";
inline constexpr int observe_fd = 3;
inline constexpr const char* of_camera = "--of-camera";
// Writes a line to that file. False: nobody reads any more.
bool write_line(int fd, const std::string& line);

// Reads the other process's orders, a line each, from stdin as they come.
class Orders {
 public:
  // Returns the newest order not taken yet. Never waits; lines that are no order are left out.
  std::optional<EyeOrder> take();

 private:
  std::string text_;  // text of a line that has not ended
};

// Is a text in memory that an eye opens as a file, read only. Throws std::runtime_error.
class HandedText {
 public:
  explicit HandedText(const std::string& text);
  ~HandedText();
  HandedText(const HandedText&) = delete;
  HandedText& operator=(const HandedText&) = delete;
  int fd() const { return fd_; }

 private:
  int fd_ = -1;
};
inline constexpr int handed_fd = 4;
inline constexpr const char* handed_file = "/proc/self/fd/4";  // as the eye opens it

class EyeProcess {
 public:
  // Starts eye 0, 1, ... Throws std::runtime_error if it cannot be started. An eye is asked to end
  // with this value, and killed after two seconds. `handed`: its handed_file; may be null.
  EyeProcess(std::vector<std::string> arguments, size_t eye, const HandedText* handed = nullptr);

  enum class Heard { line, nothing, ended };
  // Sends a line for its Orders. Never waits: an eye that hangs does not receive it.
  void tell(const std::string& line);
  // Takes the next line, without its end. Waits up to `seconds`. Lines of more than 64 KiB are left
  // out.
  Heard take(std::string& line, double seconds);
  // Returns, after Heard::ended, its exit code, or minus the signal that ended it.
  int status() { return *process_.wait(); }

 private:
  Child process_;
  std::string text_;       // text read and not taken yet
  bool too_long_ = false;  // whether text_ begins within a line that is too long
};

// Takes rights from the process that sees pictures, once its camera and its weights are open: it
// can open no file to write, no network, no other program, and leaves no memory image behind. It
// keeps what it has open already. The kernel enforces this (seccomp), for all threads and for good.

struct SandboxSettings {
  // A camera device has to be opened to read and write; also again, when it was unplugged.
  bool device = false;
};

// Enters the sandbox. Throws std::runtime_error if the kernel cannot do it.
void enter_sandbox(const SandboxSettings& settings = {});

}  // namespace wellspring::kiosk
