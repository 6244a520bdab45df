// SPDX-License-Identifier: Apache-2.0
#include "volume/compressed/compressed_file.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/load_error.h"
#include "base/write_file.h"

namespace wellspring::volume {

CompressedVolume read_compressed(const std::string& path) {
  const auto fail = [&](int file) {
    const std::string reason = std::strerror(errno);
    if (file >= 0) close(file);
    throw LoadError(path, "", "cannot be read: " + reason);
  };
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) fail(file);
  struct stat status;
  if (fstat(file, &status) != 0) fail(file);
  if (!S_ISREG(status.st_mode) || status.st_size <= 0) {
    close(file);
    throw LoadError(path, "", "is no file of a compressed volume");
  }
  const size_t count = size_t(status.st_size);
  void* place = mmap(nullptr, count, PROT_READ, MAP_SHARED, file, 0);
  if (place == MAP_FAILED) fail(file);
  close(file);
  const std::shared_ptr<const std::byte> bytes(
      static_cast<const std::byte*>(place),
      [count](const std::byte* mapped) { munmap(const_cast<std::byte*>(mapped), count); });
  return open_compressed(bytes, count, path);
}

void write_compressed(const std::string& path, const CompressedVolume& volume) {
  write_file(
      path, std::span(reinterpret_cast<const char*>(volume.file.get()), size_t(volume.file_bytes)));
}

}  // namespace wellspring::volume
