// SPDX-License-Identifier: Apache-2.0
#include "scan/las/ept.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <oneapi/tbb/info.h>
#include <optional>
#include <utility>
#include <zstd.h>

#include "base/load_error.h"
#include "base/parallel.h"
#include "base/read_file.h"
#include "scan/las/ept_hierarchy.h"
#include "scan/las/las_bytes.h"
#include "scan/las/las_header.h"
#include "scan/las/las_source.h"

namespace wellspring::scan {
namespace {

constexpr size_t most_unpacked_node = size_t(1) << 29;

double read_ept_number(const EptDimension& dimension, const uint8_t* point) {
  const uint8_t* at = point + dimension.at;
  const bool is_signed = dimension.kind == EptKind::signed_whole;
  if (dimension.kind == EptKind::floating)
    return dimension.size == 4 ? double(las_number<float>(at)) : las_number<double>(at);
  switch (dimension.size) {
    case 1: return is_signed ? las_number<int8_t>(at) : double(*at);
    case 2: return is_signed ? las_number<int16_t>(at) : double(las_number<uint16_t>(at));
    case 4: return is_signed ? las_number<int32_t>(at) : double(las_number<uint32_t>(at));
    default: return is_signed ? double(las_number<int64_t>(at)) : double(las_number<uint64_t>(at));
  }
}

// Numbers that no column can hold become the nearest one that it can.
template <class Value>
Value read_ept_whole(const EptDimension& dimension, const uint8_t* point) {
  constexpr double most = std::numeric_limits<Value>::max();
  const double number = read_ept_number(dimension, point);
  return std::isfinite(number) ? Value(std::clamp(number, 0.0, most)) : Value(0);
}

std::vector<uint8_t> unpack_zstd(const std::string& file, const std::vector<uint8_t>& packed,
                                 size_t expected) {
  // Without a size in its head the frame must fit all the same.
  const unsigned long long said = ZSTD_getFrameContentSize(packed.data(), packed.size());
  if (said == ZSTD_CONTENTSIZE_ERROR) throw LoadError(file, "", "is not packed by Zstandard");
  if (said != ZSTD_CONTENTSIZE_UNKNOWN && said != expected)
    throw LoadError(file, "", fmt::format("holds {} bytes, the tree says {}", said, expected));
  if (expected > most_unpacked_node)
    throw LoadError(file, "", fmt::format("would have {} bytes unpacked", expected));
  std::vector<uint8_t> bytes(expected);
  const size_t size = ZSTD_decompress(bytes.data(), bytes.size(), packed.data(), packed.size());
  if (ZSTD_isError(size))
    throw LoadError(file, "", std::string("cannot be unpacked: ") + ZSTD_getErrorName(size));
  bytes.resize(size);
  return bytes;
}

// Appends a part of the columns.
void append_points(PointBlock& to, const PointBlock& from, size_t begin, size_t count) {
  const auto append = [&](auto& column, const auto& source) {
    if (source.empty()) return;
    const auto first = source.begin() + ptrdiff_t(begin);
    column.insert(column.end(), first, first + ptrdiff_t(count));
  };
  append(to.place, from.place);
  append(to.color, from.color);
  append(to.intensity, from.intensity);
  append(to.classification, from.classification);
  append(to.time, from.time);
}

class EptSource : public PointSource {
 public:
  explicit EptSource(const std::string& path)
      : folder_(load_ept_folder(path)),
        at_once_(size_t(std::max(1, oneapi::tbb::info::default_concurrency()))) {
    info_.file = path;
    info_.points = folder_.points;
    info_.is_counted = true;
    info_.low = folder_.low, info_.high = folder_.high;
    info_.is_bounded = folder_.is_bounded;
    if (!folder_.wkt.empty()) info_.unit = wkt_unit(folder_.wkt, info_.notices);
    if (folder_.data == EptData::laszip) {
      info_.format = "EPT of LAZ files";
      if (folder_.nodes.empty()) return;
      const auto root = open_las(node_file(folder_.nodes.front()));
      info_.fields = root->info().fields;
      info_.color_max = info_.intensity_max = 0;
      return;
    }
    info_.format = folder_.data == EptData::binary ? "EPT, binary" : "EPT, Zstandard";
    x_ = require("X"), y_ = require("Y"), z_ = require("Z");
    red_ = folder_.find("Red"), green_ = folder_.find("Green"), blue_ = folder_.find("Blue");
    intensity_ = folder_.find("Intensity");
    classification_ = folder_.find("Classification");
    time_ = folder_.find("GpsTime");
    info_.fields.color = red_ && green_ && blue_;
    info_.fields.intensity = intensity_;
    info_.fields.classification = classification_;
    info_.fields.time = time_;
    info_.color_max = info_.fields.color && red_->size == 1 ? 255 : 0;
    info_.intensity_max = intensity_ && intensity_->size == 1 ? 255 : 0;
  }

  bool read(PointBlock& block, size_t most) override {
    block.clear();
    while (block.size() < most) {
      if (current_ == loaded_.size()) {
        if (next_ == folder_.nodes.size()) break;
        load_next();
      }
      const LoadedNode& node = loaded_[current_];
      if (node.error) throw LoadError(*node.error);
      const size_t count = std::min(most - block.size(), node.block.size() - given_);
      append_points(block, node.block, given_, count);
      given_ += count;
      if (given_ < node.block.size()) continue;
      dropped_ += node.dropped;
      loaded_[current_++] = {};
      given_ = 0;
    }
    return block.size() > 0;
  }

 private:
  struct LoadedNode {
    PointBlock block;
    uint64_t dropped = 0;
    std::optional<LoadError> error;
  };

  const EptDimension* require(const char* name) const {
    const EptDimension* dimension = folder_.find(name);
    if (!dimension) throw LoadError(folder_.file, "/schema", fmt::format("has no {}", name));
    return dimension;
  }

  std::string node_file(const EptNode& node) const {
    constexpr const char* endings[] = {"bin", "zst", "laz"};
    return fmt::format("{}ept-data/{}.{}", folder_.folder, ept_name(node.key),
                       endings[int(folder_.data)]);
  }

  void load_next() {
    const size_t count = std::min(at_once_, folder_.nodes.size() - next_);
    loaded_.clear();
    loaded_.resize(count);
    current_ = 0;
    parallel_each(int(count), [&](int i) {
      LoadedNode& loaded = loaded_[size_t(i)];
      const EptNode& node = folder_.nodes[next_ + size_t(i)];
      try {
        if (folder_.data == EptData::laszip) load_packed_node(node, loaded);
        else load_binary_node(node, loaded);
      } catch (const LoadError& error) {
        loaded.error = error;
      }
    });
    next_ += count;
  }

  void load_packed_node(const EptNode& node, LoadedNode& loaded) const {
    const std::string file = node_file(node);
    const auto source = open_las(file);
    const ScanInfo& about = source->info();
    if (about.points != node.points)
      throw LoadError(
          file, "", fmt::format("promises {} points, the tree says {}", about.points, node.points));
    if (about.fields.color != info_.fields.color || about.fields.time != info_.fields.time)
      throw LoadError(file, "", "has other columns than the root");
    source->read(loaded.block, size_t(node.points));
    loaded.dropped = source->dropped();
    check_count(file, node, loaded);
  }

  void load_binary_node(const EptNode& node, LoadedNode& loaded) const {
    const std::string file = node_file(node);
    const size_t expected = size_t(node.points) * folder_.point_bytes;
    const bool is_packed = folder_.data == EptData::zstandard;
    const size_t most = is_packed ? ZSTD_compressBound(expected) : expected;
    auto bytes = read_file<std::vector<uint8_t>>(file, most);
    if (is_packed) bytes = unpack_zstd(file, bytes, expected);
    if (bytes.size() != expected)
      throw LoadError(file, "",
                      fmt::format("holds {} bytes, the tree says {}", bytes.size(), expected));
    for (size_t at = 0; at < bytes.size(); at += folder_.point_bytes)
      add_point(loaded, bytes.data() + at);
  }

  void add_point(LoadedNode& loaded, const uint8_t* point) const {
    dvec3 place;
    int axis = 0;
    for (const EptDimension* dimension : {x_, y_, z_})
      place[axis++] = read_ept_number(*dimension, point) * dimension->scale + dimension->offset;
    if (!std::isfinite(place.x) || !std::isfinite(place.y) || !std::isfinite(place.z)) {
      loaded.dropped++;
      return;
    }
    PointBlock& block = loaded.block;
    block.place.push_back(place);
    if (info_.fields.color)
      block.color.push_back({read_ept_whole<uint16_t>(*red_, point),
                             read_ept_whole<uint16_t>(*green_, point),
                             read_ept_whole<uint16_t>(*blue_, point)});
    if (intensity_) block.intensity.push_back(read_ept_whole<uint16_t>(*intensity_, point));
    if (classification_)
      block.classification.push_back(read_ept_whole<uint8_t>(*classification_, point));
    if (!time_) return;
    const double time = read_ept_number(*time_, point);
    block.time.push_back(std::isfinite(time) ? time * time_->scale + time_->offset : 0);
  }

  static void check_count(const std::string& file, const EptNode& node, const LoadedNode& loaded) {
    const uint64_t there = loaded.block.size() + loaded.dropped;
    if (there != node.points)
      throw LoadError(file, "",
                      fmt::format("holds {} points, the tree says {}", there, node.points));
  }

  EptFolder folder_;
  size_t at_once_;
  const EptDimension *x_ = nullptr, *y_ = nullptr, *z_ = nullptr;
  const EptDimension *red_ = nullptr, *green_ = nullptr, *blue_ = nullptr;
  const EptDimension *intensity_ = nullptr, *classification_ = nullptr, *time_ = nullptr;
  size_t next_ = 0;  // node that is not loaded yet
  std::vector<LoadedNode> loaded_;
  size_t current_ = 0, given_ = 0;  // loaded node, and its points that were returned
};

}  // namespace

std::unique_ptr<PointSource> open_ept(const std::string& path) {
  return std::make_unique<EptSource>(path);
}

}  // namespace wellspring::scan
