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

// Whether files of a folder have changed, by their sizes and times. Who saves a file writes it in
// pieces, so a change is told when all have been still for a moment.

class FolderWatch {
 public:
  // As the files are now is how they are known.
  explicit FolderWatch(std::string folder, double still = 0.5);

  // At `now`, seconds. True once for each change, when the files have been still since `still`
  // seconds; not for one that is taken back before.
  bool changed(double now);
  // Whether they are now other than they were known, without waiting: somebody says that they are
  // complete.
  bool changed();

 private:
  // Of all files below the folder but hidden ones and editors' copies (~).
  using Files = std::map<std::string, std::pair<std::filesystem::file_time_type, std::uintmax_t>>;
  static Files look(const std::string& folder);

  std::string folder_;
  double still_, moved_at_ = 0;
  Files known_, last_;
};

struct Show;

class Rehearsal {
 public:
  // `make` runs on a thread of the rehearsal's own, in a CancelScope; throws what is wrong with the
  // files. `watch`: look at the files all the time; else only when look() asks for it.
  Rehearsal(std::string folder, std::function<std::unique_ptr<Show>()> make, bool watch);
  ~Rehearsal();  // cancels, and waits until that is done

  // Looks soon, and makes a show where the files have changed, or `anyway`. From any thread.
  void look(bool anyway);
  // No show is made any more: one that is being made is given up. Returns at once.
  void cancel();
  // Whether it makes a show now, and so needs the cores. From any thread.
  bool at_work() const;

  struct Outcome {
    std::unique_ptr<Show> show;     // null: it cannot be shown, for
    std::vector<Problem> problems;  // these reasons; files by their names below the folder
  };
  // Of the last change, once.
  std::optional<Outcome> take();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Tells the pages of a watched exhibit what is wrong with its files, while the old one goes on.

// {"type": "problems", "list": [{file, where, what}]}; an empty list: all is mended.
std::string write_problems(const std::vector<Problem>& problems);

// From now on these: to all visitors, and by `hello` to those who come. Nothing is sent where that
// is no news.
void set_problems(Show& show, std::vector<Problem> problems);

}  // namespace wellspring::show
