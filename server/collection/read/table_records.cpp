// SPDX-License-Identifier: Apache-2.0
// Tables of records (RFC 4180): cells in quotes may hold separators and lines.
#include <algorithm>
#include <array>
#include <utility>

#include "base/load_error.h"
#include "base/unicode.h"
#include "collection/read/raw_record.h"

namespace wellspring::collection {

namespace {

constexpr size_t most_columns = 1024;

std::string line_name(int line) { return "line " + std::to_string(line); }

// Takes rows off a text, one by one.
class TableReader {
 public:
  TableReader(const std::string& file, std::string_view text) : file_(file), rest_(text) {
    if (rest_.starts_with("\xef\xbb\xbf")) rest_.remove_prefix(3);
    const std::string_view head = rest_.substr(0, rest_.find('\n'));
    size_t most = 0;
    for (const char c : {',', ';', '\t'})
      if (const size_t count = size_t(std::ranges::count(head, c)); count > most)
        most = count, separator_ = c;
  }
  // Returns false at the end. Empty lines are left out.
  bool next(std::vector<std::string>& cells) {
    while (rest_.starts_with('\n') || rest_.starts_with("\r\n"))
      rest_.remove_prefix(rest_[0] == '\r' ? 2 : 1), next_line_++;
    if (rest_.empty()) return false;
    line_ = next_line_;
    cells.clear();
    const size_t before = rest_.size();
    while (true) {
      if (cells.size() >= most_columns)
        throw LoadError(file_, line_name(line_),
                        "more than " + std::to_string(most_columns) + " columns");
      cells.push_back(rest_.starts_with('"') ? quoted() : plain());
      if (before - rest_.size() > most_record_bytes)
        throw LoadError(file_, line_name(line_), "the record is larger than 1 MB");
      if (rest_.starts_with(separator_)) {
        rest_.remove_prefix(1);
        continue;
      }
      if (rest_.starts_with("\r\n")) rest_.remove_prefix(1);
      if (!rest_.empty()) rest_.remove_prefix(1), next_line_++;
      return true;
    }
  }
  int line() const { return line_; }

 private:
  std::string plain() {
    size_t end = 0;
    while (end < rest_.size() && rest_[end] != separator_ && rest_[end] != '\n') end++;
    std::string cell(rest_.substr(0, end));
    rest_.remove_prefix(end);
    if (rest_.starts_with('\n') && cell.ends_with('\r')) cell.pop_back();
    return cell;
  }
  std::string quoted() {
    std::string cell;
    size_t i = 1;
    for (; i < rest_.size(); i++) {
      if (rest_[i] == '\n') next_line_++;
      if (rest_[i] != '"') {
        cell += rest_[i];
      } else if (i + 1 < rest_.size() && rest_[i + 1] == '"') {
        cell += '"', i++;
      } else {
        break;
      }
    }
    if (i >= rest_.size())
      throw LoadError(file_, line_name(line_), "a quote is opened and never closed");
    rest_.remove_prefix(i + 1);
    return cell + plain();
  }

  const std::string& file_;
  std::string_view rest_;
  char separator_ = ',';
  int line_ = 0, next_line_ = 1;
};

bool is_utf8(std::string_view text) {
  for (size_t i = 0; i < text.size();) {
    const uint8_t c = uint8_t(text[i]);
    const size_t more = c < 0x80 ? 0 : c >= 0xc2 && c < 0xe0 ? 1 : c < 0xf0 ? 2 : 3;
    if ((c >= 0x80 && c < 0xc2) || c > 0xf4 || i + more >= text.size()) return false;
    for (size_t k = 1; k <= more; k++)
      if ((uint8_t(text[i + k]) & 0xc0) != 0x80) return false;
    i += more + 1;
  }
  return true;
}

// Returns the column of each of field_choices(); -1: there is none.
std::vector<int> find_columns(const std::string& file, int line,
                              const std::vector<std::string>& head, const FieldNames& names) {
  std::vector<int> columns;
  for (const FieldChoice& choice : field_choices()) {
    const std::string& named = names.*choice.name;
    int found = -1;
    if (!named.empty()) {
      for (size_t i = 0; i < head.size() && found < 0; i++)
        if (clean_text(head[i]) == named) found = int(i);
      if (found < 0)
        throw LoadError(file, line_name(line),
                        "no column is named '" + named + "', which is to hold the " + choice.role +
                            did_you_mean(named, head));
    }
    for (size_t k = 0; k < choice.usual.size() && named.empty() && found < 0; k++)
      for (size_t i = 0; i < head.size() && found < 0; i++)
        if (small_letters(clean_text(head[i])) == choice.usual[k]) found = int(i);
    columns.push_back(found);
  }
  return columns;
}

}  // namespace

void read_table(Gathering& to, std::string_view text, const FieldNames& names) {
  TableReader reader(to.file(), text);
  std::vector<std::string> head, cells;
  if (!reader.next(head)) throw LoadError(to.file(), "", "the file is empty");
  const std::vector<int> columns = find_columns(to.file(), reader.line(), head, names);
  if (std::ranges::all_of(columns, [](int one) { return one < 0; }))
    throw LoadError(to.file(), line_name(reader.line()),
                    "no column is known by its name; \"fields\" can tell which they are");
  while (reader.next(cells)) {
    const std::string where = line_name(reader.line());
    if (cells.size() != head.size()) {
      to.note(where, "the row has " + std::to_string(cells.size()) + " cells, the first line " +
                         std::to_string(head.size()) + "; it is left out");
      continue;
    }
    for (const std::string& cell : cells)
      if (!is_utf8(cell))
        throw LoadError(to.file(), where, "the text is not UTF-8; please save the table as UTF-8");
    auto cell = [&](size_t field) {
      return columns[field] < 0 ? std::string() : cells[size_t(columns[field])];
    };
    RawRecord raw;
    raw.id = cell(0), raw.title = cell(1), raw.maker = cell(2), raw.date = cell(3);
    raw.subjects = split_list(cell(4)), raw.materials = split_materials(cell(5));
    for (const std::string& color : split_list(cell(6))) raw.colors.emplace_back(color, 1);
    raw.link = clean_text(cell(7)), raw.picture = clean_text(cell(8));
    to.add(std::move(raw), where);
  }
}

}  // namespace wellspring::collection
