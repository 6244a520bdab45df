// SPDX-License-Identifier: Apache-2.0
#include "workers/package/shelf.h"

#include <algorithm>
#include <fstream>

namespace wellspring::workers {
namespace {

constexpr size_t most_lists = 3;

std::string read_part(const std::string& file, uint64_t offset, uint64_t size) {
  std::ifstream in(file, std::ios::binary);
  in.seekg(std::streamoff(offset));
  std::string bytes(std::min<uint64_t>(size - offset, most_part_bytes), '\0');
  in.read(bytes.data(), std::streamsize(bytes.size()));
  bytes.resize(in.gcount() > 0 ? size_t(in.gcount()) : 0);
  return bytes;
}

}  // namespace

PackageShelf::PackageShelf(std::string folder, std::string maps)
    : folder_(std::move(folder)), maps_(std::move(maps)) {}

FilePart PackageShelf::answer(const FileQuestion& question) {
  FilePart part{question.server, question.hash, 0, 0, {}};
  if (question.hash == FileHash{}) {
    Listed now;
    now.bytes = write_list(files_.list(folder_, maps_));
    now.hash = hash_bytes(now.bytes);
    part.bytes.assign(now.hash.begin(), now.hash.end());
    part.size = part.bytes.size();
    std::erase_if(lists_, [&](const Listed& one) { return one.hash == now.hash; });
    if (lists_.size() == most_lists) lists_.erase(lists_.begin());
    lists_.push_back(std::move(now));
    return part;
  }
  const auto list = std::ranges::find(lists_, question.hash, &Listed::hash);
  const std::string file = list == lists_.end() ? files_.find(question.hash) : "";
  if (list == lists_.end() && file.empty()) return part;
  std::error_code gone;
  const uint64_t size =
      list != lists_.end() ? list->bytes.size() : std::filesystem::file_size(file, gone);
  if (gone || question.offset > size) return part;
  part.size = size, part.offset = question.offset;
  part.bytes = list != lists_.end() ? list->bytes.substr(question.offset, most_part_bytes)
                                    : read_part(file, question.offset, size);
  return part;
}

}  // namespace wellspring::workers
