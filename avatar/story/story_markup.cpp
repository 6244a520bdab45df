// SPDX-License-Identifier: Apache-2.0
#include "avatar/story/story_markup.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <string_view>
#include <utility>

#include "avatar/speech/text.h"
#include "base/load_error.h"

namespace wellspring::avatar {
namespace {

// These names stand for code points from U+00A0 on, one each.
constexpr std::string_view latin_names =
    "nbsp iexcl cent pound curren yen brvbar sect uml copy ordf laquo not shy reg macr "
    "deg plusmn sup2 sup3 acute micro para middot cedil sup1 ordm raquo frac14 frac12 "
    "frac34 iquest Agrave Aacute Acirc Atilde Auml Aring AElig Ccedil Egrave Eacute "
    "Ecirc Euml Igrave Iacute Icirc Iuml ETH Ntilde Ograve Oacute Ocirc Otilde Ouml "
    "times Oslash Ugrave Uacute Ucirc Uuml Yacute THORN szlig agrave aacute acirc atilde "
    "auml aring aelig ccedil egrave eacute ecirc euml igrave iacute icirc iuml eth "
    "ntilde ograve oacute ocirc otilde ouml divide oslash ugrave uacute ucirc uuml "
    "yacute thorn yuml";

constexpr std::pair<std::string_view, uint32_t> other_names[] = {
    {"quot", 0x22},      {"amp", 0x26},      {"apos", 0x27},      {"lt", 0x3c},
    {"gt", 0x3e},        {"OElig", 0x152},   {"oelig", 0x153},    {"Scaron", 0x160},
    {"scaron", 0x161},   {"Yuml", 0x178},    {"fnof", 0x192},     {"circ", 0x2c6},
    {"tilde", 0x2dc},    {"Alpha", 0x391},   {"Beta", 0x392},     {"Gamma", 0x393},
    {"Delta", 0x394},    {"Epsilon", 0x395}, {"Zeta", 0x396},     {"Eta", 0x397},
    {"Theta", 0x398},    {"Iota", 0x399},    {"Kappa", 0x39a},    {"Lambda", 0x39b},
    {"Mu", 0x39c},       {"Nu", 0x39d},      {"Xi", 0x39e},       {"Omicron", 0x39f},
    {"Pi", 0x3a0},       {"Rho", 0x3a1},     {"Sigma", 0x3a3},    {"Tau", 0x3a4},
    {"Upsilon", 0x3a5},  {"Phi", 0x3a6},     {"Chi", 0x3a7},      {"Psi", 0x3a8},
    {"Omega", 0x3a9},    {"alpha", 0x3b1},   {"beta", 0x3b2},     {"gamma", 0x3b3},
    {"delta", 0x3b4},    {"epsilon", 0x3b5}, {"zeta", 0x3b6},     {"eta", 0x3b7},
    {"theta", 0x3b8},    {"iota", 0x3b9},    {"kappa", 0x3ba},    {"lambda", 0x3bb},
    {"mu", 0x3bc},       {"nu", 0x3bd},      {"xi", 0x3be},       {"omicron", 0x3bf},
    {"pi", 0x3c0},       {"rho", 0x3c1},     {"sigmaf", 0x3c2},   {"sigma", 0x3c3},
    {"tau", 0x3c4},      {"upsilon", 0x3c5}, {"phi", 0x3c6},      {"chi", 0x3c7},
    {"psi", 0x3c8},      {"omega", 0x3c9},   {"thetasym", 0x3d1}, {"upsih", 0x3d2},
    {"piv", 0x3d6},      {"ensp", 0x2002},   {"emsp", 0x2003},    {"thinsp", 0x2009},
    {"zwnj", 0x200c},    {"zwj", 0x200d},    {"lrm", 0x200e},     {"rlm", 0x200f},
    {"ndash", 0x2013},   {"mdash", 0x2014},  {"lsquo", 0x2018},   {"rsquo", 0x2019},
    {"sbquo", 0x201a},   {"ldquo", 0x201c},  {"rdquo", 0x201d},   {"bdquo", 0x201e},
    {"dagger", 0x2020},  {"Dagger", 0x2021}, {"bull", 0x2022},    {"hellip", 0x2026},
    {"permil", 0x2030},  {"prime", 0x2032},  {"Prime", 0x2033},   {"lsaquo", 0x2039},
    {"rsaquo", 0x203a},  {"oline", 0x203e},  {"frasl", 0x2044},   {"euro", 0x20ac},
    {"image", 0x2111},   {"weierp", 0x2118}, {"real", 0x211c},    {"trade", 0x2122},
    {"alefsym", 0x2135}, {"larr", 0x2190},   {"uarr", 0x2191},    {"rarr", 0x2192},
    {"darr", 0x2193},    {"harr", 0x2194},   {"crarr", 0x21b5},   {"lArr", 0x21d0},
    {"uArr", 0x21d1},    {"rArr", 0x21d2},   {"dArr", 0x21d3},    {"hArr", 0x21d4},
    {"forall", 0x2200},  {"part", 0x2202},   {"exist", 0x2203},   {"empty", 0x2205},
    {"nabla", 0x2207},   {"isin", 0x2208},   {"notin", 0x2209},   {"ni", 0x220b},
    {"prod", 0x220f},    {"sum", 0x2211},    {"minus", 0x2212},   {"lowast", 0x2217},
    {"radic", 0x221a},   {"prop", 0x221d},   {"infin", 0x221e},   {"ang", 0x2220},
    {"and", 0x2227},     {"or", 0x2228},     {"cap", 0x2229},     {"cup", 0x222a},
    {"int", 0x222b},     {"there4", 0x2234}, {"sim", 0x223c},     {"cong", 0x2245},
    {"asymp", 0x2248},   {"ne", 0x2260},     {"equiv", 0x2261},   {"le", 0x2264},
    {"ge", 0x2265},      {"sub", 0x2282},    {"sup", 0x2283},     {"nsub", 0x2284},
    {"sube", 0x2286},    {"supe", 0x2287},   {"oplus", 0x2295},   {"otimes", 0x2297},
    {"perp", 0x22a5},    {"sdot", 0x22c5},   {"lceil", 0x2308},   {"rceil", 0x2309},
    {"lfloor", 0x230a},  {"rfloor", 0x230b}, {"lang", 0x2329},    {"rang", 0x232a},
    {"loz", 0x25ca},     {"spades", 0x2660}, {"clubs", 0x2663},   {"hearts", 0x2665},
    {"diams", 0x2666}};

// HTML reads numbers 128 to 159 as those of Windows' code page.
constexpr uint16_t windows[32] = {0x20ac, 0x81,   0x201a, 0x192,  0x201e, 0x2026, 0x2020, 0x2021,
                                  0x2c6,  0x2030, 0x160,  0x2039, 0x152,  0x8d,   0x17d,  0x8f,
                                  0x90,   0x2018, 0x2019, 0x201c, 0x201d, 0x2022, 0x2013, 0x2014,
                                  0x2dc,  0x2122, 0x161,  0x203a, 0x153,  0x9d,   0x17e,  0x178};

void append_utf8(std::string& to, uint32_t code) {
  if (code < 0x80) {
    to += char(code);
  } else if (code < 0x800) {
    to += {char(0xc0 | code >> 6), char(0x80 | (code & 0x3f))};
  } else if (code < 0x10000) {
    to += {char(0xe0 | code >> 12), char(0x80 | (code >> 6 & 0x3f)), char(0x80 | (code & 0x3f))};
  } else {
    to += {char(0xf0 | code >> 18), char(0x80 | (code >> 12 & 0x3f)),
           char(0x80 | (code >> 6 & 0x3f)), char(0x80 | (code & 0x3f))};
  }
}

// Returns the code point of a name; 0: there is none.
uint32_t code_of(std::string_view name) {
  uint32_t code = 0xa0;
  for (std::string_view rest = latin_names; !rest.empty(); code++) {
    const size_t end = std::min(rest.find(' '), rest.size());
    if (rest.substr(0, end) == name) return code;
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  for (auto [other, meaning] : other_names)
    if (other == name) return meaning;
  return 0;
}

// Returns the code point of "#233" or "#xe9"; 0: none that may stand in a text.
uint32_t code_of_number(std::string_view number) {
  const bool hex = number.size() > 1 && (number[1] == 'x' || number[1] == 'X');
  const std::string_view digits = number.substr(hex ? 2 : 1);
  if (digits.empty()) return 0;
  uint32_t code = 0;
  for (char c : digits) {
    const char d = char(c | 32);
    const int value = c >= '0' && c <= '9'          ? c - '0'
                      : hex && d >= 'a' && d <= 'f' ? d - 'a' + 10
                                                    : -1;
    if (value < 0) return 0;
    code = code * (hex ? 16 : 10) + uint32_t(value);
    if (code > 0x10ffff) return 0;
  }
  if (code >= 0x80 && code < 0xa0) code = windows[code - 0x80];
  const bool surrogate = code >= 0xd800 && code < 0xe000;
  return surrogate || (code < 0x20 && !is_space(char(code))) ? 0 : code;
}

}  // namespace

size_t read_character_reference(std::string_view text, std::string& to) {
  const size_t end = text.substr(0, 12).find(';');
  if (end == std::string_view::npos || end < 2 || text[0] != '&') return 0;
  const std::string_view name = text.substr(1, end - 1);
  const uint32_t code = name[0] == '#' ? code_of_number(name) : code_of(name);
  if (code == 0) return 0;
  append_utf8(to, code);
  return end + 1;
}

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

// Drops the prefix of a name: "ssml:Break" -> "break".
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
  // Passes over the text until `end`, and over `end`, too.
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

namespace {

using Words = std::initializer_list<std::pair<std::string_view, float>>;

std::optional<float> find_word(const std::string& text, Words words) {
  for (auto [word, value] : words)
    if (text == word) return value;
  return {};
}

// Reads a number at the beginning of `text`, and gives the text after it.
std::optional<float> read_number(std::string_view text, std::string_view& unit) {
  if (!text.empty() && text[0] == '+') text.remove_prefix(1);
  float value = 0;
  auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || !std::isfinite(value)) return {};
  unit = text.substr(size_t(end - text.data()));
  return value;
}

std::optional<float> in_reach(std::optional<float> factor) {
  if (!factor || !std::isfinite(*factor) || *factor <= 0) return {};
  return std::clamp(*factor, 0.3f, 3.0f);
}

// Reads a factor: "+10%" and "110%" are 1.1, "+2st" two semitones, "+6dB" twice the amplitude; a
// bare number is a factor.
std::optional<float> read_factor(const std::string& text, bool decibels) {
  std::string_view unit;
  std::optional<float> number = read_number(text, unit);
  if (!number) return {};
  bool relative = text[0] == '+' || text[0] == '-';
  if (unit == "%") return in_reach(relative ? 1 + *number / 100 : *number / 100);
  if (unit == "st" && !decibels) return in_reach(std::pow(2.0f, *number / 12));
  if (unit == "dB" && decibels) return in_reach(std::pow(10.0f, *number / 20));
  if (unit.empty() && !relative) return in_reach(number);
  return {};
}

}  // namespace

std::optional<float> read_seconds(const std::string& text) {
  std::string_view unit;
  std::optional<float> number = read_number(text, unit);
  if (!number || *number < 0) return {};
  float seconds = unit == "ms" ? *number / 1000 : unit == "s" ? *number : -1;
  return seconds >= 0 && seconds <= 10 ? std::optional(seconds) : std::nullopt;
}

std::optional<float> read_break_strength(const std::string& text) {
  return find_word(text, {{"none", 0.0f},
                          {"x-weak", 0.1f},
                          {"weak", 0.2f},
                          {"medium", 0.35f},
                          {"strong", 0.7f},
                          {"x-strong", 1.2f}});
}

std::optional<float> read_rate(const std::string& text) {
  auto word = find_word(text, {{"x-slow", 0.6f},
                               {"slow", 0.8f},
                               {"medium", 1.0f},
                               {"default", 1.0f},
                               {"fast", 1.25f},
                               {"x-fast", 1.6f}});
  return word ? word : read_factor(text, false);
}

std::optional<float> read_pitch(const std::string& text) {
  auto word = find_word(text, {{"x-low", 0.7f},
                               {"low", 0.85f},
                               {"medium", 1.0f},
                               {"default", 1.0f},
                               {"high", 1.15f},
                               {"x-high", 1.35f}});
  return word ? word : read_factor(text, false);
}

std::optional<float> read_volume(const std::string& text) {
  auto word = find_word(text, {{"silent", 0.3f},
                               {"x-soft", 0.4f},
                               {"soft", 0.7f},
                               {"medium", 1.0f},
                               {"default", 1.0f},
                               {"loud", 1.4f},
                               {"x-loud", 2.0f}});
  return word ? word : read_factor(text, true);
}

std::optional<float> read_weight(const std::string& text) {
  std::string_view unit;
  std::optional<float> number = read_number(text, unit);
  if (!number || (!unit.empty() && unit != "%")) return {};
  float weight = unit == "%" ? *number / 100 : *number;
  return weight >= 0 && weight <= 1 ? std::optional(weight) : std::nullopt;
}

std::optional<float> read_turn(const std::string& text) {
  std::string_view unit;
  const std::optional<float> degrees = read_number(text, unit);
  const bool fits = degrees && std::abs(*degrees) <= 720 && (unit.empty() || unit == "deg");
  return fits ? degrees : std::nullopt;
}

std::optional<int> read_emphasis(const std::string& text) {
  auto word =
      find_word(text, {{"none", 0.0f}, {"reduced", -1.0f}, {"moderate", 1.0f}, {"strong", 2.0f}});
  return word ? std::optional(int(*word)) : std::nullopt;
}

}  // namespace wellspring::avatar
