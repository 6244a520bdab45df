// SPDX-License-Identifier: Apache-2.0
#include "workers/package/package.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <sodium.h>

#include "base/bytes.h"
#include "base/load_error.h"
#include "base/log.h"

namespace wellspring::workers {

namespace fs = std::filesystem;

namespace {

constexpr size_t most_path_bytes = 512, least_file_bytes = 4 + 1 + 8 + 32;

// Returns whether a path stays in its folder, by whatever system it is read.
bool stays_inside(std::string_view path) {
  if (path.empty() || path.find('\\') != path.npos || path.find('\0') != path.npos) return false;
  for (size_t from = 0; from <= path.size();) {
    const size_t to = std::min(path.find('/', from), path.size());
    const std::string_view step = path.substr(from, to - from);
    if (step.empty() || step == "." || step == "..") return false;
    from = to + 1;
  }
  return true;
}

}  // namespace

std::string to_hex(const FileHash& hash) {
  std::string text(2 * hash.size() + 1, '\0');
  sodium_bin2hex(text.data(), text.size(), hash.data(), hash.size());
  text.pop_back();
  return text;
}

FileHash hash_bytes(std::string_view bytes) {
  FileHash hash;
  crypto_generichash(hash.data(), hash.size(), reinterpret_cast<const uint8_t*>(bytes.data()),
                     bytes.size(), nullptr, 0);
  return hash;
}

FileHash hash_file(const std::string& file) {
  const std::unique_ptr<FILE, int (*)(FILE*)> in(std::fopen(file.c_str(), "rb"), std::fclose);
  if (!in) throw LoadError(file, "", "cannot be read");
  crypto_generichash_state state;
  FileHash hash;
  crypto_generichash_init(&state, nullptr, 0, hash.size());
  std::vector<uint8_t> part(1 << 20);
  while (const size_t size = std::fread(part.data(), 1, part.size(), in.get()))
    crypto_generichash_update(&state, part.data(), size);
  if (std::ferror(in.get())) throw LoadError(file, "", "cannot be read to its end");
  crypto_generichash_final(&state, hash.data(), hash.size());
  return hash;
}

std::string write_list(const PackageList& list) {
  ByteWriter out;
  out.put(uint32_t(list.size()));
  for (const PackageFile& file : list)
    out.put_text(file.path), out.put(file.size), out.put(file.hash);
  return std::move(out).bytes();
}

bool read_list(std::string_view bytes, PackageList& list) {
  if (bytes.size() > most_list_bytes) return false;
  ByteReader in(bytes);
  list.assign(in.take_count(most_package_files, least_file_bytes), {});
  for (PackageFile& file : list) {
    in.take_text(file.path, most_path_bytes);
    in.take(file.size), in.take(file.hash);
    in.need(stays_inside(file.path) && file.size <= most_file_bytes);
    if (!in.good()) return false;
  }
  // Sorted lists show what is there twice, also as a file and as a folder.
  for (size_t i = 1; i < list.size(); i++)
    if (list[i - 1].path >= list[i].path || list[i].path.starts_with(list[i - 1].path + "/"))
      return false;
  return in.ended();
}

bool holds_maps(const PackageFile& file, std::string_view exhibit) {
  return file.path == std::string(exhibit) + ".maps" ||
         file.path == std::string(exhibit) + "/light.maps";
}

void HashedFiles::add(const fs::path& file, std::string path, PackageList& list) {
  std::error_code error;
  const uint64_t size = fs::file_size(file, error);
  const auto changed = error ? fs::file_time_type() : fs::last_write_time(file, error);
  if (error) return;
  Known& known = known_[file.string()];
  try {
    if (known.size != size || known.changed != changed)
      known = {size, changed, hash_file(file.string())};
  } catch (const LoadError& problem) {
    log::warn("{}", problem.what());
    known_.erase(file.string());
    return;
  }
  by_hash_[known.hash] = file.string();
  list.push_back({std::move(path), size, known.hash});
}

PackageList HashedFiles::list(const std::string& folder, const std::string& maps) {
  PackageList list;
  by_hash_.clear();
  std::error_code error;
  const fs::path root(folder);
  const std::string name = root.filename().string();
  fs::recursive_directory_iterator it(root, error), end;
  for (; !error && it != end; it.increment(error)) {
    if (it->path().filename().string().starts_with('.')) {
      it.disable_recursion_pending();
      continue;
    }
    if (list.size() == most_package_files) break;
    std::error_code gone;
    if (it->is_regular_file(gone))
      add(it->path(), name + "/" + it->path().lexically_relative(root).generic_string(), list);
  }
  if (!maps.empty() && fs::is_regular_file(maps, error)) add(maps, name + ".maps", list);
  std::ranges::sort(list, {}, &PackageFile::path);
  return list;
}

std::string HashedFiles::find(const FileHash& hash) const {
  const auto found = by_hash_.find(hash);
  if (found == by_hash_.end()) return {};
  const auto known = known_.find(found->second);
  std::error_code error;
  if (known == known_.end() || fs::file_size(found->second, error) != known->second.size ||
      fs::last_write_time(found->second, error) != known->second.changed || error)
    return {};
  return found->second;
}

}  // namespace wellspring::workers
