// SPDX-License-Identifier: Apache-2.0
// Helps tests of readers of scans: whole files at once, messages of refusal, damaged copies.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <utility>

#include "base/load_error.h"
#include "base/rng.h"
#include "scan/format/open_scan.h"
#include "unit/folder.h"

namespace wellspring::test {

// Appends numbers in one byte order.
struct ScanBytes {
  bool is_big = false;
  std::string bytes = {};

  template <class Value>
  ScanBytes& put(Value value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    if (is_big) std::reverse(raw, raw + sizeof value);
    bytes.append(raw, sizeof value);
    return *this;
  }
};

struct ReadScan {
  scan::ScanInfo info;
  scan::PointBlock points;
  uint64_t dropped = 0;
};

// Reads a file in blocks of a size that divides nothing.
inline ReadScan read_scan(const std::string& path, size_t block_size = 1000) {
  ReadScan all;
  const std::unique_ptr<scan::PointSource> source = scan::open_scan(path);
  const auto add = [](auto& to, const auto& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  for (scan::PointBlock block; source->read(block, block_size);) {
    EXPECT_LE(block.size(), block_size);
    add(all.points.place, block.place), add(all.points.color, block.color);
    add(all.points.intensity, block.intensity), add(all.points.normal, block.normal);
    add(all.points.classification, block.classification), add(all.points.time, block.time);
    add(all.points.station, block.station);
  }
  all.info = source->info();
  all.dropped = source->dropped();
  const auto is_whole = [&](const auto& column, bool is_there) {
    EXPECT_EQ(column.size(), is_there ? all.points.size() : 0u) << path;
  };
  is_whole(all.points.color, all.info.fields.color);
  is_whole(all.points.intensity, all.info.fields.intensity);
  is_whole(all.points.normal, all.info.fields.normal);
  EXPECT_TRUE(!all.info.is_counted || all.points.size() + all.dropped <= all.info.points) << path;
  return all;
}

// Returns the message with which something is refused; empty: it is not.
inline std::string refusal_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const LoadError& error) {
    return error.what();
  }
  return {};
}
inline std::string refusal_of_scan(const std::string& path) {
  return refusal_of([&] { read_scan(path); });
}

inline std::string bytes_of_file(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// Cuts a file off at many places, and flips bytes of it: `read` may succeed or throw LoadError.
inline void expect_no_harm(const Folder& folder, const std::string& name, const std::string& bytes,
                           const std::function<void(const std::string&)>& read, int flips = 100) {
  size_t refused = 0;
  const auto try_to = [&](const std::string& damaged) {
    const std::string path = folder.write(name, damaged);
    try {
      read(path);
    } catch (const LoadError&) {
      refused++;
    }
  };
  for (size_t i = 0; i < 40; i++) try_to(bytes.substr(0, bytes.size() * i / 40));
  EXPECT_GT(refused, 0u) << name;
  Rng rng(7);
  for (int i = 0; i < flips; i++) {
    std::string damaged = bytes;
    // Heads are where a wrong byte matters most.
    const size_t reach = i % 2 ? bytes.size() : std::min<size_t>(bytes.size(), 400);
    for (int k = 0; k <= i % 3; k++) damaged[rng.next() % reach] = char(rng.next());
    try_to(damaged);
  }
}

inline std::filesystem::path scans_folder() {
  return std::filesystem::path(WELLSPRING_DATA) / "10_exhibits/scans";
}

#define WELLSPRING_SKIP_WITHOUT_SCANS()         \
  if (!std::filesystem::exists(scans_folder())) \
  GTEST_SKIP() << "no scans at " << scans_folder().string()

}  // namespace wellspring::test
