// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/json_fields.h"

#include <cctype>
#include <fmt/core.h>

#include "base/load_error.h"
#include "base/read_file.h"
#include "base/unicode.h"

namespace wellspring::show {
namespace {

std::string join(const std::vector<Problem>& problems) {
  std::string all;
  for (const Problem& problem : problems)
    if (problem.fatal) all += (all.empty() ? "" : "\n") + to_string(problem);
  return all;
}

}  // namespace

std::string to_string(const Problem& problem) {
  return problem.file + (problem.where.empty() ? "" : ": " + problem.where) + ": " + problem.what;
}

ExhibitError::ExhibitError(std::vector<Problem> problems_)
    : std::runtime_error(join(problems_)), problems(std::move(problems_)) {}

namespace {

constexpr size_t max_file_bytes = 8 << 20;

// Names are compared with those of scenes and of files (base/unicode.h).
void normalise(nlohmann::json& value) {
  if (value.is_string()) value = nfc(value.get_ref<const std::string&>());
  if (value.is_array())
    for (nlohmann::json& item : value) normalise(item);
  if (!value.is_object()) return;
  nlohmann::json made = nlohmann::json::object();
  for (auto& [name, item] : value.items()) {
    normalise(item);
    made[nfc(name)] = std::move(item);
  }
  value = std::move(made);
}

}  // namespace

void read_fields(const nlohmann::json& object, const std::string& file,
                 std::vector<Problem>& problems, const std::function<void(FieldReader&)>& read) {
  Faults faults([&](const Fault& fault) {
    problems.push_back({file, fault.where, fault.what, fault.grave});
  });
  FieldReader::read_object({object, faults}, read);
}

void read_fields(const std::string& file, std::vector<Problem>& problems,
                 const std::function<void(FieldReader&)>& read) {
  auto tell = [&](const std::string& what) { problems.push_back({file, "", what}); };
  std::string text;
  try {
    text = read_file(file, max_file_bytes);
  } catch (const LoadError& error) {
    return tell(error.what_);
  }
  auto parsed = parse_json(text);
  if (const JsonError* error = std::get_if<JsonError>(&parsed)) return tell(error->message);
  normalise(std::get<nlohmann::json>(parsed));
  read_fields(std::get<nlohmann::json>(parsed), file, problems, read);
}

bool is_language_tag(const std::string& tag) {
  if (tag.size() < 2 || tag.size() > 35) return false;
  for (char c : tag)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-') return false;
  return true;
}

namespace {

const nlohmann::ordered_json& text_schema() {
  static const nlohmann::ordered_json schema = {
      {"anyOf", {{{"type", "string"}}, FieldReader::map_schema({{"type", "string"}})}}};
  return schema;
}

// Texts for people may have more than one line.
bool read_plain_text(const JsonValue& value, std::string& to) {
  if (!value.value().is_string()) return value.fail("must be a text"), false;
  to = value.value().get<std::string>();
  if (to.size() <= most_local_text_bytes) return true;
  value.fail(fmt::format("must be a text of at most {} bytes", most_local_text_bytes));
  return false;
}

LocalText read_local_text(const JsonValue& value) {
  LocalText texts;
  if (value.value().is_string()) {
    read_plain_text(value, texts["en"]);
  } else if (!value.value().is_object()) {
    value.fail("must be a text, or texts by language");
  } else {
    for (const auto& [tag, unused] : value.value().items()) {
      const JsonValue text = *value.find(tag.c_str());
      std::string found;
      if (!is_language_tag(tag)) text.fail("is no language tag such as en");
      else if (read_plain_text(text, found)) texts[tag] = std::move(found);
    }
  }
  return texts;
}

}  // namespace

LocalText read_local_text(FieldReader& fields, const char* name, const char* about, Need need) {
  const auto field = fields.take(name, text_schema(), about, need);
  return field ? read_local_text(*field) : LocalText{};
}

std::vector<LocalText> read_local_texts(FieldReader& fields, const char* name, size_t most,
                                        const char* about, Need need) {
  std::vector<LocalText> texts;
  const auto field =
      fields.take(name, FieldReader::list_schema(text_schema(), 0, most), about, need);
  if (field)
    for (const JsonValue& one : field->list(0, most, "texts"))
      texts.push_back(read_local_text(one));
  return texts;
}

std::vector<std::string> read_texts(FieldReader& fields, const char* name, const char* about) {
  std::vector<std::string> texts;
  const auto field =
      fields.take(name, FieldReader::list_schema({{"type", "string"}}, 0), about, Need::optional);
  if (!field) return texts;
  for (const JsonValue& one : field->list(0, SIZE_MAX, "texts"))
    if (std::string text; one.text(text)) texts.push_back(std::move(text));
  return texts;
}

std::string read_address(FieldReader& fields, const char* name, const char* about, bool plain) {
  std::string address;
  if (!fields.text(name, address, about, Need::optional, most_address_bytes)) return "";
  const size_t begin = address.starts_with("https://")           ? 8
                       : address.starts_with("http://") && plain ? 7
                                                                 : 0;
  if (begin > 0 && address.size() > begin &&
      address.find_first_of(" \t\n\"<>") == std::string::npos)
    return address;
  fields.fail(name, std::string("must be an address that begins with https://") +
                        (plain ? " or http://" : ""));
  return "";
}

}  // namespace wellspring::show
