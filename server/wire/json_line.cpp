// SPDX-License-Identifier: Apache-2.0
// Finds the lines of values: the parser does not say at which place it reads, so the text counts
// its lines as they are read.
#include "wire/json_line.h"

#include <cstddef>
#include <iterator>
#include <nlohmann/json.hpp>
#include <vector>

namespace wellspring::wire {

using nlohmann::json;

namespace {

struct Lines {
  int ended = 0;
  bool last_ended = false;  // the last character that was read ended a line
};

// Iterates over the characters of a text, and counts the lines that have been read.
struct CountedText {
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;
  const char* at = nullptr;
  Lines* lines = nullptr;
  const char& operator*() const { return *at; }
  CountedText& operator++() {
    lines->last_ended = *at++ == '\n';
    lines->ended += lines->last_ended;
    return *this;
  }
  CountedText operator++(int) {
    CountedText before = *this;
    ++*this;
    return before;
  }
  bool operator==(const CountedText& other) const { return at == other.at; }
};

// Follows the places of all values, and notes the line of one.
class PlaceFinder {
 public:
  PlaceFinder(const std::string& wanted, const Lines& lines) : wanted_(wanted), lines_(lines) {}
  int found = 0;

  bool null() { return value(); }
  bool boolean(bool) { return value(); }
  bool number_integer(json::number_integer_t) { return value(); }
  bool number_unsigned(json::number_unsigned_t) { return value(); }
  bool number_float(json::number_float_t, const std::string&) { return value(); }
  bool string(std::string&) { return value(); }
  bool binary(json::binary_t&) { return value(); }
  bool start_object(size_t) { return open(false); }
  bool start_array(size_t) { return open(true); }
  bool end_object() { return shut(); }
  bool end_array() { return shut(); }
  bool key(std::string& name) {
    open_.back().place = open_.back().where + "/" + name;
    note(open_.back().place);
    return true;
  }
  bool parse_error(size_t, const std::string&, const nlohmann::detail::exception&) { return false; }

 private:
  struct Level {
    std::string where, place;  // places of the container, and of its next value
    bool list = false;
    size_t next = 0;
  };
  // Notes the line of a value. The parser reads a number up to the character after it, which may
  // end the line.
  void note(const std::string& place) {
    if (place == wanted_) found = 1 + lines_.ended - (lines_.last_ended ? 1 : 0);
  }
  std::string begin() {
    if (open_.empty()) return "";
    Level& level = open_.back();
    if (!level.list) return level.place;
    level.place = level.where + "/" + std::to_string(level.next++);
    note(level.place);
    return level.place;
  }
  bool value() {
    begin();
    return true;
  }
  bool open(bool list) {
    std::string where = begin();
    if (open_.empty()) note(where);
    open_.push_back({std::move(where), "", list, 0});
    return true;
  }
  bool shut() {
    open_.pop_back();
    return true;
  }

  const std::string& wanted_;
  const Lines& lines_;
  std::vector<Level> open_;
};

}  // namespace

int find_json_line(std::string_view text, const std::string& place) {
  Lines lines;
  PlaceFinder finder(place, lines);
  json::sax_parse(CountedText{text.data(), &lines}, CountedText{text.data() + text.size(), &lines},
                  &finder);
  return finder.found;
}

}  // namespace wellspring::wire
