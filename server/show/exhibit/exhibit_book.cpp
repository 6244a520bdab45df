// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/exhibit_book.h"

#include <algorithm>
#include <set>

#include "show/exhibit/exhibit_files.h"

namespace wellspring::show {
namespace {

struct BookReader {
  Exhibit& exhibit;

  void want_languages(FieldReader& fields, const std::string& place, const LocalText& text) {
    for (const std::string& lang : exhibit.languages)
      if (!text.empty() && !text.contains(lang))
        fields.warn(place, "has nothing in '" + lang + "'");
  }

  LocalText text(FieldReader& fields, const char* name, const char* about,
                 Need need = Need::optional) {
    LocalText text = read_local_text(fields, name, about, need);
    want_languages(fields, name, text);
    return text;
  }

  std::string id(FieldReader& fields, std::set<std::string>& taken) {
    std::string id;
    if (fields.text("id", id, "", Need::required) && !taken.insert(id).second)
      fields.fail("id", "'" + id + "' is taken by another one of this list");
    return id;
  }

  // Reads the name of a file that browsers will be given; empty: none, or one that cannot be.
  std::string file(FieldReader& fields, const char* name, const char* about, Medium medium) {
    std::string file;
    if (fields.text(name, file, about) && file.empty()) fields.fail(name, "is empty");
    return add_served_file(exhibit, fields, name, file, medium) ? file : "";
  }

  LocalText alt(FieldReader& fields, bool shows) {
    LocalText alt = text(fields, "alt", "what is seen, for those who do not see it");
    if (shows && alt.empty())
      fields.warn("alt", "is missing: what is seen, for those who do not see it");
    return alt;
  }

  BookPage page(FieldReader& fields, std::set<std::string>& taken, bool partner) {
    BookPage page;
    page.id = id(fields, taken);
    page.title = text(fields, "title", "", Need::required);
    page.text = read_local_texts(fields, "text", most_paragraphs, "paragraphs", Need::required);
    for (size_t i = 0; i < page.text.size(); i++)
      want_languages(fields, "text/" + std::to_string(i), page.text[i]);
    page.image = file(fields, "image", "JPEG or PNG", Medium::image);
    page.alt = alt(fields, fields.has("image"));
    if (partner) page.link = read_address(fields, "link", "https", false);
    else page.credit = text(fields, "credit", "who owns the picture");
    return page;
  }

  BookSlide slide(FieldReader& fields) {
    BookSlide slide;
    slide.title = text(fields, "title", "");
    slide.text = text(fields, "text", "");
    slide.image = file(fields, "image", "JPEG or PNG", Medium::image);
    slide.video = file(fields, "video", "WebM or MP4", Medium::video);
    bool image = fields.has("image"), video = fields.has("video");
    if (image && video) fields.fail("video", "is there beside an \"image\": one of them only");
    if (!image && !video && slide.text.empty())
      fields.fail("has neither \"image\" nor \"video\" nor \"text\"");
    slide.alt = alt(fields, image || video);
    fields.number("seconds", shortest_slide, longest_slide, slide.seconds, "how long it is shown");
    return slide;
  }

  BookPresentation presentation(FieldReader& fields, std::set<std::string>& taken) {
    BookPresentation presentation;
    presentation.id = id(fields, taken);
    presentation.title = text(fields, "title", "", Need::required);
    fields.parts(
        "slides", most_slides, "at least one",
        [&](FieldReader& one) { presentation.slides.push_back(slide(one)); }, Need::required);
    if (presentation.slides.empty()) fields.fail("slides", "must have at least one slide");
    return presentation;
  }
};

}  // namespace

void read_book(Exhibit& exhibit, FieldReader& root) {
  BookReader reader{exhibit};
  root.part("book", "what a kiosk's guests read", [&](FieldReader& fields) {
    Book book;
    std::set<std::string> topics, partners, presentations;
    fields.parts("topics", most_topics, "", [&](FieldReader& page) {
      book.topics.push_back(reader.page(page, topics, false));
    });
    fields.parts("partners", most_partners, "", [&](FieldReader& page) {
      book.partners.push_back(reader.page(page, partners, true));
    });
    fields.parts("presentations", most_presentations, "", [&](FieldReader& one) {
      book.presentations.push_back(reader.presentation(one, presentations));
    });
    exhibit.book = std::move(book);
  });
}

void read_ambient_sounds(Exhibit& exhibit, FieldReader& root) {
  BookReader reader{exhibit};
  std::set<std::string> taken;
  root.parts("sounds", most_sounds, "", [&](FieldReader& fields) {
    AmbientSound sound;
    sound.id = reader.id(fields, taken);
    fields.word("kind", {"fire", "water", "room", "wind"}, sound.kind, "made by the browser");
    sound.file = reader.file(fields, "file", "Ogg, MP3, WAV or FLAC", Medium::sound);
    if (fields.has("kind") == fields.has("file"))
      fields.fail("has either a \"kind\" or a \"file\"");
    fields.spot("position", most_metres, sound.position, "without one it is everywhere");
    fields.number("gain", 0, 1, sound.gain, "how loud it is");
    fields.number("radius", 0.1, 1000, sound.radius, "metres at which it is gone");
    exhibit.sounds.push_back(std::move(sound));
  });
}

}  // namespace wellspring::show
