// SPDX-License-Identifier: Apache-2.0
// `collection` of exhibit.json: what it becomes, and every mistake with its place.
#include "show/exhibit/exhibit_collection.h"

#include <gtest/gtest.h>

#include "unit/show/exhibit/room_package.h"

namespace wellspring::test {
namespace {

struct CollectionPackage : RoomPackage {
  explicit CollectionPackage(const std::string& collection) : RoomPackage(test::room_asset()) {
    manifest["collection"] = json::parse(collection);
    write("list.csv", "Nr,Name,Stoff\n1,Krug,Ton\n2,Becher,Silber und Gold\n3,Teller,Ton\n4,x\n");
  }
};

TEST(ExhibitCollection, RecordsAreReadAndTheirNotesTold) {
  CollectionPackage package(R"({"source": "list.csv", "title": {"en": "Cups", "de": "Becher"},
                                "fields": {"id": "Nr", "materials": "Stoff"}})");
  const Exhibit exhibit = package.read();
  ASSERT_TRUE(exhibit.collection);
  EXPECT_EQ(exhibit.collection->title.at("de"), "Becher");
  EXPECT_EQ(exhibit.collection->collection.records.all.size(), 3u);
  EXPECT_EQ(exhibit.collection->collection.sets.size(), 3);
  EXPECT_NE(package.told().find("list.csv: line 5: the row has 2 cells"), std::string::npos)
      << package.told();
}

TEST(ExhibitCollection, EveryMistakeIsToldWithItsPlace) {
  const std::pair<const char*, const char*> cases[] = {
      {R"({"source": "list.csv"})", "/collection/title"},
      {R"({"title": "A"})", "/collection/source"},
      {R"({"source": "none.csv", "title": "A"})", "/collection/source"},
      {R"({"source": "../list.csv", "title": "A"})", "/collection/source"},
      {R"({"source": "list.csv", "title": "A", "fields": {"id": "Nummer"}})",
       "line 1: no column is named 'Nummer', which is to hold the id"},
      {R"({"source": "list.csv", "title": "A", "fields": {"number": "Nr"}})", "number"},
      {R"({"source": "list.csv", "title": "A", "fields": {"id": "Nr"}, "objects": {"9": "b"}})",
       "the collection has no record '9'"},
      {R"({"source": "list.csv", "title": "A", "fields": {"id": "Nr"}, "objects": {"1": "b"}})",
       "/collection/objects/1"},
      {R"({"source": "list.csv", "title": "A", "fields": {"id": "Nr"}, "objects": {"1": 3}})",
       "is not the id of an object"}};
  for (const auto& [collection, told] : cases) {
    CollectionPackage package(collection);
    package.read();
    EXPECT_NE(package.told().find(told), std::string::npos) << collection << "\n" << package.told();
  }
}

}  // namespace
}  // namespace wellspring::test
