// SPDX-License-Identifier: Apache-2.0
#include "scan/tree/import/read_source.h"

#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <utility>

#include "base/load_error.h"
#include "scan/tree/octahedral.h"
#include "scan/tree/tree_format.h"

namespace wellspring::scan {
namespace {

constexpr size_t read_at_once = 1 << 16;

uint32_t fields_of(const PointFields& fields) {
  return (fields.color ? tree_color : 0u) | (fields.intensity ? tree_intensity : 0u) |
         (fields.classification ? tree_classes : 0u);
}

// Throws unless each column is empty or as long as there are places.
void check_block(const PointBlock& block, const std::string& file) {
  const size_t n = block.size();
  const auto is_good = [n](const auto& column) { return column.empty() || column.size() == n; };
  if (!is_good(block.color) || !is_good(block.intensity) || !is_good(block.classification) ||
      !is_good(block.normal) || !is_good(block.station))
    throw LoadError(file, "", "gives columns of different lengths");
}

class SourceReader {
 public:
  SourceReader(PointSource& source, const TreeSettings& settings, SourceFacts& facts)
      : facts_(facts), turn_(frame_of(settings)) {
    const ScanInfo& info = source.info();
    unit_ = settings.unit > 0 ? settings.unit : info.unit;
    if (!std::isfinite(unit_) || !(unit_ > 0))
      throw LoadError(info.file, "", "has a unit that is no length");
    facts_.color_max = info.color_max, facts_.intensity_max = info.intensity_max;
    facts_.fields = fields_of(info.fields);
    facts_.low = dvec3(std::numeric_limits<double>::infinity()), facts_.high = -facts_.low;
    facts_.notices = info.notices;
    for (const Station& station : info.stations)
      facts_.stations.push_back({station.name, turn_ * (station.place * unit_)});
  }

  size_t convert(const PointBlock& block, ReadPoint* to) {
    size_t count = 0;
    for (size_t i = 0; i < block.size(); i++) {
      const dvec3 place = turn_ * (block.place[i] * unit_);
      // False for what is not a number, too.
      if (!(std::abs(place.x) < farthest_place && std::abs(place.y) < farthest_place &&
            std::abs(place.z) < farthest_place)) {
        facts_.dropped++;
        continue;
      }
      ReadPoint& point = to[count++];
      point = {};
      point.place = place;
      facts_.low = glm::min(facts_.low, place), facts_.high = glm::max(facts_.high, place);
      if (!block.color.empty()) point.color = block.color[i];
      for (const uint16_t value : point.color) facts_.top_color = std::max(facts_.top_color, value);
      if (!block.intensity.empty()) point.intensity = block.intensity[i];
      facts_.top_intensity = std::max(facts_.top_intensity, point.intensity);
      if (!block.classification.empty()) point.classification = block.classification[i];
      point.normal =
          block.normal.empty() ? no_normal : encode_octahedral(glm::mat3(turn_) * block.normal[i]);
      point.station = block.station.empty() ? uint16_t(0) : block.station[i];
    }
    facts_.points += count;
    return count;
  }

 private:
  SourceFacts& facts_;
  const glm::dmat3 turn_;
  double unit_ = 1;
};

}  // namespace

glm::dmat3 frame_of(const TreeSettings& settings) {
  glm::dmat3 upright(1);
  if (settings.up == UpAxis::z) upright = {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}};
  if (settings.up == UpAxis::x) upright = {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
  if (settings.turn == 0) return upright;
  const double c = std::cos(settings.turn), s = std::sin(settings.turn);
  return glm::dmat3({c, 0, -s}, {0, 1, 0}, {s, 0, c}) * upright;
}

SourceFacts read_source(const TreeSource& source, const TreeSettings& settings, const DataFile& to,
                        HeldBytes& held, StageProgress& progress) {
  SourceFacts facts;
  const std::unique_ptr<PointSource> points = source.open();
  SourceReader reader(*points, settings, facts);
  constexpr size_t block_bytes = 60;  // a point of a PointBlock takes so many
  const size_t most = std::clamp<size_t>(
      size_t(settings.memory) / 16 / (block_bytes + sizeof(ReadPoint)), 1024, read_at_once);
  const Hold hold(held, most * (block_bytes + sizeof(ReadPoint)));
  std::vector<ReadPoint> records(most);
  PointBlock block;
  uint64_t at = 0;
  to.cut(0);
  uint64_t told = 0;
  const auto tell = [&] {
    const double promised = double(std::max<uint64_t>(points->info().points, 1));
    const double share = std::min(double(facts.points + facts.dropped) / promised, 1.0);
    const uint64_t now = std::max(told, uint64_t(share * read_share));
    progress.add(now - std::exchange(told, now));
  };
  while (points->read(block, most)) {
    check_block(block, source.file);
    if (block.size() > most) records.resize(block.size());
    const size_t count = reader.convert(block, records.data());
    to.write_at(at, records.data(), count * sizeof(ReadPoint));
    at += count * sizeof(ReadPoint);
    tell();
  }
  progress.add(read_share - told);
  facts.dropped += points->dropped();
  const ScanInfo& info = points->info();
  if (info.is_counted && info.points != facts.points + facts.dropped)
    facts.notices.push_back(fmt::format("{} promises {} points and has {}", source.file,
                                        info.points, facts.points + facts.dropped));
  return facts;
}

}  // namespace wellspring::scan
