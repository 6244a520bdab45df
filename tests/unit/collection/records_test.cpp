// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "base/load_error.h"
#include "collection/read/raw_record.h"
#include "collection/read/read_records.h"
#include "unit/folder.h"

namespace wellspring::test {
namespace {

Records read(const std::string& text, const std::string& file, const FieldNames& names = {}) {
  return read_records_text(file, text, names);
}

// Reads what is to be refused, and returns the error's place and words.
std::string refusal(const std::string& text, const std::string& file,
                    const FieldNames& names = {}) {
  try {
    read(text, file, names);
  } catch (const LoadError& error) {
    EXPECT_EQ(error.file, file);
    return error.where + ": " + error.what_;
  }
  return "";
}

std::string terms_of(const Records& records, size_t i, TermKind kind) {
  std::string all;
  for (const uint32_t term : records.all.at(i).terms)
    if (records.terms[term].kind == kind)
      all += (all.empty() ? "" : "|") + records.terms[term].name;
  return all;
}

bool has_note(const Records& records, const std::string& words) {
  return std::ranges::any_of(records.notes, [&](const RecordNote& note) {
    return (note.where + ": " + note.what).find(words) != std::string::npos;
  });
}

TEST(Records, TablesAreRead) {
  const Records records = read(
      "\xef\xbb\xbfID;Title;Artist;Year;Tags;Medium;Palette;URL\r\n"
      "7;\"A \"\"quoted\"\"; title\r\nof two lines\";Anna;c.1805-9;tree|hill;Oil on canvas;"
      "#ff0000|00ff00;https://example.org/7\r\n"
      "\r\n"
      "8;Second;;18th century;hill;;;javascript:alert(1)\r\n",
      "list.csv");
  ASSERT_EQ(records.all.size(), 2u);
  const Record& first = records.all[0];
  EXPECT_EQ(first.id, "7");
  EXPECT_EQ(first.title, "A \"quoted\"; title of two lines");
  EXPECT_EQ(first.maker, "Anna");
  EXPECT_EQ(first.date, "c.1805-9");
  EXPECT_EQ(first.year, 1807);
  EXPECT_EQ(first.link, "https://example.org/7");
  EXPECT_EQ(terms_of(records, 0, TermKind::subject), "tree|hill");
  EXPECT_EQ(terms_of(records, 0, TermKind::material), "oil|canvas");
  ASSERT_EQ(first.palette.size(), 2u);
  EXPECT_NEAR(first.palette[0].lab.x, 53.24, 0.05);
  EXPECT_NEAR(first.palette[0].lab.y, 80.09, 0.2);
  EXPECT_EQ(records.all[1].year, 1750);
  EXPECT_EQ(records.all[1].link, "");  // an address of the web only
  EXPECT_EQ(records.all[1].terms, std::vector<uint32_t>{records.all[0].terms.back()});
  EXPECT_TRUE(records.notes.empty());
}

TEST(Records, FlatJsonIsRead) {
  const std::string one =
      R"({"Title": "Cup", "date": 1650, "materials": ["silver", {"name": "gold"}],
    "colors": [{"hex": "#102030", "weight": 3}, "#405060"], "subjects": "bird; flower"})";
  const std::string other = R"({"id": 12, "name": "Jug", "year": "made 44 BC"})";
  for (const auto& [text, file] : std::vector<std::pair<std::string, std::string>>{
           {"[" + one + ",\n" + other + "]", "a.json"},
           {"{\"count\": 2, \"items\": [" + one + ", " + other + "], \"next\": null}", "a.json"}}) {
    const Records records = read(text, file);
    ASSERT_EQ(records.all.size(), 2u);
    EXPECT_EQ(records.all[0].title, "Cup");
    EXPECT_EQ(records.all[0].id, "1");
    EXPECT_EQ(records.all[0].year, 1650);
    EXPECT_EQ(terms_of(records, 0, TermKind::material), "silver|gold");
    EXPECT_EQ(terms_of(records, 0, TermKind::subject), "bird|flower");
    ASSERT_EQ(records.all[0].palette.size(), 2u);
    EXPECT_EQ(records.all[0].palette[0].weight, 3);
    EXPECT_EQ(records.all[1].id, "12");
    EXPECT_EQ(records.all[1].year, -44);
    EXPECT_TRUE(has_note(records, "neither subjects nor materials nor colours"));
  }
  EXPECT_EQ(read(other, "a.json").all.size(), 1u);
  EXPECT_EQ(read(other + "\n\n" + other.substr(0, 8) + "3" + other.substr(9), "a.json").all.size(),
            2u);
}

TEST(Records, LinkedArtIsRead) {
  const Records records = read(R"({"@context": "https://linked.art/ns/v1/linked-art.json",
    "id": "https://example.org/object/1", "type": "HumanMadeObject", "_label": "A painting",
    "classified_as": [{"id": "http://vocab.getty.edu/aat/300033618", "_label": "Painting"}],
    "made_of": [{"type": "Material", "_label": "oil"}, {"type": "Material", "_label": "canvas"}],
    "produced_by": {"type": "Production", "carried_out_by": [{"_label": "Rosa Bonheur"}],
      "timespan": {"begin_of_the_begin": "1850-01-01T00:00:00Z",
                   "end_of_the_end": "1852-12-31T23:59:59Z"}},
    "shows": [{"type": "VisualItem", "represents": [{"_label": "horse"}]}],
    "representation": [{"digitally_shown_by":
      [{"access_point": [{"id": "https://example.org/1.jpg"}]}]}]})",
                               "object.json");
  ASSERT_EQ(records.all.size(), 1u);
  const Record& record = records.all[0];
  EXPECT_EQ(record.title, "A painting");
  EXPECT_EQ(record.maker, "Rosa Bonheur");
  EXPECT_EQ(record.year, 1851);
  EXPECT_EQ(record.date, "1851");
  EXPECT_EQ(record.picture, "https://example.org/1.jpg");
  EXPECT_EQ(terms_of(records, 0, TermKind::material), "oil|canvas");
  EXPECT_EQ(terms_of(records, 0, TermKind::subject), "Painting|horse");
}

TEST(Records, YearsAreFoundInDates) {
  const std::pair<const char*, double> cases[] = {{"1773", 1773},
                                                  {"c.1805-9", 1807},
                                                  {"1805\u20139", 1807},
                                                  {"1914-18", 1916},
                                                  {"1850-1852", 1851},
                                                  {"born 1930", 1930},
                                                  {"12 March 44 BC", -44},
                                                  {"500 BC", -500},
                                                  {"18th century", 1750},
                                                  {"-480", -480},
                                                  {"12/05/1820", 1820},
                                                  {"20. Jahrhundert", 1950},
                                                  {"1840, cast 1902, engraved 1999", 1871}};
  for (const auto& [text, year] : cases) EXPECT_EQ(find_year(text), year) << text;
  for (const char* text : {"", "undated", "12", "12345678901234567890"})
    EXPECT_FALSE(find_year(text)) << text;
}

TEST(Records, FieldsCanBeNamed) {
  const FieldNames names{.title = "Objekttitel", .materials = "Stoff"};
  const Records records = read("Nr,Objekttitel,Stoff\n1,Krug,Ton\n", "a.csv", names);
  EXPECT_EQ(records.all[0].title, "Krug");
  EXPECT_EQ(terms_of(records, 0, TermKind::material), "ton");
  EXPECT_EQ(refusal("Nr,Objekttitl,Stoff\n1,Krug,Ton\n", "a.csv", names),
            "line 1: no column is named 'Objekttitel', which is to hold the title; did you mean "
            "'Objekttitl'?");
  EXPECT_EQ(read(R"([{"Objekttitel": "Krug", "Stoff": "Ton"}])", "a.json", names).all[0].title,
            "Krug");
  EXPECT_EQ(refusal(R"([{"Objekttitel": "Krug"}])", "a.json", names),
            ": no record has a field 'Stoff', which is to hold the materials");
}

TEST(Records, FaultsAreToldWithTheirLines) {
  EXPECT_EQ(refusal("", "a.csv"), ": the file is empty");
  EXPECT_EQ(refusal("", "a.json"), ": the file is empty");
  EXPECT_EQ(refusal("", "a.jsonl"), ": there are no records in it");
  EXPECT_EQ(refusal("id,title\n", "a.csv"), ": there are no records in it");
  EXPECT_EQ(refusal("[]", "a.json"), ": there are no records in it");
  EXPECT_EQ(refusal("a,b\n1,2\n", "a.csv"),
            "line 1: no column is known by its name; \"fields\" can tell which they are");
  EXPECT_EQ(refusal("id,title\n1,\"two\n3,4\n", "a.csv"),
            "line 2: a quote is opened and never closed");
  EXPECT_EQ(refusal("id,title\n1,caf\xe9\n", "a.csv"),
            "line 2: the text is not UTF-8; please save the table as UTF-8");
  EXPECT_EQ(refusal("{\"id\": 1}\n\n{\"id\": 2,}\n", "a.jsonl").substr(0, 30),
            "line 3: not JSON at line 3, co");
  EXPECT_EQ(refusal("[{\"id\": 1},\n {\"id\":\n oops}]", "a.json").substr(0, 26),
            "line 2: not JSON at line 3");
  EXPECT_EQ(refusal("[{\"id\": 1}\n {\"id\": 2}]", "a.json").substr(0, 16), "line 2: not JSON");
  EXPECT_EQ(refusal("[{\"id\": 1}] more", "a.json").substr(0, 28), ": around the list of records");
  EXPECT_NE(refusal(std::string(100'000, '['), "a.json"), "");
  EXPECT_EQ(refusal("text", "a.docx"),
            ": is no collection: .csv, .tsv, .json, .jsonld, .jsonl or .ndjson");
  EXPECT_EQ(refusal("[1, 2]", "a.json"),
            ": there are no records in it; a.json: line 1: a record is no JSON object; it is left "
            "out");

  const Records records = read("id,title,year\n1,a,1800\n2,b\n1,c,\n4,d,?\n5,e,\n6,f,\n", "a.csv");
  EXPECT_EQ(records.all.size(), 4u);
  EXPECT_TRUE(has_note(records, "a.csv: line 3: the row has 2 cells, the first line 3"));
  EXPECT_TRUE(has_note(records, "a.csv: line 4: another record has the same id"));
  EXPECT_TRUE(has_note(records, "a.csv: line 5: no year can be found in the date"));
  EXPECT_TRUE(has_note(records, "a.csv: line 6: no date (2 times, here first)"));
}

TEST(Records, AMillionAreRefusedKindly) {
  std::string text = "id\n";
  for (int i = 0; i < 1'000'000; i++) text += std::to_string(i) + "\n";
  EXPECT_EQ(refusal(text, "all.csv"),
            "line 100002: the collection has more than 100000 records, which is the most that a "
            "map is made of; please give a part of it, a file for each department for example");
}

TEST(Records, LongTextsAndManyTermsAreCut) {
  std::string title;
  for (int i = 0; i < 400; i++) title += "\u00e9";
  std::string tags;
  for (int i = 0; i < 500; i++) tags += "t" + std::to_string(i) + "|";
  const Records records = read("id,title,tags\n1," + title + "," + tags + "\n", "a.csv");
  EXPECT_LE(records.all[0].title.size(), most_text);
  EXPECT_TRUE(records.all[0].title.ends_with("\u00e9\u2026"));
  EXPECT_EQ(records.all[0].terms.size(), most_terms);
}

TEST(Records, AFolderOfFilesIsRead) {
  const Folder folder;
  std::filesystem::create_directories(folder.path / "a/b");
  folder.write("a/b/2.json", R"({"id": "two"})");
  folder.write("a/1.json", R"({"id": "one"})");
  folder.write("a/notes.txt", "no record");
  const Records records = read_records(folder.path.string());
  ASSERT_EQ(records.all.size(), 2u);
  EXPECT_EQ(records.all[0].id, "one");
  folder.write("a/3.json", "{");
  try {
    read_records(folder.path.string());
    FAIL();
  } catch (const LoadError& error) {
    EXPECT_TRUE(error.file.ends_with("a/3.json"));
  }
  EXPECT_THROW(read_records((folder.path / "none").string()), LoadError);
}

}  // namespace
}  // namespace wellspring::test
