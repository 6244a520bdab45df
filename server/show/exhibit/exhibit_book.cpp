// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/exhibit_book.h"

#include <algorithm>
#include <set>

#include "show/exhibit/exhibit_files.h"

namespace wellspring::show {
namespace {

struct BookReader {
  Exhibit& exhibit;

  void want_languages(Fields& fields, const std::string& place, const LocalText& text) {
    for (const std::string& lang : exhibit.languages)
      if (!text.empty() && !text.contains(lang))
        fields.problem(place, "has nothing in '" + lang + "'", false);
  }

  LocalText text(Fields& fields, const char* name, bool required) {
    LocalText text = fields.local_text(name, required);
    want_languages(fields, name, text);
    return text;
  }

  std::string id(Fields& fields, std::set<std::string>& taken) {
    std::string id = fields.text("id", true);
    if (!id.empty() && !taken.insert(id).second)
      fields.problem("id", "'" + id + "' is taken by another one of this list");
    return id;
  }

  // The name of a file that browsers will be given; empty: none, or one that cannot be.
  std::string file(Fields& fields, const char* name, Medium medium) {
    std::string file = fields.text(name, false);
    if (file.empty() && fields.has(name)) fields.problem(name, "is empty");
    return add_served_file(exhibit, fields, name, file, medium) ? file : "";
  }

  LocalText alt(Fields& fields, bool shows) {
    LocalText alt = text(fields, "alt", false);
    if (shows && alt.empty())
      fields.problem("alt", "is missing: what is seen, for those who do not see it", false);
    return alt;
  }

  BookPage page(Fields& fields, std::set<std::string>& taken, bool partner) {
    BookPage page;
    page.id = id(fields, taken);
    page.title = text(fields, "title", true);
    page.text = fields.local_texts("text", true);
    if (page.text.size() > most_paragraphs)
      fields.problem("text", "has more than " + std::to_string(most_paragraphs) + " paragraphs");
    for (size_t i = 0; i < page.text.size(); i++)
      want_languages(fields, "text/" + std::to_string(i), page.text[i]);
    page.image = file(fields, "image", Medium::image);
    page.alt = alt(fields, fields.has("image"));
    if (partner) page.link = fields.text("link", false);
    else page.credit = text(fields, "credit", false);
    bool good_link = page.link.starts_with("https://") && page.link.size() > 8 &&
                     std::all_of(page.link.begin(), page.link.end(),
                                 [](unsigned char c) { return c > ' ' && c != 0x7f; });
    if (fields.has("link") && partner && !good_link)
      fields.problem("link", "must be an address that begins with https://");
    fields.finish();
    return page;
  }

  BookSlide slide(Fields& fields) {
    BookSlide slide;
    slide.title = text(fields, "title", false);
    slide.text = text(fields, "text", false);
    slide.image = file(fields, "image", Medium::image);
    slide.video = file(fields, "video", Medium::video);
    bool image = fields.has("image"), video = fields.has("video");
    if (image && video) fields.problem("video", "is there beside an \"image\": one of them only");
    if (!image && !video && slide.text.empty())
      fields.problem("", "has neither \"image\" nor \"video\" nor \"text\"");
    slide.alt = alt(fields, image || video);
    slide.seconds = fields.number("seconds", false, slide.seconds, shortest_slide, longest_slide);
    fields.finish();
    return slide;
  }
};

// False with a problem: the list is full.
bool has_place(Fields& fields, size_t count, size_t most, const char* what) {
  if (count < most) return true;
  fields.problem("", "is one more than the " + std::to_string(most) + " " + what);
  return false;
}

}  // namespace

void read_book(Exhibit& exhibit, Fields& root) {
  BookReader reader{exhibit};
  root.object("book", false, [&](Fields book_fields) {
    Book book;
    std::set<std::string> topics, partners, presentations;
    book_fields.objects("topics", false, [&](Fields fields) {
      if (has_place(fields, book.topics.size(), most_topics, "topics a book may have"))
        book.topics.push_back(reader.page(fields, topics, false));
    });
    book_fields.objects("partners", false, [&](Fields fields) {
      if (has_place(fields, book.partners.size(), most_partners, "partners a book may have"))
        book.partners.push_back(reader.page(fields, partners, true));
    });
    book_fields.objects("presentations", false, [&](Fields fields) {
      if (!has_place(fields, book.presentations.size(), most_presentations,
                     "presentations a book may have"))
        return;
      BookPresentation presentation;
      presentation.id = reader.id(fields, presentations);
      presentation.title = reader.text(fields, "title", true);
      fields.objects("slides", true, [&](Fields slide_fields) {
        if (has_place(slide_fields, presentation.slides.size(), most_slides,
                      "slides a presentation may have"))
          presentation.slides.push_back(reader.slide(slide_fields));
      });
      if (presentation.slides.empty()) fields.problem("slides", "must have at least one slide");
      fields.finish();
      book.presentations.push_back(std::move(presentation));
    });
    book_fields.finish();
    exhibit.book = std::move(book);
  });
}

void read_ambient_sounds(Exhibit& exhibit, Fields& root) {
  BookReader reader{exhibit};
  std::set<std::string> taken;
  root.objects("sounds", false, [&](Fields fields) {
    if (!has_place(fields, exhibit.sounds.size(), most_sounds, "sounds an exhibit may have"))
      return;
    AmbientSound sound;
    sound.id = reader.id(fields, taken);
    sound.kind = fields.text("kind", false);
    sound.file = reader.file(fields, "file", Medium::sound);
    if (fields.has("kind") == fields.has("file"))
      fields.problem("", "has either a \"kind\" or a \"file\"");
    bool known = std::find(std::begin(sound_kinds), std::end(sound_kinds), sound.kind) !=
                 std::end(sound_kinds);
    if (fields.has("kind") && !known)
      fields.problem("kind", "is '" + sound.kind + "' but must be fire, water, room or wind");
    if (fields.has("position")) sound.position = fields.triple("position", true);
    sound.gain = fields.number("gain", false, sound.gain, 0, 1);
    sound.radius = fields.number("radius", false, sound.radius, 0.1, 1000);
    fields.finish();
    exhibit.sounds.push_back(std::move(sound));
  });
}

}  // namespace wellspring::show
