// SPDX-License-Identifier: Apache-2.0
#include "kiosk/process/recording.h"

#include <cerrno>
#include <cstring>

#include "base/load_error.h"
#include "wire/json.h"

namespace wellspring::kiosk {

Recorder::Recorder(const std::string& file) : file_(std::fopen(file.c_str(), "w")) {
  if (!file_) throw LoadError(file, "", std::string("cannot be written: ") + std::strerror(errno));
}

bool Recorder::write(const std::string& line) {
  return std::fputs(line.c_str(), file_.get()) >= 0 && std::fputc('\n', file_.get()) != EOF &&
         std::fflush(file_.get()) == 0;
}

Replay::Replay(const std::string& file) : name_(file), file_(file) {
  if (!file_) throw LoadError(file, "", "cannot be read");
}

bool Replay::next(Observation& seen, std::string& text) {
  auto fail = [&](const std::string& what) {
    throw LoadError(name_, "line " + std::to_string(line_), what);
  };
  while (std::getline(file_, text)) {
    line_++;
    if (text.find_first_not_of(" \t\r") == std::string::npos) continue;
    auto read = read_observation(text);
    if (auto* error = std::get_if<WireError>(&read)) fail(error->message);
    seen = std::get<Observation>(std::move(read));
    if (begun_ && seen.time < time_) fail("time runs back");
    time_ = seen.time;
    begun_ = true;
    return true;
  }
  return false;
}

}  // namespace wellspring::kiosk
