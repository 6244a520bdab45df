// SPDX-License-Identifier: Apache-2.0
// Reads, writes and describes values that list their fields. A value has a function `list(value,
// fields)` which names each field once: kind, name, limits, value, what it means, and whether it
// must be there. FieldReader, FieldWriter and FieldDescriber have the same kinds, so all three
// follow from the list. A file that is only read has a function that reads it by a FieldReader;
// the same function gives its JSON Schema. A std::optional is there or is not; a text that is empty
// is not written, unless it is required.
#pragma once
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "base/vec.h"
#include "json/text.h"

namespace wellspring::json {

// Says what is wrong with the value at `where`, a JSON pointer.
struct Fault {
  std::string where, what;
  bool grave = true;  // false: the value can be used, but its author should know
};

// Takes the faults of one text. Readers go on after a fault that is kept, and leave wrong values as
// they were.
class Faults {
 public:
  Faults() = default;  // keeps the first fault
  // Throws the first fault as a LoadError of `file`. Fields that nobody asks for are faults, too,
  // if `strict`. Places begin with their line, if the file's `text` is given, which must live
  // longer.
  explicit Faults(std::string file, bool strict = false, std::string_view text = {})
      : strict(strict), file_(std::move(file)), text_(text) {}
  // Hands every fault to `tell`. Fields that nobody asks for are slight faults.
  explicit Faults(std::function<void(const Fault&)> tell) : strict(true), tell_(std::move(tell)) {}
  void add(const std::string& where, const std::string& what);
  // Adds a slight fault; it is dropped if the first grave one is all that counts.
  void add_slight(const std::string& where, const std::string& what) {
    if (tell_) tell_({where, what, false});
  }
  void add_unknown(const std::string& where, const std::string& name,
                   const std::vector<std::string>& known);
  // Adds that the value is not `kind` ("a number from 1 to 3").
  void add_kind(const std::string& where, const std::string& kind);

  std::optional<Fault> first;
  const bool strict = false;

 private:
  std::string file_;
  std::string_view text_;
  std::function<void(const Fault&)> tell_;
};

// Refers to one value and its place. Both arguments are borrowed and must live longer. These return
// true if the value is good, and write it only then.
class JsonValue {
 public:
  JsonValue(const nlohmann::json& value, Faults& faults, std::string where = "")
      : value_(&value), faults_(&faults), where_(std::move(where)) {}
  bool number(double low, double high, double& to) const;
  bool number(double low, double high, float& to) const;
  bool whole(double low, double high, double& to) const;
  bool boolean(bool& to) const;
  // Reads a text of at most `most_bytes`, without control characters.
  bool text(std::string& to, size_t most_bytes = max_text_bytes, Need need = Need::optional) const;
  // Reads one of `words`, or an optional empty text; returns its index, or -1.
  int word(std::initializer_list<const char*> words, Need need = Need::optional) const;
  // Reads exactly `count` numbers.
  bool numbers(int count, double low, double high, double* to) const;
  // Returns the entries of a list, the first `most` of too many. `kind` names them in a fault.
  std::vector<JsonValue> list(size_t least, size_t most, const char* kind = "entries") const;
  bool object() const;  // whether it is one; otherwise a fault
  // Returns the member, or an absent optional; `name` must be one of an object.
  std::optional<JsonValue> find(const char* name) const;
  void fail(const std::string& what) const {
    if (faults_) faults_->add(where_, what);
  }
  void fail_kind(const std::string& kind) const {
    if (faults_) faults_->add_kind(where_, kind);
  }
  const nlohmann::json& value() const { return *value_; }
  const std::string& where() const { return where_; }

 protected:
  explicit JsonValue(const nlohmann::json& value) : value_(&value) {}
  const nlohmann::json* value_;
  Faults* faults_ = nullptr;  // null: faults are not told
  std::string where_;
};

// Takes the fields that a value lists out of an object; each function reads one kind of field.
// Absent fields keep the value's defaults. The functions return whether the field is there and
// good.
class FieldReader : public JsonValue {
 public:
  explicit FieldReader(const JsonValue& value);
  FieldReader(const nlohmann::json& object, Faults& faults)
      : FieldReader(JsonValue(object, faults)) {}
  // Describes instead: each field that is asked for is noted in `schema`, a JSON Schema of an
  // object (draft 2020-12), and none is there. The schema is borrowed.
  explicit FieldReader(nlohmann::ordered_json& schema);
  // Returns whether it describes; a reader then asks for all fields that there may be.
  bool describes() const { return schema_ != nullptr; }
  bool has(const char* name) const { return value_->contains(name); }

  bool text(const char* name, std::string& to, const char* about = "", Need need = Need::optional,
            size_t most_bytes = max_text_bytes);
  // Reads a text that this server sealed before (wire/tokens.h).
  bool token(const char* name, std::string& to, const char* about);
  // Reads a name: 1 to 64 letters, digits, '_', '-' and '.'.
  bool name(const char* name, std::string& to, const char* about, Need need = Need::optional);
  // Reads one of `words`; an optional one may be empty.
  bool word(const char* name, std::initializer_list<const char*> words, std::string& to,
            const char* about, Need need = Need::optional);
  // Reads one of `words`, which name the values of an enumeration in order.
  template <class Choice>
  bool choice(const char* name, std::initializer_list<const char*> words, Choice& to,
              const char* about, Need need = Need::optional) {
    if (schema_) return note(name, {{"enum", words}}, about, need);
    const auto field = take(name, need);
    const int index = field ? field->word(words, need) : -1;
    if (index >= 0) to = Choice(index);
    return index >= 0;
  }
  template <class Value>
  bool number(const char* name, double low, double high, Value& to, const char* about = "",
              Need need = Need::optional) {
    if (schema_)
      return note(name, {{"type", "number"}, {"minimum", low}, {"maximum", high}}, about, need);
    const auto field = take(name, need);
    return field && read(to, [&](auto& v) { return field->number(low, high, v); });
  }
  // Reads a number; null counts as absent.
  void number_or_null(const char* name, double low, double high, std::optional<double>& to,
                      const char* about) {
    if (const auto field = find(name); field && !field->value().is_null())
      number(name, low, high, to, about);
  }
  template <class Value>
  bool integer(const char* name, double low, double high, Value& to, const char* about = "",
               Need need = Need::optional) {
    if (schema_)
      return note(name, {{"type", "integer"}, {"minimum", low}, {"maximum", high}}, about, need);
    const auto field = take(name, need);
    double whole = 0;
    if (field && field->whole(low, high, whole)) return to = int64_t(whole), true;
    return false;
  }
  bool u32(const char* name, uint32_t& to, const char* about = "", Need need = Need::optional) {
    return integer(name, 0, 4294967295.0, to, about, need);
  }
  template <class Value>
  bool boolean(const char* name, Value& to, const char* about = "", Need need = Need::optional) {
    if (schema_) return note(name, {{"type", "boolean"}}, about, need);
    const auto field = take(name, need);
    return field && read(to, [&](bool& v) { return field->boolean(v); });
  }
  // Reads true or false, or a number.
  void switch_or_number(const char* name, double low, double high,
                        std::optional<std::variant<bool, float>>& to, const char* about,
                        Need need = Need::optional);
  // Reads a vector each number of which is at most `limit`, of either sign.
  template <class Vector>
  bool vector(const char* name, double limit, Vector& to, const char* about = "",
              Need need = Need::optional) {
    if (schema_)
      return note(name, list_schema({{"type", "number"}}, to.length(), to.length()), about, need);
    const auto field = take(name, need);
    double numbers[4];
    if (!field || !field->numbers(to.length(), -limit, limit, numbers)) return false;
    for (int i = 0; i < to.length(); i++) to[i] = typename Vector::value_type(numbers[i]);
    return true;
  }
  // Reads a place in a picture: both numbers from 0 to 1.
  void place(const char* name, std::optional<vec2>& to, const char* about,
             Need need = Need::optional);
  // Reads a place in the world: each number at most `limit`, of either sign.
  void spot(const char* name, double limit, std::optional<dvec3>& to, const char*,
            Need need = Need::optional);
  // Reads a speed in metres a second: its length is at most `limit`, too.
  void speed(const char* name, double limit, vec3& to, const char*, Need need = Need::optional);
  // Reads an object within this one by each(FieldReader&).
  template <class Each>
  bool part(const char* name, const char* about, const Each& each, Need need = Need::optional) {
    if (schema_) return note(name, object_schema(each), about, need);
    const auto field = take(name, need);
    if (!field) return false;
    read_object(*field, each);
    return true;
  }
  // Reads a list of objects by each(FieldReader&).
  template <class Each>
  void parts(const char* name, size_t most, const char* about, const Each& each,
             Need need = Need::optional) {
    if (schema_) note(name, list_schema(object_schema(each), 0, most), about, need);
    const auto field = take(name, need);
    if (!field) return;
    for (const JsonValue& one : field->list(0, most)) read_object(one, each);
  }
  // Reads an object whose members have names that are free and are objects, each by
  // each(const std::string& name, FieldReader&).
  template <class Each>
  void members(const char* name, const char* about, const Each& each) {
    if (schema_) {
      auto one = [&](FieldReader& fields) { each("", fields); };
      note(name, map_schema(object_schema(one)), about, Need::optional);
    }
    const auto field = take(name);
    if (!field || !field->object()) return;
    for (const auto& member : field->value().items())
      read_object(JsonValue(member.value(), *faults_, field->where() + "/" + member.key()),
                  [&](FieldReader& fields) { each(member.key(), fields); });
  }
  // Reads an angle in degrees, as radians.
  bool degrees(const char* name, double low, double high, float& to, const char* = "",
               Need need = Need::optional);
  // Returns exactly `count` numbers; the field is required.
  std::vector<double> numbers(const char* name, size_t count, double low, double high);
  // Returns the entries of a list; none where there is no such field.
  std::vector<JsonValue> list(const char* name, size_t least, size_t most, const char* kind,
                              Need need = Need::optional);
  // Returns all members, for objects whose names are free.
  std::vector<std::pair<std::string, JsonValue>> members();
  // Returns the field's value, for kinds that only one file has.
  std::optional<JsonValue> take(const char* name, Need need = Need::optional);
  // The same, where `kind` is its JSON Schema.
  std::optional<JsonValue> take(const char* name, const nlohmann::ordered_json& kind,
                                const char* about, Need need = Need::optional);
  // Reads an object by each(FieldReader&).
  template <class Each>
  static void read_object(const JsonValue& value, const Each& each) {
    if (!value.object()) return;
    FieldReader fields(value);
    each(fields);
    fields.finish();
  }
  using JsonValue::fail;
  // Adds a fault of a field.
  void fail(const std::string& name, const std::string& what) {
    if (faults_) faults_->add(where_ + "/" + name, what);
  }
  // Adds a slight fault of a field, or of the object if `name` is empty.
  void warn(const std::string& name, const std::string& what) {
    if (faults_) faults_->add_slight(name.empty() ? where_ : where_ + "/" + name, what);
  }
  // Adds the fields that were not asked for, where faults are strict.
  void finish() const;
  // Says in the schema that one of these sets of fields is there, and no other.
  void describe_choice(std::initializer_list<std::initializer_list<const char*>> sets) const;

  // Returns the JSON Schema of an object that is read by each(FieldReader&).
  template <class Each>
  static nlohmann::ordered_json object_schema(const Each& each) {
    nlohmann::ordered_json schema;
    FieldReader fields(schema);
    each(fields);
    fields.finish();
    return schema;
  }
  // Returns that of a list with `least` to `most` entries, SIZE_MAX: any number; and of an object
  // whose names are free.
  static nlohmann::ordered_json list_schema(const nlohmann::ordered_json& entry, size_t least,
                                            size_t most = SIZE_MAX);
  static nlohmann::ordered_json map_schema(const nlohmann::ordered_json& member);

 private:
  // Notes a field in the schema; returns false, since none is there.
  bool note(const char* name, nlohmann::ordered_json kind, const char* about, Need need);

  template <class Value, class Read>
  static bool read(Value& to, const Read& read) {
    return read(to);
  }
  template <class Value, class Read>
  static bool read(std::optional<Value>& to, const Read& read) {
    Value found{};
    return read(found) && (to = found, true);
  }
  std::vector<std::string> known_;
  nlohmann::ordered_json* schema_ = nullptr;
};

// Writes the fields that a value lists.
class FieldWriter {
 public:
  nlohmann::ordered_json out = nlohmann::ordered_json::object();

  void token(const char* name, const std::string& value, const char* about) {
    text(name, value, about);
  }
  void text(const char* name, const std::string& value, const char*, Need need = Need::optional) {
    if (need == Need::required || !value.empty()) out[name] = value;
  }
  void word(const char* name, std::initializer_list<const char*>, const std::string& value,
            const char* about, Need need = Need::optional) {
    text(name, value, about, need);
  }
  template <class Choice>
  void choice(const char* name, std::initializer_list<const char*> words, Choice value, const char*,
              Need = Need::optional) {
    out[name] = words.begin()[size_t(value)];
  }
  template <class Value>
  void number(const char* name, double, double, const Value& value, const char*,
              Need = Need::optional) {
    put(name, value);
  }
  void number_or_null(const char* name, double, double, const std::optional<double>& value,
                      const char*) {
    put(name, value);
  }
  template <class Value>
  void integer(const char* name, int, int, const Value& value, const char*, Need = Need::optional) {
    put(name, value);
  }
  void u32(const char* name, uint32_t value, const char*, Need = Need::optional) {
    put(name, value);
  }
  template <class Value>
  void boolean(const char* name, const Value& value, const char*, Need = Need::optional) {
    put(name, value);
  }
  void switch_or_number(const char* name, double, double,
                        const std::optional<std::variant<bool, float>>& value, const char*,
                        Need = Need::optional) {
    if (value) std::visit([&](auto one) { out[name] = one; }, *value);
  }
  void place(const char* name, const std::optional<vec2>& value, const char* about,
             Need need = Need::optional) {
    if (value) vector(name, 1, *value, about, need);
  }
  void spot(const char* name, double limit, const std::optional<dvec3>& value, const char* about,
            Need need = Need::optional) {
    if (value) vector(name, limit, *value, about, need);
  }
  template <class Vector>
  void vector(const char* name, double, const Vector& value, const char*, Need = Need::optional) {
    nlohmann::ordered_json numbers = nlohmann::ordered_json::array();
    for (int i = 0; i < value.length(); i++) numbers.push_back(value[i]);
    out[name] = std::move(numbers);
  }
  void speed(const char* name, double limit, const vec3& value, const char* about,
             Need need = Need::optional) {
    vector(name, limit, value, about, need);
  }

 private:
  template <class Value>
  void put(const char* name, const Value& value) {
    out[name] = value;
  }
  template <class Value>
  void put(const char* name, const std::optional<Value>& value) {
    if (value) out[name] = *value;
  }
};

// Notes the meaning of each field that a value lists.
struct FieldDescriber {
  nlohmann::json out = nlohmann::json::object();

  void text(const char* name, const std::string&, const char* about, Need = Need::optional) {
    out[name] = about;
  }
  void token(const char* name, const std::string&, const char* about) { out[name] = about; }
  void word(const char* name, std::initializer_list<const char*>, const std::string&,
            const char* about, Need = Need::optional) {
    out[name] = about;
  }
  void choice(const char* name, std::initializer_list<const char*>, const auto&, const char* about,
              Need = Need::optional) {
    out[name] = about;
  }
  void number(const char* name, double, double, const auto&, const char* about,
              Need = Need::optional) {
    out[name] = about;
  }
  void number_or_null(const char* name, double, double, const auto&, const char* about) {
    out[name] = about;
  }
  void integer(const char* name, int, int, const auto&, const char* about, Need = Need::optional) {
    out[name] = about;
  }
  void u32(const char* name, uint32_t, const char* about, Need = Need::optional) {
    out[name] = about;
  }
  void boolean(const char* name, const auto&, const char* about, Need = Need::optional) {
    out[name] = about;
  }
  void switch_or_number(const char* name, double, double, const auto&, const char* about,
                        Need = Need::optional) {
    out[name] = about;
  }
  void place(const char* name, const auto&, const char* about, Need = Need::optional) {
    out[name] = about;
  }
  void spot(const char* name, double, const auto&, const char* about, Need = Need::optional) {
    out[name] = about;
  }
  void vector(const char* name, double, const auto&, const char* about, Need = Need::optional) {
    out[name] = about;
  }
  void speed(const char* name, double, const auto&, const char* about, Need = Need::optional) {
    out[name] = about;
  }
};

}  // namespace wellspring::json
