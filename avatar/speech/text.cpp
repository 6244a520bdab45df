// SPDX-License-Identifier: Apache-2.0
#include "avatar/speech/text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace wellspring::avatar {

namespace {

bool is_ascii_mark(char c) {
  return (c >= '!' && c <= '/' && c != '%' && c != '$' && c != '&') || (c >= ':' && c <= '@') ||
         (c >= '[' && c <= '`') || (c >= '{' && c <= '~');
}

// Returns the bytes of the mark that `text` begins or ends with: ASCII punctuation, U+2010 to
// U+206F, guillemets and the opening marks of Spanish. 0: none.
size_t mark_at(std::string_view text, bool front) {
  if (text.empty()) return 0;
  if (is_ascii_mark(front ? text.front() : text.back())) return 1;
  auto is = [&](size_t size, auto test) {
    size_t at = front ? 0 : text.size() - size;
    return text.size() >= size && test(text.substr(at, size));
  };
  auto is_two = [](std::string_view s) { return s == "«" || s == "»" || s == "¿" || s == "¡"; };
  auto is_three = [](std::string_view s) {
    return s[0] == '\xe2' && (s[1] == '\x80' || s[1] == '\x81');
  };
  return is(2, is_two) ? 2 : is(3, is_three) ? 3 : 0;
}

bool is_letter_or_digit(char c) {
  return (c & 0x80) || (c >= '0' && c <= '9') || ((c | 32) >= 'a' && (c | 32) <= 'z');
}

}  // namespace

size_t count_characters(std::string_view text, size_t bytes) {
  text = text.substr(0, std::min(bytes, text.size()));
  return size_t(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

size_t find_broken_utf8(std::string_view text) {
  for (size_t i = 0; i < text.size();) {
    auto byte = [&](size_t k) { return static_cast<unsigned char>(text[k]); };
    unsigned char first = byte(i);
    size_t more = first < 0x80   ? 0
                  : first < 0xc2 ? 4
                  : first < 0xe0 ? 1
                  : first < 0xf0 ? 2
                  : first < 0xf5 ? 3
                                 : 4;
    if (more == 4 || first == 0 || i + more >= text.size()) return i;
    for (size_t k = 1; k <= more; k++)
      if ((byte(i + k) & 0xc0) != 0x80) return i;
    if (more >= 2) {
      unsigned char second = byte(i + 1);
      bool overlong = (first == 0xe0 && second < 0xa0) || (first == 0xf0 && second < 0x90);
      bool surrogate = first == 0xed && second >= 0xa0;
      bool too_high = first == 0xf4 && second >= 0x90;
      if (overlong || surrogate || too_high) return i;
    }
    i += more + 1;
  }
  return std::string_view::npos;
}

std::vector<uint32_t> character_starts(std::string_view text) {
  std::vector<uint32_t> starts;
  for (uint32_t i = 0; i < text.size(); i++)
    if ((text[i] & 0xc0) != 0x80) starts.push_back(i);
  starts.push_back(uint32_t(text.size()));
  return starts;
}

uint32_t skip_spaces(std::string_view text, uint32_t at) {
  while (at < text.size() && is_space(text[at])) at++;
  return at;
}

std::vector<SpeechWord> words_of(std::string_view text,
                                 const std::function<bool(uint32_t byte, bool begins)>& is_said) {
  std::vector<SpeechWord> words;
  for (uint32_t at = skip_spaces(text, 0); at < text.size(); at = skip_spaces(text, at)) {
    uint32_t from = at;
    bool begins = from == 0 || is_space(text[from - 1]);
    do at++;
    while (at < text.size() && !is_space(text[at]) &&
           ((text[at] & 0xc0) == 0x80 || !is_said(at, false)));
    std::string_view whole = text.substr(from, at - from), inner = whole;
    while (size_t size = mark_at(inner, true)) inner.remove_prefix(size);
    while (size_t size = mark_at(inner, false)) inner.remove_suffix(size);
    if (std::none_of(inner.begin(), inner.end(), is_letter_or_digit)) {
      if (!is_said(from, begins)) continue;
      inner = whole;
    }
    uint32_t first = uint32_t(inner.data() - text.data());
    words.push_back({0, 0, first, first + uint32_t(inner.size())});
  }
  return words;
}

namespace {

struct Writer {
  Ssml ssml;

  void tag(const std::string& tag, uint32_t source) {
    ssml.text += tag;
    ssml.source.insert(ssml.source.end(), tag.size(), source);  // tags are ASCII
  }
  void words(std::string_view words, uint32_t source, bool moves) {
    for (size_t i = 0; i < words.size(); i++) {
      char c = words[i];
      bool continues = (c & 0xc0) == 0x80;
      uint32_t from = moves ? source + uint32_t(i) : source;
      if (c == '<') tag("&lt;", from);
      else if (c == '>') tag("&gt;", from);
      else if (c == '&') tag("&amp;", from);
      else {
        ssml.text += c;
        if (!continues) ssml.source.push_back(from);
      }
    }
  }
};

float factor(float value) { return std::isfinite(value) ? std::clamp(value, 0.3f, 3.0f) : 1.0f; }

struct Manner {
  float rate = 1, pitch = 1, volume = 1;
  int emphasis = 0;
};

Manner manner_at(const std::vector<SpeechStyle>& styles, uint32_t at) {
  Manner manner;
  for (const SpeechStyle& style : styles) {
    if (at < style.begin || at >= style.end) continue;
    manner.rate *= factor(style.rate);
    manner.pitch *= factor(style.pitch);
    manner.volume *= factor(style.volume);
    if (std::abs(style.emphasis) > std::abs(manner.emphasis)) manner.emphasis = style.emphasis;
  }
  manner.rate = factor(manner.rate);
  manner.pitch = factor(manner.pitch);
  manner.volume = factor(manner.volume);
  return manner;
}

const SpeechStyle* alias_at(const std::vector<SpeechStyle>& styles, uint32_t at) {
  const SpeechStyle* found = nullptr;
  for (const SpeechStyle& style : styles)
    if (!style.alias.empty() && at >= style.begin && at < style.end &&
        (!found || style.begin < found->begin))
      found = &style;
  return found;
}

std::string percent(float value) { return std::to_string(std::lround(100 * value)) + "%"; }

std::string opening(const Manner& manner, std::string& closing) {
  std::string tags, prosody;
  if (manner.rate != 1) prosody += " rate=\"" + percent(manner.rate) + "\"";
  if (manner.pitch != 1) prosody += " pitch=\"" + percent(manner.pitch) + "\"";
  if (manner.volume != 1) prosody += " volume=\"" + percent(manner.volume) + "\"";
  if (!prosody.empty()) {
    tags = "<prosody" + prosody + ">";
    closing = "</prosody>";
  }
  if (manner.emphasis != 0) {
    const char* level = manner.emphasis < 0    ? "reduced"
                        : manner.emphasis == 1 ? "moderate"
                                               : "strong";
    tags += std::string("<emphasis level=\"") + level + "\">";
    closing = "</emphasis>" + closing;
  }
  return tags;
}

}  // namespace

Ssml make_ssml(std::string_view text, const std::vector<SpeechStyle>& styles) {
  const uint32_t size = uint32_t(text.size());
  std::vector<uint32_t> cuts{0, size};
  for (const SpeechStyle& style : styles)
    for (uint32_t cut : {style.begin, style.end}) cuts.push_back(std::min(cut, size));
  for (uint32_t& cut : cuts)  // a cut never falls inside a character
    while (cut < size && (text[cut] & 0xc0) == 0x80) cut++;
  std::sort(cuts.begin(), cuts.end());
  cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());

  Writer writer;
  writer.tag("<speak>", 0);
  const SpeechStyle* said = nullptr;
  for (size_t i = 0; i < cuts.size(); i++) {
    uint32_t from = cuts[i], to = i + 1 < cuts.size() ? cuts[i + 1] : from;
    float pause = 0;
    for (const SpeechStyle& style : styles)
      if (std::min(style.begin, size) == from && std::isfinite(style.pause))
        pause = std::max(pause, std::min(style.pause, 10.0f));
    if (pause > 0)
      writer.tag("<break time=\"" + std::to_string(std::lround(1000 * pause)) + "ms\"/>", from);
    if (from == to) continue;
    const SpeechStyle* alias = alias_at(styles, from);
    if (alias && alias == said) continue;
    said = alias;
    std::string closing, tags = opening(manner_at(styles, from), closing);
    writer.tag(tags, from);
    if (alias) writer.words(alias->alias, from, false);
    else writer.words(text.substr(from, to - from), from, true);
    writer.tag(closing, to);
  }
  writer.tag("</speak>", size);
  return std::move(writer.ssml);
}

std::string describe_styles(const std::vector<SpeechStyle>& styles) {
  std::string all;
  for (const SpeechStyle& style : styles) {
    char line[160];
    std::snprintf(line, sizeof line, "%u %u %.3f %.3f %.3f %d %.3f %zu ", style.begin, style.end,
                  double(style.rate), double(style.pitch), double(style.volume), style.emphasis,
                  double(style.pause), style.alias.size());
    all += line + style.alias + "\n";
  }
  return all;
}

}  // namespace wellspring::avatar
