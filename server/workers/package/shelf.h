// SPDX-License-Identifier: Apache-2.0
// Hands out the files of a server's exhibit, part by part, by their hashes. Reads and hashes files:
// on a thread that may wait.
#pragma once
#include <string>
#include <vector>

#include "workers/package/package.h"

namespace wellspring::workers {

class PackageShelf {
 public:
  // `folder` of the package; `maps`: file of better illumination maps that may come to be, or
  // empty.
  PackageShelf(std::string folder, std::string maps);
  // A hash of zeros asks for the hash of the list of files as they are now. A part without bytes
  // says that there is no such file any more.
  FilePart answer(const FileQuestion& question);

 private:
  struct Listed {
    FileHash hash{};
    std::string bytes;  // write_list()
  };
  std::string folder_, maps_;
  HashedFiles files_;
  std::vector<Listed> lists_;  // the last is the newest; workers may still fetch older ones
};

}  // namespace wellspring::workers
