// SPDX-License-Identifier: Apache-2.0
// Reading a curator's JSON: typed access that notes every problem with its JSON pointer and goes
// on.
#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "show/exhibit/exhibit.h"

namespace wellspring::show {

// Faults of an exhibit package are all noted with file and place, not only the first.

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

// Nothing, and a fatal problem: it cannot be read, is larger than 8 MiB, or is no JSON.
std::optional<nlohmann::json> read_json_file(const std::string& file,
                                             std::vector<Problem>& problems);

// A JSON object and its place. Reading a missing optional field gives the default; a wrong one
// gives the default and a fatal problem. finish() notes fields nobody read (a misspelt name) as not
// fatal.
class Fields {
 public:
  Fields(const nlohmann::json& object, std::string file, std::string where,
         std::vector<Problem>& problems);

  bool has(const char* name) const;
  std::string text(const char* name, bool required, const std::string& otherwise = "");
  double number(const char* name, bool required, double otherwise, double low, double high);
  bool flag(const char* name, bool otherwise);
  dvec3 triple(const char* name, bool required, dvec3 otherwise = dvec3(0));
  // A text, or an object of texts by language tag.
  LocalText local_text(const char* name, bool required);
  // A list of these.
  std::vector<LocalText> local_texts(const char* name, bool required);
  std::vector<std::string> texts(const char* name);
  // Calls each(Fields) for every object in the array (or, for `members`, of the object: name,
  // Fields).
  template <class Each>
  void objects(const char* name, bool required, const Each& each) {
    if (const nlohmann::json* array =
            get(name, required, nlohmann::json::value_t::array, "an array"))
      for (size_t i = 0; i < array->size(); i++)
        each(Fields((*array)[i], file_, where_ + "/" + name + "/" + std::to_string(i), problems_));
  }
  template <class Each>
  void members(const char* name, const Each& each) {
    if (const nlohmann::json* object =
            get(name, false, nlohmann::json::value_t::object, "an object"))
      for (const auto& [key, value] : object->items())
        each(key, Fields(value, file_, where_ + "/" + name + "/" + key, problems_));
  }
  template <class Each>
  void object(const char* name, bool required, const Each& each) {
    if (const nlohmann::json* found =
            get(name, required, nlohmann::json::value_t::object, "an object"))
      each(Fields(*found, file_, where_ + "/" + name, problems_));
  }
  std::vector<std::string> names() const;  // names of all fields that are there
  // The value of a field as it is, noted as read; null: it is not there.
  const nlohmann::json* value(const char* name);
  const std::string& where() const { return where_; }
  void problem(const std::string& name, const std::string& what, bool fatal = true);
  void finish();

 private:
  const nlohmann::json* get(const char* name, bool required, nlohmann::json::value_t type,
                            const char* type_name);
  LocalText read_local_text(const nlohmann::json& value, const std::string& place);
  const nlohmann::json& object_;
  std::string file_, where_;
  std::vector<Problem>& problems_;
  std::set<std::string> read_;
};

}  // namespace wellspring::show
