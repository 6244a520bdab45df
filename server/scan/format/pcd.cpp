// SPDX-License-Identifier: Apache-2.0
#include "scan/format/pcd.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <optional>

#include "scan/format/column_source.h"
#include "scan/format/lzf.h"
#include "scan/format/number_text.h"
#include "scan/format/ply_header.h"

namespace wellspring::scan {
namespace {

// One of FIELDS: `count` numbers of a kind. Numbers of 8 bytes that are no reals are not read.
struct Field {
  std::string name;
  size_t size = 4, count = 1;
  char type = 'F';
  Role role = Role::none;
  NumberKind kind = NumberKind::f32;
  bool is_packed_color = false;
  uint64_t offset = 0;  // in a record
  size_t words = 0;     // so many words of a line stand before it
};

std::optional<NumberKind> kind_of(char type, size_t size) {
  if (type == 'F' && size == 4) return NumberKind::f32;
  if (type == 'F' && size == 8) return NumberKind::f64;
  if (type == 'U' && size <= 2) return size == 1 ? NumberKind::u8 : NumberKind::u16;
  if (type == 'I' && size <= 2) return size == 1 ? NumberKind::i8 : NumberKind::i16;
  if (size == 4 && type == 'U') return NumberKind::u32;
  if (size == 4 && type == 'I') return NumberKind::i32;
  return std::nullopt;
}

class PcdSource : public ColumnSource {
 public:
  explicit PcdSource(const std::string& path) : file_(path), lines_(file_) {
    info_.file = path;
    read_header();
    choose_fields();
    info_.points = points_;
    info_.is_counted = true;
    if (coding_ == "binary_compressed") unpack();
    const uint64_t least = coding_ == "ascii" ? 2 * words_ : record_;
    const uint64_t room = coding_ == "ascii" ? file_.rest() + 1 : file_.rest();
    if (coding_ != "binary_compressed" && points_ > room / least)
      file_.fail("POINTS", fmt::format("promises {} points of at least {} bytes, {} bytes are left",
                                       points_, least, file_.rest()));
    begin();
  }

 private:
  std::vector<std::string_view> words_of(std::string_view line) const {
    std::vector<std::string_view> words;
    const char* at = line.data();
    const char* end = at + line.size();
    for (;;) {
      while (at < end && separates(*at)) at++;
      const char* stop = at;
      while (stop < end && !separates(*stop)) stop++;
      if (stop == at) return words;
      words.emplace_back(at, size_t(stop - at));
      at = stop;
    }
  }

  uint64_t whole(std::string_view word, uint64_t most) const {
    uint64_t value = 0;
    const auto read = std::from_chars(word.data(), word.data() + word.size(), value);
    if (read.ec != std::errc() || read.ptr != word.data() + word.size() || value > most)
      file_.fail(lines_.where(), fmt::format("'{}' is out of range", word.substr(0, 40)));
    return value;
  }

  void read_header() {
    std::map<std::string, std::vector<std::string>> said;
    std::map<std::string, std::string> where;
    for (std::string_view line; coding_.empty();) {
      if (!lines_.next(line) || lines_.number() > 1000) file_.fail("", "has no DATA");
      const std::vector<std::string_view> words = words_of(line);
      if (words.empty() || words[0].starts_with('#')) continue;
      const std::string key(words[0]);
      where[key] = lines_.where();
      if (words.size() > 1025) file_.fail(lines_.where(), "has too many fields");
      said[key] = {words.begin() + 1, words.end()};
      if (key == "WIDTH" || key == "HEIGHT" || key == "POINTS")
        sizes_[key] = words.size() == 2 ? whole(words[1], uint64_t(1) << 40) : 0;
      if (key == "SIZE" || key == "COUNT")
        for (const std::string& word : said[key]) whole(word, 1 << 20);
      if (key == "DATA" && words.size() == 2) coding_ = words[1];
    }
    if (coding_ != "ascii" && coding_ != "binary" && coding_ != "binary_compressed")
      file_.fail("DATA", fmt::format("'{}' is not read", coding_.substr(0, 40)));
    info_.format = "PCD, " + coding_;
    const std::vector<std::string>& names = said["FIELDS"];
    for (size_t i = 0; i < names.size(); i++) {
      Field field{names[i]};
      if (said["SIZE"].size() != names.size() || said["TYPE"].size() != names.size())
        file_.fail(where["FIELDS"], "SIZE and TYPE do not have as many items as FIELDS");
      field.size = std::stoul(said["SIZE"][i]);
      field.type = said["TYPE"][i][0];
      if (!said["COUNT"].empty() && said["COUNT"].size() != names.size())
        file_.fail(where["COUNT"], "does not have as many items as FIELDS");
      if (!said["COUNT"].empty()) field.count = std::stoul(said["COUNT"][i]);
      fields_.push_back(std::move(field));
    }
    points_ = sizes_["POINTS"];
    if (!sizes_.contains("POINTS") || points_ == 0) points_ = sizes_["WIDTH"] * sizes_["HEIGHT"];
    const std::vector<std::string>& view = said["VIEWPOINT"];
    if (view.size() == 7 && view != std::vector<std::string>{"0", "0", "0", "1", "0", "0", "0"}) {
      double at[3] = {0, 0, 0};
      for (size_t i = 0; i < 3; i++)
        std::from_chars(view[i].data(), view[i].data() + view[i].size(), at[i]);
      info_.stations.push_back({"", dvec3(at[0], at[1], at[2])});
    }
  }

  void choose_fields() {
    for (Field& field : fields_) {
      field.offset = record_;
      field.words = words_;
      record_ += uint64_t(field.size) * field.count;
      words_ += field.count;
      const std::optional<NumberKind> kind = kind_of(field.type, field.size);
      if (field.count != 1 || !kind) continue;
      field.kind = *kind;
      field.is_packed_color = (field.name == "rgb" || field.name == "rgba") && field.size == 4;
      field.role = field.is_packed_color ? Role::red : role_named(field.name);
      for (const Field& other : fields_)
        if (&other != &field && other.role == field.role && other.role != Role::none)
          field.role = Role::none;
    }
    for (const Role role : {Role::x, Role::y, Role::z})
      if (!has(role)) file_.fail("FIELDS", "has no x, y, z");
    bool is_packed = false;
    for (const Field& field : fields_)
      is_packed = is_packed || (field.is_packed_color && field.role == Role::red);
    keep_whole(Role::normal_x);
    if (!is_packed) keep_whole(Role::red);
    for (Field& field : fields_) {
      const bool is_part = field.role == Role::green || field.role == Role::blue;
      if (is_packed && is_part) field.role = Role::none;
      if (field.role == Role::red && !is_packed) colors_are_real_ = is_real(field.kind);
      if (field.role == Role::red && (is_packed || field.size == 1)) color_range_ = {0, 255};
      if (field.role == Role::intensity && field.kind == NumberKind::u8)
        intensity_range_ = {0, 255};
    }
  }
  bool has(Role role) const {
    return std::ranges::any_of(fields_, [role](const Field& one) { return one.role == role; });
  }
  void keep_whole(Role first) {
    const Role all[] = {first, Role(int(first) + 1), Role(int(first) + 2)};
    if (has(all[0]) && has(all[1]) && has(all[2])) return;
    for (Field& field : fields_)
      if (std::ranges::find(all, field.role) != std::end(all)) field.role = Role::none;
  }

  // Compressed data have all numbers of a field side by side.
  void unpack() {
    const std::string where = fmt::format("byte {}", file_.place());
    const uint32_t packed = number_at<uint32_t>(file_.take(4).data());
    const uint32_t size = number_at<uint32_t>(file_.take(4).data());
    if (packed > file_.rest())
      file_.fail(where, fmt::format("is cut off: {} bytes should follow", packed));
    if (points_ > size / record_ || size != points_ * record_)
      file_.fail(where,
                 fmt::format("has {} bytes unpacked, not {} points of {}", size, points_, record_));
    if (!unpack_lzf(file_.take(packed), size, unpacked_))
      file_.fail(where, "its compressed data are damaged");
  }

  void read_columns(PointColumns& columns, size_t most) override {
    const size_t count = size_t(std::min<uint64_t>(most, points_ - done_));
    columns.count = count;
    for (const Field& field : fields_)
      if (field.role != Role::none) columns[field.role].resize(count);
    if (coding_ == "ascii") {
      for (size_t i = 0; i < count; i++) read_line(columns, i);
    } else {
      const bool is_table = coding_ == "binary";
      const std::string_view bytes = is_table ? file_.take(count * record_) : unpacked_;
      for (const Field& field : fields_) {
        if (field.role == Role::none) continue;
        const char* from = bytes.data();
        from += is_table ? field.offset : field.offset * points_ + done_ * field.size;
        // The bits of a packed colour are those of a whole number, whatever its type.
        read_numbers(field.is_packed_color ? NumberKind::u32 : field.kind, from,
                     is_table ? record_ : field.size, false, count, columns[field.role].data());
      }
    }
    unpack_colors(columns);
    done_ += count;
  }

  void read_line(PointColumns& columns, size_t i) {
    std::string_view line;
    do {
      if (!lines_.next(line))
        file_.fail(lines_.where(),
                   fmt::format("is cut off: {} points of {} are there", done_ + i, points_));
    } while (line.find_first_not_of(" \t") == std::string_view::npos);
    const char* at = line.data();
    const char* end = at + line.size();
    for (const Field& field : fields_)
      for (size_t k = 0; k < field.count; k++) {
        double value = 0;
        const int found = next_number(at, end, value);
        if (found < 0)
          file_.fail(lines_.where(), fmt::format("'{}' is no number", word_at(at, end)));
        if (found == 0)
          file_.fail(lines_.where(), fmt::format("has fewer than {} numbers", words_));
        if (field.role == Role::none) continue;
        if (field.is_packed_color && field.type == 'F')
          value = double(std::bit_cast<uint32_t>(float(value)));
        columns[field.role][i] = value;
      }
  }

  void unpack_colors(PointColumns& columns) const {
    for (const Field& field : fields_) {
      if (!field.is_packed_color || field.role != Role::red) continue;
      columns[Role::green].resize(columns.count);
      columns[Role::blue].resize(columns.count);
      for (size_t i = 0; i < columns.count; i++) {
        const double whole = columns[Role::red][i];
        // A signed number that is negative has the highest bit of an alpha.
        const uint32_t bits = std::abs(whole) < 0x1p32 ? uint32_t(int64_t(whole)) : 0;
        columns[Role::red][i] = bits >> 16 & 255;
        columns[Role::green][i] = bits >> 8 & 255;
        columns[Role::blue][i] = bits & 255;
      }
    }
  }

  InputFile file_;
  InputLines lines_;
  std::string coding_;
  std::map<std::string, uint64_t> sizes_;
  std::vector<Field> fields_;
  uint64_t record_ = 0, words_ = 0, points_ = 0, done_ = 0;
  std::string unpacked_;
};

}  // namespace

std::unique_ptr<PointSource> open_pcd(const std::string& path) {
  return std::make_unique<PcdSource>(path);
}

bool is_pcd(std::string_view head) {
  return head.starts_with("# .PCD") || head.starts_with("VERSION ") || head.starts_with("# .pcd");
}

}  // namespace wellspring::scan
