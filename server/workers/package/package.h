// SPDX-License-Identifier: Apache-2.0
// Names the files of an exhibit by hashes of their bytes, so that a worker fetches those that it
// lacks, goes on with what it has half of, and knows when all is there.
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/layers.h"

namespace wellspring::workers {

using FileHash = std::array<uint8_t, 32>;  // BLAKE2b-256, by libsodium

// Paths are relative to the folder that holds the package: "castle/exhibit.json". The maps that a
// server keeps beside are "castle.maps", as its --cache has them.
struct PackageFile {
  std::string path;
  uint64_t size = 0;  // bytes
  FileHash hash{};
  bool operator==(const PackageFile&) const = default;
};
using PackageList = std::vector<PackageFile>;

inline constexpr size_t most_package_files = 200'000, most_list_bytes = 64 << 20;
inline constexpr uint64_t most_file_bytes = uint64_t(64) << 30;

// Asks a server for a file of an exhibit's package by its hash, from an offset on: it comes part by
// part. A hash of zeros asks for the hash of the list of files.
struct FileQuestion {
  uint64_t server = 0;  // as in the order that was refused
  FileHash hash{};
  uint64_t offset = 0;  // bytes
};
struct FilePart {
  uint64_t server = 0;
  FileHash hash{};
  uint64_t offset = 0, size = 0;  // bytes; size of the file
  std::string bytes;              // none: there is no such file any more
};
inline constexpr size_t most_part_bytes = 256 * 1024;

std::string to_hex(const FileHash& hash);
FileHash hash_bytes(std::string_view bytes);
FileHash hash_file(const std::string& file);  // throws LoadError

std::string write_list(const PackageList& list);
// Returns false if the bytes are no list: cut off, too long, a path that leaves its folder or is
// there twice.
bool read_list(std::string_view bytes, PackageList& list);
// Returns whether a file of a list holds illumination maps of the exhibit.
bool holds_maps(const PackageFile& file, std::string_view exhibit);

// Remembers the hashes of files for as long as these do not change.
class HashedFiles {
 public:
  // Lists the files of a package's folder, sorted, without hidden ones, and `maps`, if that file
  // exists (empty: none). Files that cannot be read are left out.
  PackageList list(const std::string& folder, const std::string& maps);
  // Returns where a file that was listed lies; empty: nowhere, or it has changed since.
  std::string find(const FileHash& hash) const;

 private:
  struct Known {
    uint64_t size = 0;
    std::filesystem::file_time_type changed;
    FileHash hash{};
  };
  void add(const std::filesystem::path& file, std::string path, PackageList& list);
  std::map<std::string, Known> known_;  // by where they lie
  std::map<FileHash, std::string> by_hash_;
};

}  // namespace wellspring::workers
