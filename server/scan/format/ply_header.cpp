// SPDX-License-Identifier: Apache-2.0
#include "scan/format/ply_header.h"

#include <bit>
#include <charconv>
#include <fmt/format.h>
#include <utility>

namespace wellspring::scan {
namespace {

constexpr size_t most_elements = 64, most_properties = 4096, most_lines = 20'000;

template <class Value>
void read_all(const char* from, size_t stride, bool is_swapped, size_t count, double* to) {
  if (is_swapped)
    for (size_t i = 0; i < count; i++, from += stride) to[i] = double(number_at<Value>(from, true));
  else
    for (size_t i = 0; i < count; i++, from += stride) to[i] = double(number_at<Value>(from));
}

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (size_t at = 0; (at = line.find_first_not_of(" \t", at)) != std::string_view::npos;) {
    const size_t end = std::min(line.find_first_of(" \t", at), line.size());
    words.push_back(line.substr(at, end - at));
    at = end;
  }
  return words;
}

bool find_kind(std::string_view name, NumberKind& kind) {
  constexpr std::pair<const char*, NumberKind> names[] = {
      {"char", NumberKind::i8},     {"int8", NumberKind::i8},     {"uchar", NumberKind::u8},
      {"uint8", NumberKind::u8},    {"short", NumberKind::i16},   {"int16", NumberKind::i16},
      {"ushort", NumberKind::u16},  {"uint16", NumberKind::u16},  {"int", NumberKind::i32},
      {"int32", NumberKind::i32},   {"uint", NumberKind::u32},    {"uint32", NumberKind::u32},
      {"float", NumberKind::f32},   {"float32", NumberKind::f32}, {"double", NumberKind::f64},
      {"float64", NumberKind::f64},
  };
  for (const auto& [known, value] : names)
    if (name == known) {
      kind = value;
      return true;
    }
  return false;
}

// Refuses counts that the rest of the file has no bytes for.
void check_counts(InputFile& file, const PlyHeader& header) {
  uint64_t rest = file.rest();
  for (const PlyElement& element : header.elements) {
    uint64_t least = 0;
    for (const PlyProperty& property : element.properties)
      least += header.is_text     ? 2
               : property.is_list ? bytes_of(property.count_kind)
                                  : bytes_of(property.kind);
    // The last number of a text may end without a line's end.
    const uint64_t room = rest + (header.is_text ? 1 : 0);
    if (least == 0 ? element.count > 0 : element.count > room / least)
      file.fail("element " + element.name,
                fmt::format("promises {} of at least {} bytes, {} bytes are left", element.count,
                            least, rest));
    rest -= std::min(rest, element.count * least);
  }
}

}  // namespace

size_t bytes_of(NumberKind kind) {
  constexpr uint8_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[size_t(kind)];
}

double read_number(NumberKind kind, const char* from, bool is_swapped) {
  double value = 0;
  read_numbers(kind, from, 0, is_swapped, 1, &value);
  return value;
}

void read_numbers(NumberKind kind, const char* from, size_t stride, bool is_swapped, size_t count,
                  double* to) {
  switch (kind) {
    case NumberKind::i8: return read_all<int8_t>(from, stride, is_swapped, count, to);
    case NumberKind::u8: return read_all<uint8_t>(from, stride, is_swapped, count, to);
    case NumberKind::i16: return read_all<int16_t>(from, stride, is_swapped, count, to);
    case NumberKind::u16: return read_all<uint16_t>(from, stride, is_swapped, count, to);
    case NumberKind::i32: return read_all<int32_t>(from, stride, is_swapped, count, to);
    case NumberKind::u32: return read_all<uint32_t>(from, stride, is_swapped, count, to);
    case NumberKind::f32: return read_all<float>(from, stride, is_swapped, count, to);
    case NumberKind::f64: return read_all<double>(from, stride, is_swapped, count, to);
  }
}

bool PlyElement::has_lists() const {
  for (const PlyProperty& property : properties)
    if (property.is_list) return true;
  return false;
}

size_t PlyElement::record_bytes() const {
  size_t bytes = 0;
  for (const PlyProperty& property : properties)
    if (!property.is_list) bytes += bytes_of(property.kind);
  return bytes;
}

size_t PlyElement::find(std::string_view property) const {
  size_t i = 0;
  while (i < properties.size() && (properties[i].is_list || properties[i].name != property)) i++;
  return i;
}

const PlyElement* PlyHeader::find(std::string_view element) const {
  for (const PlyElement& one : elements)
    if (one.name == element) return &one;
  return nullptr;
}

bool is_ply(InputFile& file) {
  const std::string_view head = file.peek(4);
  return head.size() >= 4 && head.starts_with("ply") &&
         (head[3] == '\n' || head[3] == '\r' || head[3] == ' ');
}

PlyHeader read_ply_header(InputFile& file) {
  PlyHeader header;
  InputLines lines(file);
  std::string_view line;
  bool has_format = false;
  for (lines.next(line);;) {
    if (!lines.next(line)) file.fail("", "has no end_header");
    if (lines.number() > most_lines) file.fail(lines.where(), "the head is too long");
    const std::vector<std::string_view> words = words_of(line);
    const auto wrong = [&] {
      file.fail(lines.where(), fmt::format("is not read: '{}'", line.substr(0, 80)));
    };
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "end_header") break;
    if (words[0] == "format" && words.size() >= 2) {
      has_format = true;
      header.is_text = words[1] == "ascii";
      header.is_big = words[1] == "binary_big_endian";
      if (!header.is_text && !header.is_big && words[1] != "binary_little_endian") wrong();
    } else if (words[0] == "element" && words.size() == 3) {
      PlyElement element{std::string(words[1]), 0, {}};
      const char* end = words[2].data() + words[2].size();
      const auto read = std::from_chars(words[2].data(), end, element.count);
      if (read.ec != std::errc() || read.ptr != end) wrong();
      if (header.elements.size() == most_elements) file.fail(lines.where(), "too many elements");
      header.elements.push_back(std::move(element));
    } else if (words[0] == "property" && words.size() >= 3 && !header.elements.empty()) {
      PlyProperty property{std::string(words.back())};
      property.is_list = words[1] == "list";
      const bool is_known = property.is_list
                                ? words.size() == 5 && find_kind(words[2], property.count_kind) &&
                                      find_kind(words[3], property.kind)
                                : words.size() == 3 && find_kind(words[1], property.kind);
      if (!is_known || (property.is_list && is_real(property.count_kind))) wrong();
      if (header.elements.back().properties.size() == most_properties)
        file.fail(lines.where(), "too many properties");
      header.elements.back().properties.push_back(std::move(property));
    } else {
      wrong();
    }
  }
  if (!has_format) file.fail("", "does not say its format");
  header.lines = lines.number();
  check_counts(file, header);
  return header;
}

void pass_list(InputFile& file, const PlyProperty& list, bool is_swapped) {
  const double length =
      read_number(list.count_kind, file.take(bytes_of(list.count_kind)).data(), is_swapped);
  if (length < 0 || length * double(bytes_of(list.kind)) > double(file.rest()))
    file.fail(fmt::format("byte {}", file.place()),
              fmt::format("a list of {} numbers does not fit into the file", length));
  file.go_to(file.place() + uint64_t(length) * bytes_of(list.kind));
}

void pass_element(InputFile& file, const PlyHeader& header, const PlyElement& element,
                  InputLines& lines) {
  const bool is_swapped = header.is_big != (std::endian::native == std::endian::big);
  if (header.is_text) {
    std::string_view line;
    for (uint64_t i = 0; i < element.count; i++) do {
        if (!lines.next(line)) file.fail("element " + element.name, "is cut off");
      } while (line.find_first_not_of(" \t") == std::string_view::npos);
  } else if (!element.has_lists()) {
    file.go_to(file.place() + element.count * element.record_bytes());  // checked with the head
  } else {
    for (uint64_t i = 0; i < element.count; i++)
      for (const PlyProperty& property : element.properties)
        if (property.is_list) pass_list(file, property, is_swapped);
        else file.take(bytes_of(property.kind));
  }
}

bool has_splats(const PlyHeader& header) {
  const PlyElement* vertex = header.find("vertex");
  if (!vertex) return false;
  if (vertex->has("packed_position")) return header.find("chunk") != nullptr;
  return vertex->has("f_dc_0") && vertex->has("opacity") && vertex->has("scale_0") &&
         vertex->has("rot_0");
}

}  // namespace wellspring::scan
