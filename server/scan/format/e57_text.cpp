// SPDX-License-Identifier: Apache-2.0
#include "scan/format/e57_text.h"

#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <limits>
#include <pugixml.hpp>

namespace wellspring::scan {
namespace {

constexpr uint64_t most_text = uint64_t(1) << 26;
constexpr size_t most_scans = 65'535, most_streams = 256;

[[noreturn]] void refuse(const E57Pages& pages, const pugi::xml_node& node,
                         const std::string& what) {
  pages.file().fail(node.path(), what);
}

template <class Value>
Value parse(const E57Pages& pages, const pugi::xml_node& node, std::string_view text) {
  while (!text.empty() && uint8_t(text.front()) <= 32) text.remove_prefix(1);
  while (!text.empty() && uint8_t(text.back()) <= 32) text.remove_suffix(1);
  if (text.starts_with('+')) text.remove_prefix(1);
  Value value = 0;
  const char* end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, value);
  if (read.ec == std::errc::result_out_of_range && std::is_floating_point_v<Value>) return 0;
  if (read.ec != std::errc() || read.ptr != end)
    refuse(pages, node, fmt::format("'{}' is no number in range", text.substr(0, 40)));
  return value;
}

// An element without text is 0, as the standard has it.
double real_of(const E57Pages& pages, const pugi::xml_node& node) {
  const std::string_view text = node.child_value();
  return text.empty() ? 0 : parse<double>(pages, node, text);
}

template <class Value>
Value attribute(const E57Pages& pages, const pugi::xml_node& node, const char* name,
                Value otherwise) {
  const pugi::xml_attribute found = node.attribute(name);
  return found ? parse<Value>(pages, node, found.value()) : otherwise;
}

dvec3 vector_of(const E57Pages& pages, const pugi::xml_node& node) {
  return {real_of(pages, node.child("x")), real_of(pages, node.child("y")),
          real_of(pages, node.child("z"))};
}

void read_pose(const E57Pages& pages, const pugi::xml_node& pose, E57Scan& scan) {
  if (!pose) return;
  scan.is_posed = true;
  scan.place = vector_of(pages, pose.child("translation"));
  if (const pugi::xml_node turn = pose.child("rotation")) {
    const dvec3 xyz = vector_of(pages, turn);
    scan.turn = glm::dquat(real_of(pages, turn.child("w")), xyz.x, xyz.y, xyz.z);
    const double length = glm::length(scan.turn);
    if (!(length > 1e-6 && length < 1e6)) refuse(pages, turn, "is no rotation");
    scan.turn /= length;
  }
  if (!std::isfinite(scan.place.x + scan.place.y + scan.place.z)) refuse(pages, pose, "is no pose");
}

E57Range range_of(const E57Pages& pages, const pugi::xml_node& limits, const char* low,
                  const char* high) {
  if (!limits.child(high)) return {};
  return {real_of(pages, limits.child(low)), real_of(pages, limits.child(high))};
}

E57Stream read_stream(const E57Pages& pages, const pugi::xml_node& node) {
  E57Stream stream;
  stream.name = node.name();
  const std::string_view type = node.attribute("type").value();
  if (type == "Float") {
    const bool is_single = std::string_view(node.attribute("precision").value()) == "single";
    stream.kind = is_single ? E57Stream::Kind::single_real : E57Stream::Kind::double_real;
    stream.bits = is_single ? 32 : 64;
    stream.least = attribute(pages, node, "minimum", 0.0);
    stream.most = attribute(pages, node, "maximum", 0.0);
  } else if (type == "Integer" || type == "ScaledInteger") {
    using Limits = std::numeric_limits<int64_t>;
    stream.kind = E57Stream::Kind::integer;
    stream.low = attribute(pages, node, "minimum", Limits::min());
    const int64_t high = attribute(pages, node, "maximum", Limits::max());
    if (high < stream.low) refuse(pages, node, "has a maximum below its minimum");
    stream.bits = std::bit_width(uint64_t(high) - uint64_t(stream.low));
    if (type == "ScaledInteger") {
      stream.scale = attribute(pages, node, "scale", 1.0);
      stream.offset = attribute(pages, node, "offset", 0.0);
    }
    stream.least = double(stream.low) * stream.scale + stream.offset;
    stream.most = double(high) * stream.scale + stream.offset;
  } else if (type == "String") {
    stream.kind = E57Stream::Kind::text;
  } else {
    refuse(pages, node, fmt::format("has type '{}', which is not read", type.substr(0, 40)));
  }
  return stream;
}

// Structures within a prototype have streams of their own, in the order of the text.
void read_prototype(const E57Pages& pages, const pugi::xml_node& structure, int depth,
                    std::vector<E57Stream>& streams) {
  for (const pugi::xml_node& node : structure.children()) {
    if (node.type() != pugi::node_element) continue;
    if (std::string_view(node.attribute("type").value()) == "Structure") {
      if (depth == 8) refuse(pages, node, "is nested too deeply");
      read_prototype(pages, node, depth + 1, streams);
      continue;
    }
    if (streams.size() == most_streams) refuse(pages, node, "has too many numbers a point");
    streams.push_back(read_stream(pages, node));
  }
}

E57Scan read_scan(const E57Pages& pages, const pugi::xml_node& node) {
  E57Scan scan;
  scan.name = node.child("name").child_value();
  read_pose(pages, node.child("pose"), scan);
  scan.color = range_of(pages, node.child("colorLimits"), "colorRedMinimum", "colorRedMaximum");
  scan.intensity =
      range_of(pages, node.child("intensityLimits"), "intensityMinimum", "intensityMaximum");
  const pugi::xml_node points = node.child("points");
  if (!points) return scan;
  scan.section = attribute(pages, points, "fileOffset", uint64_t(0));
  scan.points = attribute(pages, points, "recordCount", uint64_t(0));
  read_prototype(pages, points.child("prototype"), 0, scan.streams);
  return scan;
}

}  // namespace

E57Text read_e57_text(E57Pages& pages) {
  const InputFile& file = pages.file();
  char header[48];
  pages.read(0, header, sizeof header);
  if (std::memcmp(header, "ASTM-E57", 8) != 0) file.fail("byte 0", "does not begin as E57 does");
  const uint32_t version = number_at<uint32_t>(header + 8);
  if (version != 1) file.fail("byte 8", fmt::format("has version {}, which is not read", version));
  if (const uint64_t size = number_at<uint64_t>(header + 16); size > file.size())
    file.fail("byte 16", fmt::format("is cut off: it has {} bytes of {}", file.size(), size));
  if (const uint64_t page = number_at<uint64_t>(header + 40); page != E57Pages::page)
    file.fail("byte 40", fmt::format("has pages of {} bytes, which are not read", page));
  const uint64_t begin = pages.to_logical(number_at<uint64_t>(header + 24));
  const uint64_t length = number_at<uint64_t>(header + 32);
  if (length > most_text || length > pages.size() - begin)
    file.fail("byte 32", fmt::format("promises an XML of {} bytes", length));
  std::string text(size_t(length), '\0');
  pages.read(begin, text.data(), length);
  pugi::xml_document document;
  const pugi::xml_parse_result parsed = document.load_buffer(text.data(), text.size());
  if (!parsed) file.fail(fmt::format("XML, byte {}", parsed.offset), parsed.description());
  const pugi::xml_node root = document.child("e57Root");
  if (!root) file.fail("XML", "has no e57Root");
  E57Text description;
  for (const pugi::xml_node& node : root.child("data3D").children("vectorChild")) {
    if (description.scans.size() == most_scans) file.fail("XML", "has too many scans");
    description.scans.push_back(read_scan(pages, node));
  }
  for (const pugi::xml_node& node : root.child("images2D").children("vectorChild")) {
    static_cast<void>(node);
    description.images++;
  }
  return description;
}

}  // namespace wellspring::scan
