// SPDX-License-Identifier: Apache-2.0
#include "scan/splats/splat_bytes.h"

#include <algorithm>
#include <fmt/format.h>
#include <glm/gtc/packing.hpp>

#include "base/load_error.h"
#include "scan/format/input_file.h"
#include "scan/splats/splat_finish.h"

namespace wellspring::scan {
namespace {

vec3 floats_at(const char* from) {
  return {number_at<float>(from), number_at<float>(from + 4), number_at<float>(from + 8)};
}
float half_at(const char* from) { return glm::unpackHalf1x16(number_at<uint16_t>(from)); }
vec3 halves_at(const char* from) { return {half_at(from), half_at(from + 2), half_at(from + 4)}; }
vec3 codes_at(const char* from) {
  return vec3(uint8_t(from[0]), uint8_t(from[1]), uint8_t(from[2])) / 255.0f;
}

constexpr size_t ksplat_header = 4096, section_header = 1024;

struct KsplatSection {
  uint32_t splats = 0, room = 0;  // there is room for more splats than there are
  uint32_t bucket_size = 0, buckets = 0, full_buckets = 0, partial_buckets = 0;
  float block = 0;  // edge of a bucket's cube
  uint32_t range = 0;
  size_t bucket_bytes = 0;
  int degree = 0;
};

KsplatSection read_section(const char* from) {
  KsplatSection section;
  section.splats = number_at<uint32_t>(from), section.room = number_at<uint32_t>(from + 4);
  section.bucket_size = number_at<uint32_t>(from + 8);
  section.buckets = number_at<uint32_t>(from + 12);
  section.block = number_at<float>(from + 16);
  section.bucket_bytes = number_at<uint16_t>(from + 20);
  section.range = number_at<uint32_t>(from + 24);
  if (section.range == 0) section.range = 32767;
  section.full_buckets = number_at<uint32_t>(from + 32);
  section.partial_buckets = number_at<uint32_t>(from + 36);
  section.degree = number_at<uint16_t>(from + 40);
  return section;
}

// Reads the splats of one file's sections, one after the other.
class KsplatReader {
 public:
  KsplatReader(const std::string& file, std::string_view bytes) : file_(file), bytes_(bytes) {
    if (bytes.size() < ksplat_header) fail("", "is cut off: its head has 4096 bytes");
    if (bytes[0] != 0 || bytes[1] < 1)
      fail("byte 0", fmt::format("has version {}.{}, which is not read", uint8_t(bytes[0]),
                                 uint8_t(bytes[1])));
    level_ = number_at<uint16_t>(bytes.data() + 20);
    if (level_ > 2) fail("byte 20", fmt::format("has compression level {}", level_));
    least_ = number_at<float>(bytes.data() + 36), most_ = number_at<float>(bytes.data() + 40);
    if (least_ == 0) least_ = -1.5f;
    if (most_ == 0) most_ = 1.5f;
  }

  SplatSet read() {
    const uint32_t count = number_at<uint32_t>(bytes_.data() + 4);
    const uint32_t promised = number_at<uint32_t>(bytes_.data() + 16);
    if (count > (bytes_.size() - ksplat_header) / section_header)
      fail("byte 4", fmt::format("promises {} sections", count));
    std::vector<KsplatSection> sections;
    for (size_t i = 0; i < count; i++) {
      sections.push_back(read_section(bytes_.data() + ksplat_header + i * section_header));
      if (sections.back().degree > 3)
        fail(fmt::format("section {}", i), "has harmonics of more than degree 3");
      if (sections.back().splats > 0) set_.degree = std::max(set_.degree, sections.back().degree);
    }
    set_.format = fmt::format("KSPLAT, compression level {}", level_);
    uint64_t at = ksplat_header + uint64_t(count) * section_header;
    for (size_t i = 0; i < count; i++) at = read_one(sections[i], i, at);
    if (set_.size() != promised)
      fail("byte 16",
           fmt::format("promises {} splats, its sections have {}", promised, set_.size()));
    return std::move(set_);
  }

 private:
  [[noreturn]] void fail(const std::string& where, const std::string& what) const {
    throw LoadError(file_, where, what);
  }

  // Returns the place behind the section.
  uint64_t read_one(const KsplatSection& section, size_t index, uint64_t at) {
    const std::string where = fmt::format("section {}", index);
    const size_t harmonics = 3 * size_t(splat_harmonics[section.degree]);
    const size_t wide = level_ == 0 ? 4 : 2;
    const size_t record = 10 * wide + 4 + harmonics * (level_ == 0 ? 4 : level_ == 1 ? 2 : 1);
    const uint64_t lengths = uint64_t(section.partial_buckets) * 4;
    const uint64_t heads = lengths + uint64_t(section.bucket_bytes) * section.buckets;
    const uint64_t rest = bytes_.size() - at;
    if (heads > rest || section.room > (rest - heads) / record || section.splats > section.room)
      fail(where, fmt::format("promises {} splats, which the file has no bytes for", section.room));
    if (level_ > 0 && section.splats > 0 && section.bucket_bytes < 12)
      fail(where, "has no places of its buckets");
    const char* partial = bytes_.data() + at;
    const char* centers = partial + lengths;
    const char* splat = partial + heads;
    const size_t first = set_.size();
    resize_splats(set_, first + section.splats);
    const uint64_t in_full = uint64_t(section.full_buckets) * section.bucket_size;
    uint64_t bucket = section.full_buckets, bucket_end = in_full;
    for (uint64_t i = 0; i < section.splats; i++, splat += record) {
      if (level_ == 0) {
        set_.place[first + i] = floats_at(splat);
      } else {
        uint64_t mine = section.bucket_size > 0 ? i / section.bucket_size : 0;
        if (i >= in_full) {
          // A partial bucket's length stands before the centres; the first one is not passed yet.
          while (i >= bucket_end) {
            const uint64_t which = partials_passed_++;
            if (which >= section.partial_buckets)
              fail(where, fmt::format("splat {} is in no bucket", i));
            bucket = section.full_buckets + which;
            bucket_end += number_at<uint32_t>(partial + 4 * which);
          }
          mine = bucket;
        }
        if (mine >= section.buckets) fail(where, fmt::format("splat {} is in no bucket", i));
        const vec3 code(number_at<uint16_t>(splat), number_at<uint16_t>(splat + 2),
                        number_at<uint16_t>(splat + 4));
        set_.place[first + i] =
            (code - float(section.range)) * (section.block / 2 / float(section.range)) +
            floats_at(centers + mine * section.bucket_bytes);
      }
      read_rest(splat, first + i, section.degree, wide);
    }
    partials_passed_ = 0;
    return at + heads + uint64_t(section.room) * record;
  }

  void read_rest(const char* splat, size_t i, int degree, size_t wide) {
    const auto number = [&](size_t index) {
      return wide == 4 ? number_at<float>(splat + 4 * index) : half_at(splat + 2 * index);
    };
    set_.scale[i] = wide == 4 ? floats_at(splat + 12) : halves_at(splat + 6);
    set_.turn[i] = quat(number(6), number(7), number(8), number(9));
    const char* color = splat + 10 * wide;
    set_.color[i] = codes_at(color);
    set_.opacity[i] = float(uint8_t(color[3])) / 255;
    const char* harmonic = color + 4;
    vec3* to = set_.harmonics.data() + i * size_t(splat_harmonics[set_.degree]);
    // Each degree has all of red, then green, then blue.
    for (int l = 1; l <= degree; l++) {
      for (int channel = 0; channel < 3; channel++)
        for (int h = 0; h < 2 * l + 1; h++) {
          if (level_ == 0) to[h][channel] = number_at<float>(harmonic), harmonic += 4;
          else if (level_ == 1) to[h][channel] = half_at(harmonic), harmonic += 2;
          else to[h][channel] = least_ + float(uint8_t(*harmonic++)) / 255 * (most_ - least_);
        }
      to += 2 * l + 1;
    }
  }

  std::string file_;
  std::string_view bytes_;
  SplatSet set_;
  int level_ = 0;
  float least_ = 0, most_ = 0;  // a byte of 0 and of 255 means these, in harmonics
  uint64_t partials_passed_ = 0;
};

}  // namespace

SplatSet read_splat(const std::string& file, std::string_view bytes) {
  constexpr size_t record = 32;
  if (bytes.size() % record != 0)
    throw LoadError(file, fmt::format("byte {}", bytes.size() / record * record),
                    "is cut off: a splat has 32 bytes");
  SplatSet set;
  set.format = "SPLAT";
  resize_splats(set, bytes.size() / record);
  for (size_t i = 0; i < set.size(); i++) {
    const char* splat = bytes.data() + i * record;
    set.place[i] = floats_at(splat);
    set.scale[i] = floats_at(splat + 12);
    set.color[i] = codes_at(splat + 24);
    set.opacity[i] = float(uint8_t(splat[27])) / 255;
    const auto part = [splat](size_t k) { return (float(uint8_t(splat[28 + k])) - 128) / 128; };
    set.turn[i] = quat(part(0), part(1), part(2), part(3));
  }
  return set;
}

SplatSet read_ksplat(const std::string& file, std::string_view bytes) {
  return KsplatReader(file, bytes).read();
}

}  // namespace wellspring::scan
