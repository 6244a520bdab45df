// SPDX-License-Identifier: Apache-2.0
// Makes a first exhibit of somebody's model: a folder with exhibit.json that can be shown at once.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "world/world.h"

namespace wellspring::show {

struct NewExhibit {
  std::string folder;
  std::vector<std::string> told;  // findings and decisions, a sentence each
};

// Makes `content`/`id` with the model and all files that it names. See content/README.md, "From a
// model", for what it looks like. Throws LoadError when the id is no name of a folder, the folder
// is there, the model cannot be read or has nothing to see, or files cannot be written; then
// nothing is left behind.
NewExhibit make_new_exhibit(const std::string& content, const std::string& id,
                            const std::string& model);

// Returns the folder of a new exhibit, which is not made yet. Throws LoadError when the id is no
// name of a folder, or the folder is there.
std::string name_folder(const std::string& content, const std::string& id);
// Makes the folder, and calls `fill` to write into it. Leaves nothing behind if that throws.
void fill_folder(const std::string& folder, const std::function<void()>& fill);

// Proposes places from which a scene that nobody has furnished yet can be seen: from inside if it
// is a room, from around if it is an object.

struct ProposedViews {
  bool is_room = false;
  std::vector<Viewpoint> views;  // 2 to 5 views, with names
};

// Proposes views of a scene with something to see. In rooms a visitor's eye is `eye_height` above a
// floor. The views are the same each time; takes milliseconds to tenths of a second.
ProposedViews propose_views(const World& world, float eye_height);

}  // namespace wellspring::show
