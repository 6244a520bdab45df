// SPDX-License-Identifier: Apache-2.0
#include "scan/tree/import/run_import.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <zlib.h>

#include "base/load_error.h"
#include "base/rng.h"
#include "base/write_file.h"
#include "scan/tree/import/index_parts.h"

namespace wellspring::scan {
namespace {

constexpr uint64_t journal_format = 0x31657274706d69;
constexpr double smallest_edge = 0x1p-10;  // metres, of the root
constexpr int most_readers = 4;

// Remembers which stages are done.
struct Journal {
  std::vector<SourceFacts> facts;
  std::vector<uint8_t> is_read;
  std::vector<Chunk> chunks;  // empty: points are not distributed yet

  std::string bytes() {
    PutBytes put;
    put.array(is_read), put.array(chunks);
    for (size_t i = 0; i < facts.size(); i++) {
      if (!is_read[i]) continue;
      facts[i].list(put);
      put.value(uint64_t(facts[i].stations.size()));
      for (const Station& station : facts[i].stations) {
        put.value(station.place);
        put.array(std::vector<char>(station.name.begin(), station.name.end()));
      }
      put.value(uint64_t(facts[i].notices.size()));
      for (const std::string& notice : facts[i].notices)
        put.array(std::vector<char>(notice.begin(), notice.end()));
    }
    return std::move(put.bytes);
  }

  // False: it is of no use.
  bool take(const std::string& from, size_t sources) {
    TakeBytes get{from};
    get.array(is_read), get.array(chunks);
    if (!get.good || is_read.size() != sources) return false;
    facts.resize(sources);
    const auto text = [&] {
      std::vector<char> letters;
      get.array(letters);
      return std::string(letters.begin(), letters.end());
    };
    for (size_t i = 0; i < sources; i++) {
      if (!is_read[i]) continue;
      facts[i].list(get);
      uint64_t count = 0;
      get.value(count);
      for (uint64_t k = 0; k < count && get.good; k++) {
        Station station;
        get.value(station.place);
        station.name = text();
        facts[i].stations.push_back(std::move(station));
      }
      get.value(count);
      for (uint64_t k = 0; k < count && get.good; k++) facts[i].notices.push_back(text());
    }
    return get.complete();
  }
};

uint64_t key_of(const std::vector<TreeSource>& sources, const TreeSettings& settings) {
  PutBytes all;
  all.value(settings.unit), all.value(settings.up), all.value(settings.turn);
  all.value(settings.memory), all.value(settings.leaf_points), all.value(settings.chunk_points);
  for (const TreeSource& source : sources) {
    std::error_code none;
    all.bytes += source.file + '\0';
    all.value(uint64_t(std::filesystem::file_size(source.file, none)));
    all.value(std::filesystem::last_write_time(source.file, none).time_since_epoch().count());
  }
  uint64_t key = all.bytes.size();
  for (const char letter : all.bytes) key = mix64(key ^ uint8_t(letter));
  return key;
}

class Import {
 public:
  Import(const std::vector<TreeSource>& sources, const WorkPlace& place,
         const TreeSettings& settings, const TreeProgress& tell, TreeReport& report)
      : sources_(sources),
        place_(place),
        settings_(settings),
        progress_(tell),
        report_(report),
        key_(key_of(sources, settings)) {}

  DataFile run() {
    resume();
    read();
    find_cube();
    distribute_points();
    const DataFile tree = place_.open("tree");
    BuiltNodes built;
    built.end = tree_page;
    PartLog log(place_.open("nodes"));
    if (!is_fresh_) log.resume(built);
    tree.cut(built.end);
    progress_.begin("building", 0.5, 0.95, report_.points);
    index_chunks(log, built, build_, journal_.chunks, chunks_, tree, settings_.memory, held_,
                 progress_);
    progress_.begin("merging", 0.95, 1, 1);
    const uint32_t root = merge_parts(built, build_, log, tree, progress_);
    write_table(tree, built, root);
    report_.nodes = built.nodes.size(), report_.bytes = tree.size();
    report_.most_held = held_.most();
    return tree;
  }

 private:
  std::string read_name(size_t i) const { return "read" + std::to_string(i); }

  void resume() {
    std::string bytes;
    const bool is_there = !place_.is_memory() && read_keyed(place_.path("journal"), journal_format,
                                                            key_, bytes) == KeyedFile::read;
    is_fresh_ = !is_there || !journal_.take(bytes, sources_.size());
    if (!is_fresh_) return;
    journal_ = {};
    journal_.facts.resize(sources_.size()), journal_.is_read.assign(sources_.size(), 0);
    for (const char* name : {"journal", "chunks", "nodes", "tree"}) place_.remove(name);
  }

  void note() {
    if (place_.is_memory()) return;
    if (!write_keyed(place_.path("journal"), journal_format, key_, journal_.bytes()))
      throw LoadError(place_.path("journal"), "", "cannot be written");
  }

  void read() {
    if (sources_.empty()) throw LoadError("", "", "no file of points is given");
    progress_.begin("reading", 0, 0.3, sources_.size() * read_share);
    if (!journal_.chunks.empty()) return add_up();
    files_.resize(sources_.size());
    std::mutex mutex;
    run_in_order(sources_.size(), most_readers, [&](size_t i) {
      files_[i] = place_.open(read_name(i));
      if (journal_.is_read[i]) return progress_.add(read_share);
      SourceFacts facts = read_source(sources_[i], settings_, files_[i], held_, progress_);
      if (!place_.is_memory()) files_[i].sync();
      std::lock_guard lock(mutex);
      journal_.facts[i] = std::move(facts), journal_.is_read[i] = 1;
      note();
    });
    add_up();
  }

  void add_up() {
    for (const SourceFacts& facts : journal_.facts) {
      report_.points += facts.points, report_.dropped += facts.dropped;
      report_.notices.insert(report_.notices.end(), facts.notices.begin(), facts.notices.end());
      fields_ |= facts.fields;
    }
    if (report_.points == 0) throw LoadError(sources_[0].file, "", "has no point");
  }

  void find_cube() {
    dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
    for (const SourceFacts& facts : journal_.facts)
      if (facts.points > 0) low = glm::min(low, facts.low), high = glm::max(high, facts.high);
    const dvec3 size = high - low, centre = low + size / 2.0;
    const double extent = std::max({size.x, size.y, size.z, smallest_edge});
    build_.cube.origin = glm::round(centre);
    build_.cube.edge = std::exp2(std::ceil(std::log2(extent)));
    build_.cube.corner = centre - build_.cube.origin - build_.cube.edge / 2;
    build_.has_classes = fields_ & tree_classes, build_.leaf_points = settings_.leaf_points;
    for (const SourceFacts& facts : journal_.facts)
      for (const Station& station : facts.stations)
        build_.stations.emplace_back(station.place - build_.cube.origin - build_.cube.corner);
  }

  void distribute_points() {
    progress_.begin("distributing", 0.3, 0.5, 2 * report_.points);
    if (journal_.chunks.empty()) {
      chunks_ = place_.open("chunks");
      const uint64_t affordable = settings_.memory / built_point_bytes;
      const uint64_t limit =
          std::clamp<uint64_t>(affordable / 2, settings_.leaf_points,
                               std::max(settings_.chunk_points, settings_.leaf_points));
      ReadPointStream stream(files_, journal_.facts, build_.cube);
      journal_.chunks =
          distribute(stream, limit, affordable, settings_.memory, chunks_, held_, progress_);
      if (!place_.is_memory()) chunks_.sync();
      note();
    } else chunks_ = place_.open("chunks");
    files_.clear();
    for (size_t i = 0; i < sources_.size(); i++) place_.remove(read_name(i));
  }

  // Numbers nodes level by level, and writes what follows the columns and the head.
  void write_table(const DataFile& tree, BuiltNodes& built, uint32_t root) {
    const double spacing = typical_spacing(built);
    std::vector<NodeRecord> table;
    std::vector<uint32_t> order{root};
    table.reserve(built.nodes.size());
    for (size_t i = 0; i < order.size(); i++) {
      const BuiltNode& node = built.nodes[order[i]];
      NodeRecord record = node.record;
      record.first_child = record.child_mask ? uint32_t(order.size()) : 0;
      if (!(record.spacing > 0)) record.spacing = float(spacing);
      for (uint32_t octant = 0; octant < 8; octant++)
        if (record.child_mask >> octant & 1) order.push_back(node.children[octant]);
      table.push_back(record);
    }
    std::string stations;
    for (const SourceFacts& facts : journal_.facts)
      for (const Station& station : facts.stations) {
        PutBytes put;
        put.value(dvec3(station.place - build_.cube.origin));
        put.value(uint32_t(station.name.size()));
        stations += put.bytes + station.name;
      }
    TreeHead head{};
    head.magic = tree_magic;
    for (int i = 0; i < 3; i++)
      head.origin[i] = build_.cube.origin[i], head.corner[i] = build_.cube.corner[i];
    const glm::dmat3 frame = frame_of(settings_);
    for (int i = 0; i < 9; i++) head.frame[i] = frame[i / 3][i % 3];
    head.edge = build_.cube.edge, head.density = 1 / (spacing * spacing);
    head.points = report_.points, head.fields = fields_;
    head.nodes = uint32_t(table.size()), head.stations = uint32_t(build_.stations.size());
    // Vectors of eight items may be read beyond the last column.
    head.table_at = round_up(built.end + column_align, tree_page);
    head.stations_at = head.table_at + table.size() * sizeof(NodeRecord);
    head.end_at = head.stations_at + stations.size();
    const auto sum = [](uint32_t before, const void* from, size_t count) {
      return uint32_t(crc32_z(before, static_cast<const Bytef*>(from), count));
    };
    head.table_sum = sum(sum(0, table.data(), table.size() * sizeof(NodeRecord)), stations.data(),
                         stations.size());
    head.head_sum = sum(0, &head, offsetof(TreeHead, head_sum));
    tree.cut(built.end);
    tree.cut(head.end_at);
    tree.write_at(head.table_at, table.data(), table.size() * sizeof(NodeRecord));
    tree.write_at(head.stations_at, stations.data(), stations.size());
    tree.write_at(0, &head, sizeof head);
  }

  // Returns the mean over all points of leaves, where neighbours were found.
  double typical_spacing(const BuiltNodes& built) const {
    double sum = 0, points = 0;
    for (const BuiltNode& node : built.nodes)
      if (node.record.child_mask == 0 && node.record.spacing > 0)
        sum += double(node.record.spacing) * node.record.count, points += node.record.count;
    return points > 0 ? sum / points : build_.cube.edge / voxel_side;
  }

  const std::vector<TreeSource>& sources_;
  const WorkPlace& place_;
  const TreeSettings settings_;
  StageProgress progress_;
  TreeReport& report_;
  const uint64_t key_;
  HeldBytes held_;
  Journal journal_;
  bool is_fresh_ = true;
  std::vector<DataFile> files_;
  DataFile chunks_;
  uint32_t fields_ = 0;
  BuildSettings build_;
};

}  // namespace

DataFile import_points(const std::vector<TreeSource>& sources, const WorkPlace& place,
                       const TreeSettings& settings, const TreeProgress& progress,
                       TreeReport& report) {
  report = {};
  return Import(sources, place, settings, progress, report).run();
}

}  // namespace wellspring::scan
