// SPDX-License-Identifier: Apache-2.0
// Runs a program beside this one, and ends it.
#pragma once
#include <limits>
#include <optional>
#include <string>
#include <sys/types.h>
#include <utility>
#include <vector>

namespace wellspring {

struct ChildSettings {
  std::vector<std::string> words;  // the program, which is looked for in PATH, and its arguments
  std::string program = {};        // file that is started if the first word does not say it
  // The child's descriptors that are pipes from Child::to(), and to Child::from(); -1: none.
  int reads = -1, writes = -1;
  // These open files of ours are the child's descriptors, too; it has no others but 0, 1 and 2.
  std::vector<std::pair<int, int>> files = {};
  bool apart = false;   // has its own process group, no blocked signals, and no ignored ones
  double patience = 0;  // seconds that it has to end when it is asked to; 0: it is killed
};

class Child {
 public:
  // Throws std::runtime_error with one sentence if the program cannot be started.
  explicit Child(const ChildSettings& settings);
  // Closes the pipes and ends the program, if it is apart with its process group.
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  pid_t id() const { return id_; }  // 0: it has ended
  int to() const { return to_; }
  int from() const { return from_; }
  // Waits for its end. Returns its exit code, or minus the signal that ended it; nothing if it
  // still runs after `seconds`.
  std::optional<int> wait(double seconds = std::numeric_limits<double>::infinity());

 private:
  pid_t id_ = 0;
  int to_ = -1, from_ = -1, status_ = 0;
  bool apart_ = false;
  double patience_ = 0;
};

}  // namespace wellspring
