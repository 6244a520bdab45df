// SPDX-License-Identifier: Apache-2.0
#include "volume/bricks/brick_file.h"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/load_error.h"
#include "base/parallel.h"
#include "volume/format/stored_volume.h"

namespace wellspring::volume {
namespace {

static_assert(std::endian::native == std::endian::little);
static_assert(sizeof(BrickEntry) == 8 && sizeof(CodeRange) == 4);
static_assert(sizeof(BrickHead) == 8 + 16 + 18 * 8 + code_bins * 8);

std::shared_ptr<const int> open_to_read(const std::string& path) {
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) throw LoadError(path, "", std::string("cannot be read: ") + std::strerror(errno));
  return {new int(file), [](const int* descriptor) {
            close(*descriptor);
            delete descriptor;
          }};
}

void read_at(const std::string& path, int file, uint64_t from, void* to, size_t count) {
  char* place = static_cast<char*>(to);
  while (count > 0) {
    const ssize_t got = pread(file, place, count, off_t(from));
    if (got < 0 && errno == EINTR) continue;
    const std::string where = fmt::format("byte {}", from);
    if (got < 0)
      throw LoadError(path, where, std::string("cannot be read: ") + std::strerror(errno));
    if (got == 0) throw LoadError(path, where, fmt::format("is cut off, {} bytes early", count));
    place += got, from += uint64_t(got), count -= size_t(got);
  }
}

void check_head(const std::string& path, const BrickHead& head) {
  if (head.magic != brick_magic)
    throw LoadError(path, "byte 0", "is no file of a volume's bricks, or of another version");
  for (const int32_t side : head.size)
    if (side < 1 || side > longest_volume)
      throw LoadError(
          path, "byte 8",
          fmt::format("says {} samples along an axis; 1 to {} are read", side, longest_volume));
  if (!std::isfinite(head.low) || !std::isfinite(head.high) || !(head.low < head.high))
    throw LoadError(path, "byte 24", "has no sensible range of values");
}

// Throws LoadError unless the file is as long as its head says.
void check_length(const std::string& path, const BrickFile& file, uint32_t records,
                  uint64_t length) {
  uint64_t cells = 0;
  for (const BrickLevel& level : file.levels) {
    const glm::ivec3 of = cells_of(level.size);
    cells += uint64_t(of.x) * uint64_t(of.y) * uint64_t(of.z);
  }
  const uint64_t bricks = file.levels.back().first + file.levels.back().count();
  if (records > bricks)
    throw LoadError(path, "byte 20", fmt::format("says {} records for {} bricks", records, bricks));
  const uint64_t needed = sizeof(BrickHead) + uint64_t(records) * record_bytes +
                          bricks * sizeof(BrickEntry) + cells * sizeof(CodeRange);
  if (needed != length)
    throw LoadError(path, "", fmt::format("holds {} bytes, its head says {}", length, needed));
}

}  // namespace

std::vector<BrickLevel> brick_levels(glm::ivec3 finest) {
  std::vector<BrickLevel> levels;
  size_t first = 0;
  for (const glm::ivec3 size : level_sizes(finest)) {
    // Places lie between samples, so there are bricks for one sample less.
    const glm::ivec3 bricks = glm::max((size - 1 + inner_side - 1) / inner_side, 1);
    levels.push_back({size, bricks, first});
    first += levels.back().count();
  }
  return levels;
}

void BrickFile::read(const BrickEntry& entry, uint16_t* codes, uint32_t* normals) const {
  if (entry.record == no_record) {
    std::fill_n(codes, stored_samples, entry.least);
    if (normals) std::fill_n(normals, stored_samples, 0u);
    return;
  }
  const uint64_t from = sizeof(BrickHead) + uint64_t(entry.record) * record_bytes;
  read_at(path, *descriptor, from, codes, stored_code_bytes);
  if (normals)
    read_at(path, *descriptor, from + stored_code_bytes, normals,
            stored_samples * sizeof(uint32_t));
}

void BrickFile::expect(const BrickEntry& entry) const {
  if (entry.record != no_record)
    posix_fadvise(*descriptor, off_t(sizeof(BrickHead) + uint64_t(entry.record) * record_bytes),
                  off_t(record_bytes), POSIX_FADV_WILLNEED);
}

bool is_brick_file(const std::string& path) {
  std::array<char, 8> magic{};
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) return false;
  const bool read = pread(file, magic.data(), magic.size(), 0) == ssize_t(magic.size());
  close(file);
  return read && magic == brick_magic;
}

BrickFile open_bricks(const std::string& path) {
  BrickFile file;
  file.path = path;
  file.descriptor = open_to_read(path);
  struct stat about {};
  if (fstat(*file.descriptor, &about) != 0 || !S_ISREG(about.st_mode))
    throw LoadError(path, "", "is no file of a volume's bricks");
  BrickHead head;
  read_at(path, *file.descriptor, 0, &head, sizeof head);
  check_head(path, head);
  file.scale = {head.low, head.high};
  std::memcpy(&file.to_metres, head.to_metres, sizeof head.to_metres);
  if (!is_regular(file.to_metres))
    throw LoadError(path, "byte 40", "the affine is singular, or has numbers that are not finite");
  file.code_counts.assign(head.code_counts, head.code_counts + code_bins);
  file.levels = brick_levels({head.size[0], head.size[1], head.size[2]});
  check_length(path, file, head.records, uint64_t(about.st_size));
  uint64_t at = sizeof head + uint64_t(head.records) * record_bytes;
  file.entries.resize(file.levels.back().first + file.levels.back().count());
  read_at(path, *file.descriptor, at, file.entries.data(),
          file.entries.size() * sizeof(BrickEntry));
  for (const BrickEntry& entry : file.entries) {
    const bool is_even = entry.record == no_record && entry.least == entry.most;
    if (!is_even && (entry.record >= head.records || entry.least > entry.most))
      throw LoadError(path, fmt::format("byte {}", at), "the entry of a brick is wrong");
    at += sizeof entry;
  }
  for (const BrickLevel& level : file.levels) {
    const glm::ivec3 cells = cells_of(level.size);
    auto& ranges = file.ranges.emplace_back(size_t(cells.x) * size_t(cells.y) * size_t(cells.z));
    read_at(path, *file.descriptor, at, ranges.data(), ranges.size() * sizeof(CodeRange));
    at += ranges.size() * sizeof(CodeRange);
  }
  // Bricks are read here and there.
  posix_fadvise(*file.descriptor, 0, 0, POSIX_FADV_RANDOM);
  return file;
}

std::vector<uint16_t> read_level_codes(const BrickFile& file, int level) {
  const BrickLevel& of = file.levels[size_t(level)];
  const size_t row = size_t(of.size.x), slice = row * size_t(of.size.y);
  std::vector<uint16_t> codes(slice * size_t(of.size.z));
  parallel_each(of.bricks.z, [&](int bz) {
    std::vector<uint16_t> brick(stored_samples);
    for (int by = 0; by < of.bricks.y; by++)
      for (int bx = 0; bx < of.bricks.x; bx++) {
        file.read(file.entries[of.number_of({bx, by, bz})], brick.data(), nullptr);
        const glm::ivec3 from = inner_side * glm::ivec3(bx, by, bz);
        // The last bricks have the samples at the end, too. Each writes its own part of what two
        // have.
        const glm::ivec3 last = glm::ivec3(bx, by, bz) + 1;
        glm::ivec3 count = glm::min(of.size - from, inner_side);
        for (int axis = 0; axis < 3; axis++)
          if (last[axis] == of.bricks[axis]) count[axis] = of.size[axis] - from[axis];
        for (int z = 0; z < count.z; z++)
          for (int y = 0; y < count.y; y++)
            std::copy_n(
                &brick[size_t((z + 1) * stored_slice + (y + 1) * stored_row + 1)], count.x,
                &codes[size_t(from.z + z) * slice + size_t(from.y + y) * row + size_t(from.x)]);
      }
  });
  return codes;
}

}  // namespace wellspring::volume
