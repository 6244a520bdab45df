// SPDX-License-Identifier: Apache-2.0
// Makes a new show of an exhibit when its files have changed, while the old one goes on.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "show/exhibit/problem.h"

namespace wellspring::show {

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

}  // namespace wellspring::show
