// SPDX-License-Identifier: Apache-2.0
#include "volume/format/slc.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <fmt/format.h>

#include "base/load_error.h"
#include "volume/format/byte_stream.h"
#include "volume/format/header_text.h"
#include "volume/format/patient_frame.h"

namespace wellspring::volume {
namespace {

constexpr size_t most_slc_header = 1024;
constexpr uint64_t most_samples_of_a_byte = 64;  // a run of 127 has two bytes

// Unpacks one slice; returns how many samples it has, at most `count`, or -1 if it has more.
int64_t unpack_runs(const std::vector<std::byte>& packed, std::byte* to, int64_t count) {
  int64_t done = 0;
  for (size_t at = 0; at < packed.size();) {
    const unsigned code = unsigned(packed[at++]);
    const int64_t length = code & 127;
    if (length == 0) break;
    if (length > count - done) return -1;
    if (code & 128) {
      const int64_t there = std::min<int64_t>(length, int64_t(packed.size() - at));
      std::memcpy(to + done, &packed[0] + at, size_t(there));
      done += there, at += size_t(there);
    } else if (at < packed.size()) {
      std::memset(to + done, int(packed[at++]), size_t(length));
      done += length;
    }
  }
  return done;
}

}  // namespace

StoredVolume read_slc_header(const std::string& file) {
  StoredVolume stored;
  stored.file = file, stored.format = "SLC";
  const std::string text = first_bytes(file, most_slc_header);
  const auto fail = [&](const std::string& what) { throw LoadError(file, "header", what); };
  // Numbers up to the mark X behind the sizes of the small picture.
  const size_t mark = text.find('X');
  if (!text.starts_with("11111") || mark == std::string::npos) fail("is no header of SLC");
  const std::vector<double> numbers = numbers_of(text.substr(0, mark));
  if (numbers.size() != 14) fail("does not have the 14 numbers of SLC");
  if (numbers[4] != 8) fail(fmt::format("says {} bits a sample; 8 are read", numbers[4]));
  set_size(stored, to_whole(numbers[1]), to_whole(numbers[2]), to_whole(numbers[3]), "header");
  glm::dvec3 spacing(numbers[5], numbers[6], numbers[7]);
  complete_spacing(stored, spacing, "header");
  set_place(stored, affine_of(spacing, glm::dvec3(0)), unstated_axes, 1e-3, "header");
  const double compression = numbers[11], wide = numbers[12], high = numbers[13];
  if (compression != 0 && compression != 1)
    fail(fmt::format("says compression {}; 0 and 1 are read", compression));
  if (!(wide >= 0 && high >= 0 && wide <= 4096 && high <= 4096))
    fail("says a small picture of no sensible size");
  const uint64_t begin = mark + 1 + 3 * uint64_t(wide) * uint64_t(high);
  stored.parts = {{file, begin, 0}};
  if (compression == 1) stored.packing = Packing::slc;
  return stored;
}

void read_slc_samples(const StoredVolume& stored, std::byte* to) {
  ByteStream stream(stored.file, stored.parts[0].begin, Packing::none);
  const int64_t count = int64_t(stored.size.x) * stored.size.y;
  if (uint64_t(count) * uint64_t(stored.size.z) / most_samples_of_a_byte > stream.file_bytes())
    throw LoadError(stored.file, "",
                    fmt::format("has {} bytes, which cannot hold {} slices of {} samples",
                                stream.file_bytes(), stored.size.z, count));
  std::vector<std::byte> packed;
  for (int z = 0; z < stored.size.z; z++) {
    const auto fail = [&](const std::string& what) {
      throw LoadError(stored.file, fmt::format("slice {}", z), what);
    };
    std::string text;
    for (std::byte letter{}; text.size() < 32; text += char(letter)) {
      if (stream.read(&letter, 1) == 0) fail("is not there: the file is cut off");
      if (char(letter) == 'X') break;
    }
    const std::vector<double> length = numbers_of(text);
    if (length.size() != 1 || !(length[0] >= 0 && length[0] <= double(stream.file_bytes())))
      fail("does not begin with its length in bytes");
    packed.resize(size_t(length[0]));
    if (const uint64_t got = stream.read(packed.data(), packed.size()); got < packed.size())
      fail(fmt::format("is cut off: {} of its {} bytes are there", got, packed.size()));
    const int64_t got = unpack_runs(packed, to + int64_t(z) * count, count);
    // Memory is 0 where nothing was written.
    if (got < count - 1)
      fail(got < 0 ? fmt::format("has more than {} samples", count)
                   : fmt::format("has {} of {} samples", got, count));
  }
}

}  // namespace wellspring::volume
