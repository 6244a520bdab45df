// SPDX-License-Identifier: Apache-2.0
#include "avatar/speech/style.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace wellspring::avatar {

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
  for (uint32_t& cut : cuts)  // never inside a character
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
