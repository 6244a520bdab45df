// SPDX-License-Identifier: Apache-2.0
#include "scan/format/input_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/load_error.h"

namespace wellspring::scan {
namespace {
constexpr size_t usual_window = size_t(1) << 18;
}

InputFile::InputFile(const std::string& path) : path_(path) {
  // A pipe would let open() wait.
  descriptor_ = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  struct stat about {};
  if (descriptor_ < 0 || fstat(descriptor_, &about) != 0) {
    const std::string reason = std::strerror(errno);
    if (descriptor_ >= 0) close(descriptor_);
    fail("", "cannot be read: " + reason);
  }
  if (!S_ISREG(about.st_mode)) {
    close(descriptor_);
    fail("", "is no regular file");
  }
  size_ = uint64_t(about.st_size);
}

InputFile::~InputFile() { close(descriptor_); }

void InputFile::fail(const std::string& where, const std::string& what) const {
  throw LoadError(path_, where, what);
}

size_t InputFile::read_at(char* to, size_t count, uint64_t place) const {
  size_t done = 0;
  while (done < count) {
    const ssize_t got = pread(descriptor_, to + done, count - done, off_t(place + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail("", std::string("cannot be read: ") + std::strerror(errno));
    if (got == 0) break;
    done += size_t(got);
  }
  return done;
}

void InputFile::go_to(uint64_t place) {
  place = std::min(place, size_);
  if (place >= buffer_place_ && place <= buffer_place_ + end_) {
    next_ = size_t(place - buffer_place_);
    return;
  }
  buffer_place_ = place;
  next_ = end_ = 0;
}

std::string_view InputFile::peek(size_t least) {
  if (end_ - next_ < least && buffer_place_ + end_ < size_) {
    std::copy(buffer_.begin() + std::ptrdiff_t(next_), buffer_.begin() + std::ptrdiff_t(end_),
              buffer_.begin());
    buffer_place_ += next_;
    end_ -= next_;
    next_ = 0;
    // No more is allocated than the file has.
    const uint64_t wanted = std::min<uint64_t>(std::max(least, usual_window), rest());
    if (buffer_.size() < wanted) buffer_.resize(size_t(wanted));
    end_ += read_at(buffer_.data() + end_, size_t(wanted) - end_, buffer_place_ + end_);
  }
  return {buffer_.data() + next_, end_ - next_};
}

std::string_view InputFile::take(size_t count) {
  const std::string_view bytes = peek(count);
  if (bytes.size() < count)
    fail("byte " + std::to_string(place()), "is cut off: " + std::to_string(count) +
                                                " bytes should follow, there are " +
                                                std::to_string(bytes.size()));
  pass(count);
  return bytes.substr(0, count);
}

void InputFile::take_to(void* to, size_t count) {
  const std::string_view bytes = take(count);
  std::memcpy(to, bytes.data(), count);
}

bool InputLines::next(std::string_view& line) {
  std::string_view window = file_->peek(1);
  if (window.empty()) return false;
  size_t end = window.find('\n');
  if (end == std::string_view::npos) {
    window = file_->peek(longest_line + 1);
    end = window.find('\n');
  }
  number_++;
  const bool is_last = end == std::string_view::npos;
  if (std::min(end, window.size()) > longest_line) file_->fail(where(), "is no line of text");
  line = window.substr(0, end);
  file_->pass(line.size() + (is_last ? 0 : 1));
  if (line.ends_with('\r')) line.remove_suffix(1);
  return true;
}

}  // namespace wellspring::scan
