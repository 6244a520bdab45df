// SPDX-License-Identifier: Apache-2.0
// Reads a curator's JSON: every fault is noted with file and place, not only the first, and reading
// goes on. Adds the kinds of fields that only a museum's files have.
#pragma once
#include <functional>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "json/fields.h"
#include "show/exhibit/exhibit.h"

namespace wellspring::show {

struct Problem {
  std::string file, where, what;
  bool fatal = true;  // false: the exhibit runs, but a curator should know
};
std::string to_string(const Problem& problem);  // "file: where: what"

struct ExhibitError : std::runtime_error {
  std::vector<Problem> problems;
  explicit ExhibitError(std::vector<Problem> problems);
};

bool is_language_tag(const std::string& tag);

// Calls read(FieldReader&) with an object, which is of `file`; notes each fault as a problem.
void read_fields(const nlohmann::json& object, const std::string& file,
                 std::vector<Problem>& problems, const std::function<void(FieldReader&)>& read);
// The same with the object in a file, its texts in Unicode's form C. A file that cannot be read, is
// larger than 8 MiB, or is no JSON is a fatal problem.
void read_fields(const std::string& file, std::vector<Problem>& problems,
                 const std::function<void(FieldReader&)>& read);

// Bounds a coordinate: metres.
inline constexpr double most_metres = 1e9;
// Bounds a text for people, and an address, in bytes.
inline constexpr size_t most_local_text_bytes = 20'000, most_address_bytes = 300;

// Reads a text, or an object of texts by language tag.
LocalText read_local_text(FieldReader& fields, const char* name, const char* about,
                          Need need = Need::optional);
// Reads a list of these.
std::vector<LocalText> read_local_texts(FieldReader& fields, const char* name, size_t most,
                                        const char* about, Need need = Need::optional);
// Reads a list of texts.
std::vector<std::string> read_texts(FieldReader& fields, const char* name, const char* about);
// Reads an address that begins with https:// or, where `plain` is true, with http://.
std::string read_address(FieldReader& fields, const char* name, const char* about, bool plain);

// Returns the JSON Schema of a file whose fields are read by read(FieldReader&), draft 2020-12.
template <class Read>
nlohmann::ordered_json describe_fields(const char* title, const Read& read) {
  nlohmann::ordered_json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                                   {"title", title}};
  schema.update(FieldReader::object_schema(read));
  return schema;
}

}  // namespace wellspring::show
