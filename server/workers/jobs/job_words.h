// SPDX-License-Identifier: Apache-2.0
// Says which command lines a job may have: whoever takes shards runs these programs with these
// options, and nothing else that arrives.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "base/layers.h"

namespace wellspring::workers {

// Says how a shard's work comes together.
enum class JobMerge : uint8_t {
  bake,      // files of states make one bake
  pictures,  // files of pictures lie beside one another
  clip,      // folders of pictures make a clip
  places,    // files of pairs make a table
  none,      // there is one shard, whose files are the result
};

struct JobWord {
  std::string text;
  bool is_path = false;  // below the folder of all inputs
};

// Holds a command line that may be run.
struct JobCommand {
  std::string program;         // "bake": wellspring_bake
  std::vector<JobWord> words;  // its arguments
  JobMerge merge = JobMerge::none;
  // Returns the paths among the words.
  std::vector<std::string> paths() const;
};

// Checks the words of a job ("bake", "content/ID", ...). Throws std::invalid_argument with one
// sentence that names the word that is not allowed, or what is missing.
JobCommand check_words(const std::vector<std::string>& words, uint32_t shards);

// Returns the path below `folder`, nothing: it leads out of it, also by symbolic links, or there is
// nothing.
std::optional<std::string> path_below(const std::string& folder, const std::string& path);

}  // namespace wellspring::workers
