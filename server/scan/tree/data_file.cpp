// SPDX-License-Identifier: Apache-2.0
#include "scan/tree/data_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/load_error.h"

namespace wellspring::scan {
namespace {

std::shared_ptr<const int> own_descriptor(int file) {
  return {new int(file), [](const int* descriptor) {
            close(*descriptor);
            delete descriptor;
          }};
}

}  // namespace

DataFile DataFile::open(const std::string& path) {
  DataFile file;
  file.path_ = path;
  const int descriptor = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor < 0) file.fail("cannot be written");
  file.descriptor_ = own_descriptor(descriptor);
  return file;
}

DataFile DataFile::open_to_read(const std::string& path) {
  DataFile file;
  file.path_ = path;
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) file.fail("cannot be read");
  file.descriptor_ = own_descriptor(descriptor);
  struct stat about {};
  if (fstat(descriptor, &about) != 0 || !S_ISREG(about.st_mode))
    throw LoadError(path, "", "is no regular file");
  return file;
}

DataFile DataFile::in_memory(const std::string& name) {
  DataFile file;
  file.path_ = name;
  const int descriptor = memfd_create(name.c_str(), MFD_CLOEXEC);
  if (descriptor < 0) file.fail("cannot be kept in memory");
  file.descriptor_ = own_descriptor(descriptor);
  return file;
}

void DataFile::fail(const char* what) const {
  throw LoadError(path_, "", std::string(what) + ": " + std::strerror(errno));
}

void DataFile::write_at(uint64_t to, const void* from, size_t count) const {
  const char* bytes = static_cast<const char*>(from);
  while (count > 0) {
    const ssize_t written = pwrite(*descriptor_, bytes, count, off_t(to));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) fail("cannot be written");
    bytes += written, to += uint64_t(written), count -= size_t(written);
  }
}

void DataFile::read_at(uint64_t from, void* to, size_t count) const {
  char* place = static_cast<char*>(to);
  while (count > 0) {
    const ssize_t got = pread(*descriptor_, place, count, off_t(from));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail("cannot be read");
    if (got == 0)
      throw LoadError(path_, fmt::format("byte {}", from),
                      fmt::format("is cut off, {} bytes early", count));
    place += got, from += uint64_t(got), count -= size_t(got);
  }
}

uint64_t DataFile::size() const {
  struct stat about {};
  if (fstat(*descriptor_, &about) != 0) fail("cannot be read");
  return uint64_t(about.st_size);
}

void DataFile::cut(uint64_t size) const {
  if (ftruncate(*descriptor_, off_t(size)) != 0) fail("cannot be written");
}

void DataFile::sync() const {
  if (fdatasync(*descriptor_) != 0) fail("cannot be written");
}

std::shared_ptr<const std::byte> DataFile::map() const {
  const size_t count = size_t(size());
  void* place = mmap(nullptr, std::max<size_t>(count, 1), PROT_READ, MAP_SHARED, *descriptor_, 0);
  if (place == MAP_FAILED) fail("cannot be mapped");
  return {static_cast<const std::byte*>(place), [count](const std::byte* mapped) {
            munmap(const_cast<std::byte*>(mapped), std::max<size_t>(count, 1));
          }};
}

bool DataFile::lock() const { return flock(*descriptor_, LOCK_EX | LOCK_NB) == 0; }

DataFile WorkPlace::open(const std::string& name) const {
  return is_memory() ? DataFile::in_memory(name) : DataFile::open(path(name));
}

void WorkPlace::remove(const std::string& name) const {
  std::error_code none;
  if (!is_memory()) std::filesystem::remove(path(name), none);
}

}  // namespace wellspring::scan
