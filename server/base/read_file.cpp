// SPDX-License-Identifier: Apache-2.0
#include "base/read_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/load_error.h"

namespace wellspring {

void read_file_into(const std::string& path, size_t most_bytes, FileKind kind,
                    const std::function<void*(size_t)>& resize) {
  const auto fail = [&](const std::string& what) { throw LoadError(path, "", what); };
  const auto fail_to_read = [&] { fail(std::string("cannot be read: ") + std::strerror(errno)); };
  const auto check = [&](size_t size) {
    if (size > most_bytes) fail("is larger than " + std::to_string(most_bytes >> 20) + " MiB");
  };
  struct stat about {};
  if (stat(path.c_str(), &about) != 0) fail_to_read();
  if (!S_ISREG(about.st_mode) && (kind == FileKind::regular || S_ISDIR(about.st_mode)))
    fail("is no regular file");
  check(size_t(about.st_size));
  struct Open {
    int file;
    ~Open() { close(file); }
  } in{open(path.c_str(), O_RDONLY | O_CLOEXEC)};
  if (in.file < 0) fail_to_read();
  size_t size = 0;
  for (size_t room = std::max<size_t>(size_t(about.st_size) + 1, 4096);;) {
    const ssize_t count = read(in.file, static_cast<char*>(resize(room)) + size, room - size);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail_to_read();
    if (count == 0) break;
    check(size += size_t(count));
    if (size == room) room *= 2;
  }
  resize(size);
}

}  // namespace wellspring
