// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/exhibit_collection.h"

#include <algorithm>
#include <fmt/format.h>
#include <memory>
#include <set>
#include <utility>

#include "base/load_error.h"
#include "collection/read/read_records.h"
#include "show/exhibit/exhibit_files.h"
#include "store/remote/http_get.h"

namespace wellspring::show {
namespace {

constexpr size_t most_named_hosts = 4;

FieldNames read_names(FieldReader& fields) {
  FieldNames names;
  fields.part("fields", "names of the file's fields, where they are not the usual ones",
              [&](FieldReader& one) {
                one.text("id", names.id, "a name that no other record has");
                one.text("title", names.title, "as it is shown");
                one.text("maker", names.maker, "who made it");
                one.text("date", names.date, "a year, or words with one");
                one.text("subjects", names.subjects, "what it shows or is about; several");
                one.text("materials", names.materials, "what it is made of; several");
                one.text("colors", names.colors, "colours as #rrggbb; several");
                one.text("link", names.link, "address of its page");
                one.text("picture", names.picture, "address of a picture");
              });
  return names;
}

// Returns the first few hosts of pictures that the exhibit does not let in.
std::set<std::string> hosts_not_allowed(const Exhibit& exhibit, const Records& records) {
  std::set<std::string> hosts;
  for (const Record& record : records.all)
    if (const auto address = store::read_http_address(record.picture);
        address && hosts.size() < most_named_hosts &&
        !store::is_allowed(*address, exhibit.allowed_hosts))
      hosts.insert(store::host_text(*address));
  return hosts;
}

// Notes which records stand in the exhibit.
void read_places(const Exhibit& exhibit, FieldReader& fields, ExhibitCollection& made) {
  const auto field = fields.take("objects", FieldReader::map_schema({{"type", "string"}}),
                                 "ids of records that stand here, and of which object each is");
  if (!field || !field->object()) return;
  const std::vector<Record>& records = made.collection.records.all;
  for (const auto& [id, value] : field->value().items()) {
    const std::string where = "objects/" + id;
    const auto record = std::ranges::find(records, id, &Record::id);
    if (!records.empty() && record == records.end())
      fields.fail(where, "the collection has no record '" + id + "'");
    const std::string object = value.is_string() ? value.get<std::string>() : std::string();
    const PointOfInterest* point = find_point(exhibit, object);
    if (object.empty()) fields.fail(where, "is not the id of an object, as a text");
    else if (!point) fields.fail(where, unknown_object(exhibit, object));
    else if (record != records.end())
      made.points[int(record - records.begin())] = int(point - exhibit.points.data());
  }
}

}  // namespace

void read_collection(Exhibit& exhibit, FieldReader& root) {
  root.part("collection", "a museum's records, to be browsed as a map", [&](FieldReader& fields) {
    auto made = std::make_shared<ExhibitCollection>();
    std::string source;
    const bool named =
        fields.text("source", source,
                    "a file or folder of records: .csv, .json, .jsonl, Linked Art", Need::required);
    made->title = read_local_text(fields, "title", "its name", Need::required);
    const FieldNames names = read_names(fields);
    if (named) {
      const std::string path =
          package_file(fields, "source", exhibit.folder, source, PackagePart::file_or_folder);
      try {
        if (!path.empty()) made->collection = make_collection(read_records(path, names));
      } catch (const LoadError& error) {
        fields.fail("source", error.where.empty()
                                  ? error.what_
                                  : fmt::format("{}: {}", error.where, error.what_));
      }
    }
    for (const RecordNote& note : made->collection.records.notes) {
      // Places of notes begin with the whole path of the file.
      const size_t at = note.where.rfind('/');
      fields.warn("source",
                  fmt::format("{}: {}", note.where.substr(at == std::string::npos ? 0 : at + 1),
                              note.what));
    }
    for (const std::string& host : hosts_not_allowed(exhibit, made->collection.records))
      fields.warn("source", fmt::format("pictures of host '{}' are not shown: add \"{}\" to "
                                        "\"allowed_hosts\" of this file",
                                        host, host));
    read_places(exhibit, fields, *made);
    if (!made->collection.records.all.empty()) exhibit.collection = std::move(made);
  });
}

}  // namespace wellspring::show
