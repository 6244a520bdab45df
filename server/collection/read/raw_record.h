// SPDX-License-Identifier: Apache-2.0
// A record as a file has it, and the list that cleans it.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "collection/read/field_names.h"
#include "collection/records.h"

namespace wellspring::collection {

struct RawRecord {
  std::string id, title, maker, date, link, picture;
  std::optional<double> year;  // set if the file tells it as a number
  std::vector<std::string> subjects, materials;
  std::vector<std::pair<std::string, double>> colors;  // "#rrggbb" and its weight
};

// Gathers records of one or more files. Texts are cleaned and cut, years found in dates, terms
// numbered, and what is wrong is noted, the first of each kind with its place.
class Gathering {
 public:
  // Begins a file; places are told within it.
  void begin_file(const std::string& file) { file_ = file; }
  const std::string& file() const { return file_; }
  // Throws LoadError for one record too many.
  void add(RawRecord&& raw, const std::string& where);
  // Notes what was left out. Equal texts are told once, with the first place and their number.
  void note(const std::string& where, const std::string& what);
  // Throws LoadError if there is no record.
  Records take(const std::string& path);

 private:
  std::string file_;
  Records records_;
  std::map<std::pair<TermKind, std::string>, uint32_t> terms_;
  std::unordered_set<std::string> ids_;
  std::vector<std::pair<RecordNote, int>> notes_;
  std::map<std::string, size_t> note_of_;

  void add_terms(Record& record, TermKind kind, const std::vector<std::string>& names);
};

// Returns the text on one line, without blanks around, at most most_text bytes of whole letters.
std::string clean_text(std::string_view text);
// Makes A to Z small.
std::string small_letters(std::string_view text);
// Takes a cell that holds several apart: at '|', else at ';', else at ','.
std::vector<std::string> split_list(std::string_view text);
// Takes "Oil paint and chalk on canvas" apart.
std::vector<std::string> split_materials(std::string_view text);
// Finds a year in a date: "c.1805-9", "born 1930", "18th century", "12 March 44 BC". The middle of
// what it spans.
std::optional<double> find_year(std::string_view date);
// Returns the colour of "#rrggbb" or "rrggbb".
std::optional<dvec3> find_lab(std::string_view color);

// Each reads the records of a text into the list; throws LoadError for what cannot be read on.
void read_table(Gathering& to, std::string_view text, const FieldNames& names);
void read_json(Gathering& to, std::string_view text, const FieldNames& names);
void read_json_lines(Gathering& to, std::string_view text, const FieldNames& names);
// Says whether the first line holds a whole object and another follows.
bool has_json_lines(std::string_view text);

// Says which field of the file is used for a field of records; empty: none.
struct FieldChoice {
  const char* role;
  std::string FieldNames::*name;
  std::vector<const char*> usual;
};
const std::vector<FieldChoice>& field_choices();

}  // namespace wellspring::collection
