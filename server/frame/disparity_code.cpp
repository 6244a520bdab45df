// SPDX-License-Identifier: Apache-2.0
#include "frame/disparity_code.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

namespace wellspring::frame {
namespace {

constexpr int tolerance = 2;  // units; rounding to whole ones is the rest of worst_units
// Bits of a slope's fraction, and the steepest slope in these.
constexpr int fraction_bits = 8, steepest = 32767;
constexpr int least_run = 3;     // pixels that a new plane has to have
constexpr int long_enough = 12;  // pixels of a known plane from which on no new one is looked for
constexpr int longest_fit = 64;  // most pixels, across and down, from which slopes are found
constexpr uint8_t long_length = 255;
constexpr int level = 4;  // level of deflate
constexpr size_t header_bytes = 16;

enum Kind : uint8_t { above, after, earlier, begins, values };

struct Plane {
  int value = 0, across = 0, down = 0, x = 0, y = 0;  // units at (x, y), and slopes
  int at(int px, int py) const {
    const int64_t sum = (int64_t(value) << fraction_bits) + int64_t(across) * (px - x) +
                        int64_t(down) * (py - y) + (1 << (fraction_bits - 1));
    return int(std::clamp<int64_t>(sum >> fraction_bits, 0, most_disparity));
  }
};

int zigzag(int v) { return v < 0 ? -2 * v - 1 : 2 * v; }
int unzigzag(int v) { return v % 2 ? -(v + 1) / 2 : v / 2; }

struct Run {
  int begin = 0, end = 0;
  int plane = -1;  // -1: none
  Kind kind = values;
  int end_above = 0;  // end of the run above whose plane this one has, kinds `above` and `after`
  int length() const {
    return kind == above || kind == after ? zigzag(end - end_above) : end - begin - 1;
  }
};

// Holds the arrays of the format, in its order.
struct Parts {
  std::vector<uint8_t> kind, length;
  std::vector<uint16_t> long_length, value, across, down, single;
};

class RowCoder {
 public:
  RowCoder(std::span<const float> disparity, int width, int height, float unit)
      : width_(width), height_(height), units_(size_t(width) * size_t(height)) {
    const float per_unit = 1 / unit;
    for (size_t i = 0; i < units_.size(); i++) {
      const float units = disparity[i] * per_unit;  // NaN is not > 0
      units_[i] = units > 0 ? uint16_t(std::min(units, float(most_disparity)) + 0.5f) : 0;
    }
  }
  Parts encode() {
    for (int y = 0; y < height_; y++) encode_row(y);
    return std::move(parts_);
  }

 private:
  int unit_at(int x, int y) const { return units_[size_t(y) * size_t(width_) + size_t(x)]; }
  bool fits(const Plane& plane, int x, int y) const {
    return std::abs(plane.at(x, y) - unit_at(x, y)) <= tolerance;
  }
  // Returns the pixel after the last one that the plane fits.
  int reach(const Plane& plane, int x, int y) const {
    while (x < width_ && fits(plane, x, y)) x++;
    return x;
  }
  bool fits_row(const Plane& plane, int x, int y, int count) const {
    for (int i = 1; i < count; i++)
      if (!fits(plane, x + i, y)) return false;
    return true;
  }
  bool fits_column(const Plane& plane, int x, int y, int count) const {
    for (int i = 1; i <= count; i++)
      if (!fits(plane, x, y + i)) return false;
    return true;
  }
  static bool set_slope(int first, int last, int steps, int& slope) {
    slope = ((last - first) * (1 << fraction_bits)) / steps;
    return std::abs(slope) <= steepest;
  }
  bool find_plane(int x, int y, Plane& found) const;
  void encode_row(int y);
  Run find_known(int x, int y, const Run* up, const Run* next) const;
  void add_plane(const Plane& plane);

  const int width_, height_;
  std::vector<uint16_t> units_;
  std::vector<Plane> planes_;
  std::vector<Run> before_, row_;  // runs of the row above, and of this one
  Parts parts_;
};

// Finds a plane that begins here and goes on for some pixels at least; its slopes are those over as
// long a way as it holds.
bool RowCoder::find_plane(int x, int y, Plane& found) const {
  found = {unit_at(x, y), 0, 0, x, y};
  bool any = false;
  Plane next = found;
  for (int count = least_run; count <= longest_fit && x + count <= width_; count *= 2) {
    if (!set_slope(found.value, unit_at(x + count - 1, y), count - 1, next.across)) break;
    if (!fits_row(next, x, y, count)) break;
    found.across = next.across, any = true;
  }
  next = found;
  for (int count = 1; count <= longest_fit && y + count < height_; count *= 2) {
    if (!set_slope(found.value, unit_at(x, y + count), count, next.down)) break;
    if (!fits_column(next, x, y, count)) break;
    found.down = next.down;
  }
  return any;
}

// Finds the known plane that holds for most pixels from here on; kind `values`: there is none.
Run RowCoder::find_known(int x, int y, const Run* up, const Run* next) const {
  Run best{x, x};
  auto consider = [&](Kind kind, int plane, int end_above) {
    if (plane < 0) return;
    const int end = reach(planes_[size_t(plane)], x, y);
    if (end > best.end) best = {x, end, plane, kind, end_above};
  };
  if (up) consider(above, up->plane, up->end);
  if (best.end >= x + long_enough) {
    // At a crease both planes hold for some pixels: it goes on as it is above.
    const bool both = next && best.end > up->end && next->plane >= 0 &&
                      fits(planes_[size_t(next->plane)], up->end, y);
    if (both) best.end = up->end;
    return best;
  }
  if (next) consider(after, next->plane, next->end);
  if (row_.size() >= 2) consider(earlier, row_[row_.size() - 2].plane, 0);
  return best;
}

void RowCoder::add_plane(const Plane& plane) {
  planes_.push_back(plane);
  parts_.value.push_back(uint16_t(plane.value));
  parts_.across.push_back(uint16_t(int16_t(plane.across)));
  parts_.down.push_back(uint16_t(int16_t(plane.down)));
}

void RowCoder::encode_row(int y) {
  row_.clear();
  size_t over = 0;  // index of the run above in the row above
  for (int x = 0; x < width_; x = row_.back().end) {
    while (over < before_.size() && before_[over].end <= x) over++;
    auto run_above = [&](size_t i) { return i < before_.size() ? &before_[i] : nullptr; };
    Run best = find_known(x, y, run_above(over), run_above(over + 1));
    Plane fresh;
    if (best.end - x < least_run && find_plane(x, y, fresh)) {
      best = {x, reach(fresh, x, y), int(planes_.size()), begins};
      add_plane(fresh);
    }
    if (best.kind != values) {
      row_.push_back(best);
      continue;
    }
    parts_.single.push_back(uint16_t(unit_at(x, y)));
    if (row_.empty() || row_.back().plane >= 0) row_.push_back({x, x});
    row_.back().end = x + 1;
  }
  for (const Run& run : row_) {
    const int length = run.length();
    parts_.kind.push_back(run.kind);
    parts_.length.push_back(uint8_t(std::min(length, int(long_length))));
    if (length >= long_length) parts_.long_length.push_back(uint16_t(length));
  }
  std::swap(before_, row_);
}

void put_number(uint32_t value, uint8_t* to) {
  for (size_t i = 0; i < 4; i++) to[i] = uint8_t(value >> 8 * i);
}
uint32_t get_number(const uint8_t* from) {
  return uint32_t(from[0] | from[1] << 8 | from[2] << 16) | uint32_t(from[3]) << 24;
}

// Hands out arrays from the bytes one after the other.
struct Bytes {
  std::span<const uint8_t> left;
  std::span<const uint8_t> take(size_t count) {
    const auto taken = left.first(count);
    left = left.subspan(count);
    return taken;
  }
  std::vector<uint16_t> take_words(size_t count) {
    const auto low = take(count), high = take(count);
    std::vector<uint16_t> words(count);
    for (size_t i = 0; i < count; i++) words[i] = uint16_t(low[i] | high[i] << 8);
    return words;
  }
};

class RowReader {
 public:
  RowReader(const Parts& parts, int width) : parts_(parts), width_(width) {}
  // Returns false if this is no row.
  bool read(int y, float unit, float* to);
  bool done() const { return run_ == parts_.kind.size(); }

 private:
  bool find_plane(int y, Run& run, size_t over);
  bool find_end(Run& run, size_t over);

  const Parts& parts_;
  const int width_;
  std::vector<Plane> planes_;
  std::vector<Run> before_, row_;
  size_t run_ = 0, long_ = 0, single_ = 0;
};

bool RowReader::find_plane(int y, Run& run, size_t over) {
  if (run.kind == above || run.kind == after) {
    const size_t of = over + (run.kind == after);
    if (of < before_.size()) run.plane = before_[of].plane;
  } else if (run.kind == earlier) {
    if (row_.size() >= 2) run.plane = row_[row_.size() - 2].plane;
  } else if (run.kind == begins) {
    const size_t next = planes_.size();
    if (next >= parts_.value.size()) return false;
    planes_.push_back({parts_.value[next], int16_t(parts_.across[next]), int16_t(parts_.down[next]),
                       run.begin, y});
    run.plane = int(next);
  }
  return run.kind == values || run.plane >= 0;
}

bool RowReader::find_end(Run& run, size_t over) {
  int length = parts_.length[run_];
  if (length == long_length) {
    if (long_ >= parts_.long_length.size()) return false;
    length = parts_.long_length[long_++];
  }
  const bool as_above = run.kind == above || run.kind == after;
  run.end = as_above ? before_[over + (run.kind == after)].end + unzigzag(length)
                     : run.begin + length + 1;
  return run.end > run.begin && run.end <= width_;
}

bool RowReader::read(int y, float unit, float* to) {
  row_.clear();
  size_t over = 0;
  for (int x = 0; x < width_; x = row_.back().end) {
    while (over < before_.size() && before_[over].end <= x) over++;
    if (run_ >= parts_.kind.size() || parts_.kind[run_] > values) return false;
    Run run{x, x, -1, Kind(parts_.kind[run_])};
    if (!find_plane(y, run, over) || !find_end(run, over)) return false;
    if (run.plane < 0 && single_ + size_t(run.end - x) > parts_.single.size()) return false;
    for (int i = x; i < run.end; i++)
      to[i] = unit *
              float(run.plane < 0 ? parts_.single[single_++] : planes_[size_t(run.plane)].at(i, y));
    row_.push_back(run);
    run_++;
  }
  std::swap(before_, row_);
  return true;
}

}  // namespace

void encode_disparity(std::span<const float> disparity, int width, int height, float unit,
                      std::vector<uint8_t>& out) {
  if (width < 1 || height < 1 || disparity.size() < size_t(width) * size_t(height) || !(unit > 0))
    throw std::invalid_argument("encode_disparity: too few disparities, or no unit");
  const Parts parts = RowCoder(disparity, width, height, unit).encode();
  std::vector<uint8_t> all = parts.kind;
  all.insert(all.end(), parts.length.begin(), parts.length.end());
  for (const auto* words :
       {&parts.long_length, &parts.value, &parts.across, &parts.down, &parts.single})
    for (int shift : {0, 8})
      for (uint16_t word : *words) all.push_back(uint8_t(word >> shift));
  const size_t begin = out.size();
  uLongf bytes = compressBound(uLong(all.size()));
  out.resize(begin + header_bytes + bytes);
  size_t at = begin;
  for (size_t count :
       {parts.kind.size(), parts.value.size(), parts.single.size(), parts.long_length.size()})
    put_number(uint32_t(count), &out[at]), at += 4;
  if (compress2(&out[at], &bytes, all.data(), uLong(all.size()), level) != Z_OK)
    throw std::runtime_error("encode_disparity: deflate failed");
  out.resize(at + bytes);
}

bool decode_disparity(std::span<const uint8_t> bytes, int width, int height, float unit,
                      std::vector<float>& disparity) {
  if (bytes.size() < header_bytes || width < 1 || height < 1) return false;
  const size_t pixels = size_t(width) * size_t(height);
  size_t count[4];
  for (size_t i = 0; i < 4; i++) {
    count[i] = get_number(&bytes[4 * i]);
    if (count[i] > pixels) return false;
  }
  const auto [runs, planes, singles, longs] = count;
  std::vector<uint8_t> all(2 * (runs + longs + 3 * planes + singles));
  uLongf unpacked = uLongf(all.size());
  if (uncompress(all.data(), &unpacked, &bytes[header_bytes], uLong(bytes.size() - header_bytes)) !=
          Z_OK ||
      unpacked != all.size())
    return false;
  Bytes left{all};
  Parts parts;
  const auto kinds = left.take(runs), lengths = left.take(runs);
  parts.kind.assign(kinds.begin(), kinds.end());
  parts.length.assign(lengths.begin(), lengths.end());
  parts.long_length = left.take_words(longs);
  parts.value = left.take_words(planes);
  parts.across = left.take_words(planes);
  parts.down = left.take_words(planes);
  parts.single = left.take_words(singles);
  disparity.resize(pixels);
  RowReader reader(parts, width);
  for (int y = 0; y < height; y++)
    if (!reader.read(y, unit, &disparity[size_t(y) * size_t(width)])) return false;
  return reader.done();
}

}  // namespace wellspring::frame
