// SPDX-License-Identifier: Apache-2.0
// One function reads a value and gives its JSON Schema, and all faults of a value are told.
#include "json/fields.h"

#include <gtest/gtest.h>

namespace wellspring::test {
namespace {

struct Door {
  std::string name;
  double width = 1;
  int hinge = 0;
  std::vector<vec3> handles;
};

void read_door(Door& door, FieldReader& fields) {
  fields.text("name", door.name, "as people say it", Need::required);
  fields.number("width", 0.5, 3, door.width, "metres");
  fields.choice("hinge", {"left", "right"}, door.hinge, "");
  fields.parts("handles", 2, "", [&](FieldReader& handle) {
    handle.vector("at", 10, door.handles.emplace_back(), "", Need::required);
  });
}

std::vector<Fault> read(Door& door, const char* text) {
  std::vector<Fault> all;
  Faults faults([&](const Fault& fault) { all.push_back(fault); });
  FieldReader::read_object({nlohmann::json::parse(text), faults},
                           [&](FieldReader& fields) { read_door(door, fields); });
  return all;
}

TEST(FieldReader, ReadsWhatItDescribes) {
  Door door;
  EXPECT_TRUE(read(door, R"({"name": "gate", "width": 2, "hinge": "right",
                             "handles": [{"at": [1, 2, 3]}, {"at": [0, 0, 0]}]})")
                  .empty());
  EXPECT_EQ(door.name, "gate");
  EXPECT_EQ(door.width, 2);
  EXPECT_EQ(door.hinge, 1);
  ASSERT_EQ(door.handles.size(), 2u);
  EXPECT_EQ(door.handles[0], vec3(1, 2, 3));
  Door none;
  const nlohmann::ordered_json schema =
      FieldReader::object_schema([&](FieldReader& fields) { read_door(none, fields); });
  EXPECT_EQ(nlohmann::json::parse(schema.dump()),
            nlohmann::json::parse(R"({"type": "object", "properties": {
    "name": {"type": "string", "description": "as people say it"},
    "width": {"type": "number", "minimum": 0.5, "maximum": 3.0, "description": "metres"},
    "hinge": {"enum": ["left", "right"]},
    "handles": {"type": "array", "maxItems": 2, "items": {"type": "object", "properties": {
      "at": {"type": "array", "minItems": 3, "maxItems": 3, "items": {"type": "number"}}},
      "required": ["at"], "additionalProperties": false}}},
    "required": ["name"], "additionalProperties": false})"));
}

TEST(FieldReader, TellsAllFaultsAndGoesOn) {
  Door door;
  const auto faults = read(door, R"({"width": 9, "hinge": "lefd", "widht": 1,
      "handles": [{"at": [1, 2]}, 7, {"at": [1, 1, 1]}]})");
  const std::pair<const char*, const char*> expected[] = {
      {"/name", "is missing"},
      {"/width", "from 0.5 to 3"},
      {"/hinge", "did you mean 'left'?"},
      {"/handles", "at most 2"},
      {"/handles/0/at", "three numbers"},
      {"/handles/1", "an object"},
      {"/widht", "ignored; did you mean 'width'?"}};
  ASSERT_EQ(faults.size(), std::size(expected));
  for (size_t i = 0; i < faults.size(); i++) {
    EXPECT_EQ(faults[i].where, expected[i].first);
    EXPECT_NE(faults[i].what.find(expected[i].second), std::string::npos) << faults[i].what;
    EXPECT_EQ(faults[i].grave, faults[i].where != "/widht");
  }
  EXPECT_EQ(door.width, 1) << "a wrong value leaves the default";
}

}  // namespace
}  // namespace wellspring::test
