// SPDX-License-Identifier: Apache-2.0
// Writes the log: one line an event on stderr, or where log.h says. WELLSPRING_LOG=debug
// shows more. Usage: log::info("exhibit {} loaded in {:.1f} s", id, seconds); Formats are checked
// when they are compiled; lines are put together in log.cpp alone, since the code for that takes
// seconds to compile.
#pragma once
#include <fmt/core.h>
#include <string>
#include <vector>

#include "base/layers.h"

namespace wellspring::log {

enum class Level { debug, info, warn, error };

// Writes one line, if lines of that level are shown. Any thread.
void write(Level level, fmt::string_view format, fmt::format_args arguments);

template <class... T>
void debug(fmt::format_string<T...> format, T&&... arguments) {
  write(Level::debug, format, fmt::make_format_args(arguments...));
}
template <class... T>
void info(fmt::format_string<T...> format, T&&... arguments) {
  write(Level::info, format, fmt::make_format_args(arguments...));
}
template <class... T>
void warn(fmt::format_string<T...> format, T&&... arguments) {
  write(Level::warn, format, fmt::make_format_args(arguments...));
}
template <class... T>
void error(fmt::format_string<T...> format, T&&... arguments) {
  write(Level::error, format, fmt::make_format_args(arguments...));
}

// Sends the log to stderr, with the journal's marks if stderr is the journal (systemd), and reads
// WELLSPRING_LOG. Call once at the start of main().
void start(const char* program);

// Chooses where the log's lines go, and which are shown: for main() alone.

// Returns the names of levels, from the most talkative.
std::vector<std::string> levels();
void set_level(const std::string& name);  // one of levels(); any thread

// Sends the log to the end of this file instead of stderr from now on. Lines that cannot be
// written, for example to a full disk, are lost and counted; the next line that can be written
// gives their number. Throws std::runtime_error if the file cannot be opened. Call before other
// threads begin.
void send_to(const std::string& file);

// Opens that file anew, as it must after it was renamed (logrotate). If it cannot be opened, the
// log goes on in the old one. Any thread.
void reopen();

}  // namespace wellspring::log
