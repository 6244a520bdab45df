// SPDX-License-Identifier: Apache-2.0
#include "scan/tree/import/chunks.h"

#include <algorithm>
#include <atomic>
#include <fmt/format.h>

#include "base/load_error.h"
#include "base/parallel.h"
#include "scan/tree/tree_format.h"

namespace wellspring::scan {
namespace {

constexpr int grid_bits = 7, grid_side = 1 << grid_bits;
constexpr size_t grid_cells = size_t(1) << (3 * grid_bits);
constexpr size_t points_at_once = 1 << 19;

uint32_t to_byte(uint16_t value, uint16_t most) {
  return (std::min(value, most) * 255u + most / 2u) / most;
}

// Gives the points of a chunk that is to be distributed again.
class ChunkStream : public PointStream {
 public:
  ChunkStream(const DataFile& file, const Chunk& chunk) : file_(file), chunk_(chunk) {}
  void begin() override { done_ = 0; }
  size_t read(ChunkPoint* to, size_t most) override {
    const size_t count = size_t(std::min<uint64_t>(most, chunk_.count - done_));
    file_.read_at((chunk_.first + done_) * sizeof(ChunkPoint), to, count * sizeof(ChunkPoint));
    done_ += count;
    return count;
  }

 private:
  const DataFile& file_;
  const Chunk chunk_;
  uint64_t done_ = 0;
};

// Distributes the points of one cube.
class Distributor {
 public:
  Distributor(const Chunk& cube, uint64_t limit, uint64_t memory, HeldBytes& held)
      : cube_(cube),
        limit_(limit),
        most_(std::clamp<size_t>(size_t(memory) / 8 / point_bytes, 4096, points_at_once)),
        hold_(held, most_ * point_bytes + grid_cells * 14) {
    points_.resize(most_), sorted_.resize(most_), chunk_of_.resize(most_);
  }

  void count(PointStream& stream, StageProgress& progress) {
    counts_.assign(grid_cells, 0);
    stream.begin();
    for (size_t n; (n = stream.read(points_.data(), most_)) > 0;) {
      parallel_ranges(int(n), 1 << 14, [&](int begin, int end) {
        for (int i = begin; i < end; i++)
          std::atomic_ref(counts_[cell_of(points_[size_t(i)])])
              .fetch_add(1, std::memory_order_relaxed);
      });
      progress.add(n);
    }
  }

  // Puts cells together; records of chunks lie one after the other from `first`.
  std::vector<Chunk> plan(uint64_t first) {
    std::vector<std::vector<uint64_t>> levels;
    levels.push_back(std::move(counts_));
    for (int bits = grid_bits - 1; bits >= 0; bits--) {
      const std::vector<uint64_t>& finer = levels.back();
      std::vector<uint64_t> sums(size_t(1) << (3 * bits), 0);
      const size_t side = size_t(1) << (bits + 1);
      for (size_t i = 0; i < finer.size(); i++) {
        const size_t x = i % side, y = i / side % side, z = i / side / side;
        sums[((z / 2) * (side / 2) + y / 2) * (side / 2) + x / 2] += finer[i];
      }
      levels.push_back(std::move(sums));
    }
    of_cell_.assign(grid_cells, 0);
    std::vector<Chunk> chunks;
    put_together(levels, 0, {0, 0, 0}, chunks);
    for (Chunk& chunk : chunks) chunk.first = first, first += chunk.count;
    return chunks;
  }

  void write(PointStream& stream, const std::vector<Chunk>& chunks, const DataFile& to,
             StageProgress& progress) {
    std::vector<uint64_t> next(chunks.size());
    for (size_t i = 0; i < chunks.size(); i++) next[i] = chunks[i].first;
    stream.begin();
    for (size_t n; (n = stream.read(points_.data(), most_)) > 0;) {
      const std::vector<size_t> ends = sort(n, chunks.size());
      for (size_t c = 0, from = 0; c < chunks.size(); from = ends[c++]) {
        if (ends[c] == from) continue;
        to.write_at(next[c] * sizeof(ChunkPoint), &sorted_[from],
                    (ends[c] - from) * sizeof(ChunkPoint));
        next[c] += ends[c] - from;
      }
      progress.add(n);
    }
  }

 private:
  static constexpr size_t point_bytes =
      2 * sizeof(ChunkPoint) + sizeof(uint32_t) + sizeof(ReadPoint);

  size_t cell_of(const ChunkPoint& point) const {
    const int shift = position_bits - int(cube_.level) - grid_bits;
    size_t cell = 0;
    for (int axis = 2; axis >= 0; axis--)
      cell = cell << grid_bits | size_t(point.place(axis) >> shift & (grid_side - 1));
    return cell;
  }

  void put_together(const std::vector<std::vector<uint64_t>>& levels, int bits, glm::uvec3 cell,
                    std::vector<Chunk>& chunks) {
    const auto& counts = levels[size_t(grid_bits - bits)];
    const uint64_t count = counts[(size_t(cell.z) << bits | cell.y) << bits | cell.x];
    if (count == 0) return;
    if (count > limit_ && bits < grid_bits) {
      for (uint32_t i = 0; i < 8; i++)
        put_together(levels, bits + 1, 2u * cell + glm::uvec3(i & 1, i >> 1 & 1, i >> 2), chunks);
      return;
    }
    Chunk chunk{cube_.level + uint32_t(bits), {}, count, 0};
    for (int axis = 0; axis < 3; axis++) chunk.cell[axis] = cube_.cell[axis] << bits | cell[axis];
    const size_t side = size_t(1) << (grid_bits - bits);
    for (size_t z = 0; z < side; z++)
      for (size_t y = 0; y < side; y++)
        std::fill_n(
            &of_cell_[((cell.z * side + z) << grid_bits | (cell.y * side + y)) << grid_bits |
                      cell.x * side],
            side, uint32_t(chunks.size()));
    chunks.push_back(chunk);
  }

  // Sorts the first points by chunks and keeps their order within; returns where chunks end.
  std::vector<size_t> sort(size_t n, size_t chunks) {
    constexpr size_t pieces = 8;
    const size_t piece = (n + pieces - 1) / pieces;
    std::vector<std::vector<size_t>> places(pieces, std::vector<size_t>(chunks, 0));
    parallel_each(int(pieces), [&](int p) {
      for (size_t i = size_t(p) * piece; i < std::min(n, size_t(p + 1) * piece); i++)
        places[size_t(p)][chunk_of_[i] = of_cell_[cell_of(points_[i])]]++;
    });
    std::vector<size_t> ends(chunks);
    size_t at = 0;
    for (size_t c = 0; c < chunks; c++) {
      for (auto& place : places) at += std::exchange(place[c], at);
      ends[c] = at;
    }
    parallel_each(int(pieces), [&](int p) {
      for (size_t i = size_t(p) * piece; i < std::min(n, size_t(p + 1) * piece); i++)
        sorted_[places[size_t(p)][chunk_of_[i]]++] = points_[i];
    });
    return ends;
  }

  const Chunk cube_;
  const uint64_t limit_;
  const size_t most_;
  const Hold hold_;
  std::vector<uint64_t> counts_;
  std::vector<uint32_t> of_cell_;  // the chunk of each cell of the grid
  std::vector<ChunkPoint> points_, sorted_;
  std::vector<uint32_t> chunk_of_;
};

void check_pile(const Chunk& chunk, uint64_t piled) {
  if (chunk.count > piled)
    throw LoadError(
        "", "",
        fmt::format("{} points lie in one place; the memory allowed holds {}", chunk.count, piled));
}

}  // namespace

ReadPointStream::ReadPointStream(const std::vector<DataFile>& files,
                                 const std::vector<SourceFacts>& facts, const TreeCube& cube)
    : files_(files), facts_(facts), cube_(cube) {
  uint16_t top_color = 0, top_intensity = 0;
  for (const SourceFacts& source : facts) {
    if (source.color_max == 0) top_color = std::max(top_color, source.top_color);
    if (source.intensity_max == 0) top_intensity = std::max(top_intensity, source.top_intensity);
  }
  const auto decided = [](uint16_t max, uint16_t top) {
    return max > 0 ? max : uint16_t(top > 255 ? 65535 : 255);
  };
  size_t stations = 0;
  for (const SourceFacts& source : facts) {
    color_max_.push_back(decided(source.color_max, top_color));
    intensity_max_.push_back(decided(source.intensity_max, top_intensity));
    first_station_.push_back(uint16_t(std::min<size_t>(stations, 65535)));
    stations += source.stations.size();
  }
}

size_t ReadPointStream::read(ChunkPoint* to, size_t most) {
  while (source_ < files_.size() && at_ == facts_[source_].points) source_++, at_ = 0;
  if (source_ == files_.size()) return 0;
  const SourceFacts& facts = facts_[source_];
  const size_t count = size_t(std::min<uint64_t>(most, facts.points - at_));
  records_.resize(std::max(records_.size(), count));
  files_[source_].read_at(at_ * sizeof(ReadPoint), records_.data(), count * sizeof(ReadPoint));
  at_ += count;
  const dvec3 corner = cube_.origin + cube_.corner;
  const double steps = double(uint64_t(1) << position_bits) / cube_.edge;
  const bool has_color = facts.fields & tree_color, has_stations = !facts.stations.empty();
  parallel_ranges(int(count), 1 << 14, [&](int begin, int end) {
    for (int i = begin; i < end; i++) {
      const ReadPoint& from = records_[size_t(i)];
      ChunkPoint& point = to[i];
      for (int axis = 0; axis < 3; axis++) {
        const double step = std::max((from.place[axis] - corner[axis]) * steps, 0.0);
        const uint64_t place = std::min(uint64_t(step), (uint64_t(1) << position_bits) - 1);
        point.low[axis] = uint32_t(place), point.high[axis] = uint16_t(place >> 32);
      }
      point.color = to_byte(from.intensity, intensity_max_[source_]) << 24;
      for (size_t channel = 0; channel < 3; channel++)
        point.color |= (has_color ? to_byte(from.color[channel], color_max_[source_]) : 191u)
                       << (8 * channel);
      point.normal = from.normal;
      const bool is_known = has_stations && from.station < facts.stations.size();
      const uint32_t station = uint32_t(first_station_[source_]) + from.station;
      point.station = is_known ? uint16_t(std::min<uint32_t>(station, no_station)) : no_station;
      point.classification = from.classification;
      point.none = 0;
    }
  });
  return count;
}

std::vector<Chunk> distribute(PointStream& points, uint64_t limit, uint64_t piled, uint64_t memory,
                              const DataFile& to, HeldBytes& held, StageProgress& progress) {
  to.cut(0);
  uint64_t end = 0;  // records
  const auto split = [&](PointStream& stream, const Chunk& cube) {
    Distributor distributor(cube, limit, memory, held);
    distributor.count(stream, progress);
    const std::vector<Chunk> chunks = distributor.plan(end);
    for (const Chunk& chunk : chunks) end += chunk.count;
    distributor.write(stream, chunks, to, progress);
    return chunks;
  };
  // A chunk that is still too large takes its turn again, with a grid of its own.
  std::vector<Chunk> waiting = split(points, {}), done;
  std::ranges::reverse(waiting);
  while (!waiting.empty()) {
    const Chunk chunk = waiting.back();
    waiting.pop_back();
    const bool is_split = chunk.count > limit && int(chunk.level) + grid_bits <= deepest_level;
    if (!is_split) {
      check_pile(chunk, std::max(limit, piled));
      done.push_back(chunk);
      continue;
    }
    ChunkStream stream(to, chunk);
    std::vector<Chunk> parts = split(stream, chunk);
    waiting.insert(waiting.end(), parts.rbegin(), parts.rend());
  }
  return done;
}

}  // namespace wellspring::scan
