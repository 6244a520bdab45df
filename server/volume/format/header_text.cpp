// SPDX-License-Identifier: Apache-2.0
#include "volume/format/header_text.h"

#include <charconv>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <limits>

#include "base/load_error.h"
#include "volume/format/byte_stream.h"

namespace wellspring::volume {
namespace {

constexpr double most_files = 1 << 16;
constexpr int64_t most_skipped_lines = 1 << 20;
constexpr const char* blanks = " \t\r\n\v\f";

// Returns the place behind so many lines of a file.
uint64_t skip_lines(const std::string& file, uint64_t begin, int64_t lines) {
  ByteStream stream(file, begin, Packing::none);
  std::vector<std::byte> bytes(1 << 12);
  for (uint64_t at = begin; lines > 0;) {
    const uint64_t got = stream.read(bytes.data(), bytes.size());
    if (got == 0) throw LoadError(file, "", "has fewer lines than are to be skipped");
    for (uint64_t i = 0; i < got; i++)
      if (char(bytes[i]) == '\n' && --lines == 0) return at + i + 1;
    at += got;
  }
  return begin;
}

}  // namespace

std::string_view without_blanks(std::string_view text) {
  const size_t begin = text.find_first_not_of(blanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

std::string in_small_letters(std::string_view text) {
  std::string small(text);
  for (char& letter : small)
    if (letter >= 'A' && letter <= 'Z') letter = char(letter - 'A' + 'a');
  return small;
}

std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words;
  for (size_t at = 0; (at = text.find_first_not_of(blanks, at)) != std::string_view::npos;) {
    const size_t end = std::min(text.find_first_of(blanks, at), text.size());
    words.emplace_back(text.substr(at, end - at));
    at = end;
  }
  return words;
}

std::vector<double> numbers_of(std::string_view text) {
  std::vector<double> numbers;
  for (const std::string& word : words_of(text)) {
    const char* begin = word.data() + (word.starts_with('+') ? 1 : 0);
    const char* end = word.data() + word.size();
    double number = 0;
    const auto [stop, error] = std::from_chars(begin, end, number);
    numbers.push_back(
        error == std::errc() && stop == end ? number : std::numeric_limits<double>::quiet_NaN());
  }
  return numbers;
}

int64_t to_whole(double number) {
  if (!(std::abs(number) < 0x1p53) || number != std::floor(number)) return -1;
  return int64_t(number);
}

std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    const size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    if (line.ends_with('\r')) line.remove_suffix(1);
    lines.emplace_back(line);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

std::string companion(const std::string& header, const std::string& name,
                      const std::string& where) {
  namespace fs = std::filesystem;
  const fs::path path(name);
  bool is_inside = !name.empty() && name.find('\0') == std::string::npos && path.is_relative();
  for (const fs::path& part : path) is_inside = is_inside && part != "..";
  if (!is_inside)
    throw LoadError(header, where,
                    fmt::format("names the file '{}', which does not lie beside the header", name));
  return (fs::path(header).parent_path() / path).string();
}

std::vector<std::string> numbered_files(const std::string& header, const std::string& pattern,
                                        double first, double last, double step,
                                        const std::string& where) {
  const auto fail = [&](const std::string& what) { throw LoadError(header, where, what); };
  const size_t sign = pattern.find('%');
  size_t at = std::min(sign, pattern.size() - 1) + 1, width = 0;
  const bool has_zeros = at < pattern.size() && pattern[at] == '0';
  for (; at < pattern.size() && pattern[at] >= '0' && pattern[at] <= '9' && width < 100; at++)
    width = width * 10 + size_t(pattern[at] - '0');
  if (sign == std::string::npos || at >= pattern.size() ||
      std::string_view("diu").find(pattern[at]) == std::string_view::npos || width > 20 ||
      pattern.find('%', at) != std::string::npos)
    fail(fmt::format("has the pattern '{}', which is no name with one %d", pattern));
  const double count = std::floor((last - first) / step) + 1;
  if (to_whole(first) < 0 || to_whole(last) < 0 || !(std::abs(step) >= 1) || !(count >= 1) ||
      step != std::floor(step))
    fail("does not count from a first file to a last");
  if (count > most_files) fail(fmt::format("names {} files; {} are read", count, most_files));
  std::vector<std::string> files;
  for (int64_t i = 0; i < int64_t(count); i++) {
    const int64_t number = int64_t(first) + i * int64_t(step);
    const std::string digits =
        has_zeros ? fmt::format("{:0{}}", number, width) : fmt::format("{:{}}", number, width);
    files.push_back(
        companion(header, pattern.substr(0, sign) + digits + pattern.substr(at + 1), where));
  }
  return files;
}

void set_parts(StoredVolume& stored, const std::vector<std::string>& files, uint64_t begin,
               int64_t lines, int64_t bytes, const std::string& where) {
  const auto fail = [&](const std::string& what) { throw LoadError(stored.file, where, what); };
  if (files.empty() || double(files.size()) > most_files) fail("names no sensible number of files");
  if (lines < 0 || lines > most_skipped_lines) fail("skips no sensible number of lines");
  if (bytes < -1 - (int64_t(1) << 40) || bytes > int64_t(1) << 40)
    fail("skips no sensible number of bytes");
  if (bytes < 0 && stored.packing != Packing::none)
    fail("counts bytes from the end, which packed samples do not allow");
  const uint64_t share = uint64_t(stored.times) * stored.stored_bytes() / files.size();
  for (const std::string& file : files) {
    StoredPart part{file, begin, 0};
    if (lines > 0) part.begin = skip_lines(file, begin, lines);
    if (bytes < 0) {
      const uint64_t behind = uint64_t(-1 - bytes) + share;
      const uint64_t size = ByteStream(file, 0, Packing::none).file_bytes();
      if (size < part.begin + behind)
        throw LoadError(
            file, "",
            fmt::format("is cut off: it has {} bytes, the header says {} of samples", size, share));
      part.begin = size - behind;
    } else {
      part.skip = uint64_t(bytes);
    }
    stored.parts.push_back(part);
  }
}

}  // namespace wellspring::volume
