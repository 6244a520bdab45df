// SPDX-License-Identifier: Apache-2.0
#include "denoise/weights.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "base/load_error.h"
#include "base/read_file.h"

namespace wellspring::denoise {
namespace {

constexpr uint16_t magic = 0x41d7;
constexpr int major_version = 2;
constexpr size_t most_file_bytes = 64 << 20;
constexpr uint32_t most_tensors = 1024, most_size = 1 << 16;
constexpr int most_dimensions = 4;

// Converts a half float: sign, exponent 5 and mantissa 10 (IEEE 754-2008 binary16).
float float_of_half(uint16_t half) {
  float magnitude = std::bit_cast<float>(uint32_t(half & 0x7fff) << 13) * 0x1p112f;
  if ((half & 0x7c00) == 0x7c00) magnitude = (half & 0x3ff) ? NAN : INFINITY;
  return half & 0x8000 ? -magnitude : magnitude;
}

struct Reader {
  std::span<const std::byte> file;
  const std::string& path;
  size_t at = 0;

  [[noreturn]] void fail(size_t byte, const std::string& what) const {
    throw LoadError(path, "byte " + std::to_string(byte), what);
  }
  std::span<const std::byte> take(size_t bytes) {
    if (bytes > file.size() - at) fail(at, "the file ends within its table");
    at += bytes;
    return file.subspan(at - bytes, bytes);
  }
  // Reads a little-endian number.
  template <class T>
  T number() {
    T value = 0;
    auto bytes = take(sizeof(T));
    for (size_t i = 0; i < sizeof(T); i++) value |= T(T(bytes[i]) << (8 * i));
    return value;
  }
};

Tensor read_tensor(Reader& reader, std::string& name) {
  const size_t began = reader.at;
  auto letters = reader.take(reader.number<uint16_t>());
  name.assign(reinterpret_cast<const char*>(letters.data()), letters.size());
  int dimensions = reader.number<uint8_t>();
  if (dimensions < 1 || dimensions > most_dimensions)
    reader.fail(began, "a tensor of " + std::to_string(dimensions) + " dimensions");
  Tensor tensor;
  size_t count = 1;
  for (int i = 0; i < dimensions; i++) {
    uint32_t size = reader.number<uint32_t>();
    if (size < 1 || size > most_size)
      reader.fail(began, "a tensor's size of " + std::to_string(size));
    tensor.sizes.push_back(int(size));
    count *= size;
    if (count > most_file_bytes) reader.fail(began, "a tensor of more values than the file holds");
  }
  auto letters_of_layout = reader.take(size_t(dimensions));
  std::string layout(reinterpret_cast<const char*>(letters_of_layout.data()), size_t(dimensions));
  if (layout != "oihw" && layout != "x")
    reader.fail(began, "a tensor whose layout is neither oihw nor x");
  char type = char(reader.number<uint8_t>());
  if (type != 'h' && type != 'f') reader.fail(began, "a tensor that is neither of half nor float");
  uint64_t offset = reader.number<uint64_t>();
  size_t bytes = count * (type == 'h' ? 2 : 4);
  if (offset > reader.file.size() || bytes > reader.file.size() - offset)
    reader.fail(began, "a tensor's data lies beyond the file's end");
  const std::byte* from = reader.file.data() + offset;
  tensor.values.resize(count);
  for (size_t i = 0; i < count; i++) {
    uint16_t half;
    if (type == 'f') {
      std::memcpy(&tensor.values[i], from + 4 * i, 4);
    } else {
      std::memcpy(&half, from + 2 * i, 2);
      tensor.values[i] = float_of_half(half);
    }
    if (!std::isfinite(tensor.values[i]))
      reader.fail(size_t(offset) + i * (bytes / count), "a weight that is not finite");
  }
  return tensor;
}

}  // namespace

Weights read_weights(std::span<const std::byte> file, const std::string& path) {
  Reader reader{file, path};
  if (file.size() < 12 || reader.number<uint16_t>() != magic)
    reader.fail(0, "not a file of weights (.tza)");
  int major = reader.number<uint8_t>();
  reader.number<uint8_t>();
  if (major != major_version)
    reader.fail(2, "version " + std::to_string(major) + " of the format; 2 is known");
  uint64_t table = reader.number<uint64_t>();
  if (table > file.size()) reader.fail(4, "the table lies beyond the file's end");
  reader.at = size_t(table);
  uint32_t count = reader.number<uint32_t>();
  if (count > most_tensors) reader.fail(size_t(table), std::to_string(count) + " tensors");
  Weights weights;
  // Tensors may share their data: the sum is bounded all the same.
  size_t values = 0;
  for (uint32_t i = 0; i < count; i++) {
    size_t began = reader.at;
    std::string name;
    Tensor tensor = read_tensor(reader, name);
    values += tensor.values.size();
    if (values > most_file_bytes) reader.fail(began, "more values than any network has");
    if (!weights.emplace(name, std::move(tensor)).second)
      reader.fail(began, "a second tensor \"" + name + "\"");
  }
  return weights;
}

Weights load_weights(const std::string& path) {
  return read_weights(read_file<std::vector<std::byte>>(path, most_file_bytes), path);
}

}  // namespace wellspring::denoise
