// SPDX-License-Identifier: Apache-2.0
#include "base/write_file.h"

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "base/load_error.h"

namespace wellspring {

void write_file(const std::string& path, std::span<const char> bytes) {
  static std::atomic<unsigned> count{0};
  std::string temporary = path + ".part" + std::to_string(getpid()) + "-" + std::to_string(count++);
  FILE* file = std::fopen(temporary.c_str(), "wb");
  if (!file) throw LoadError(path, "", std::string("cannot be written: ") + std::strerror(errno));
  bool good = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
  int reason = errno;
  if (std::fclose(file) != 0 && good) good = false, reason = errno;
  if (good && std::rename(temporary.c_str(), path.c_str()) != 0) good = false, reason = errno;
  if (!good) {
    std::remove(temporary.c_str());
    throw LoadError(path, "", std::string("cannot be written: ") + std::strerror(reason));
  }
}

}  // namespace wellspring
