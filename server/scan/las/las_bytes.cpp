// SPDX-License-Identifier: Apache-2.0
#include "scan/las/las_bytes.h"

#include <cerrno>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/load_error.h"

namespace wellspring::scan {

MappedFile::MappedFile(const std::string& file) {
  struct stat about {};
  const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  const auto fail = [&](const std::string& what) {
    if (descriptor >= 0) close(descriptor);
    throw LoadError(file, "", what);
  };
  if (descriptor < 0 || fstat(descriptor, &about) != 0)
    fail(std::string("cannot be read: ") + std::strerror(errno));
  if (!S_ISREG(about.st_mode)) fail("is no regular file");
  const size_t size = size_t(about.st_size);
  if (size > 0) {
    void* place = mmap(nullptr, size, PROT_READ, MAP_SHARED, descriptor, 0);
    if (place == MAP_FAILED) fail(std::string("cannot be mapped: ") + std::strerror(errno));
    bytes_ = {static_cast<const uint8_t*>(place), size};
  }
  close(descriptor);
}

MappedFile::~MappedFile() {
  if (!bytes_.empty()) munmap(const_cast<uint8_t*>(bytes_.data()), bytes_.size());
}

}  // namespace wellspring::scan
