// SPDX-License-Identifier: Apache-2.0
// The book and the sounds of an exhibit.json: what is read, and every mistake with its place.
#include <gtest/gtest.h>

#include "frame/picture_file.h"
#include "show/exhibit/exhibit_book.h"
#include "show/exhibit/exhibit_files.h"
#include "show/exhibit/load/exhibit_load.h"
#include "unit/folder.h"

using namespace wellspring;

using namespace wellspring::test;
using Places = std::vector<std::string>;

namespace {

const std::string webm = std::string("\x1a\x45\xdf\xa3\x9f\x42\x82\x84webm", 12) + "rest";

// A package in English and German with picture.png, film.webm and hum.ogg.
struct Package {
  test::Folder folder;
  std::vector<Problem> problems;
  Exhibit exhibit;

  Package() {
    save_image8(folder.file("picture.png"), {4, 2, std::vector<uint8_t>(24, 200)});
    folder.write("film.webm", webm);
    folder.write("hum.ogg", "OggS and so on");
    folder.write("scene.gltf", R"({"asset": {"version": "2.0"}})");
  }
  void load(const std::string& fields, const std::string& languages = R"(["en", "de"])") {
    problems.clear();
    folder.write("exhibit.json", R"({"title": "Room", "scene": "scene.gltf", "languages": )" +
                                     languages + ", " + fields + "}");
    exhibit = read_exhibit(folder.path.string(), problems);
  }
  // Returns where the problems of book and sounds lie.
  Places places() const {
    Places list;
    for (const Problem& p : problems)
      if (p.where.starts_with("/book") || p.where.starts_with("/sounds")) {
        EXPECT_EQ(p.file, folder.file("exhibit.json"));
        EXPECT_FALSE(p.what.empty());
        list.push_back(p.fatal ? p.where : p.where + " (note)");
      }
    return list;
  }
  Places of(const std::string& fields) {
    load(fields);
    return places();
  }
  Places of_topic(const std::string& fields) {
    return of(R"("book": {"topics": [{"id": "a", "title": {"en": "A", "de": "A"}, )" + fields +
              "}]}");
  }
  Places of_partner(const std::string& fields) {
    return of(R"("book": {"partners": [{"id": "a", "title": {"en": "A", "de": "A"}, "text": [], )" +
              fields + "}]}");
  }
  Places of_slides(const std::string& slides) {
    return of(
        R"("book": {"presentations": [{"id": "p", "title": {"en": "P", "de": "P"}, "slides": [)" +
        slides + "]}]}");
  }
  Places of_picture(const std::string& name) {
    return of_topic(R"("text": [], "alt": {"en": "x", "de": "x"}, "image": ")" + name + '"');
  }
};

const std::string both = R"({"en": "x", "de": "x"})";

std::string repeated(size_t count, const std::function<std::string(size_t)>& one) {
  std::string list;
  for (size_t i = 0; i < count; i++) list += (i ? ", " : "") + one(i);
  return list;
}

}  // namespace

TEST(ExhibitBook, IsReadAsItIsWritten) {
  Package package;
  EXPECT_EQ(package.of(R"("book": {
    "topics": [{"id": "a", "title": {"en": "Well", "de": "Brunnen"},
      "text": [{"en": "One.", "de": "Eins."}, {"en": "Two.", "de": "Zwei."}],
      "image": "picture.png", "alt": {"en": "A well", "de": "Ein Brunnen"},
      "credit": {"en": "Us", "de": "Wir"}}],
    "partners": [{"id": "a", "title": {"en": "P", "de": "P"}, "text": [{"en": "x", "de": "y"}],
      "link": "https://example.org/x"}],
    "presentations": [{"id": "a", "title": {"en": "S", "de": "S"}, "slides": [
      {"video": "film.webm", "alt": {"en": "f", "de": "f"}, "seconds": 20},
      {"title": {"en": "t", "de": "t"}, "text": {"en": "u", "de": "u"}}]}]},
    "sounds": [{"id": "f", "kind": "fire", "position": [1, 2, 3], "gain": 0.5, "radius": 4},
      {"id": "h", "file": "hum.ogg"}])"),
            Places{});
  const Exhibit& exhibit = package.exhibit;
  ASSERT_TRUE(exhibit.book);
  const BookPage& topic = exhibit.book->topics.at(0);
  EXPECT_EQ(topic.text.at(1).at("de"), "Zwei.");
  EXPECT_EQ(topic.image, "picture.png");
  EXPECT_EQ(topic.credit.at("en"), "Us");
  EXPECT_EQ(exhibit.book->partners.at(0).link, "https://example.org/x");
  const auto& slides = exhibit.book->presentations.at(0).slides;
  ASSERT_EQ(slides.size(), 2u);
  EXPECT_EQ(slides[0].video, "film.webm");
  EXPECT_EQ(slides[0].seconds, 20);
  EXPECT_EQ(slides[1].seconds, 10);
  EXPECT_EQ(slides[1].text.at("de"), "u");
  ASSERT_EQ(exhibit.sounds.size(), 2u);
  EXPECT_EQ(exhibit.sounds[0].position, dvec3(1, 2, 3));
  EXPECT_EQ(exhibit.sounds[0].gain, 0.5);
  EXPECT_EQ(exhibit.sounds[0].radius, 4);
  EXPECT_EQ(exhibit.sounds[1].file, "hum.ogg");
  EXPECT_FALSE(exhibit.sounds[1].position);
  ASSERT_EQ(exhibit.files.size(), 3u);
  EXPECT_EQ(exhibit.files.at("picture.png").type, "image/png");
  EXPECT_EQ(exhibit.files.at("film.webm").type, "video/webm");
  EXPECT_EQ(exhibit.files.at("film.webm").bytes, webm.size());
  EXPECT_EQ(exhibit.files.at("hum.ogg").type, "audio/ogg");
}

TEST(ExhibitBook, AnExhibitWithoutOneHasNone) {
  Package package;
  EXPECT_EQ(package.of(R"("exposure": 1)"), Places{});
  EXPECT_FALSE(package.exhibit.book);
  EXPECT_TRUE(package.exhibit.files.empty());
}

TEST(ExhibitBook, ThePosterIsAPictureOfThePackage) {
  Package package;
  package.load(R"("poster": "picture.png")");
  EXPECT_EQ(package.exhibit.poster, "picture.png");
  EXPECT_TRUE(package.exhibit.files.contains("picture.png"));
  for (const std::string name : {"film.webm", "nowhere.png", "../picture.png"}) {
    package.load(R"("poster": ")" + name + '"');
    EXPECT_EQ(package.exhibit.poster, "") << name;
    EXPECT_EQ(std::ranges::count(package.problems, "/poster", &Problem::where), 1) << name;
  }
}

TEST(ExhibitBook, TheReadmesExampleIsGood) {
  Package package;
  test::Folder& folder = package.folder;
  std::filesystem::create_directory(folder.path / "book");
  save_image8(folder.file("book/vase.jpg"), {16, 16, std::vector<uint8_t>(768, 90)});
  folder.write("book/wheel.webm", webm);
  std::ifstream in(std::string(WELLSPRING_SOURCE) + "/content/README.md");
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const size_t chapter = text.find("### The book"), begin = text.find("```json", chapter) + 7,
               end = text.find("```", begin);
  ASSERT_NE(end, text.npos);
  package.load("\"book\": " + text.substr(begin, end - begin), R"(["en"])");
  EXPECT_EQ(package.places(), Places{});
  ASSERT_TRUE(package.exhibit.book);
  EXPECT_EQ(package.exhibit.book->presentations.at(0).slides.size(), 2u);
  EXPECT_EQ(package.exhibit.files.size(), 2u);
}

TEST(ExhibitBook, TheCastlesBookIsGood) {
  std::vector<Problem> problems;
  Exhibit castle = read_exhibit(std::string(WELLSPRING_SOURCE) + "/content/castle", problems);
  for (const Problem& problem : problems) ADD_FAILURE() << to_string(problem);
  ASSERT_TRUE(castle.book);
  EXPECT_GE(castle.book->topics.size(), 4u);
  uint64_t bytes = 0;
  for (const auto& [name, file] : castle.files) bytes += file.bytes;
  EXPECT_LT(bytes, 12u << 20);
}

TEST(ExhibitBook, PagesAreChecked) {
  Package package;
  const std::string topic = "/book/topics/0", partner = "/book/partners/0";
  EXPECT_EQ(package.of(R"("book": {"topic": []})"), Places{"/book/topic (note)"});
  EXPECT_EQ(package.of(R"("book": [])"), Places{"/book"});
  EXPECT_EQ(package.of_topic(R"("txt": [])"), (Places{topic + "/text", topic + "/txt (note)"}));
  EXPECT_EQ(package.of_topic(R"("text": [{"en": "only"}])"), Places{topic + "/text/0 (note)"});
  EXPECT_EQ(package.of_topic(R"("text": [{"en": "x", "de": 7}])"),
            (Places{topic + "/text/0/de", topic + "/text/0 (note)"}));
  EXPECT_EQ(package.of_topic(R"("text": [], "image": "picture.png")"),
            Places{topic + "/alt (note)"});
  EXPECT_EQ(package.of_topic(R"("text": [], "link": "https://example.org")"),
            Places{topic + "/link (note)"})
      << "topics have none";
  EXPECT_EQ(package.of_partner(R"("link": "https://example.org")"), Places{});
  for (const char* link : {"http://example.org", "https://", "javascript:alert(1)", "",
                           "https://a b", "HTTPS//x", "https://a\\n"})
    EXPECT_EQ(package.of_partner(R"("link": ")" + std::string(link) + '"'),
              Places{partner + "/link"})
        << link;
  EXPECT_EQ(package.of(R"("book": {"topics": [{"id": "a", "title": )" + both +
                       R"(, "text": []}, {"id": "a", "title": )" + both + R"(, "text": []}]})"),
            Places{"/book/topics/1/id"});
}

TEST(ExhibitBook, SlidesAreChecked) {
  Package package;
  const std::string slide = "/book/presentations/0/slides/0";
  EXPECT_EQ(package.of_slides(""), Places{"/book/presentations/0/slides"});
  EXPECT_EQ(package.of_slides(R"({"title": )" + both + "}"), Places{slide});
  EXPECT_EQ(
      package.of_slides(R"({"image": "picture.png", "video": "film.webm", "alt": )" + both + "}"),
      Places{slide + "/video"});
  for (const char* seconds : {"0", "0.5", "601", "-1"})
    EXPECT_EQ(package.of_slides(R"({"text": )" + both + R"(, "seconds": )" + seconds + "}"),
              Places{slide + "/seconds"})
        << seconds;
  EXPECT_EQ(package.of_slides(R"({"text": )" + both + R"(, "second": 3})"),
            Places{slide + "/second (note)"});
  EXPECT_EQ(package.of_slides(R"({"video": "picture.png", "alt": )" + both + "}"),
            Places{slide + "/video"});
  EXPECT_EQ(package.of_slides(R"({"image": "film.webm", "alt": )" + both + "}"),
            Places{slide + "/image"});
}

TEST(ExhibitBook, ListsHaveAnEnd) {
  Package package;
  auto page = [](size_t i) {
    return R"({"id": "a)" + std::to_string(i) + R"(", "title": )" + both + R"(, "text": []})";
  };
  auto slide = [](size_t) { return R"({"text": )" + both + "}"; };
  auto list = [&](const char* name, size_t count) {
    return package.of("\"book\": {\"" + std::string(name) + "\": [" + repeated(count, page) + "]}");
  };
  EXPECT_EQ(list("topics", most_topics), Places{});
  EXPECT_EQ(list("topics", most_topics + 1), Places{"/book/topics"});
  EXPECT_EQ(list("partners", most_partners + 1), Places{"/book/partners"});
  EXPECT_EQ(package.of_slides(repeated(most_slides, slide)), Places{});
  EXPECT_EQ(package.of_slides(repeated(most_slides + 1, slide)),
            Places{"/book/presentations/0/slides"});
  auto paragraph = [](size_t) { return both; };
  EXPECT_EQ(package.of_topic("\"text\": [" + repeated(most_paragraphs + 1, paragraph) + "]"),
            Places{"/book/topics/0/text"});
  auto presentation = [&](size_t i) {
    return R"({"id": "a)" + std::to_string(i) + R"(", "title": )" + both + R"(, "slides": [)" +
           slide(0) + "]}";
  };
  EXPECT_EQ(package.of(R"("book": {"presentations": [)" +
                       repeated(most_presentations + 1, presentation) + "]}"),
            Places{"/book/presentations"});
}

TEST(ExhibitBook, FilesAreOpenedAndDecoded) {
  Package package;
  const test::Folder& folder = package.folder;
  const Places bad = {"/book/topics/0/image"};
  EXPECT_EQ(package.of_picture("picture.png"), Places{});
  EXPECT_EQ(package.of_picture("missing.png"), bad);
  EXPECT_EQ(package.of_picture("../picture.png"), bad);
  EXPECT_EQ(package.of_picture("/etc/passwd"), bad);
  EXPECT_EQ(package.of_picture("./picture.png"), bad) << "two names for one file";
  EXPECT_EQ(package.of_picture(""), bad);
  folder.write("a picture.png", folder.read("picture.png"));
  EXPECT_EQ(package.of_picture("a picture.png"), bad) << "no name of an address";
  folder.write("text.png", "no picture");
  EXPECT_EQ(package.of_picture("text.png"), bad);
  std::string png = folder.read("picture.png");
  folder.write("half.png", png.substr(0, png.size() / 2));
  EXPECT_EQ(package.of_picture("half.png"), bad);
  save_image8(folder.file("long.png"),
              {longest_image_side + 1, 1, std::vector<uint8_t>(3 * (longest_image_side + 1), 9)});
  EXPECT_EQ(package.of_picture("long.png"), bad);
  EXPECT_TRUE(package.exhibit.files.empty());
  folder.write("heavy.png", png + std::string(most_image_bytes, 'x'));
  EXPECT_EQ(package.of_picture("heavy.png"), bad);
  std::filesystem::create_symlink("/etc/passwd", folder.file("link.png"));
  EXPECT_EQ(package.of_picture("link.png"), bad);

  auto film = [&](const std::string& bytes) {
    folder.write("other.webm", bytes);
    return package.of_slides(R"({"video": "other.webm", "alt": )" + both + "}");
  };
  const Places bad_film = {"/book/presentations/0/slides/0/video"};
  EXPECT_EQ(film(webm), Places{});
  EXPECT_EQ(film("\x1a\x45\xdf\xa3\x42\x82\x88matroska"), bad_film);
  EXPECT_EQ(film(std::string("\0\0\0\x18"
                             "ftypisom",
                             12)),
            Places{});
  EXPECT_EQ(film(std::string("\0\0\0\x18"
                             "ftypqt  ",
                             12)),
            bad_film);
  EXPECT_EQ(film("RIFF....AVI "), bad_film);
  folder.write("other.webm", webm);
  std::filesystem::resize_file(folder.file("other.webm"), most_video_bytes + 1);
  EXPECT_EQ(package.of_slides(R"({"video": "other.webm", "alt": )" + both + "}"), bad_film);
}

TEST(ExhibitBook, EntityTagsAreOfTheBytes) {
  Package package;
  auto etag = [&](const std::string& bytes) {
    package.folder.write("film.webm", bytes);
    package.load(R"("book": {"presentations": [{"id": "p", "title": "P", "slides": [
        {"video": "film.webm"}]}]})");
    return package.exhibit.files.at("film.webm").etag;
  };
  const std::string first = etag(webm);
  EXPECT_EQ(first, etag(webm));
  std::string other = webm;
  other.back() ^= 1;
  EXPECT_NE(first, etag(other));
}

TEST(ExhibitSounds, AreChecked) {
  Package package;
  auto sound = [&](const std::string& fields) {
    return package.of(R"("sounds": [{"id": "a", )" + fields + "}]");
  };
  const std::string at = "/sounds/0";
  for (const char* kind : {"fire", "water", "room", "wind"})
    EXPECT_EQ(sound(R"("kind": ")" + std::string(kind) + '"'), Places{}) << kind;
  EXPECT_EQ(sound(R"("kind": "thunder")"), Places{at + "/kind"});
  EXPECT_EQ(sound(R"("gain": 1)"), Places{at});
  EXPECT_EQ(sound(R"("kind": "fire", "file": "hum.ogg")"), Places{at});
  EXPECT_EQ(sound(R"("file": "picture.png")"), Places{at + "/file"});
  EXPECT_EQ(sound(R"("kind": "fire", "gain": 1.5)"), Places{at + "/gain"});
  EXPECT_EQ(sound(R"("kind": "fire", "radius": 0)"), Places{at + "/radius"});
  EXPECT_EQ(sound(R"("kind": "fire", "position": [1, 2])"), Places{at + "/position"});
  EXPECT_EQ(sound(R"("kind": "fire", "loud": 1)"), Places{at + "/loud (note)"});
  EXPECT_EQ(package.of(R"("sounds": [{"id": "a", "kind": "fire"}, {"id": "a", "kind": "wind"}])"),
            Places{"/sounds/1/id"});
  auto one = [](size_t i) { return R"({"kind": "room", "id": "s)" + std::to_string(i) + "\"}"; };
  EXPECT_EQ(package.of("\"sounds\": [" + repeated(most_sounds + 1, one) + "]"), Places{"/sounds"});
}

TEST(MediaType, IsKnownByTheFirstBytes) {
  EXPECT_EQ(media_type(Medium::image, "\xff\xd8\xff\xe0"), "image/jpeg");
  EXPECT_EQ(media_type(Medium::sound, "RIFF....WAVEfmt "), "audio/wav");
  EXPECT_EQ(media_type(Medium::sound, "RIFF....AVI "), "");
  EXPECT_EQ(media_type(Medium::sound, "ID3"), "audio/mpeg");
  EXPECT_EQ(media_type(Medium::sound, "\xff\xfb"), "audio/mpeg");
  EXPECT_EQ(media_type(Medium::sound, "\xff\xf1"), "") << "ADTS, which is AAC";
  EXPECT_EQ(media_type(Medium::sound, "fLaC"), "audio/flac");
  EXPECT_EQ(media_type(Medium::image, "GIF89a"), "");
  for (Medium medium : {Medium::image, Medium::video, Medium::sound})
    EXPECT_EQ(media_type(medium, ""), "");
}
