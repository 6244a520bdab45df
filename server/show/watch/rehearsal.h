// SPDX-License-Identifier: Apache-2.0
// Makes a new show of an exhibit when its files have changed, while the old one goes on.
#pragma once
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "show/exhibit/json_fields.h"
#include "show/state/show.h"

namespace wellspring::show {

// Finds whether files of a folder have changed, by their sizes and times. An editor writes a file
// in pieces, so a change is reported when all files have been still for a moment.

class FolderWatch {
 public:
  // Takes the files' present state as the known one.
  explicit FolderWatch(std::string folder, double still = 0.5);

  // Returns true once for each change, when the files have been still for `still` seconds; not for
  // a change that is taken back before. `now` is in seconds.
  bool changed(double now);
  // Returns whether the files now differ from their known state, without waiting: somebody says
  // that they are complete.
  bool changed();

 private:
  // Holds size and time of all files below the folder but hidden ones and editors' copies (~).
  using Files = std::map<std::string, std::pair<std::filesystem::file_time_type, std::uintmax_t>>;
  static Files look(const std::string& folder);

  std::string folder_;
  double still_, moved_at_ = 0;
  Files known_, last_;
};

struct Show;

class Rehearsal {
 public:
  // Watches the exhibit's folder. `make` runs on a thread of the rehearsal's own, in a CancelScope,
  // and throws what is wrong with the files. `watch`: look at the files all the time; else only
  // when look() asks for it.
  Rehearsal(std::string folder, std::function<std::unique_ptr<Show>()> make, bool watch);
  ~Rehearsal();  // cancels, and waits until that is done

  // Looks soon, and makes a show if the files have changed, or `anyway`. From any thread.
  void look(bool anyway);
  // Makes no show any more and gives up one that is being made. Returns at once.
  void cancel();
  // Returns whether it makes a show now, and so needs the cores. From any thread.
  bool at_work() const;

  struct Outcome {
    std::unique_ptr<Show> show;     // null: it cannot be shown
    std::vector<Problem> problems;  // reasons why; files by their names below the folder
  };
  // Returns the outcome of the last change, once.
  std::optional<Outcome> take();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Sends the pages of a watched exhibit the problems with its files, while the old exhibit goes on.

// Writes {"type": "problems", "list": [{file, where, what}]}; an empty list: all is mended.
std::string write_problems(const std::vector<Problem>& problems);

// Sets the present problems, and sends them to all visitors; `hello` sends them to those who come.
// Nothing is sent if that is no news.
void set_problems(ExhibitStage& stage, ShowVisits& visits, std::vector<Problem> problems);

}  // namespace wellspring::show
