// SPDX-License-Identifier: Apache-2.0
// An empty folder of one's own, which is removed with all that is in it at the end of this value.
// Throws std::runtime_error if it cannot be made.
#pragma once
#include <filesystem>
#include <stdexcept>
#include <stdlib.h>
#include <string>

namespace wellspring::test {

class OwnFolder {
 public:
  OwnFolder()
      : path_((std::filesystem::temp_directory_path() / "wellspring_bench_XXXXXX").string()) {
    if (!mkdtemp(path_.data())) throw std::runtime_error(path_ + ": cannot be made");
  }
  ~OwnFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  OwnFolder(const OwnFolder&) = delete;
  OwnFolder& operator=(const OwnFolder&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace wellspring::test
