// SPDX-License-Identifier: Apache-2.0
#include "volume/nrrd_write.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <span>
#include <stdexcept>

#include <fmt/core.h>

#include "base/write_file.h"

namespace wellspring::volume {

namespace {

struct NrrdKind {
  const char* name;
  double least, largest;  // whole numbers alone
};

template <class Sample>
NrrdKind nrrd_kind(const char* name) {
  return {name, double(std::numeric_limits<Sample>::lowest()),
          double(std::numeric_limits<Sample>::max())};
}

NrrdKind nrrd_kind(SampleKind kind) {
  switch (kind) {
    case SampleKind::u8: return nrrd_kind<uint8_t>("uint8");
    case SampleKind::i8: return nrrd_kind<int8_t>("int8");
    case SampleKind::u16: return nrrd_kind<uint16_t>("uint16");
    case SampleKind::i16: return nrrd_kind<int16_t>("int16");
    case SampleKind::u32: return nrrd_kind<uint32_t>("uint32");
    case SampleKind::i32: return nrrd_kind<int32_t>("int32");
    case SampleKind::f32: return {"float", 0, 0};
    case SampleKind::f64: break;
  }
  return {"double", 0, 0};
}

// Returns a direction or place in the frame of NRRD: millimetres, left, posterior, superior.
std::string nrrd_vector(glm::dvec4 metres) {
  return fmt::format("({:.17g},{:.17g},{:.17g})", 1000 * metres.x, 0.0 - 1000 * metres.z,
                     1000 * metres.y);
}

std::string nrrd_header(const Volume& volume) {
  const NrrdKind kind = nrrd_kind(volume.kind);
  const bool colours = volume.channels > 1;
  std::string text = "NRRD0005\n";
  text += fmt::format("type: {}\ndimension: {}\n", kind.name, colours ? 4 : 3);
  text += "space: left-posterior-superior\nsizes:";
  if (colours) text += fmt::format(" {}", volume.channels);
  text += fmt::format(" {} {} {}\nspace directions:", volume.size.x, volume.size.y, volume.size.z);
  if (colours) text += " none";
  for (int axis = 0; axis < 3; ++axis)
    text += fmt::format(" {}", nrrd_vector(volume.to_metres[axis]));
  text += fmt::format("\nspace origin: {}\nspace units: \"mm\" \"mm\" \"mm\"\nkinds:",
                      nrrd_vector(volume.to_metres[3]));
  if (colours) text += volume.channels == 3 ? " RGB-color" : " vector";
  text += " space space space\n";
  if (std::endian::native == std::endian::little) text += "endian: little\n";
  else text += "endian: big\n";
  if (kind.largest > 0 && (volume.slope != 1 || volume.intercept != 0))
    text += fmt::format("old min: {:.17g}\nold max: {:.17g}\n",
                        kind.least * volume.slope + volume.intercept,
                        kind.largest * volume.slope + volume.intercept);
  return text + "encoding: gzip\n\n";
}

// Appends the bytes as a gzip file.
void append_gzip(std::span<const std::byte> bytes, std::vector<char>& file) {
  constexpr int gzip_window = 15 + 16, memory_level = 8;
  constexpr size_t most_at_once = 1 << 24;
  z_stream stream{};
  if (deflateInit2(&stream, 4, Z_DEFLATED, gzip_window, memory_level, Z_DEFAULT_STRATEGY) != Z_OK)
    throw std::bad_alloc();
  std::vector<char> packed(1 << 20);
  int state = Z_OK;
  while (state != Z_STREAM_END) {
    const size_t count = std::min(bytes.size(), most_at_once);
    // zlib reads through a pointer that is not const.
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(bytes.data()));
    stream.avail_in = uInt(count);
    bytes = bytes.subspan(count);
    const int flush = bytes.empty() ? Z_FINISH : Z_NO_FLUSH;
    do {
      stream.next_out = reinterpret_cast<Bytef*>(packed.data());
      stream.avail_out = uInt(packed.size());
      state = deflate(&stream, flush);
      file.insert(file.end(), packed.begin(),
                  packed.begin() + ptrdiff_t(packed.size() - stream.avail_out));
    } while (stream.avail_out == 0 && state != Z_STREAM_END);
  }
  deflateEnd(&stream);
}

// Returns floats as what they measure.
template <class Sample>
std::vector<Sample> measured(const Volume& volume) {
  std::vector<Sample> values(volume.samples() * size_t(volume.channels));
  std::memcpy(values.data(), volume.bytes.get(), volume.byte_count());
  for (Sample& value : values) value = Sample(double(value) * volume.slope + volume.intercept);
  return values;
}

}  // namespace

std::vector<char> encode_nrrd(const Volume& volume) {
  const std::string header = nrrd_header(volume);
  std::vector<char> file(header.begin(), header.end());
  const bool plain = volume.slope == 1 && volume.intercept == 0;
  if (volume.kind == SampleKind::f32 && !plain)
    append_gzip(std::as_bytes(std::span<const float>(measured<float>(volume))), file);
  else if (volume.kind == SampleKind::f64 && !plain)
    append_gzip(std::as_bytes(std::span<const double>(measured<double>(volume))), file);
  else append_gzip({volume.bytes.get(), volume.byte_count()}, file);
  return file;
}

void save_nrrd(const std::string& file, const Volume& volume) {
  write_file(file, std::span<const char>(encode_nrrd(volume)));
}

}  // namespace wellspring::volume
