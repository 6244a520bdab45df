// SPDX-License-Identifier: Apache-2.0
#include "workers/package/fetch.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fcntl.h>
#include <fmt/core.h>
#include <fstream>
#include <sys/file.h>
#include <system_error>
#include <unistd.h>
#include <utility>

#include "base/load_error.h"
#include "base/log.h"
#include "base/read_file.h"

namespace wellspring::workers {

namespace fs = std::filesystem;

namespace {

// Seconds: until a part is asked for again; without any until the server is given up; until another
// attempt.
constexpr double ask_again = 2, give_up_after = 20, try_again = 10;
constexpr size_t most_kept = 3;  // versions of a package
constexpr std::chrono::hours half_is_old{7 * 24};
constexpr uint64_t spare = 16 << 20;  // bytes of the disk that stay free

double megabytes(uint64_t bytes) { return 1e-6 * double(bytes); }

// Links a file to another place, or copies it where links cannot be.
void put_at(const fs::path& file, const fs::path& place) {
  std::error_code error;
  fs::create_directories(place.parent_path());
  if (fs::exists(place)) return;
  fs::create_hard_link(file, place, error);
  if (error) fs::copy_file(file, place);
}

}  // namespace

PackageFetch::PackageFetch(std::string folder, uint64_t most_bytes)
    : folder_(std::move(folder)), most_bytes_(most_bytes) {}

std::string PackageFetch::file_of(const FileHash& hash) const {
  return folder_ + "/files/" + to_hex(hash);
}

void PackageFetch::use(const std::string& package_folder) {
  std::lock_guard lock(mutex_);
  here_.list(package_folder, "");
}

bool PackageFetch::busy() const {
  std::lock_guard lock(mutex_);
  return server_ != 0;
}

bool PackageFetch::is_full() const {
  std::lock_guard lock(mutex_);
  return full_;
}

bool PackageFetch::begin(uint64_t server, const std::string& exhibit, What what, double now) {
  std::lock_guard lock(mutex_);
  if (server_ != 0) return exhibit == exhibit_ && (what == what_ || what_ == What::package);
  if (most_bytes_ == 0 || server == 0 || result_ || now - ended_ < try_again || !lock_folder(now))
    return false;
  server_ = server, exhibit_ = exhibit, what_ = what;
  list_hash_ = {}, list_.clear(), missing_.clear();
  offset_ = done_ = all_ = 0;
  has_list_ = full_ = false;
  asked_ = -1e9, heard_ = now;
  log::info("{} of '{}' are fetched from the server",
            what == What::maps ? "illumination maps" : "files", exhibit);
  return true;
}

// The system ends the lock of a process that is killed.
bool PackageFetch::lock_folder(double now) {
  std::error_code error;
  fs::create_directories(folder_, error);
  const std::string file = folder_ + "/lock";
  lock_ = open(file.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0600);
  if (lock_ < 0) {
    full_ = errno == ENOSPC || errno == EDQUOT;
    ended_ = now;
    log::warn("{}: {}", file, std::strerror(errno));
    return false;
  }
  if (flock(lock_, LOCK_EX | LOCK_NB) == 0) return true;
  unlock_folder();
  return false;
}

void PackageFetch::unlock_folder() {
  if (lock_ >= 0) close(lock_);
  lock_ = -1;
}

std::optional<FileQuestion> PackageFetch::ask(double now) {
  std::lock_guard lock(mutex_);
  if (server_ == 0 || now - asked_ < ask_again) return std::nullopt;
  if (now - heard_ > give_up_after) {
    fail("its server does not answer", now);
    return std::nullopt;
  }
  asked_ = now;
  return FileQuestion{server_, missing_.empty() ? FileHash{} : missing_.back().hash, offset_};
}

void PackageFetch::take(const FilePart& part, double now) {
  std::lock_guard lock(mutex_);
  if (server_ == 0 || part.server != server_) return;
  const FileHash wanted = missing_.empty() ? FileHash{} : missing_.back().hash;
  if (part.hash != wanted || (part.offset != offset_ && !part.bytes.empty())) return;
  heard_ = now, asked_ = -1e9;
  try {
    if (missing_.empty()) return begin_list(part, now);
    Part& file = missing_.back();
    if (file.size == 0) file.size = part.size;  // a list tells its size with its first part
    if (part.bytes.empty() || part.size != file.size || part.size > most_file_bytes ||
        (!has_list_ && part.size > most_list_bytes))
      return fail("its files at the server have changed", now);
    std::ofstream out(file_of(file.hash) + ".part", std::ios::binary | std::ios::app);
    errno = 0;
    if (!out.write(part.bytes.data(), std::streamsize(part.bytes.size())).flush()) {
      full_ = errno == ENOSPC || errno == EDQUOT;
      return fail(fmt::format("{}: {}", folder_, std::strerror(errno)), now);
    }
    out.close();
    offset_ += part.bytes.size(), done_ += part.bytes.size();
    if (offset_ == file.size) go_on(now);
  } catch (const fs::filesystem_error& error) {
    full_ = error.code() == std::errc::no_space_on_device;
    fail(error.what(), now);
  } catch (const LoadError& error) {
    fail(error.what(), now);
  }
}

// The lock is held, here and below.
void PackageFetch::begin_list(const FilePart& part, double now) {
  if (part.bytes.size() != list_hash_.size())
    return fail("its server says nothing of its files", now);
  std::memcpy(list_hash_.data(), part.bytes.data(), list_hash_.size());
  fs::create_directories(folder_ + "/files");
  missing_ = {{list_hash_, 0}};
  go_on(now);
}

// Returns false if the file that is next has ended: it is here, or has come to be no good.
bool PackageFetch::open_part(double now) {
  const Part& next = missing_.back();
  const std::string file = file_of(next.hash), part = file + ".part";
  if (fs::exists(file)) {
    missing_.pop_back();
    return false;
  }
  offset_ = fs::exists(part) ? fs::file_size(part) : 0;
  if (next.size == 0 || offset_ < next.size) return true;
  if (offset_ == next.size && hash_file(part) == next.hash) {
    fs::rename(part, file);
    missing_.pop_back();
    return false;
  }
  fs::remove(part);
  fail("a file was damaged on its way", now);
  return false;
}

void PackageFetch::go_on(double now) {
  while (server_ != 0) {
    if (missing_.empty()) {
      if (has_list_) return finish(now);
      take_list(now);
    } else if (open_part(now)) {
      return;
    }
    offset_ = 0;
  }
}

void PackageFetch::take_list(double now) {
  const std::string bytes = read_file(file_of(list_hash_), most_list_bytes);
  PackageList all;
  if (!read_list(bytes, all)) return fail("the list of its files is none", now);
  has_list_ = true;
  uint64_t size = 0;
  for (PackageFile& file : all) {
    const bool maps = holds_maps(file, exhibit_);
    if (!maps && !file.path.starts_with(exhibit_ + "/"))
      return fail("the list of its files has others", now);
    if (what_ == What::maps && !maps) continue;
    size += file.size;
    list_.push_back(std::move(file));
  }
  if (size > most_bytes_)
    return fail(fmt::format("{:.0f} MB are more than --fetch-most", megabytes(size)), now);
  for (const PackageFile& file : list_) {
    const std::string place = file_of(file.hash);
    if (fs::exists(place)) continue;
    if (const std::string known = here_.find(file.hash); !known.empty()) {
      fs::copy_file(known, place + ".part", fs::copy_options::overwrite_existing);
      if (hash_file(place + ".part") == file.hash) fs::rename(place + ".part", place);
    } else if (file.size == 0) {
      const std::ofstream empty(place);
    }
    if (fs::exists(place)) continue;
    missing_.push_back({file.hash, file.size});
    std::error_code none;
    const uint64_t half = fs::file_size(place + ".part", none);
    all_ += file.size - (none ? 0 : std::min(half, file.size));
  }
  if (fs::space(folder_).available < all_ + spare) {
    full_ = true;
    fail(fmt::format("{}: {:.0f} MB do not fit on the disk", folder_, megabytes(all_)), now);
  }
  done_ = 0;
}

void PackageFetch::finish(double now) {
  Result result{exhibit_, what_, {}, {}, {}};
  for (const PackageFile& file : list_)
    if (holds_maps(file, exhibit_)) result.maps.push_back(file_of(file.hash));
  if (what_ == What::package) {
    result.folder = folder_ + "/" + to_hex(list_hash_).substr(0, 16);
    for (const PackageFile& file : list_)
      put_at(file_of(file.hash), result.folder + "/" + file.path);
    fs::last_write_time(result.folder, fs::file_time_type::clock::now());
  }
  log::info("'{}': {} files are there, {:.1f} MB of them were fetched", exhibit_, list_.size(),
            megabytes(done_));
  server_ = 0, ended_ = now;
  result_ = std::move(result);
  tidy();
  unlock_folder();
}

void PackageFetch::fail(const std::string& problem, double now) {
  log::warn("'{}' cannot be fetched: {}", exhibit_, problem);
  server_ = 0, ended_ = now;
  unlock_folder();
  result_ = Result{exhibit_, what_, {}, {}, problem};
}

// Removes old versions of the package, and files that are of no package any more.
void PackageFetch::tidy() const {
  std::error_code error;
  std::vector<std::pair<fs::file_time_type, fs::path>> versions;
  for (const auto& entry : fs::directory_iterator(folder_, error))
    if (fs::exists(entry.path() / exhibit_))
      versions.emplace_back(entry.last_write_time(), entry.path());
  std::ranges::sort(versions, std::greater());
  for (size_t i = most_kept; i < versions.size(); i++) fs::remove_all(versions[i].second, error);
  const auto is_of_this = [&](const std::string& name) {
    return std::ranges::any_of(list_, [&](const auto& file) { return to_hex(file.hash) == name; });
  };
  const auto now = fs::file_time_type::clock::now();
  for (const auto& entry : fs::directory_iterator(folder_ + "/files", error)) {
    const bool half = entry.path().extension() == ".part";
    if (half ? now - entry.last_write_time() > half_is_old
             : entry.hard_link_count() == 1 && !is_of_this(entry.path().filename()))
      fs::remove(entry.path(), error);
  }
}

std::optional<PackageFetch::Result> PackageFetch::take_result() {
  std::lock_guard lock(mutex_);
  return std::exchange(result_, std::nullopt);
}

}  // namespace wellspring::workers
