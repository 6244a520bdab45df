// SPDX-License-Identifier: Apache-2.0
#include "volume/format/meta_image.h"

#include <bit>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <utility>

#include "base/load_error.h"
#include "volume/format/byte_stream.h"
#include "volume/format/header_text.h"
#include "volume/format/patient_frame.h"

namespace wellspring::volume {
namespace {

constexpr size_t most_meta_header = size_t(1) << 20;

struct MetaHeader {
  std::string file;
  std::map<std::string, std::string> fields;  // names in small letters
  std::vector<std::string> list;              // lines behind ElementDataFile
  uint64_t end = 0;                           // place behind the line of ElementDataFile

  [[noreturn]] void fail(const std::string& where, const std::string& what) const {
    throw LoadError(file, where, what);
  }
  const std::string* find(std::initializer_list<const char*> names) const {
    for (const char* name : names)
      if (const auto found = fields.find(name); found != fields.end()) return &found->second;
    return nullptr;
  }
  bool is_true(std::initializer_list<const char*> names) const {
    const std::string* text = find(names);
    return text && (in_small_letters(*text) == "true" || *text == "1");
  }
  // Returns numbers, none if there is no such field.
  std::vector<double> numbers(std::initializer_list<const char*> names, size_t least) const {
    const std::string* text = find(names);
    if (!text) return {};
    const std::vector<double> found = numbers_of(*text);
    if (found.size() < least)
      fail(*names.begin(), fmt::format("has {} numbers, {} are wanted", found.size(), least));
    return found;
  }
  double number(std::initializer_list<const char*> names, double otherwise) const {
    const std::vector<double> found = numbers(names, 1);
    return found.empty() ? otherwise : found[0];
  }
};

MetaHeader parse_meta_header(const std::string& file) {
  MetaHeader header;
  header.file = file;
  const std::string text = first_bytes(file, most_meta_header);
  int number = 0;
  for (size_t at = 0; at < text.size();) {
    const size_t end = std::min(text.find('\n', at), text.size());
    const std::string line = text.substr(at, end - at);
    at = std::min(end + 1, text.size());
    number++;
    const size_t sign = line.find('=');
    if (without_blanks(line).empty()) continue;
    if (sign == std::string::npos)
      header.fail(fmt::format("line {}", number), "is no field 'name = value'");
    const std::string name = in_small_letters(without_blanks(line.substr(0, sign)));
    header.fields[name] = without_blanks(line.substr(sign + 1));
    if (name != "elementdatafile") continue;
    header.end = at;
    if (header.fields[name].starts_with("LIST"))
      for (const std::string& one : lines_of(std::string_view(text).substr(at)))
        if (!without_blanks(one).empty()) header.list.emplace_back(without_blanks(one));
    return header;
  }
  header.fail("", "has no field ElementDataFile");
}

void set_meta_numbers(StoredVolume& stored, const MetaHeader& header) {
  constexpr std::pair<const char*, Number> types[] = {
      {"MET_UCHAR", Number::u8},  {"MET_CHAR", Number::i8},        {"MET_USHORT", Number::u16},
      {"MET_SHORT", Number::i16}, {"MET_UINT", Number::u32},       {"MET_INT", Number::i32},
      {"MET_FLOAT", Number::f32}, {"MET_DOUBLE", Number::f64},     {"MET_ULONG", Number::u32},
      {"MET_LONG", Number::i32},  {"MET_ULONG_LONG", Number::u64}, {"MET_LONG_LONG", Number::i64},
  };
  const std::string* type = header.find({"elementtype"});
  if (!type) header.fail("ElementType", "is missing");
  bool is_known = false;
  for (const auto& [name, number] : types)
    if (*type == name) stored.number = number, is_known = true;
  if (!is_known) header.fail("ElementType", fmt::format("is '{}', which is not read", *type));
  const double channels = header.number({"elementnumberofchannels"}, 1);
  if (channels == 3 || channels == 4) stored.components = int(channels), stored.channels = 3;
  if (channels != 1 && (stored.channels != 3 || stored.number != Number::u8))
    header.fail("ElementNumberOfChannels",
                fmt::format("is {} of {}: colours are 3 or 4 of MET_UCHAR", channels, *type));
  const bool is_big = header.is_true({"binarydatabyteordermsb", "elementbyteordermsb"});
  stored.is_swapped = is_big == (std::endian::native == std::endian::little);
  stored.slope = header.number({"elementtointensityfunctionslope"}, 1);
  stored.intercept = header.number({"elementtointensityfunctionoffset"}, 0);
  if (!std::isfinite(stored.slope) || stored.slope == 0 || !std::isfinite(stored.intercept))
    header.fail("ElementToIntensityFunctionSlope", "is no scale");
}

void set_meta_place(StoredVolume& stored, const MetaHeader& header, size_t dimensions) {
  const std::vector<double> spacings =
      header.numbers({"elementspacing", "elementsize"}, dimensions);
  const std::vector<double> offsets = header.numbers({"offset", "position", "origin"}, dimensions);
  const std::vector<double> turn =
      header.numbers({"transformmatrix", "rotation", "orientation"}, dimensions * dimensions);
  glm::dvec3 spacing(1), origin(0);
  for (size_t i = 0; i < std::min<size_t>(dimensions, 3); i++) {
    if (!spacings.empty()) spacing[int(i)] = spacings[i];
    if (!offsets.empty()) origin[int(i)] = offsets[i];
  }
  complete_spacing(stored, spacing, "ElementSpacing");
  double unit = 1e-3;
  if (const std::string* name = header.find({"distanceunits"})) {
    if (*name == "um") unit = 1e-6;
    if (*name == "cm") unit = 1e-2;
    if (*name == "m") unit = 1;
  }
  std::string axes = unstated_axes;
  glm::dmat4 affine = affine_of(spacing, origin);
  if (!turn.empty()) {
    // The first numbers are the direction of x.
    for (size_t i = 0; i < std::min<size_t>(dimensions, 3); i++)
      for (size_t row = 0; row < 3; row++)
        affine[int(i)][int(row)] =
            spacing[int(i)] * (row < dimensions ? turn[i * dimensions + row] : 0);
    stored.is_placed = true;
  } else if (const std::string* from = header.find({"anatomicalorientation"})) {
    // Its letters say from where axes come.
    std::string to = *from;
    for (char& letter : to)
      for (const char* pair : {"LR", "RL", "AP", "PA", "SI", "IS"})
        if (letter == pair[0]) {
          letter = pair[1];
          break;
        }
    stored.is_placed = are_axes(to);
    // The offset stays in LPS.
    if (stored.is_placed) {
      const glm::dmat4 turned = glm::transpose(to_patient_frame("LPS")) * to_patient_frame(to);
      affine = turned * affine_of(spacing, glm::dvec3(0));
      affine[3] = glm::dvec4(origin, 1);
    }
  }
  set_place(stored, affine, axes, unit, turn.empty() ? "ElementSpacing" : "TransformMatrix");
}

}  // namespace

bool is_meta_image(std::string_view first_bytes) {
  const std::string_view text = without_blanks(first_bytes);
  return text.starts_with("ObjectType") || text.starts_with("NDims") ||
         text.starts_with("Comment =") || text.starts_with("ObjectSubType");
}

StoredVolume read_meta_header(const std::string& file) {
  StoredVolume stored;
  stored.file = file, stored.format = "MetaImage";
  const MetaHeader header = parse_meta_header(file);
  const double dimensions = header.number({"ndims"}, 0);
  if (!(dimensions >= 2 && dimensions <= 4) || dimensions != std::floor(dimensions))
    header.fail("NDims", fmt::format("is {}; 2 to 4 are read", dimensions));
  if (const std::string* text = header.find({"binarydata"});
      text && !header.is_true({"binarydata"}))
    header.fail("BinaryData", "is not True: samples as text are not read");
  set_meta_numbers(stored, header);
  const std::vector<double> sizes = header.numbers({"dimsize"}, size_t(dimensions));
  if (sizes.empty()) header.fail("DimSize", "is missing");
  set_size(stored, to_whole(sizes[0]), to_whole(sizes[1]), dimensions > 2 ? to_whole(sizes[2]) : 1,
           "DimSize");
  if (dimensions == 4) set_times(stored, to_whole(sizes[3]), "DimSize");
  set_meta_place(stored, header, size_t(dimensions));

  if (header.is_true({"compresseddata"})) stored.packing = Packing::deflate;
  const double skipped = header.number({"headersize"}, 0);
  if (!(skipped >= -1 && skipped <= 0x1p40) || skipped != std::floor(skipped))
    header.fail("HeaderSize", fmt::format("is {}", skipped));
  const std::string where = "ElementDataFile";
  const std::string& name = *header.find({"elementdatafile"});
  const std::vector<std::string> words = words_of(name);
  std::vector<std::string> files;
  uint64_t begin = 0;
  if (name == "LOCAL" || name == "Local" || name == "local") {
    files = {file}, begin = header.end;
  } else if (name.starts_with("LIST")) {
    for (const std::string& one : header.list) files.push_back(companion(file, one, where));
  } else if (words.size() >= 3 && words[0].find('%') != std::string::npos) {
    const std::vector<double> counts = numbers_of(name.substr(words[0].size()));
    files = numbered_files(file, words[0], counts[0], counts[1], counts.size() > 2 ? counts[2] : 1,
                           where);
  } else {
    files = {companion(file, name, where)};
  }
  set_parts(stored, files, begin, 0, int64_t(skipped), where);
  return stored;
}

}  // namespace wellspring::volume
