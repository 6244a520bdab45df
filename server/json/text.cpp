// SPDX-License-Identifier: Apache-2.0
#include "json/text.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/load_error.h"

namespace wellspring::json {

using nlohmann::json;

namespace {

// Builds the tree from the parser's calls. The parser itself keeps its state in a vector, so depth
// costs no stack while parsing.
class TreeBuilder {
 public:
  TreeBuilder(std::string_view text, const JsonLimits& limits) : text_(text), limits_(limits) {}
  json root;
  JsonError error;
  size_t values = 0;

  bool null() { return add(nullptr); }
  bool boolean(bool value) { return add(value); }
  bool number_integer(json::number_integer_t value) { return add(value); }
  bool number_unsigned(json::number_unsigned_t value) { return add(value); }
  bool number_float(json::number_float_t value, const std::string&) { return add(value); }
  bool string(std::string& value) { return add(std::move(value)); }
  bool binary(json::binary_t&) { return fail("bad_json", "binary values are not JSON"); }
  bool start_object(size_t) { return open(json::object()); }
  bool start_array(size_t) { return open(json::array()); }
  bool end_object() { return shut(); }
  bool end_array() { return shut(); }
  bool key(std::string& name) {
    key_ = std::move(name);
    return true;
  }
  bool parse_error(size_t position, const std::string&, const nlohmann::detail::exception& e) {
    if (e.id == 406)  // a number beyond double
      return fail("bad_field", "number out of range at " + place_of(position) +
                                   (key_.empty() ? "" : " (field '" + key_.substr(0, 64) + "')"));
    return fail("bad_json", "not JSON at " + place_of(position));
  }

 private:
  // Returns the place of the last character read, counted from 1; a column is a byte.
  std::string place_of(size_t position) const {
    std::string_view read = text_.substr(0, position > 0 ? position - 1 : 0);
    size_t line = 1 + size_t(std::count(read.begin(), read.end(), '\n'));
    size_t begin = read.rfind('\n') + 1;  // npos + 1 is 0
    return "line " + std::to_string(line) + ", column " + std::to_string(read.size() - begin + 1);
  }
  json* add(json&& value, json*& place) {
    if (open_.empty()) {
      root = std::move(value);
      place = &root;
    } else if (json& parent = *open_.back(); parent.is_array()) {
      parent.push_back(std::move(value));
      place = &parent.back();
    } else {
      place = &(parent[key_] = std::move(value));
    }
    return place;
  }
  bool add(json&& value) {
    json* place = nullptr;
    return count() && add(std::move(value), place) != nullptr;
  }
  bool count() {
    if (values >= limits_.values)
      return fail("too_large", "more than " + std::to_string(limits_.values) + " values");
    values++;
    return true;
  }
  // Opens a container. Addresses stay valid while it is open: a container only grows after its last
  // value was closed.
  bool open(json&& value) {
    if (int(open_.size()) >= limits_.depth)
      return fail("too_deep", "nested deeper than " + std::to_string(limits_.depth));
    if (!count()) return false;
    json* place = nullptr;
    open_.push_back(add(std::move(value), place));
    return true;
  }
  bool shut() {
    open_.pop_back();
    return true;
  }
  bool fail(std::string code, std::string message) {
    error = {std::move(code), std::move(message)};
    return false;
  }

  std::string_view text_;
  const JsonLimits limits_;
  std::string key_;
  std::vector<json*> open_;
};

}  // namespace

std::variant<json, JsonError> parse_json(std::string_view text, const JsonLimits& limits,
                                         size_t* values) {
  TreeBuilder builder(text, limits);
  const bool good = json::sax_parse(text.begin(), text.end(), &builder, json::input_format_t::json,
                                    true, limits.comments);
  if (values) *values = builder.values;
  if (!good) return std::move(builder.error);
  return std::move(builder.root);
}

std::string read_json_text(const std::string& file, FileKind kind) {
  return read_file(file, max_json_bytes, kind);
}

json parse_json_file(const std::string& file, std::string_view text, bool comments) {
  if (text.size() > max_json_bytes) throw LoadError(file, "", "is larger than 32 MiB");
  auto parsed = parse_json(text, {.comments = comments});
  if (const auto* error = std::get_if<JsonError>(&parsed))
    throw LoadError(file, "", error->message);
  return std::get<json>(std::move(parsed));
}

// Finds the lines of values: the parser does not say at which place it reads, so the text counts
// its lines as they are read.

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

}  // namespace wellspring::json
