// SPDX-License-Identifier: Apache-2.0
#include "volume/format/nifti.h"

#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <string_view>

#include "base/load_error.h"
#include "base/log.h"
#include "volume/format/byte_stream.h"
#include "volume/format/patient_frame.h"

namespace wellspring::volume {
namespace {

constexpr int size_1 = 348, size_2 = 540;

// The fields of both versions that are used.
struct NiftiHeader {
  bool is_analyze = false, is_pair = false;
  int type = 0, orient = 0, sform_code = 0, qform_code = 0, unit = 0;
  int64_t dim[8] = {};
  double pixdim[8] = {}, offset = 0, slope = 0, intercept = 0;
  glm::dvec3 quaternion{0}, shift{0};
  glm::dmat4 sform{1};
};

struct HeaderBytes {
  std::string bytes;
  bool is_swapped = false;
  template <class Value>
  Value at(size_t place) const {
    return number_at<Value>(reinterpret_cast<const std::byte*>(bytes.data()) + place, is_swapped);
  }
};

// Both versions have the same fields: whole numbers and reals of other sizes at other places.
template <class Whole, class Real, class Code>
void take_fields(const HeaderBytes& from, NiftiHeader& header, size_t dim, size_t pixdim,
                 size_t offset, size_t slope, size_t code, size_t quaternion, size_t unit) {
  for (size_t i = 0; i < 8; i++) {
    header.dim[i] = from.at<Whole>(dim + i * sizeof(Whole));
    header.pixdim[i] = from.at<Real>(pixdim + i * sizeof(Real));
  }
  header.slope = from.at<Real>(slope), header.intercept = from.at<Real>(slope + sizeof(Real));
  header.offset = sizeof(Whole) == 8 ? double(from.at<int64_t>(offset)) : from.at<float>(offset);
  header.qform_code = from.at<Code>(code), header.sform_code = from.at<Code>(code + sizeof(Code));
  for (int i = 0; i < 3; i++) {
    header.quaternion[i] = from.at<Real>(quaternion + size_t(i) * sizeof(Real));
    header.shift[i] = from.at<Real>(quaternion + size_t(i + 3) * sizeof(Real));
    for (int column = 0; column < 4; column++)
      header.sform[column][i] =
          from.at<Real>(quaternion + size_t(6 + 4 * i + column) * sizeof(Real));
  }
  header.unit = unit < 400 ? from.at<uint8_t>(unit) : from.at<int32_t>(unit);
}

NiftiHeader parse_header(const std::string& file, HeaderBytes& from) {
  NiftiHeader header;
  const auto fail = [&](const std::string& what) { throw LoadError(file, "header", what); };
  if (from.bytes.size() < 4) fail("is cut off");
  int size = from.at<int32_t>(0);
  if (size != size_1 && size != size_2) from.is_swapped = true, size = from.at<int32_t>(0);
  if (size != size_1 && size != size_2) fail("is no header of NIfTI or Analyze");
  if (from.bytes.size() < size_t(size))
    fail(fmt::format("is cut off: {} of {} bytes are there", from.bytes.size(), size));
  if (size == size_2) {
    const std::string magic = from.bytes.substr(4, 8);
    header.is_pair = magic == std::string("ni2\0\r\n\x1a\n", 8);
    if (!header.is_pair && magic != std::string("n+2\0\r\n\x1a\n", 8))
      fail("has no magic of NIfTI-2, or its line ends were changed");
    header.type = from.at<int16_t>(12);
    take_fields<int64_t, double, int32_t>(from, header, 16, 104, 168, 176, 344, 352, 500);
  } else {
    const std::string magic = from.bytes.substr(344, 4);
    header.is_pair = magic == std::string("ni1\0", 4);
    header.is_analyze = !header.is_pair && magic != std::string("n+1\0", 4);
    header.type = from.at<int16_t>(70);
    header.orient = from.at<uint8_t>(252);
    take_fields<int16_t, float, int16_t>(from, header, 40, 76, 108, 112, 252, 256, 123);
  }
  if (header.dim[0] < 1 || header.dim[0] > 7)
    fail(
        fmt::format("says {} dimensions, 1 to 7 are possible: it has the wrong byte order, or is "
                    "damaged",
                    header.dim[0]));
  return header;
}

void set_numbers(StoredVolume& stored, const NiftiHeader& header) {
  const auto fail = [&](const char* what) {
    throw LoadError(stored.file, "datatype", fmt::format("is {}: {}", header.type, what));
  };
  switch (header.type) {
    case 2: stored.number = Number::u8; break;
    case 4: stored.number = Number::i16; break;
    case 8: stored.number = Number::i32; break;
    case 16: stored.number = Number::f32; break;
    case 64: stored.number = Number::f64; break;
    case 256: stored.number = Number::i8; break;
    case 512: stored.number = Number::u16; break;
    case 768: stored.number = Number::u32; break;
    case 1024: stored.number = Number::i64; break;
    case 1280: stored.number = Number::u64; break;
    case 128: stored.components = stored.channels = 3; break;
    case 2304: stored.components = 4, stored.channels = 3; break;
    case 1: fail("one bit a sample is not read; turn it into bytes first"); break;
    case 32:
    case 1792:
    case 2048: fail("complex samples are not read; take their magnitudes first"); break;
    case 1536: fail("floats of 128 bits are not read; turn them into 64 bits first"); break;
    default: fail("no such kind of samples is known");
  }
  if (header.is_analyze && stored.channels == 3)
    fail("Analyze does not say how its colours lie; turn it into NIfTI first");
}

// The standard's method 2: a turn as a quaternion, spacings, and whether z is mirrored.
glm::dmat4 qform_of(const NiftiHeader& header, const glm::dvec3& spacing) {
  glm::dvec3 v = header.quaternion;
  const double rest = 1 - glm::dot(v, v);
  if (rest < 0) v = glm::normalize(v);
  const double a = std::sqrt(std::max(rest, 0.0)), b = v.x, c = v.y, d = v.z;
  glm::dmat4 turn(1);
  turn[0] = {a * a + b * b - c * c - d * d, 2 * (b * c + a * d), 2 * (b * d - a * c), 0};
  turn[1] = {2 * (b * c - a * d), a * a + c * c - b * b - d * d, 2 * (c * d + a * b), 0};
  turn[2] = {2 * (b * d + a * c), 2 * (c * d - a * b), a * a + d * d - b * b - c * c, 0};
  for (int i = 0; i < 3; i++) turn[i] *= spacing[i];
  if (header.pixdim[0] < 0) turn[2] = -turn[2];
  turn[3] = glm::dvec4(header.shift, 1);
  return turn;
}

void set_nifti_place(StoredVolume& stored, const NiftiHeader& header) {
  const int unit = header.unit & 7;
  const double metres = unit == 1 ? 1 : unit == 3 ? 1e-6 : 1e-3;
  glm::dmat4 sform = header.sform;
  for (int i = 0; i < 3; i++) sform[i][3] = 0;
  sform[3][3] = 1;
  if (!header.is_analyze && header.sform_code > 0) {
    if (is_regular(sform)) {
      set_place(stored, sform, "RAS", metres, "sform");
      stored.is_placed = true;
      return;
    }
    if (header.qform_code <= 0) set_place(stored, sform, "RAS", metres, "sform");  // throws
    log::warn("{}: sform is singular, so qform counts", stored.file);
  }
  glm::dvec3 spacing(std::abs(header.pixdim[1]), std::abs(header.pixdim[2]),
                     std::abs(header.pixdim[3]));
  complete_spacing(stored, spacing, "pixdim");
  if (header.is_analyze) {
    constexpr const char* orients[] = {"LAS", "LSA", "ASL", "LPS", "LIA", "AIL"};
    if (header.orient > 5)
      throw LoadError(stored.file, "orient", fmt::format("is {}; 0 to 5 are known", header.orient));
    set_place(stored, affine_of(spacing, glm::dvec3(0)), orients[header.orient], metres, "pixdim");
    stored.is_placed = true;
  } else if (header.qform_code > 0) {
    set_place(stored, qform_of(header, spacing), "RAS", metres, "qform");
    stored.is_placed = true;
  } else {
    set_place(stored, affine_of(spacing, glm::dvec3(0)), unstated_axes, metres, "pixdim");
  }
}

// Returns the file of samples beside a header.
std::string image_of(const std::string& header) {
  for (const auto& [end, image] : {std::pair{".hdr", ".img"}, std::pair{".hdr.gz", ".img"}})
    if (header.ends_with(end)) {
      const std::string stem = header.substr(0, header.size() - std::string_view(end).size());
      std::error_code error;
      for (const std::string& path : {stem + image, stem + image + ".gz"})
        if (std::filesystem::is_regular_file(path, error)) return path;
      throw LoadError(header, "", fmt::format("has no samples: {}.img is not there", stem));
    }
  throw LoadError(header, "header",
                  "has its samples in another file, so its name must end with .hdr");
}

std::string header_of(const std::string& file) {
  for (const std::string_view end : {".img", ".img.gz"})
    if (file.ends_with(end)) {
      const std::string stem = file.substr(0, file.size() - end.size());
      std::error_code error;
      for (const std::string& path : {stem + ".hdr", stem + ".hdr.gz"})
        if (std::filesystem::is_regular_file(path, error)) return path;
      throw LoadError(file, "", fmt::format("has no header: {}.hdr is not there", stem));
    }
  return file;
}

}  // namespace

bool is_nifti(std::string_view first_bytes) {
  for (const std::string_view magic :
       {std::string_view("\x5c\x01\0\0", 4), std::string_view("\0\0\x01\x5c", 4),
        std::string_view("\x1c\x02\0\0", 4), std::string_view("\0\0\x02\x1c", 4)})
    if (first_bytes.starts_with(magic)) return true;
  return false;
}

StoredVolume read_nifti_header(const std::string& file) {
  StoredVolume stored;
  stored.file = header_of(file);
  HeaderBytes bytes{first_bytes(stored.file, size_2)};
  const NiftiHeader header = parse_header(stored.file, bytes);
  stored.format = header.is_analyze                ? "Analyze 7.5"
                  : bytes.at<int32_t>(0) == size_2 ? "NIfTI-2"
                                                   : "NIfTI-1";
  stored.is_swapped = bytes.is_swapped;
  set_numbers(stored, header);
  const auto length = [&](int i) { return i <= header.dim[0] ? header.dim[i] : 1; };
  set_size(stored, length(1), length(2), length(3), "dim");
  int64_t times = 1;
  for (int i = 4; i < 8; i++) {
    set_times(stored, length(i) == 0 ? 1 : length(i), fmt::format("dim[{}]", i));
    set_times(stored, times *= stored.times, "dim");
  }
  if (!header.is_analyze && stored.channels == 1 && std::isfinite(header.slope) &&
      header.slope != 0) {
    stored.slope = header.slope;
    stored.intercept = std::isfinite(header.intercept) ? header.intercept : 0;
  }
  set_nifti_place(stored, header);

  const bool is_single = !header.is_pair && !header.is_analyze;
  const std::string image = is_single ? stored.file : image_of(stored.file);
  double offset = header.offset;
  const double least = !is_single ? 0 : stored.format == "NIfTI-2" ? size_2 + 4 : size_1 + 4;
  // Some programs leave it 0 in a single file.
  if (is_single && offset == 0) offset = least;
  if (!(offset >= least && offset <= 0x1p40))
    throw LoadError(stored.file, "vox_offset",
                    fmt::format("is {}; samples begin at {} or later", header.offset, least));
  stored.packing = is_gzip(image) ? Packing::deflate : Packing::none;
  stored.parts = {{image, 0, uint64_t(offset)}};
  return stored;
}

}  // namespace wellspring::volume
