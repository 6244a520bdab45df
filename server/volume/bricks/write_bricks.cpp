// SPDX-License-Identifier: Apache-2.0
#include "volume/bricks/write_bricks.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "base/load_error.h"
#include "base/parallel.h"
#include "volume/bricks/brick_file.h"
#include "volume/reconstruct/normal_grid.h"

namespace wellspring::volume {
namespace {

// A file that gets its name when it is whole; until then remove_unfinished() (base/write_file.h)
// knows it.
class UnnamedFile {
 public:
  explicit UnnamedFile(std::string path) : path_(std::move(path)) {
    static std::atomic<unsigned> files{0};
    temporary_ = path_ + ".part" + std::to_string(getpid()) + "-" + std::to_string(files++);
    file_ = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (file_ < 0) fail();
    flock(file_, LOCK_EX | LOCK_NB);
  }
  UnnamedFile(const UnnamedFile&) = delete;
  UnnamedFile& operator=(const UnnamedFile&) = delete;
  ~UnnamedFile() {
    if (file_ < 0) return;
    close(file_);
    std::remove(temporary_.c_str());
  }
  // Any thread, for parts of its own.
  void write_at(uint64_t to, const void* from, size_t count) {
    const char* bytes = static_cast<const char*>(from);
    while (count > 0) {
      const ssize_t written = pwrite(file_, bytes, count, off_t(to));
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) fail();
      bytes += written, to += uint64_t(written), count -= size_t(written);
    }
  }
  void name() {
    const int closing = file_;
    file_ = -1;
    if (close(closing) != 0 || std::rename(temporary_.c_str(), path_.c_str()) != 0) {
      const int reason = errno;
      std::remove(temporary_.c_str());
      errno = reason;
      fail();
    }
  }

 private:
  [[noreturn]] void fail() const {
    throw LoadError(path_, "", std::string("cannot be written: ") + std::strerror(errno));
  }
  std::string path_, temporary_;
  int file_ = -1;
};

constexpr int window = inner_side + 4;  // slices: a layer of bricks, its skirt, and theirs

// Holds the newest slices of a level, and what was made of it so far.
struct Stage {
  BrickLevel level;
  std::vector<uint16_t> slices;
  int have = 0;  // slices came so far
  int layers = 0, cell_layers = 0;

  explicit Stage(const BrickLevel& of)
      : level(of), slices(slice_samples() * size_t(std::min(window, of.size.z))) {}
  size_t slice_samples() const { return size_t(level.size.x) * size_t(level.size.y); }
  size_t place_of(int z) const {
    return slice_samples() * size_t(z % std::min(window, level.size.z));
  }
  const uint16_t* slice(int z) const { return &slices[place_of(z)]; }
  uint16_t* row(int y, int z) { return &slices[place_of(z) + size_t(y) * size_t(level.size.x)]; }
};

// Holds one brick's samples with their neighbours.
class CutBrick {
 public:
  // Copies codes from slices that must be there.
  void cut(const Stage& stage, glm::ivec3 brick) {
    size_ = stage.level.size, from_ = inner_side * brick - 1;
    uint16_t* to = codes_.data();
    for (int z = 0; z < stored_side; z++) {
      const uint16_t* slice = stage.slice(inside(from_.z + z, 2));
      for (int y = 0; y < stored_side; y++) {
        const uint16_t* row = slice + size_t(inside(from_.y + y, 1)) * size_t(size_.x);
        for (int x = 0; x < stored_side; x++) *to++ = row[inside(from_.x + x, 0)];
      }
    }
  }
  CodeRange range() const {
    const auto [least, most] = std::ranges::minmax(codes_);
    return {least, most};
  }
  // Makes normals as make_normals() does.
  void add_normals(const Stage& stage) {
    const size_t row = size_t(size_.x);
    uint32_t* to = normals_.data();
    for (int z = 0; z < stored_side; z++) {
      const int at_z = inside(from_.z + z, 2);
      const int above = std::max(at_z - 1, 0), below = std::min(at_z + 1, size_.z - 1);
      const uint16_t *slice = stage.slice(at_z), *front = stage.slice(above),
                     *behind = stage.slice(below);
      for (int y = 0; y < stored_side; y++) {
        const int at_y = inside(from_.y + y, 1);
        const size_t line = size_t(at_y) * row;
        const size_t up = size_t(std::max(at_y - 1, 0)) * row,
                     down = size_t(std::min(at_y + 1, size_.y - 1)) * row;
        for (int x = 0; x < stored_side; x++) {
          const size_t at = size_t(inside(from_.x + x, 0));
          const size_t left = at - (at > 0), right = std::min(at + 1, row - 1);
          *to++ = pack_normal({fall(slice[line + left], slice[line + right], int(right - left)),
                               fall(slice[up + at], slice[down + at], int((down - up) / row)),
                               fall(front[line + at], behind[line + at], below - above)});
        }
      }
    }
  }
  const uint16_t* codes() const { return codes_.data(); }
  const uint32_t* normals() const { return normals_.data(); }

 private:
  int inside(int at, int axis) const { return std::clamp(at, 0, size_[axis] - 1); }
  static double fall(uint16_t before, uint16_t after, int apart) {
    return apart > 0 ? (double(before) - double(after)) / apart : 0.0;
  }
  glm::ivec3 size_{1}, from_{0};
  std::vector<uint16_t> codes_ = std::vector<uint16_t>(stored_samples);
  std::vector<uint32_t> normals_ = std::vector<uint32_t>(stored_samples);
};

class BrickWriter {
 public:
  BrickWriter(const Volume& volume, const std::string& path) : volume_(volume), file_(path) {
    head_.magic = brick_magic;
    const std::vector<BrickLevel> levels = brick_levels(volume.size);
    entries_.resize(levels.back().first + levels.back().count());
    for (const BrickLevel& level : levels) {
      stages_.emplace_back(level);
      const glm::ivec3 cells = cells_of(level.size);
      ranges_.emplace_back(size_t(cells.x) * size_t(cells.y) * size_t(cells.z));
    }
  }

  void write(const std::function<void(double)>& tell) {
    const CodeScale scale = code_scale_of(volume_);
    const glm::ivec3 size = volume_.size;
    std::vector<uint64_t> counts(code_bins);
    for (int z = 0; z < size.z; z++) {
      parallel_for(size.y, [&](int y) { code_row(volume_, scale, y, z, stages_[0].row(y, z)); });
      const uint16_t* codes = stages_[0].slice(z);
      for (size_t i = 0; i < stages_[0].slice_samples(); i++)
        counts[codes[i] * size_t(code_bins) / 65536]++;
      advance(0);
      if (tell) tell(double(z + 1) / size.z);
    }
    for (int axis = 0; axis < 3; axis++) head_.size[axis] = size[axis];
    head_.low = scale.low, head_.high = scale.high;
    std::memcpy(head_.to_metres, &volume_.to_metres, sizeof head_.to_metres);
    std::ranges::copy(counts, head_.code_counts);
    uint64_t at = sizeof head_ + uint64_t(head_.records) * record_bytes;
    file_.write_at(at, entries_.data(), entries_.size() * sizeof(BrickEntry));
    at += entries_.size() * sizeof(BrickEntry);
    for (const auto& ranges : ranges_) {
      file_.write_at(at, ranges.data(), ranges.size() * sizeof(CodeRange));
      at += ranges.size() * sizeof(CodeRange);
    }
    file_.write_at(0, &head_, sizeof head_);
    file_.name();
  }

 private:
  // Makes what can be made now that one more slice of the level is there.
  void advance(size_t k) {
    Stage& stage = stages_[k];
    const glm::ivec3 size = stage.level.size;
    const int z = stage.have++;
    const bool is_last = stage.have == size.z;
    // A layer of cells reads one slice more, a layer of bricks two: the skirt's and its normals'.
    if ((stage.have % cell_side == 1 && z > 0) || is_last)
      while (stage.cell_layers * cell_side < (is_last ? size.z : z)) write_cells(k);
    while (stage.layers < stage.level.bricks.z &&
           stage.have >= std::min((stage.layers + 1) * inner_side + 2, size.z))
      write_layer(stage);
    if (k + 1 == stages_.size() || (z % 2 == 0 && !is_last)) return;
    Stage& coarser = stages_[k + 1];
    const uint16_t *front = stage.slice(z & ~1), *behind = stage.slice(z);
    parallel_ranges(coarser.level.size.y, 16, [&](int begin, int end) {
      for (int y = begin; y < end; y++)
        halve_row(front, behind, size, y, coarser.row(y, coarser.have));
    });
    advance(k + 1);
  }

  void write_cells(size_t k) {
    Stage& stage = stages_[k];
    const glm::ivec3 cells = cells_of(stage.level.size);
    const int first = stage.cell_layers * cell_side;
    std::vector<const uint16_t*> slices;
    for (int z = first; z < std::min(first + cell_side + 1, stage.level.size.z); z++)
      slices.push_back(stage.slice(z));
    find_ranges(slices, stage.level.size,
                &ranges_[k][size_t(stage.cell_layers) * size_t(cells.x) * size_t(cells.y)]);
    stage.cell_layers++;
  }

  // Numbers the records first, so that the file does not depend on which core was faster.
  void write_layer(Stage& stage) {
    const glm::ivec3 bricks = stage.level.bricks;
    const int count = bricks.x * bricks.y, layer = stage.layers++;
    const auto place = [&](int i) { return glm::ivec3(i % bricks.x, i / bricks.x, layer); };
    const auto entry = [&](int i) -> BrickEntry& {
      return entries_[stage.level.number_of(place(i))];
    };
    parallel_ranges(count, 1, [&](int begin, int end) {
      CutBrick brick;
      for (int i = begin; i < end; i++) {
        brick.cut(stage, place(i));
        const CodeRange range = brick.range();
        entry(i) = {range.least, range.most, no_record};
      }
    });
    for (int i = 0; i < count; i++)
      if (entry(i).least < entry(i).most) entry(i).record = head_.records++;
    parallel_ranges(count, 1, [&](int begin, int end) {
      CutBrick brick;
      for (int i = begin; i < end; i++) {
        if (entry(i).record == no_record) continue;
        brick.cut(stage, place(i));
        brick.add_normals(stage);
        const uint64_t at = sizeof head_ + uint64_t(entry(i).record) * record_bytes;
        file_.write_at(at, brick.codes(), stored_code_bytes);
        file_.write_at(at + stored_code_bytes, brick.normals(), record_bytes - stored_code_bytes);
      }
    });
  }

  const Volume& volume_;
  UnnamedFile file_;
  BrickHead head_{};
  std::vector<Stage> stages_;
  std::vector<BrickEntry> entries_;
  std::vector<std::vector<CodeRange>> ranges_;
};

}  // namespace

void write_bricks(const Volume& volume, const std::string& path,
                  const std::function<void(double)>& tell) {
  BrickWriter(volume, path).write(tell);
}

}  // namespace wellspring::volume
