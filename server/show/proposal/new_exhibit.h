// SPDX-License-Identifier: Apache-2.0
// A first exhibit of somebody's model: a folder with exhibit.json that can be shown at once.
#pragma once
#include <string>
#include <vector>

#include "world/world.h"

namespace wellspring::show {

struct NewExhibit {
  std::string folder;
  std::vector<std::string> told;  // what was found out and decided, a sentence each
};

// Makes `content`/`id` with the model and all files that it names. What it looks like: content/
// README.md, "From a model". Throws LoadError when the id is no name of a folder, the folder is
// there, the model cannot be read or has nothing to see, or files cannot be written; then nothing
// is left behind.
NewExhibit make_new_exhibit(const std::string& content, const std::string& id,
                            const std::string& model);

// Places from which a scene that nobody has furnished yet can be seen: from inside where it is a
// room, from around where it is an object.

struct ProposedViews {
  bool is_room = false;
  std::vector<Viewpoint> views;  // 2 to 5, with names
};

// A scene with something to see. In rooms somebody's eye is `eye_height` above a floor. The same
// views each time; milliseconds to tenths of a second.
ProposedViews propose_views(const World& world, float eye_height);

}  // namespace wellspring::show
