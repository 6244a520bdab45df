// SPDX-License-Identifier: Apache-2.0
#include "volume/format/nrrd.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <map>
#include <optional>

#include "base/load_error.h"
#include "volume/format/byte_stream.h"
#include "volume/format/header_text.h"
#include "volume/format/patient_frame.h"

namespace wellspring::volume {
namespace {

constexpr size_t most_nrrd_header = size_t(1) << 22;
constexpr double none = std::numeric_limits<double>::quiet_NaN();

using Direction = std::optional<glm::dvec3>;  // none: the axis does not lie in space

struct NrrdHeader {
  std::string file;
  std::map<std::string, std::string> fields;  // names in small letters, "data file" as "datafile"
  std::vector<std::string> list;              // file names behind "data file: LIST"
  uint64_t end = 0;                           // place behind the empty line

  [[noreturn]] void fail(const std::string& where, const std::string& what) const {
    throw LoadError(file, where, what);
  }
  std::string text(const std::string& name, const std::string& otherwise = "") const {
    const auto found = fields.find(name);
    return found == fields.end() ? otherwise : found->second;
  }
  int64_t whole(const std::string& name, int64_t otherwise) const {
    const std::string one = text(name);
    if (one.empty()) return otherwise;
    const std::vector<double> numbers = numbers_of(one);
    if (numbers.size() != 1 || numbers[0] != std::floor(numbers[0]) ||
        std::abs(numbers[0]) > 0x1p40)
      fail(name, fmt::format("is '{}', which is no whole number", one));
    return int64_t(numbers[0]);
  }
};

NrrdHeader parse_nrrd_header(const std::string& file) {
  NrrdHeader header;
  header.file = file;
  const std::string text = first_bytes(file, most_nrrd_header);
  int number = 0;
  for (size_t at = 0; at < text.size();) {
    const size_t end = std::min(text.find('\n', at), text.size());
    std::string line = text.substr(at, end - at);
    at = std::min(end + 1, text.size());
    if (line.ends_with('\r')) line.pop_back();
    header.end = at;
    if (number++ == 0) continue;  // the magic
    if (line.empty()) return header;
    if (line.starts_with('#')) continue;
    const size_t sign = line.find(':');
    if (sign == std::string::npos)
      header.fail(fmt::format("line {}", number), "is no field 'name: value'");
    if (sign + 1 < line.size() && line[sign + 1] == '=') continue;  // for other programs
    std::string name = in_small_letters(without_blanks(line.substr(0, sign)));
    for (const auto& [other, usual] :
         {std::pair{"data file", "datafile"}, std::pair{"centerings", "centers"},
          std::pair{"line skip", "lineskip"}, std::pair{"byte skip", "byteskip"}})
      if (name == other) name = usual;
    header.fields[name] = without_blanks(line.substr(sign + 1));
    if (name != "datafile" || !header.fields[name].starts_with("LIST")) continue;
    for (const std::string& one : lines_of(std::string_view(text).substr(at)))
      if (!without_blanks(one).empty()) header.list.emplace_back(without_blanks(one));
    return header;
  }
  return header;  // a header alone may end without an empty line
}

Number number_of(const NrrdHeader& header) {
  static const std::map<std::string, Number> types = [] {
    std::map<std::string, Number> names;
    const auto add = [&](Number number, std::initializer_list<const char*> all) {
      for (const char* name : all) names[name] = number;
    };
    add(Number::i8, {"signed char", "int8", "int8_t"});
    add(Number::u8, {"uchar", "unsigned char", "uint8", "uint8_t"});
    add(Number::i16,
        {"short", "short int", "signed short", "signed short int", "int16", "int16_t"});
    add(Number::u16, {"ushort", "unsigned short", "unsigned short int", "uint16", "uint16_t"});
    add(Number::i32, {"int", "signed int", "int32", "int32_t"});
    add(Number::u32, {"uint", "unsigned int", "uint32", "uint32_t"});
    add(Number::i64, {"longlong", "long long", "long long int", "signed long long",
                      "signed long long int", "int64", "int64_t"});
    add(Number::u64,
        {"ulonglong", "unsigned long long", "unsigned long long int", "uint64", "uint64_t"});
    add(Number::f32, {"float"});
    add(Number::f64, {"double"});
    return names;
  }();
  const std::string type = header.text("type");
  if (type.empty()) header.fail("type", "is missing");
  const auto found = types.find(in_small_letters(type));
  if (found == types.end()) header.fail("type", fmt::format("is '{}', which is not read", type));
  return found->second;
}

// Reads "(1,0,0) none (0,1,0)". Components beyond three, such as time, are left out.
std::vector<Direction> directions_of(const NrrdHeader& header, const std::string& name) {
  std::vector<Direction> directions;
  const std::string text = header.text(name);
  for (size_t at = 0; (at = text.find_first_not_of(" \t", at)) != std::string::npos;) {
    if (text.compare(at, 4, "none") == 0) {
      directions.emplace_back();
      at += 4;
      continue;
    }
    const size_t end = text.find(')', at);
    if (text[at] != '(' || end == std::string::npos)
      header.fail(name, fmt::format("is '{}', which are no vectors", text));
    std::string inside = text.substr(at + 1, end - at - 1);
    std::ranges::replace(inside, ',', ' ');
    std::vector<double> numbers = numbers_of(inside);
    if (numbers.empty() || numbers.size() > 4)
      header.fail(name, "has vectors that do not have 1 to 4 numbers");
    numbers.resize(3);
    directions.emplace_back(glm::dvec3(numbers[0], numbers[1], numbers[2]));
    at = end + 1;
  }
  return directions;
}

// Returns the space's axes, and whether it states an orientation.
std::pair<std::string, bool> axes_of_space(const NrrdHeader& header) {
  std::string space = in_small_letters(header.text("space"));
  for (const char* time : {"-time", "t"})
    if (space.ends_with(time) && space.size() > 3) {
      space.resize(space.size() - std::string_view(time).size());
      break;
    }
  if (space == "right-anterior-superior" || space == "ras") return {"RAS", true};
  if (space == "left-anterior-superior" || space == "las") return {"LAS", true};
  if (space == "left-posterior-superior" || space == "lps") return {"LPS", true};
  if (space == "3d-left-handed") return {"LAS", false};
  return {unstated_axes, false};
}

// The axes of an array that are those of space: `first` and those behind it, at most three.
struct SpaceAxes {
  size_t first = 0, count = 0;
};

bool is_listed(const std::string& kind) {
  for (const char* name : {"list", "point", "vector", "covariant-vector", "normal", "stub",
                           "scalar", "complex", "quaternion"})
    if (kind == name) return true;
  return kind.find("-color") != std::string::npos || kind.find("-vector") != std::string::npos ||
         kind.find("-gradient") != std::string::npos || kind.find("-normal") != std::string::npos ||
         kind.find("matrix") != std::string::npos;
}

SpaceAxes find_space_axes(const NrrdHeader& header, const std::vector<double>& sizes,
                          const std::vector<Direction>& directions) {
  const size_t count = sizes.size();
  const std::vector<std::string> kinds = words_of(in_small_letters(header.text("kinds")));
  SpaceAxes axes;
  if (directions.size() == count) {
    while (axes.first < count && !directions[axes.first]) axes.first++;
    while (axes.first + axes.count < count && directions[axes.first + axes.count]) axes.count++;
  } else if (kinds.size() == count) {
    while (axes.first < count && is_listed(kinds[axes.first])) axes.first++;
    axes.count = std::min<size_t>(count - axes.first, 3);
  } else {
    // Nothing says what axes are: a first one of 3 or 4 bytes is colour.
    if (count >= 3 && (sizes[0] == 3 || sizes[0] == 4) && number_of(header) == Number::u8)
      axes.first = 1;
    axes.count = std::min<size_t>(count - axes.first, 3);
  }
  if (axes.count == 0 || axes.count > 3 || axes.first > 1 || count - axes.first - axes.count > 1)
    header.fail("sizes", "does not have 1 to 3 axes in space, and at most one before and behind");
  return axes;
}

void set_nrrd_place(StoredVolume& stored, const NrrdHeader& header, const SpaceAxes& axes,
                    const std::vector<Direction>& directions) {
  const auto [space, is_stated] = axes_of_space(header);
  double unit = 1e-3;
  const std::string units = header.text("space units", header.text("units"));
  if (units.find("\"um\"") != std::string::npos || units.find("micro") != std::string::npos)
    unit = 1e-6;
  if (units.find("\"m\"") != std::string::npos) unit = 1;
  if (units.find("\"cm\"") != std::string::npos) unit = 1e-2;
  const std::vector<Direction> origins = directions_of(header, "space origin");
  const glm::dvec3 origin = !origins.empty() && origins[0] ? *origins[0] : glm::dvec3(0);
  if (directions.empty()) {
    const std::vector<double> numbers = numbers_of(header.text("spacings"));
    glm::dvec3 spacing(none);
    for (size_t i = 0; i < axes.count; i++)
      spacing[int(i)] = numbers.empty()                   ? 1
                        : axes.first + i < numbers.size() ? numbers[axes.first + i]
                                                          : none;
    complete_spacing(stored, spacing, "spacings");
    stored.is_placed = is_stated;
    set_place(stored, affine_of(spacing, origin), space, unit, "spacings");
    return;
  }
  glm::dvec3 columns[3]{};
  double longest = 0;
  for (size_t i = 0; i < axes.count; i++) {
    columns[i] = *directions[axes.first + i];
    longest = std::max(longest, glm::length(columns[i]));
  }
  if (axes.count == 1)  // a line: two more axes at right angles
    columns[1] =
        glm::cross(columns[0], std::abs(columns[0].x) < 0.9 * longest ? glm::dvec3(longest, 0, 0)
                                                                      : glm::dvec3(0, longest, 0));
  for (size_t i = std::max<size_t>(axes.count, 1); i < 3; i++) {
    if (i == 2) columns[2] = glm::cross(columns[0], columns[1]);
    const double length = glm::length(columns[i]);
    columns[i] *= length > 0 ? longest / length : 0;
  }
  glm::dmat4 affine(1);
  for (int i = 0; i < 3; i++) affine[i] = glm::dvec4(columns[i], 0);
  affine[3] = glm::dvec4(origin, 1);
  stored.is_placed = is_stated;
  set_place(stored, affine, space, unit, "space directions");
}

void set_nrrd_parts(StoredVolume& stored, const NrrdHeader& header) {
  const std::string encoding = in_small_letters(header.text("encoding"));
  if (encoding == "gzip" || encoding == "gz") stored.packing = Packing::deflate;
  else if (encoding != "raw")
    header.fail("encoding", encoding.empty()
                                ? "is missing"
                                : fmt::format("is '{}'; raw and gzip are read", encoding));
  const std::string endian = in_small_letters(header.text("endian"));
  if (bytes_of(stored.number) > 1) {
    if (endian != "little" && endian != "big") header.fail("endian", "is neither little nor big");
    stored.is_swapped = (endian == "big") == (std::endian::native == std::endian::little);
  }
  const std::string name = header.text("datafile");
  const std::vector<std::string> words = words_of(name);
  const std::string where = "data file";
  std::vector<std::string> files;
  if (name.empty()) {
    files = {stored.file};
  } else if (words[0] == "LIST") {
    for (const std::string& one : header.list) files.push_back(companion(stored.file, one, where));
  } else if (words[0].find('%') != std::string::npos) {
    const std::vector<double> counts = numbers_of(name.substr(words[0].size()));
    if (counts.size() < 3) header.fail(where, "has no first and last number and step");
    files = numbered_files(stored.file, words[0], counts[0], counts[1], counts[2], where);
  } else {
    files = {companion(stored.file, name, where)};
  }
  set_parts(stored, files, name.empty() ? header.end : 0, header.whole("lineskip", 0),
            header.whole("byteskip", 0), "byte skip");
}

}  // namespace

StoredVolume read_nrrd_header(const std::string& file, int64_t entry) {
  StoredVolume stored;
  stored.file = file, stored.format = "NRRD";
  const NrrdHeader header = parse_nrrd_header(file);
  const std::vector<double> sizes = numbers_of(header.text("sizes"));
  const int64_t dimension = header.whole("dimension", 0);
  if (dimension < 1 || dimension > 5 || sizes.size() != size_t(dimension))
    header.fail("sizes", fmt::format("has {} numbers, the dimension is {}; 1 to 5 are read",
                                     sizes.size(), dimension));
  stored.number = number_of(header);
  const std::vector<Direction> directions = directions_of(header, "space directions");
  if (!directions.empty() && directions.size() != sizes.size())
    header.fail("space directions", "does not have a vector or 'none' for each axis");
  const SpaceAxes axes = find_space_axes(header, sizes, directions);
  if (axes.first == 1) {
    const int64_t count = to_whole(sizes[0]);
    if (count < 1 || count > longest_volume) header.fail("sizes", "has a list of no sensible size");
    stored.components = int(count);
    if (stored.number == Number::u8 && (count == 3 || count == 4)) {
      stored.channels = 3;
    } else {
      if (entry < 0 || entry >= count)
        header.fail("sizes", fmt::format("has a list of {}, so there is no {}", count, entry));
      stored.first = int(entry);
    }
  }
  const auto length = [&](size_t i) {
    return i < axes.count ? to_whole(sizes[axes.first + i]) : 1;
  };
  set_size(stored, length(0), length(1), length(2), "sizes");
  if (axes.first + axes.count < sizes.size()) set_times(stored, to_whole(sizes.back()), "sizes");
  set_nrrd_place(stored, header, axes, directions);
  set_nrrd_parts(stored, header);
  return stored;
}

}  // namespace wellspring::volume
