// SPDX-License-Identifier: Apache-2.0
#include "avatar/story/story_markup.h"

#include <algorithm>

#include "avatar/speech/text.h"
#include "avatar/story/character_reference.h"
#include "base/load_error.h"

namespace wellspring::avatar {

namespace {

bool is_tag_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_name(char c) {
  return is_tag_letter(c) || (c >= '0' && c <= '9') || c == '-' || c == ':' || c == '.';
}

std::string small(std::string_view text) {
  std::string result(text);
  for (char& c : result)
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
  return result;
}

// "ssml:Break" -> "break".
std::string local_name(std::string_view name) {
  size_t colon = name.rfind(':');
  return small(colon == std::string_view::npos ? name : name.substr(colon + 1));
}

struct Reader {
  std::string_view text;
  const std::string& file;
  size_t at = 0;
  MarkupPlace place;
  std::vector<MarkupPiece> pieces;
  std::vector<std::pair<std::string, MarkupPlace>> open;

  [[noreturn]] void fail(const MarkupPlace& where, const std::string& what) const {
    throw LoadError(file, to_string(where), what);
  }
  bool ended() const { return at >= text.size(); }
  bool begins(std::string_view with) const { return text.substr(at, with.size()) == with; }
  void step(size_t bytes) {
    for (size_t end = std::min(at + bytes, text.size()); at < end; at++) {
      if (text[at] == '\n') place = {place.line + 1, 1};
      else if ((text[at] & 0xc0) != 0x80) place.column++;
    }
  }
  void skip_space() {
    while (!ended() && is_space(text[at])) step(1);
  }
  std::string_view name() {
    size_t from = at;
    while (!ended() && is_name(text[at])) step(1);
    return text.substr(from, at - from);
  }
  // Passes what stands until `end`, `end` too.
  std::string_view until(std::string_view end, const char* what) {
    MarkupPlace from = place;
    size_t found = text.find(end, at);
    if (found == std::string_view::npos) fail(from, std::string(what) + " does not end");
    std::string_view inside = text.substr(at, found - at);
    step(found + end.size() - at);
    return inside;
  }

  void add_text(std::string_view plain, const MarkupPlace& from) {
    if (plain.empty()) return;
    if (pieces.empty() || pieces.back().kind != MarkupPiece::Kind::text) {
      pieces.emplace_back();
      pieces.back().place = from;
    }
    pieces.back().text += plain;
  }

  void read_text() {
    MarkupPlace from = place;
    std::string plain;
    while (!ended() && !is_tag()) {
      if (size_t bytes = text[at] == '&' ? read_character_reference(text.substr(at), plain) : 0) {
        step(bytes);
      } else {
        plain += text[at];
        step(1);
      }
    }
    add_text(plain, from);
  }

  bool is_tag() const {
    if (text[at] != '<' || at + 1 >= text.size()) return false;
    char next = text[at + 1];
    return is_tag_letter(next) || next == '/' || next == '!' || next == '?';
  }

  void read_attributes(MarkupPiece& piece) {
    for (;;) {
      skip_space();
      if (ended()) fail(piece.place, "the tag <" + piece.name + "> does not end");
      if (text[at] == '>' || begins("/>")) return;
      MarkupPlace from = place;
      std::string_view key = name();
      if (key.empty()) fail(from, "the tag <" + piece.name + "> has an attribute without a name");
      skip_space();
      bool quoted = !ended() && text[at] == '=';
      if (quoted) {
        step(1);
        skip_space();
        quoted = !ended() && (text[at] == '"' || text[at] == '\'');
      }
      if (!quoted)
        fail(from, "the attribute " + std::string(key) + " of <" + piece.name +
                       "> needs a value in quotes");
      std::string_view quote = text.substr(at, 1);
      step(1);
      std::string_view raw = until(quote, "the value of an attribute");
      std::string value;
      for (size_t i = 0; i < raw.size();) {
        size_t bytes = raw[i] == '&' ? read_character_reference(raw.substr(i), value) : 0;
        if (bytes == 0) value += raw[i];
        i += std::max(bytes, size_t(1));
      }
      std::string local = local_name(key);
      if (find_attribute(piece, local))
        fail(from, "<" + piece.name + "> has the attribute " + local + " twice");
      piece.attributes.emplace_back(std::move(local), std::move(value));
    }
  }

  void read_tag() {
    if (begins("<!--")) return (void)until("-->", "a comment");
    if (begins("<![CDATA[")) {
      MarkupPlace from = place;
      step(9);
      return add_text(until("]]>", "CDATA"), from);
    }
    if (begins("<?")) return (void)until("?>", "a processing instruction");
    if (begins("<!")) return (void)until(">", "a declaration");
    MarkupPiece piece;
    piece.place = place;
    bool closing = begins("</");
    step(closing ? 2 : 1);
    piece.name = local_name(name());
    if (piece.name.empty()) fail(piece.place, "a tag has no name");
    if (closing) {
      skip_space();
      if (ended() || text[at] != '>')
        fail(piece.place, "the tag </" + piece.name + "> does not end");
      step(1);
      if (open.empty()) fail(piece.place, "</" + piece.name + "> closes what was never opened");
      if (open.back().first != piece.name)
        fail(piece.place, "</" + piece.name + "> stands where <" + open.back().first + "> of " +
                              to_string(open.back().second) + " must be closed first");
      open.pop_back();
      piece.kind = MarkupPiece::Kind::close;
    } else {
      read_attributes(piece);
      bool lone = begins("/>");
      step(lone ? 2 : 1);
      piece.kind = lone ? MarkupPiece::Kind::lone : MarkupPiece::Kind::open;
      if (!lone) open.emplace_back(piece.name, piece.place);
      if (open.size() > most_markup_depth) fail(piece.place, "tags are nested too deep");
    }
    pieces.push_back(std::move(piece));
  }
};

}  // namespace

std::string to_string(const MarkupPlace& place) {
  return "line " + std::to_string(place.line) + ", column " + std::to_string(place.column);
}

const std::string* find_attribute(const MarkupPiece& piece, std::string_view name) {
  for (const auto& [key, value] : piece.attributes)
    if (key == name) return &value;
  return nullptr;
}

namespace {
Reader open_text(std::string_view text, const std::string& file) {
  if (text.substr(0, 3) == "\xef\xbb\xbf") text.remove_prefix(3);
  Reader reader{text, file, 0, {}, {}, {}};
  if (text.size() > most_markup_bytes) reader.fail({}, "the text is longer than a mebibyte");
  if (size_t broken = find_broken_utf8(text); broken != std::string_view::npos) {
    reader.step(broken);
    reader.fail(reader.place, "the text is not UTF-8");
  }
  return reader;
}
}  // namespace

std::vector<MarkupPiece> read_plain_markup(std::string_view text, const std::string& file) {
  Reader reader = open_text(text, file);
  reader.add_text(reader.text, {});
  return std::move(reader.pieces);
}

std::vector<MarkupPiece> read_markup(std::string_view text, const std::string& file) {
  Reader reader = open_text(text, file);
  while (!reader.ended()) {
    if (reader.is_tag()) reader.read_tag();
    else reader.read_text();
  }
  if (!reader.open.empty())
    reader.fail(reader.open.back().second, "<" + reader.open.back().first + "> is never closed");
  return std::move(reader.pieces);
}

}  // namespace wellspring::avatar
