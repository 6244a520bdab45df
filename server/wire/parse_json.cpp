// SPDX-License-Identifier: Apache-2.0
// Text to a tree of values, stopping at the first value beyond the limits.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "wire/json.h"

namespace wellspring::wire {

using nlohmann::json;

namespace {

// What the parser tells us, put together. The parser itself keeps its state in a vector, so depth
// costs no stack while parsing.
class TreeBuilder {
 public:
  TreeBuilder(std::string_view text, const JsonLimits& limits) : text_(text), limits_(limits) {}
  json root;
  WireError error;
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
  // Of the last character read, counted from 1; a column is a byte.
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
  // Addresses stay valid while open: a container only grows after what it holds was shut.
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

std::variant<json, WireError> parse_json(std::string_view text, const JsonLimits& limits,
                                         size_t* values) {
  TreeBuilder builder(text, limits);
  const bool good = json::sax_parse(text.begin(), text.end(), &builder);
  if (values) *values = builder.values;
  if (!good) return std::move(builder.error);
  return std::move(builder.root);
}

}  // namespace wellspring::wire
