// SPDX-License-Identifier: Apache-2.0
// Writes values one after the other as little-endian bytes, and reads such bytes of strangers.
#pragma once
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

namespace wellspring {

static_assert(std::endian::native == std::endian::little);

class ByteWriter {
 public:
  template <class T>
  void put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void put_text(std::string_view text) {
    put(uint32_t(text.size()));
    bytes_ += text;
  }
  template <class T>
  void put_all(const T& values) {
    put(uint32_t(values.size()));
    for (const auto& value : values) put(value);
  }
  std::string bytes() && { return std::move(bytes_); }

 private:
  std::string bytes_;
};

// Reads what a ByteWriter wrote. After the first thing that is wrong all reads give zeros.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : rest_(bytes) {}
  template <class T>
  void take(T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    need(rest_.size() >= sizeof value);
    if (!good_) {
      value = T{};
      return;
    }
    std::memcpy(&value, rest_.data(), sizeof value);
    rest_.remove_prefix(sizeof value);
  }
  void take_text(std::string& text, size_t most) {
    const size_t size = take_count(most, 1);
    text = rest_.substr(0, size);
    rest_.remove_prefix(size);
  }
  // Returns the number of things that follow, each of at least `least` bytes; 0: they cannot.
  size_t take_count(size_t most, size_t least) {
    uint32_t count = 0;
    take(count);
    need(count <= most && count * least <= rest_.size());
    return good_ ? count : 0;
  }
  template <class T>
  void take_all(T& values, size_t most) {
    values.resize(take_count(most, sizeof values[0]));
    for (auto& value : values) take(value);
  }
  void need(bool condition) { good_ = good_ && condition; }
  bool good() const { return good_; }
  bool ended() const { return good_ && rest_.empty(); }

 private:
  std::string_view rest_;
  bool good_ = true;
};

}  // namespace wellspring
