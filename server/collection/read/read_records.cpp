// SPDX-License-Identifier: Apache-2.0
#include "collection/read/read_records.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "base/load_error.h"
#include "base/read_file.h"
#include "collection/read/raw_record.h"

namespace wellspring::collection {

namespace {

namespace fs = std::filesystem;

std::string kind_of(const std::string& file) {
  return small_letters(fs::path(file).extension().string());
}

void read_text(Gathering& to, const std::string& file, std::string_view text,
               const FieldNames& names) {
  to.begin_file(file);
  const std::string kind = kind_of(file);
  if (kind == ".csv" || kind == ".tsv" || kind == ".txt") return read_table(to, text, names);
  if (kind == ".jsonl" || kind == ".ndjson") return read_json_lines(to, text, names);
  if (kind != ".json" && kind != ".jsonld")
    throw LoadError(file, "", "is no collection: .csv, .tsv, .json, .jsonld, .jsonl or .ndjson");
  if (has_json_lines(text)) return read_json_lines(to, text, names);
  read_json(to, text, names);
}

// Returns the files of records below a folder, by name.
std::vector<std::string> files_below(const std::string& folder) {
  std::vector<std::string> files;
  std::error_code error;
  for (fs::recursive_directory_iterator at(folder, error), end; !error && at != end;
       at.increment(error)) {
    const std::string kind = kind_of(at->path().string());
    if ((kind == ".json" || kind == ".jsonld") && at->is_regular_file(error))
      files.push_back(at->path().string());
    if (files.size() > most_records)
      throw LoadError(folder, "", "has more than " + std::to_string(most_records) + " files");
  }
  if (error) throw LoadError(folder, "", "cannot be read: " + error.message());
  std::ranges::sort(files);
  return files;
}

}  // namespace

Records read_records_text(const std::string& file, std::string_view text, const FieldNames& names) {
  Gathering gathering;
  read_text(gathering, file, text, names);
  return gathering.take(file);
}

Records read_records(const std::string& path, const FieldNames& names) {
  std::error_code error;
  if (!fs::is_directory(path, error))
    return read_records_text(path, read_file(path, most_collection_bytes), names);
  Gathering gathering;
  size_t bytes = 0;
  for (const std::string& file : files_below(path)) {
    const std::string text = read_file(file, most_record_bytes);
    bytes += text.size();
    if (bytes > most_collection_bytes) throw LoadError(path, "", "is larger than 256 MiB");
    read_text(gathering, file, text, names);
  }
  return gathering.take(path);
}

}  // namespace wellspring::collection
