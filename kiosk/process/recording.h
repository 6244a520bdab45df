// SPDX-License-Identifier: Apache-2.0
// Keeps observations in a file, a line each, as they went to the server: numbers only. They can be
// played again without a camera.
#pragma once
#include <cstdio>
#include <fstream>
#include <memory>
#include <string>

#include "wire/messages.h"

namespace wellspring::kiosk {

class Recorder {
 public:
  explicit Recorder(const std::string& file);  // begins the file anew; throws LoadError
  // Writes at once into the file. False: it is full or gone.
  bool write(const std::string& line);

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> file_;
};

class Replay {
 public:
  explicit Replay(const std::string& file);  // throws LoadError
  // Reads the next observation, with its text; false: there are no more. Empty lines are passed
  // over. Throws LoadError naming the line that is no observation, or whose time runs back.
  bool next(Observation& seen, std::string& text);

 private:
  std::string name_;
  std::ifstream file_;
  long line_ = 0;
  double time_ = 0;
  bool begun_ = false;
};

}  // namespace wellspring::kiosk
