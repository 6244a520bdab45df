// SPDX-License-Identifier: Apache-2.0
// Where peers wait until they have said which exhibit they want.
#pragma once
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "wire/link.h"

namespace wellspring {

// What the reception knows of an exhibit.
struct ExhibitDoor {
  std::string id;
  std::vector<std::string> kiosks;  // their names
};

// Which of the doors the first text of a peer leads to: the exhibit that a `hello` names; else the
// one that has the kiosk of that name; else the first. -1: there is no exhibit of that name.
int find_door(const std::vector<ExhibitDoor>& doors, LinkKind kind, const std::string& first_text);

void turn_away(Link& link);  // tells it that the museum is full

class Reception {
 public:
  // At least one door; more people than `most_waiting` are told to come back.
  explicit Reception(std::vector<ExhibitDoor> doors, size_t most_waiting = 64)
      : doors_(std::move(doors)), most_waiting_(most_waiting) {}

  void enter(std::shared_ptr<Link> link);  // from any thread; does not block
  struct Shown {
    size_t door = 0;
    std::shared_ptr<Link> link;  // its texts are still to be read
  };
  // Who knows by now where to go, after at most `seconds` in which nobody does. Those who ask for
  // what is not there are told so and may ask again; those who are gone are forgotten.
  std::vector<Shown> show_in(double seconds);

 private:
  std::vector<Shown> find_ready();  // with the lock held
  const std::vector<ExhibitDoor> doors_;
  const size_t most_waiting_;
  std::mutex mutex_;
  std::condition_variable somebody_;
  std::vector<std::shared_ptr<Link>> waiting_;
};

}  // namespace wellspring
