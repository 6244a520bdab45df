// SPDX-License-Identifier: Apache-2.0
// How far long work of the command line has come, on one line of a terminal: each takes the place
// of the last. Where stderr is no terminal nothing is written, unless somebody wants lines there.
#pragma once
#include <mutex>
#include <string>
#include <string_view>

namespace wellspring {

// "render [##########....................] 33 %, 0:40 left". `done`: 0 to 1; `seconds`: that this
// took. What is left is not guessed in the first seconds. `more` follows a comma.
std::string progress_line(std::string_view what, double done, double seconds,
                          std::string_view more = {});

class Progress {
 public:
  // `seconds_elsewhere`: from one line to the next where stderr is no terminal; 0: none are
  // written.
  explicit Progress(std::string what, double seconds_elsewhere = 0);
  ~Progress() { clear(); }
  // Any thread, as often as it likes: a line is written at most ten times a second.
  void tell(double done, std::string_view more = {});
  void clear();  // before anything else is written

 private:
  const std::string what_;
  const bool terminal_;
  const double pause_, began_;
  std::mutex mutex_;  // of what follows
  double told_ = -1e9;
  bool stands_ = false;  // a line, on the terminal
};

}  // namespace wellspring
