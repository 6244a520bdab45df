// SPDX-License-Identifier: Apache-2.0
#include "avatar/story/story_script.h"

#include <algorithm>
#include <array>
#include <set>

#include "avatar/speech/text.h"
#include "avatar/story/story_markup.h"
#include "avatar/story/subtitle.h"
#include "base/load_error.h"

namespace wellspring::avatar {

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c & 0x80) || ((c | 32) >= 'a' && (c | 32) <= 'z'); }

// Returns the bytes of one of `marks` at the beginning of `text`; 0: none.
template <size_t N>
size_t mark_of(std::string_view text, const std::array<std::string_view, N>& marks) {
  for (std::string_view mark : marks)
    if (text.substr(0, mark.size()) == mark) return mark.size();
  return 0;
}

constexpr std::array<std::string_view, 9> ends = {".", "!", "?", "…", "。", "！", "？", "؟", "।"};
constexpr std::array<std::string_view, 9> closings = {"\"", "'", ")", "]", "”", "’", "“", "»", "«"};

// Returns whether `text` begins with a small letter of the Latin, Greek or Cyrillic script, as far
// as the bytes show case: ASCII, Latin-1, and Latin Extended-A by its pairs.
bool begins_small(std::string_view text) {
  if (text.empty()) return false;
  unsigned char a = static_cast<unsigned char>(text[0]);
  if (a < 0x80) return a >= 'a' && a <= 'z';
  if (text.size() < 2 || (a & 0xe0) != 0xc0) return false;
  unsigned code = (a & 0x1fu) << 6 | (static_cast<unsigned char>(text[1]) & 0x3fu);
  if (code >= 0xdf && code <= 0xff) return code != 0xf7;
  if (code >= 0x100 && code <= 0x17f) {
    bool odd_is_small = code < 0x139 || (code > 0x148 && code < 0x179);
    return (code % 2 == 1) == odd_is_small;
  }
  return (code >= 0x3ac && code <= 0x3ce) || (code >= 0x430 && code <= 0x45f);
}

// Returns whether the full stop at `at` belongs to the text before it.
bool abbreviates(std::string_view text, size_t at, size_t begin) {
  if (at == begin) return true;
  if (is_digit(text[at - 1]))
    return at < begin + 3 || !is_digit(text[at - 3]);  // 13. but not 1786.
  size_t word = at;
  while (word > begin && is_letter(text[word - 1])) word--;
  size_t characters = 0;
  for (size_t i = word; i < at; i++) characters += (text[i] & 0xc0) != 0x80;
  return characters == 1;
}

}  // namespace

std::vector<TextSpan> find_sentences(std::string_view text) {
  std::vector<TextSpan> spans;
  size_t begin = 0, at = 0;
  auto close = [&](size_t end) {
    size_t from = begin, to = end;
    while (from < to && is_space(text[from])) from++;
    while (to > from && is_space(text[to - 1])) to--;
    if (to > from) spans.push_back({uint32_t(from), uint32_t(to)});
    begin = end;
  };
  while (at < text.size()) {
    size_t mark = mark_of(text.substr(at), ends);
    if (mark == 0) {
      at++;
      continue;
    }
    bool lone_stop = text[at] == '.' && abbreviates(text, at, begin);
    size_t end = at;
    while (size_t more = mark_of(text.substr(end), ends)) end += more;
    lone_stop = lone_stop && end == at + 1;
    while (size_t more = mark_of(text.substr(end), closings)) end += more;
    bool wide = mark == 3 && text.substr(at, 3) != "…";  // no space follows 。
    size_t next = end;
    while (next < text.size() && is_space(text[next])) next++;
    bool ends_here =
        next == text.size() || wide || (next > end && !begins_small(text.substr(next)));
    if (ends_here && (!lone_stop || next == text.size())) close(end);
    at = end;
  }
  close(text.size());
  return spans;
}

namespace {

// Collects a paragraph: its text with single spaces, and what stands at its bytes.
struct Paragraph {
  std::string text;
  bool space = false;  // a space is due before the next character
  std::vector<SpeechStyle> styles;
  std::vector<StoryMark> marks;
  // bytes at which words begin, and their places in the file
  std::vector<std::pair<uint32_t, MarkupPlace>> places;

  uint32_t here() const { return uint32_t(text.size() + (space && !text.empty())); }
};

struct Builder {
  const std::string& file;
  StoryScript script;
  Paragraph paragraph;
  std::vector<std::pair<StoryMark, StoryMark>> held;  // emotions of open tags and the ones before
  StoryMark emotion;                                  // the emotion in force
  struct Open {
    size_t style = SIZE_MAX;  // index into the paragraph's styles
    SpeechStyle manner;
    bool emotion = false, sentence = false, paragraph = false;
  };
  std::vector<Open> open;
  std::set<std::string> unknown;

  [[noreturn]] void fail(const MarkupPlace& place, const std::string& what) const {
    throw LoadError(file, to_string(place), what);
  }
  void note(const MarkupPlace& place, const std::string& what) {
    script.notes.push_back({place, what});
  }

  // ---- text ----

  void add_text(const std::string& text, MarkupPlace place) {
    int newlines = 0;
    for (char c : text) {
      if (c == '\n') {
        place = {place.line + 1, 1};
        if (++newlines == 2 && !in_sentence()) end_paragraph();
      } else if ((c & 0xc0) != 0x80) {
        place.column++;
      }
      if (is_space(c)) {
        paragraph.space = true;
        continue;
      }
      newlines = 0;
      // control characters do not belong in subtitles
      if (static_cast<unsigned char>(c) < 0x20) continue;
      if (paragraph.space && !paragraph.text.empty()) paragraph.text += ' ';
      if (paragraph.space || paragraph.text.empty()) {
        MarkupPlace from = place;
        from.column = std::max(1, from.column - 1);
        paragraph.places.emplace_back(uint32_t(paragraph.text.size()), from);
      }
      paragraph.space = false;
      paragraph.text += c;
    }
  }

  bool in_sentence() const {
    return std::any_of(open.begin(), open.end(), [](const Open& tag) { return tag.sentence; });
  }

  MarkupPlace place_of(uint32_t byte) const {
    MarkupPlace place;
    for (const auto& [from, at] : paragraph.places)
      if (from <= byte) place = at;
    return place;
  }

  // Turns the collected text into lines: one sentence, or as many as are found.
  void flush(bool one_sentence) {
    const std::string& text = paragraph.text;
    std::vector<TextSpan> spans;
    if (one_sentence && !text.empty()) spans = {{0, uint32_t(text.size())}};
    else spans = find_sentences(text);
    for (size_t i = 0; i < spans.size(); i++) {
      TextSpan span = spans[i];
      // Marks between two sentences belong to the one whose word they touch.
      uint32_t until = i + 1 < spans.size() ? spans[i + 1].begin : uint32_t(text.size()) + 2;
      StoryLine line;
      line.text = text.substr(span.begin, span.end - span.begin);
      line.place = place_of(span.begin);
      if (line.text.size() > most_line_bytes)
        fail(line.place, "a sentence is longer than " + std::to_string(most_line_bytes) + " bytes");
      for (SpeechStyle style : paragraph.styles) {
        bool pause_only = style.begin == style.end;
        if (pause_only && style.begin >= span.end && style.begin < until + (i + 1 < spans.size()))
          line.pause = std::max(line.pause, style.pause);
        bool inside = pause_only ? style.begin > span.begin && style.begin < span.end
                                 : style.begin < span.end && style.end > span.begin;
        bool leads = pause_only && i == 0 && style.begin <= span.begin && !script.lines.empty();
        if (leads) script.lines.back().pause = std::max(script.lines.back().pause, style.pause);
        if (!inside) continue;
        style.begin = std::max(style.begin, span.begin) - span.begin;
        style.end = std::min(style.end, span.end) - span.begin;
        line.styles.push_back(style);
      }
      for (StoryMark mark : paragraph.marks) {
        uint32_t from = i == 0 ? 0 : span.begin;
        if (mark.at < from || mark.at >= until) continue;
        mark.at = std::min(std::max(mark.at, span.begin), span.end) - span.begin;
        line.marks.push_back(std::move(mark));
      }
      std::stable_sort(line.marks.begin(), line.marks.end(),
                       [](const StoryMark& a, const StoryMark& b) { return a.at < b.at; });
      script.lines.push_back(std::move(line));
    }
    carry_over(spans.empty());
  }

  // Carries open tags over into the next paragraph, and marks without a word after them.
  void carry_over(bool nothing_said) {
    Paragraph next;
    if (nothing_said) {
      for (StoryMark& mark : paragraph.marks) {
        mark.at = 0;
        next.marks.push_back(std::move(mark));
      }
      for (SpeechStyle& style : paragraph.styles)
        if (style.begin == style.end && !script.lines.empty())
          script.lines.back().pause = std::max(script.lines.back().pause, style.pause);
    }
    paragraph = std::move(next);
    for (Open& tag : open)
      if (tag.style != SIZE_MAX) {
        tag.style = paragraph.styles.size();
        paragraph.styles.push_back(tag.manner);
        paragraph.styles.back().begin = 0;
      }
  }

  void close_styles() {
    for (const Open& tag : open)
      if (tag.style != SIZE_MAX) paragraph.styles[tag.style].end = uint32_t(paragraph.text.size());
  }

  void end_sentence(bool one) {
    close_styles();
    flush(one);
  }

  void end_paragraph() {
    end_sentence(false);
    if (!script.lines.empty())
      script.lines.back().pause = std::max(script.lines.back().pause, paragraph_pause);
  }

  // ---- tags ----

  const std::string& need(const MarkupPiece& piece, const char* name) const {
    const std::string* value = find_attribute(piece, name);
    if (!value || value->empty())
      fail(piece.place, "<" + piece.name + "> needs the attribute " + name);
    return *value;
  }

  // Returns the value of an attribute; `otherwise` without it.
  template <class T>
  T value(const MarkupPiece& piece, const char* name, std::optional<T> (*read)(const std::string&),
          T otherwise) const {
    const std::string* text = find_attribute(piece, name);
    if (!text) return otherwise;
    std::optional<T> value = read(*text);
    if (!value) fail(piece.place, "<" + piece.name + ">: '" + *text + "' is no value for " + name);
    return *value;
  }

  StoryMark mark_of(const MarkupPiece& piece, StoryMarkKind kind, std::string name) {
    return {kind, paragraph.here(), std::move(name), value<float>(piece, "weight", read_weight, 1),
            piece.place};
  }

  PieceMark piece_mark_of(const MarkupPiece& piece) const {
    auto id = [&](const char* name) {
      const std::string* value = find_attribute(piece, name);
      return value ? *value : "";
    };
    auto number = [&](const char* name, std::optional<float> (*read)(const std::string&)) {
      std::optional<float> given;
      if (find_attribute(piece, name)) given = value<float>(piece, name, read, 0);
      return given;
    };
    PieceMark mark{.layer = id("layer"), .over = id("over")};
    mark.share = value<float>(piece, "share", read_weight, 0.5f);
    mark.turn = number("turn", read_turn), mark.cut = number("cut", read_weight);
    return mark;
  }

  void set_emotion(StoryMark mark) {
    mark.at = paragraph.here();
    emotion = mark;
    paragraph.marks.push_back(std::move(mark));
  }

  bool read_mark(const MarkupPiece& piece, Open& tag) {
    const std::string& name = piece.name;
    if (name == "emotion") {
      StoryMark before = emotion;
      std::string which = need(piece, "name");
      set_emotion(mark_of(piece, StoryMarkKind::emotion, which == "neutral" ? "" : which));
      tag.emotion = true;
      held.emplace_back(emotion, before);
    } else if (name == "gesture") {
      paragraph.marks.push_back(mark_of(piece, StoryMarkKind::gesture, need(piece, "name")));
    } else if (name == "look" || name == "point") {
      StoryMarkKind kind = name == "look" ? StoryMarkKind::look : StoryMarkKind::point;
      std::string at = need(piece, "at");
      bool none = at == "visitor" || at == "nothing";
      paragraph.marks.push_back(mark_of(piece, kind, none ? "" : at));
    } else if (name == "hold") {
      std::string prop = need(piece, "name");
      paragraph.marks.push_back(mark_of(piece, StoryMarkKind::hold, prop == "nothing" ? "" : prop));
    } else if (name == "view") {
      paragraph.marks.push_back(mark_of(piece, StoryMarkKind::view, need(piece, "name")));
    } else if (name == "show") {
      paragraph.marks.push_back(mark_of(piece, StoryMarkKind::show, need(piece, "piece")));
      paragraph.marks.back().piece = piece_mark_of(piece);
    } else if (name == "mark") {
      paragraph.marks.push_back(mark_of(piece, StoryMarkKind::mark, need(piece, "name")));
    } else {
      return false;
    }
    return true;
  }

  void read_style(const MarkupPiece& piece, Open& tag) {
    const std::string& name = piece.name;
    SpeechStyle& style = tag.manner;
    if (name == "prosody") {
      style.rate = value<float>(piece, "rate", read_rate, 1);
      style.volume = value<float>(piece, "volume", read_volume, 1);
      const std::string* pitch = find_attribute(piece, "pitch");
      if (pitch && pitch->ends_with("Hz")) note(piece.place, "pitch in Hz is not done");
      else style.pitch = value<float>(piece, "pitch", read_pitch, 1);
      for (const char* other : {"contour", "range", "duration"})
        if (find_attribute(piece, other) && unknown.insert(std::string("prosody ") + other).second)
          note(piece.place, std::string("<prosody ") + other + "> is not done");
    } else if (name == "emphasis") {
      style.emphasis = value<int>(piece, "level", read_emphasis, 1);
      if (style.emphasis > 0) {
        StoryMark beat = mark_of(piece, StoryMarkKind::beat, "");
        beat.weight = style.emphasis == 2 ? 1.0f : 0.6f;
        paragraph.marks.push_back(beat);
      }
    } else {  // sub
      style.alias = need(piece, "alias");
    }
    if (piece.kind != MarkupPiece::Kind::open) return;
    style.begin = paragraph.here();
    tag.style = paragraph.styles.size();
    paragraph.styles.push_back(style);
  }

  void read_break(const MarkupPiece& piece) {
    float seconds = value<float>(piece, "strength", read_break_strength, 0.35f);
    seconds = value<float>(piece, "time", read_seconds, seconds);
    SpeechStyle style;
    style.begin = style.end = paragraph.here();
    style.pause = seconds;
    paragraph.styles.push_back(style);
  }

  void read_open(const MarkupPiece& piece) {
    const std::string& name = piece.name;
    Open tag;
    if (name == "break") {
      read_break(piece);
    } else if (name == "p" || name == "paragraph") {
      end_paragraph();
      tag.paragraph = true;
    } else if (name == "s" || name == "sentence") {
      end_sentence(false);
      tag.sentence = true;
    } else if (name == "prosody" || name == "emphasis" || name == "sub") {
      read_style(piece, tag);
    } else if (!read_mark(piece, tag)) {
      static const std::set<std::string> silent = {"speak", "story", "say-as",
                                                   "w",     "token", "metadata"};
      if (!silent.contains(name) && unknown.insert(name).second)
        note(piece.place, "<" + name + "> is not known; what stands inside is said as it is");
    }
    if (piece.kind == MarkupPiece::Kind::open) {
      open.push_back(std::move(tag));
      return;
    }
    if (tag.emotion) held.pop_back();  // <emotion/> holds until the next
    if (tag.sentence) end_sentence(true);
    if (tag.paragraph) end_paragraph();
  }

  void read_close() {
    Open tag = open.back();
    if (tag.sentence) end_sentence(true);
    if (tag.paragraph) end_paragraph();
    open.pop_back();
    if (tag.style != SIZE_MAX && !tag.sentence && tag.style < paragraph.styles.size())
      paragraph.styles[tag.style].end = uint32_t(paragraph.text.size());
    if (tag.emotion) {
      set_emotion(held.back().second);
      held.pop_back();
    }
  }

  void finish() {
    end_sentence(false);
    // Marks after the last word belong to its end.
    for (StoryMark mark : paragraph.marks) {
      if (script.lines.empty()) break;
      mark.at = uint32_t(script.lines.back().text.size());
      script.lines.back().marks.push_back(std::move(mark));
    }
    bool speaks = std::any_of(script.lines.begin(), script.lines.end(),
                              [](const StoryLine& line) { return !line.text.empty(); });
    if (!speaks) fail({}, "there is nothing to say");
    script.lines.back().pause = 0;
  }
};

StoryScript read_pieces(const std::vector<MarkupPiece>& pieces, const std::string& file,
                        bool one_line) {
  Builder builder{file, {}, {}, {}, {}, {}, {}};
  builder.emotion.kind = StoryMarkKind::emotion;
  if (one_line) builder.open.emplace_back().sentence = true;
  for (const MarkupPiece& piece : pieces) {
    if (piece.kind == MarkupPiece::Kind::text) builder.add_text(piece.text, piece.place);
    else if (piece.kind == MarkupPiece::Kind::close) builder.read_close();
    else builder.read_open(piece);
  }
  if (one_line) builder.end_sentence(true);
  builder.finish();
  return std::move(builder.script);
}

}  // namespace

StoryScript read_story(std::string_view text, const std::string& file) {
  return read_pieces(read_markup(text, file), file, false);
}

StoryScript read_plain_story(std::string_view text, const std::string& file) {
  return read_pieces(read_plain_markup(text, file), file, false);
}

StoryScript read_subtitle_story(std::string_view text, const std::string& file) {
  const Subtitles subtitles = load_subtitles(text, file);
  std::vector<MarkupPiece> pieces;
  for (const SubtitleCue& cue : subtitles.cues) {
    MarkupPiece& piece = pieces.emplace_back();
    piece.text = cue.text + "\n";
    piece.place.line = cue.line;
  }
  StoryScript script = read_pieces(pieces, file, false);
  for (const auto& [line, what] : subtitles.notes) script.notes.push_back({{line, 1}, what});
  return script;
}

StoryScript read_story_line(std::string_view text, const std::string& file) {
  return read_pieces(read_markup(text, file), file, true);
}

}  // namespace wellspring::avatar
