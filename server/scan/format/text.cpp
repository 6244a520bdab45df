// SPDX-License-Identifier: Apache-2.0
#include "scan/format/text.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>

#include "scan/format/column_source.h"
#include "scan/format/input_file.h"
#include "scan/format/number_text.h"
#include "scan/format/text_columns.h"

namespace wellspring::scan {
namespace {

constexpr size_t most_columns = 256;

bool is_comment(std::string_view line) { return line.starts_with('#') || line.starts_with("//"); }

bool is_blank(std::string_view line) {
  return std::ranges::all_of(line, [](char letter) { return separates(letter); });
}

// Returns the numbers of a line; nothing: it holds something else.
std::optional<std::vector<double>> numbers_of(std::string_view line) {
  std::vector<double> numbers;
  const char* at = line.data();
  const char* end = at + line.size();
  for (double value = 0;;) {
    const int found = next_number(at, end, value);
    if (found == 0) return numbers;
    if (found < 0 || numbers.size() == most_columns) return std::nullopt;
    numbers.push_back(value);
  }
}

bool is_count(const std::vector<double>& numbers) {
  return numbers.size() == 1 && numbers[0] >= 0 && numbers[0] == std::floor(numbers[0]) &&
         numbers[0] < 0x1p53;
}

class TextSource : public ColumnSource {
 public:
  explicit TextSource(const std::string& path) : file_(path), lines_(file_) {
    info_.file = path;
    is_leica_ = path.ends_with(".pts") || path.ends_with(".PTS");
    info_.format = is_leica_ ? "PTS" : "text";
    if (file_.peek(3).starts_with("\xef\xbb\xbf")) file_.pass(3);
    find_first_point();
    if (is_counted_) count_lines();
    begin();
    info_.is_counted = is_counted_;
  }

 private:
  // Passes what stands before the points, and finds out what their columns hold.
  void find_first_point() {
    std::vector<Role> names;
    std::string first_words;
    uint64_t place = file_.place(), number = 0;
    std::vector<std::vector<double>> rows;
    for (std::string_view line; rows.size() < piece_size;) {
      if (rows.empty()) place = file_.place(), number = lines_.number();
      if (!lines_.next(line)) break;
      if (is_blank(line)) continue;
      const bool is_said = is_comment(line);
      if (is_said && rows.empty() && names.empty()) names = read_column_names(line);
      if (is_said) continue;
      std::optional<std::vector<double>> numbers = numbers_of(line);
      if (!numbers) {
        if (!rows.empty()) break;  // reading names the line
        if (names.empty()) names = read_column_names(line);
        if (names.empty())
          file_.fail(lines_.where(), fmt::format("is neither numbers nor names of columns with x, "
                                                 "y and z: '{}'",
                                                 line.substr(0, 60)));
      } else if (is_count(*numbers)) {
        if (rows.empty() && promised_ > 0)
          file_.fail(lines_.where(), "a count follows a count: PTX is not read");
        if (rows.empty()) is_counted_ = true, promised_ = uint64_t((*numbers)[0]);
      } else if (numbers->size() < 3) {
        file_.fail(lines_.where(), "has fewer than three numbers");
      } else if (rows.empty() || numbers->size() == rows[0].size()) {
        rows.push_back(std::move(*numbers));
      } else {
        break;
      }
    }
    if (rows.empty() && promised_ != 0) file_.fail("", "holds no points");
    const size_t count = rows.empty() ? 3 : rows[0].size();
    if (!names.empty() && names.size() != count) {
      note(fmt::format("names {} columns but has {}: the names are not used", names.size(), count));
      names.clear();
    }
    if (names.empty())
      names = rows.empty() ? std::vector<Role>{Role::x, Role::y, Role::z}
                           : guess_columns(rows, is_leica_);
    roles_ = std::move(names);
    keep_whole_groups();
    file_.go_to(place);
    lines_.count_from(number);
  }

  // A colour or a normal needs all three columns; columns behind the last that is read do not
  // matter.
  void keep_whole_groups() {
    for (const Role first : {Role::red, Role::normal_x}) {
      const Role all[] = {first, Role(int(first) + 1), Role(int(first) + 2)};
      if (std::ranges::all_of(
              all, [&](Role role) { return std::ranges::find(roles_, role) != roles_.end(); }))
        continue;
      for (Role& role : roles_)
        if (std::ranges::find(all, role) != std::end(all)) role = Role::none;
    }
    const auto ignored = std::ranges::count(roles_, Role::none);
    if (ignored > 0) note(fmt::format("{} columns are not read", ignored));
    while (roles_.back() == Role::none) roles_.pop_back();
  }

  // There are no more points than lines. Who writes a count may lie.
  void count_lines() {
    const uint64_t place = file_.place();
    uint64_t lines = 0;
    bool is_within = false;
    for (std::string_view window; !(window = file_.peek(1)).empty(); file_.pass(window.size())) {
      lines += uint64_t(std::ranges::count(window, '\n'));
      is_within = window.back() != '\n';
    }
    file_.go_to(place);
    // Empty lines at the end are none.
    file_.go_to(file_.size() - std::min<uint64_t>(file_.size() - place, 4096));
    const std::string_view tail = file_.peek(4096);
    const size_t last = tail.find_last_not_of(" \t\r\n");
    if (last != std::string_view::npos) {
      lines -= uint64_t(std::ranges::count(tail.substr(last), '\n'));
      is_within = true;
    }
    file_.go_to(place);
    info_.points = lines + (is_within ? 1 : 0);
    if (info_.points < promised_)
      note(fmt::format("promises {} points, but has {} lines", promised_, info_.points));
  }

  void read_columns(PointColumns& columns, size_t most) override {
    for (const Role role : roles_)
      if (role != Role::none) columns[role].resize(most);
    columns.count = 0;
    for (std::string_view line; columns.count < most && lines_.next(line);)
      if (read_line(line, columns)) columns.count++;
  }

  bool read_line(std::string_view line, PointColumns& columns) {
    const char* at = line.data();
    const char* end = at + line.size();
    for (size_t k = 0; k < roles_.size(); k++) {
      double value = 0;
      const int found = next_number(at, end, value);
      if (found == 1) {
        if (roles_[k] != Role::none) columns[roles_[k]][columns.count] = value;
        continue;
      }
      if (k == 0 && (found == 0 || is_comment(line))) return false;
      if (k == 1 && found == 0 && is_counted_ && is_count({columns[Role::x][columns.count]}))
        return false;  // another cloud begins
      if (found < 0) file_.fail(lines_.where(), fmt::format("'{}' is no number", word_at(at, end)));
      file_.fail(lines_.where(),
                 fmt::format("has {} numbers, others have {} or more", k, roles_.size()));
    }
    return true;
  }

  InputFile file_;
  InputLines lines_;
  std::vector<Role> roles_;  // columns hold these, up to the last that is read
  bool is_counted_ = false;
  uint64_t promised_ = 0;
};

}  // namespace

std::unique_ptr<PointSource> open_text(const std::string& path) {
  return std::make_unique<TextSource>(path);
}

bool may_be_text(std::string_view head) {
  return !head.empty() && std::ranges::none_of(head, [](char letter) {
    return uint8_t(letter) < 32 && letter != '\t' && letter != '\n' && letter != '\r';
  });
}

}  // namespace wellspring::scan
