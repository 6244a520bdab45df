// SPDX-License-Identifier: Apache-2.0
#include "volume/format/byte_stream.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <vector>
#include <zlib.h>

#include "base/load_error.h"

namespace wellspring::volume {

namespace {
constexpr size_t packed_piece = size_t(1) << 18;  // bytes that are read from a file at once
}  // namespace

struct ByteStream::Inflater {
  z_stream state{};
  std::vector<std::byte> packed = std::vector<std::byte>(packed_piece);
  uint64_t given = 0;
  bool has_ended = false;

  ~Inflater() { inflateEnd(&state); }
};

ByteStream::ByteStream(const std::string& file, uint64_t begin, Packing packing)
    : file_(file), position_(begin) {
  struct stat about {};
  descriptor_ = open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  const auto fail = [&](const std::string& what) {
    if (descriptor_ >= 0) close(descriptor_);
    throw LoadError(file_, "", what);
  };
  if (descriptor_ < 0 || fstat(descriptor_, &about) != 0)
    fail(std::string("cannot be read: ") + std::strerror(errno));
  if (!S_ISREG(about.st_mode)) fail("is no regular file");
  file_bytes_ = uint64_t(about.st_size);
  if (packing == Packing::none) return;
  inflater_ = std::make_unique<Inflater>();
  // 32: finds out by itself whether it is gzip or zlib.
  if (inflateInit2(&inflater_->state, 15 + 32) != Z_OK) {
    inflater_.reset();
    fail("cannot be unpacked: there is no memory");
  }
}

ByteStream::~ByteStream() { close(descriptor_); }

size_t ByteStream::read_file(std::byte* to, size_t count) {
  size_t done = 0;
  while (done < count) {
    const ssize_t got =
        pread(descriptor_, to + done, std::min(count - done, size_t(1) << 30), off_t(position_));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw LoadError(file_, "", std::string("cannot be read: ") + std::strerror(errno));
    if (got == 0) break;
    done += size_t(got), position_ += uint64_t(got);
  }
  return done;
}

uint64_t ByteStream::read_packed(std::byte* to, uint64_t count) {
  z_stream& state = inflater_->state;
  uint64_t done = 0;
  while (done < count && !inflater_->has_ended) {
    if (state.avail_in == 0) {
      state.next_in = reinterpret_cast<Bytef*>(inflater_->packed.data());
      state.avail_in = uInt(read_file(inflater_->packed.data(), packed_piece));
      if (state.avail_in == 0) {
        is_cut_off_ = inflater_->has_ended = true;
        break;
      }
    }
    const uInt room = uInt(std::min<uint64_t>(count - done, uint64_t(1) << 30));
    state.next_out = reinterpret_cast<Bytef*>(to + done);
    state.avail_out = room;
    const int result = inflate(&state, Z_NO_FLUSH);
    done += room - state.avail_out;
    if (result == Z_STREAM_END) {
      // Another member follows, or what other programs leave behind the last.
      if (state.avail_in < 2) {
        std::byte* packed = inflater_->packed.data();
        if (state.avail_in == 1) packed[0] = std::byte{*state.next_in};
        state.next_in = reinterpret_cast<Bytef*>(packed);
        state.avail_in += uInt(read_file(packed + state.avail_in, packed_piece - state.avail_in));
      }
      if (state.avail_in < 2 || state.next_in[0] != 0x1f || state.next_in[1] != 0x8b)
        inflater_->has_ended = true;
      else if (inflateReset(&state) != Z_OK) inflater_->has_ended = is_cut_off_ = true;
    } else if (result != Z_OK && result != Z_BUF_ERROR) {
      throw LoadError(
          file_, fmt::format("byte {}", position_ - state.avail_in),
          fmt::format("packed data are damaged ({}), {} bytes were unpacked",
                      state.msg ? state.msg : "zlib gives no reason", inflater_->given + done));
    }
  }
  inflater_->given += done;
  return done;
}

uint64_t ByteStream::read(std::byte* to, uint64_t count) {
  return inflater_ ? read_packed(to, count) : read_file(to, count);
}

uint64_t ByteStream::skip(uint64_t count) {
  if (!inflater_) {
    const uint64_t left = file_bytes_ > position_ ? file_bytes_ - position_ : 0;
    position_ += count;
    return std::min(count, left);
  }
  std::vector<std::byte> dropped(size_t(std::min<uint64_t>(count, packed_piece)));
  uint64_t done = 0;
  while (done < count) {
    const uint64_t got = read(dropped.data(), std::min<uint64_t>(count - done, dropped.size()));
    if (got == 0) break;
    done += got;
  }
  return done;
}

bool is_gzip(const std::string& file) {
  ByteStream stream(file, 0, Packing::none);
  std::byte magic[2]{};
  return stream.read(magic, 2) == 2 && magic[0] == std::byte{0x1f} && magic[1] == std::byte{0x8b};
}

std::string first_bytes(const std::string& file, size_t most) {
  ByteStream stream(file, 0, is_gzip(file) ? Packing::deflate : Packing::none);
  std::string bytes(most, '\0');
  bytes.resize(size_t(stream.read(reinterpret_cast<std::byte*>(bytes.data()), most)));
  return bytes;
}

}  // namespace wellspring::volume
