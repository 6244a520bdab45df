// SPDX-License-Identifier: Apache-2.0
// Records as JSON: flat ones, Linked Art's and Tate's.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/load_error.h"
#include "collection/read/raw_record.h"
#include "json/text.h"

namespace wellspring::collection {

using nlohmann::json;

namespace {

constexpr size_t most_record_values = 100'000;

const json* member(const json& object, const std::string& name) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(name);
  return found == object.end() || found->is_null() ? nullptr : &*found;
}

// Returns the value as a text: what it is named by, if it is an object; "" if it is none.
std::string text_of(const json* value) {
  if (!value) return "";
  if (value->is_string()) return value->get<std::string>();
  if (value->is_number_integer()) return std::to_string(value->get<int64_t>());
  if (value->is_number()) {
    const double number = value->get<double>();
    return number == std::floor(number) && std::abs(number) < 1e15 ? std::to_string(int64_t(number))
                                                                   : std::to_string(number);
  }
  for (const char* name : {"_label", "name", "label", "title", "content", "fc"})
    if (const json* found = member(*value, name); found && found->is_string())
      return found->get<std::string>();
  return "";
}
std::string text_of(const json& object, const char* name) { return text_of(member(object, name)); }

// Returns the entries of a list, or the value itself.
std::vector<const json*> entries(const json* value) {
  std::vector<const json*> found;
  if (!value) return found;
  if (!value->is_array()) return {value};
  for (const json& one : *value) found.push_back(&one);
  return found;
}

void add_texts(const json* value, std::vector<std::string>& to) {
  for (const json* one : entries(value))
    if (std::string text = text_of(one); !text.empty()) to.push_back(std::move(text));
}

// Tells which members of flat records are used, found in the record itself.
const json* field_of(const json& record, const FieldChoice& choice, const FieldNames& names) {
  if (const std::string& named = names.*choice.name; !named.empty()) return member(record, named);
  for (const char* usual : choice.usual)
    for (const auto& [name, value] : record.items()) {
      if (value.is_null() || name.size() != std::char_traits<char>::length(usual)) continue;
      const bool same = std::ranges::equal(name, std::string_view(usual), [](char a, char b) {
        return a == b || (a >= 'A' && a <= 'Z' && a - 'A' + 'a' == b);
      });
      if (same) return &value;
    }
  return nullptr;
}

// Reads "#rrggbb", or {"color": "#rrggbb", "weight": 3}.
void add_color(const json& value, std::vector<std::pair<std::string, double>>& to) {
  if (!value.is_object()) return to.emplace_back(text_of(&value), 1), void();
  std::string color;
  for (const char* name : {"color", "colour", "hex"})
    if (color.empty()) color = text_of(value, name);
  double weight = 1;
  for (const char* name : {"weight", "percent", "share"})
    if (const json* found = member(value, name); found && found->is_number())
      weight = found->get<double>();
  to.emplace_back(std::move(color), weight);
}

RawRecord flat_record(const json& record, const FieldNames& names) {
  RawRecord raw;
  for (const FieldChoice& choice : field_choices()) {
    const json* value = field_of(record, choice, names);
    if (!value) continue;
    const std::string_view role = choice.role;
    auto joined = [&] {
      std::vector<std::string> texts;
      add_texts(value, texts);
      std::string all;
      for (const std::string& one : texts) all += (all.empty() ? "" : "; ") + one;
      return all;
    };
    if (role == "id") raw.id = joined();
    if (role == "title") raw.title = joined();
    if (role == "maker") raw.maker = joined();
    if (role == "link") raw.link = joined();
    if (role == "picture") raw.picture = joined();
    if (role == "date") {
      raw.date = joined();
      if (value->is_number()) raw.year = value->get<double>();
    }
    if (role == "subjects" && value->is_string()) raw.subjects = split_list(text_of(value));
    else if (role == "subjects") add_texts(value, raw.subjects);
    if (role == "materials" && value->is_string()) raw.materials = split_materials(text_of(value));
    else if (role == "materials") add_texts(value, raw.materials);
    if (role == "colors" && value->is_string()) {
      for (const std::string& one : split_list(text_of(value))) raw.colors.emplace_back(one, 1);
    } else if (role == "colors") {
      for (const json* one : entries(value)) add_color(*one, raw.colors);
    }
  }
  return raw;
}

// Takes the leaves of Tate's tree of subjects. Depth is bounded by that of JSON.
void add_leaves(const json& node, bool is_root, std::vector<std::string>& to) {
  const json* children = member(node, "children");
  if (children && children->is_array() && !children->empty()) {
    for (const json& one : *children) add_leaves(one, false, to);
  } else if (!is_root) {
    if (std::string name = text_of(&node); !name.empty()) to.push_back(std::move(name));
  }
}

RawRecord tate_record(const json& record) {
  RawRecord raw;
  raw.id = text_of(record, "acno"), raw.title = text_of(record, "title");
  raw.maker = text_of(record, "all_artists"), raw.date = text_of(record, "dateText");
  raw.link = text_of(record, "url"), raw.picture = text_of(record, "thumbnailUrl");
  raw.materials = split_materials(text_of(record, "medium"));
  if (const json* subjects = member(record, "subjects")) add_leaves(*subjects, true, raw.subjects);
  if (const json* range = member(record, "dateRange")) {
    std::vector<double> years;
    for (const char* end : {"startYear", "endYear"})
      if (const json* year = member(*range, end); year && year->is_number())
        years.push_back(year->get<double>());
    if (!years.empty()) raw.year = (years.front() + years.back()) / 2;
  }
  return raw;
}

// Reads an object of Linked Art (linked.art), as far as a map needs it.
RawRecord linked_record(const json& record) {
  RawRecord raw;
  raw.id = text_of(record, "id"), raw.link = raw.id;
  raw.title = text_of(record, "_label");
  for (const json* one : entries(member(record, "identified_by"))) {
    const std::string type = text_of(*one, "type");
    if (raw.title.empty() && type == "Name") raw.title = text_of(*one, "content");
    if (type == "Identifier" && raw.id.empty()) raw.id = text_of(*one, "content");
  }
  for (const json* made : entries(member(record, "produced_by"))) {
    std::vector<std::string> makers;
    add_texts(member(*made, "carried_out_by"), makers);
    for (const json* part : entries(member(*made, "part")))
      add_texts(member(*part, "carried_out_by"), makers);
    for (const std::string& one : makers) raw.maker += (raw.maker.empty() ? "" : ", ") + one;
    if (const json* span = member(*made, "timespan"); span) {
      const json& first = *entries(span)[0];
      const std::string from = text_of(first, "begin_of_the_begin");
      const std::string to = text_of(first, "end_of_the_end");
      const std::optional<double> begin = find_year(from.substr(0, from.find('-', 1)));
      const std::optional<double> end = find_year(to.substr(0, to.find('-', 1)));
      if (begin) raw.year = end ? (*begin + *end) / 2 : *begin;
      raw.date = text_of(&first);
      for (const json* name : entries(member(first, "identified_by")))
        if (raw.date.empty()) raw.date = text_of(*name, "content");
      if (raw.date.empty() && raw.year) raw.date = std::to_string(int(std::lround(*raw.year)));
    }
  }
  add_texts(member(record, "made_of"), raw.materials);
  add_texts(member(record, "classified_as"), raw.subjects);
  add_texts(member(record, "represents"), raw.subjects);
  for (const json* shown : entries(member(record, "shows"))) {
    add_texts(member(*shown, "represents"), raw.subjects);
    add_texts(member(*shown, "about"), raw.subjects);
  }
  for (const json* view : entries(member(record, "representation")))
    for (const json* digital : entries(member(*view, "digitally_shown_by")))
      for (const json* point : entries(member(*digital, "access_point")))
        if (raw.picture.empty()) raw.picture = text_of(*point, "id");
  return raw;
}

bool is_linked_art(const json& record) {
  const json* context = member(record, "@context");
  return text_of(record, "type") == "HumanMadeObject" ||
         (context && context->dump().find("linked.art") != std::string::npos);
}

// Counts for which named fields a record was found.
struct NamedFields {
  std::vector<std::pair<const FieldChoice*, bool>> all;
  explicit NamedFields(const FieldNames& names) {
    for (const FieldChoice& choice : field_choices())
      if (!(names.*choice.name).empty()) all.emplace_back(&choice, false);
  }
  void look(const json& record, const FieldNames& names) {
    for (auto& [choice, found] : all) found = found || member(record, names.*choice->name);
  }
  void check(const std::string& file, const FieldNames& names) const {
    for (const auto& [choice, found] : all)
      if (!found)
        throw LoadError(file, "",
                        "no record has a field '" + names.*choice->name +
                            "', which is to hold the " + choice->role);
  }
};

// Returns true for records whose fields have their own names.
bool add_record(Gathering& to, const json& record, int line, const FieldNames& names,
                NamedFields& named) {
  const std::string where = "line " + std::to_string(line);
  if (!record.is_object()) {
    to.note(where, "a record is no JSON object; it is left out");
    return false;
  }
  const bool linked = is_linked_art(record);
  const bool tate = record.contains("acno") && record.contains("all_artists");
  named.look(record, names);
  to.add(linked ? linked_record(record)
         : tate ? tate_record(record)
                : flat_record(record, names),
         where);
  return linked || tate;
}

// Adds to the line that a message of the parser names.
std::string move_line(const std::string& message, int lines) {
  const size_t at = message.find("line ");
  int line = 0;
  if (at == std::string::npos) return message;
  const char* begin = message.data() + at + 5;
  const char* end = std::from_chars(begin, message.data() + message.size(), line).ptr;
  return message.substr(0, at + 5) + std::to_string(line + lines) +
         message.substr(size_t(end - message.data()));
}

json parse(const Gathering& to, std::string_view text, int line) {
  const std::string where = "line " + std::to_string(line);
  if (text.size() > most_record_bytes)
    throw LoadError(to.file(), where, "the record is larger than 1 MB");
  auto parsed = parse_json(text, {.values = most_record_values});
  if (const auto* error = std::get_if<JsonError>(&parsed))
    throw LoadError(to.file(), where, move_line(error->message, line - 1));
  return std::get<nlohmann::json>(std::move(parsed));
}

// Finds where values begin and end, so that one record at a time is made, and its line is known.
// The parser looks at each afterwards.
class Scanner {
 public:
  explicit Scanner(std::string_view text) : text_(text) {
    if (text.starts_with("\xef\xbb\xbf")) at_ = 3;
  }
  size_t at() const { return at_; }
  int line() const { return line_; }
  // Returns the next character that is no blank; 0: there is none.
  char peek() {
    while (at_ < text_.size() &&
           std::string_view(" \t\r\n").find(text_[at_]) != std::string_view::npos)
      step();
    return at_ < text_.size() ? text_[at_] : 0;
  }
  bool skip(char c) { return peek() == c && (step(), true); }
  // Takes the value that begins here; at least one character, unless the text is at its end.
  std::string_view value() {
    peek();
    const size_t begin = at_;
    int depth = 0;
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '"') {
        string();
      } else if (c == '[' || c == '{') {
        depth++, step();
      } else if (c == ']' || c == '}') {
        if (depth == 0) break;
        depth--, step();
      } else if (depth == 0 && std::string_view(",: \t\r\n").find(c) != std::string_view::npos) {
        break;
      } else {
        step();
      }
      if (depth == 0 && (c == '"' || c == ']' || c == '}')) break;
    }
    if (at_ == begin && at_ < text_.size()) step();
    return text_.substr(begin, at_ - begin);
  }

 private:
  void step() { line_ += text_[at_++] == '\n'; }
  void string() {
    for (step(); at_ < text_.size(); step()) {
      if (text_[at_] == '\\') {
        step();
        if (at_ >= text_.size()) return;
      } else if (text_[at_] == '"') {
        return step();
      }
    }
  }
  std::string_view text_;
  size_t at_ = 0;
  int line_ = 1;
};

// Names the members of an object that hold records.
constexpr std::string_view list_names[] = {"items",    "records",      "objects", "data",
                                           "artworks", "orderedItems", "@graph"};

// Goes to the list of records within the object that begins here. Returns false if it has none.
bool find_list(Scanner& scanner) {
  if (!scanner.skip('{')) return false;
  while (scanner.peek() == '"') {
    std::string_view name = scanner.value();
    name = name.size() >= 2 ? name.substr(1, name.size() - 2) : "";
    if (!scanner.skip(':')) return false;
    const bool is_list = std::ranges::find(list_names, name) != std::end(list_names);
    if (is_list && scanner.peek() == '[') return true;
    scanner.value();
    if (!scanner.skip(',')) return false;
  }
  return false;
}

}  // namespace

bool has_json_lines(std::string_view text) {
  Scanner scanner(text);
  if (scanner.peek() != '{') return false;
  scanner.value();
  return scanner.peek() == '{';
}

void read_json_lines(Gathering& to, std::string_view text, const FieldNames& names) {
  NamedFields named(names);
  bool linked = false;
  int line = 1;
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  for (; !text.empty(); line++) {
    const size_t end = std::min(text.find('\n'), text.size());
    const std::string_view one = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (one.find_first_not_of(" \t\r") == std::string_view::npos) continue;
    linked = add_record(to, parse(to, one, line), line, names, named) || linked;
  }
  if (!linked) named.check(to.file(), names);
}

void read_json(Gathering& to, std::string_view text, const FieldNames& names) {
  NamedFields named(names);
  bool linked = false;
  Scanner scanner(text), within(text);
  if (scanner.peek() == 0) throw LoadError(to.file(), "", "the file is empty");
  const bool wrapped = scanner.peek() == '{' && find_list(within);
  if (scanner.peek() != '[' && !wrapped) {
    linked = add_record(to, parse(to, text, 1), 1, names, named);
  } else {
    if (wrapped) scanner = within;
    const size_t begin = scanner.at();
    scanner.skip('[');
    bool more = scanner.peek() != ']';
    while (more) {
      scanner.peek();
      const int line = scanner.line();
      linked = add_record(to, parse(to, scanner.value(), line), line, names, named) || linked;
      more = scanner.skip(',');
    }
    if (!scanner.skip(']'))
      throw LoadError(to.file(), "line " + std::to_string(scanner.line()),
                      "not JSON: the list of records goes on without a comma, or does not end");
    // The text around the list has to be JSON, too.
    const std::string around =
        std::string(text.substr(0, begin)) + "[]" + std::string(text.substr(scanner.at()));
    auto parsed = parse_json(around, {.values = most_record_values});
    if (const auto* error = std::get_if<JsonError>(&parsed))
      throw LoadError(to.file(), "", "around the list of records: " + error->message);
  }
  if (!linked) named.check(to.file(), names);
}

}  // namespace wellspring::collection
