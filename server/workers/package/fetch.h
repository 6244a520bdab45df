// SPDX-License-Identifier: Apache-2.0
// Fetches the files of an exhibit from its server, at a worker: one package at a time, one part
// after the other, those alone that are not here yet. Files stay in a folder, also half of one, so
// that the next attempt goes on with it. No clock: times are given, in seconds.
#pragma once
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "workers/package/package.h"

namespace wellspring::workers {

class PackageFetch {
 public:
  // `folder` gets files/HASH and HASH/EXHIBIT. `most_bytes` of a package; 0: nothing is fetched.
  PackageFetch(std::string folder, uint64_t most_bytes);
  ~PackageFetch() { unlock_folder(); }
  PackageFetch(const PackageFetch&) = delete;
  PackageFetch& operator=(const PackageFetch&) = delete;

  enum class What : uint8_t { package, maps };
  // Begins, unless something is being fetched, here or by another process with the same folder, or
  // the last attempt has ended just before. Returns whether the fetch of this goes on.
  bool begin(uint64_t server, const std::string& exhibit, What what, double now);
  // Lets files that are here already be taken from a folder instead: a package of that exhibit.
  void use(const std::string& package_folder);

  // Returns what is to be asked now of its server; none: nothing, or the answer may still come.
  std::optional<FileQuestion> ask(double now);
  // Takes what was asked for; others' parts are dropped. Writes to the disk.
  void take(const FilePart& part, double now);

  struct Result {
    std::string exhibit;
    What what = What::package;
    std::string folder;             // it holds the package; empty: it failed, or only maps came
    std::vector<std::string> maps;  // files that may be the exhibit's illumination maps
    std::string problem;            // why it failed; empty: it did not
  };
  std::optional<Result> take_result();  // once
  bool busy() const;
  bool is_full() const;  // the last attempt failed for want of space

 private:
  struct Part {
    FileHash hash{};
    uint64_t size = 0;
  };
  bool lock_folder(double now);
  void unlock_folder();
  void fail(const std::string& problem, double now);
  void begin_list(const FilePart& part, double now);
  void take_list(double now);
  void go_on(double now);
  void finish(double now);
  void tidy() const;
  std::string file_of(const FileHash& hash) const;
  bool open_part(double now);
  mutable std::mutex mutex_;  // parts come on NATS's thread
  const std::string folder_;
  const uint64_t most_bytes_;
  HashedFiles here_;
  uint64_t server_ = 0;  // 0: nothing is being fetched
  std::string exhibit_;
  What what_ = What::package;
  FileHash list_hash_{};
  PackageList list_;
  std::vector<Part> missing_;                 // the last is next
  uint64_t offset_ = 0, done_ = 0, all_ = 0;  // bytes
  double asked_ = -1e9, heard_ = -1e9, ended_ = -1e9;
  bool has_list_ = false, full_ = false;
  int lock_ = -1;  // descriptor of the locked file; -1: it is not locked
  std::optional<Result> result_;
};

}  // namespace wellspring::workers
