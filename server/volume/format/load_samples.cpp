// SPDX-License-Identifier: Apache-2.0
#include "volume/format/load_samples.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/load_error.h"
#include "base/parallel.h"
#include "volume/format/byte_stream.h"
#include "volume/format/slc.h"

namespace wellspring::volume {
namespace {

constexpr uint64_t most_unpacked_by = 1032;  // deflate makes at most so many bytes of one
constexpr uint64_t ignored_bytes = 1 << 16;  // so many more than the header says may be unpacked
constexpr uint64_t swapped_at_once = 1 << 16;

// Takes addresses, and no memory before it is written to: what a header says costs nothing.
std::shared_ptr<std::byte> take_memory(const StoredVolume& stored, uint64_t count) {
  void* place = mmap(nullptr, count, PROT_READ | PROT_WRITE,
                     MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (place == MAP_FAILED)
    throw LoadError(stored.file, "",
                    fmt::format("needs {} bytes of memory, which are not there", count));
  return {static_cast<std::byte*>(place), [count](std::byte* bytes) { munmap(bytes, count); }};
}

[[noreturn]] void fail_short(const StoredPart& part, uint64_t held, uint64_t wanted) {
  throw LoadError(
      part.file, "",
      fmt::format("is cut off: it holds {} bytes of samples, the header says {}", held, wanted));
}

// Returns how many bytes of samples lie in a file that is not packed.
uint64_t held_bytes(const StoredPart& part) {
  struct stat about {};
  if (stat(part.file.c_str(), &about) != 0)
    throw LoadError(part.file, "", std::string("cannot be read: ") + std::strerror(errno));
  const uint64_t size = uint64_t(about.st_size), begin = part.begin + part.skip;
  return size > begin ? size - begin : 0;
}

std::shared_ptr<const std::byte> map_samples(const StoredPart& part, uint64_t from,
                                             uint64_t count) {
  const int descriptor = open(part.file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0)
    throw LoadError(part.file, "", std::string("cannot be read: ") + std::strerror(errno));
  const uint64_t begin = part.begin + part.skip + from;
  const uint64_t page = uint64_t(sysconf(_SC_PAGESIZE)), before = begin % page;
  void* place =
      mmap(nullptr, before + count, PROT_READ, MAP_SHARED, descriptor, off_t(begin - before));
  const int error = errno;
  close(descriptor);
  if (place == MAP_FAILED)
    throw LoadError(part.file, "", std::string("cannot be mapped: ") + std::strerror(error));
  const auto* bytes = static_cast<const std::byte*>(place);
  return {bytes + before, [place, before, count](auto*) { munmap(place, before + count); }};
}

// Reads bytes [from, from + count) of a part's share, which has `share` bytes.
void read_part(const StoredVolume& stored, const StoredPart& part, uint64_t from, uint64_t count,
               uint64_t share, std::byte* to) {
  if (stored.packing == Packing::none) {
    if (const uint64_t held = held_bytes(part); held < from + count) fail_short(part, held, share);
    ByteStream stream(part.file, part.begin + part.skip + from, Packing::none);
    if (const uint64_t got = stream.read(to, count); got < count)
      fail_short(part, from + got, share);
    return;
  }
  ByteStream stream(part.file, part.begin, Packing::deflate);
  const uint64_t before = part.skip + from,
                 packed = stream.file_bytes() - std::min(stream.file_bytes(), part.begin);
  if ((before + count) / most_unpacked_by > packed)
    throw LoadError(part.file, "",
                    fmt::format("holds {} packed bytes, which cannot become the {} that the header "
                                "says",
                                packed, before + count));
  uint64_t got = stream.skip(before);
  if (got == before) got += stream.read(to, count);
  if (got < before + count) fail_short(part, got - std::min(got, part.skip), share);
  if (from + count < share) return;
  // Reading on to the end checks the sum, too.
  if (stream.skip(ignored_bytes + 1) > ignored_bytes)
    throw LoadError(part.file, "",
                    fmt::format("unpacks to more than the {} bytes that the header says", share));
  if (stream.is_cut_off())
    throw LoadError(part.file, "", "is cut off behind its samples: the packed data have no end");
}

void swap_bytes(std::byte* bytes, uint64_t count, int each) {
  const uint64_t step = swapped_at_once * uint64_t(each);
  parallel_each(int((count + step - 1) / step), [&](int piece) {
    std::byte* at = bytes + uint64_t(piece) * step;
    std::byte* end = bytes + std::min(count, uint64_t(piece + 1) * step);
    for (; at < end; at += each) std::reverse(at, at + each);
  });
}

template <class Value>
double to_double(const std::byte* from) {
  Value value;
  std::memcpy(&value, from, sizeof value);
  return double(value);
}

// Takes the wanted numbers of each sample, as the kind that a Volume has.
void choose_numbers(const StoredVolume& stored, const std::byte* from, std::byte* to) {
  const size_t each = size_t(bytes_of(stored.number));
  const size_t row = size_t(stored.size.x) * size_t(stored.size.y);
  parallel_each(stored.size.z, [&](int z) {
    for (size_t i = size_t(z) * row; i < (size_t(z) + 1) * row; i++)
      for (size_t channel = 0; channel < size_t(stored.channels); channel++) {
        const std::byte* number =
            from + (i * size_t(stored.components) + size_t(stored.first) + channel) * each;
        std::byte* place = to + (i * size_t(stored.channels) + channel) * each;
        if (stored.number < Number::u64) {
          std::memcpy(place, number, each);
        } else {
          const double value = stored.number == Number::u64 ? to_double<uint64_t>(number)
                                                            : to_double<int64_t>(number);
          std::memcpy(place, &value, sizeof value);
        }
      }
  });
}

}  // namespace

Volume load_samples(const StoredVolume& stored, int64_t time, const VolumeLimits& limits) {
  if (time < 0 || time >= stored.times)
    throw LoadError(stored.file, "",
                    fmt::format("has {} times, so there is no time {}", stored.times, time));
  Volume volume;
  volume.size = stored.size;
  volume.channels = stored.channels;
  volume.kind = stored.number < Number::u64 ? SampleKind(stored.number) : SampleKind::f64;
  volume.slope = stored.slope, volume.intercept = stored.intercept;
  volume.to_metres = stored.to_metres;

  const int each = bytes_of(stored.number);
  const bool swaps = stored.is_swapped && each > 1;
  const uint64_t wanted = stored.stored_bytes(), begin = uint64_t(time) * wanted;
  const uint64_t all = uint64_t(stored.times) * wanted, files = stored.parts.size();
  if (files == 0 || all / uint64_t(each * stored.components) % files != 0)
    throw LoadError(stored.file, "",
                    fmt::format("has {} files for {} bytes of samples, which gives no whole share",
                                files, all));
  if (stored.packing == Packing::none && stored.is_direct() && !swaps && files == 1 &&
      wanted >= limits.mapped_from) {
    if (const uint64_t held = held_bytes(stored.parts[0]); held < begin + wanted)
      fail_short(stored.parts[0], held, all);
    volume.bytes = map_samples(stored.parts[0], begin, wanted);
    return volume;
  }
  const uint64_t needed = wanted + (stored.is_direct() ? 0 : volume.byte_count());
  if (needed > limits.memory)
    throw LoadError(stored.file, "",
                    fmt::format("needs {} MiB of memory, {} are allowed; samples that are not "
                                "packed, in this machine's byte order, and in one file need none",
                                needed >> 20, limits.memory >> 20));
  const std::shared_ptr<std::byte> bytes = take_memory(stored, wanted);
  if (stored.packing == Packing::slc) {
    read_slc_samples(stored, bytes.get());
  } else {
    const uint64_t share = all / files;
    for (uint64_t at = begin; at < begin + wanted;) {
      const uint64_t from = at % share, count = std::min(share - from, begin + wanted - at);
      read_part(stored, stored.parts[size_t(at / share)], from, count, share,
                bytes.get() + (at - begin));
      at += count;
    }
  }
  if (swaps) swap_bytes(bytes.get(), wanted, each);
  volume.bytes = bytes;
  if (stored.is_direct()) return volume;
  const std::shared_ptr<std::byte> chosen = take_memory(stored, volume.byte_count());
  choose_numbers(stored, bytes.get(), chosen.get());
  volume.bytes = chosen;
  return volume;
}

}  // namespace wellspring::volume
