// SPDX-License-Identifier: Apache-2.0
#include "avatar/story/subtitle.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "avatar/speech/text.h"
#include "avatar/story/story_markup.h"
#include "base/load_error.h"

namespace wellspring::avatar {

namespace {

constexpr size_t most_cues = 100'000;

std::string write_time(double seconds) {
  long long ms = std::llround(1000 * std::clamp(seconds, 0.0, 359999.0));
  char text[32];
  std::snprintf(text, sizeof text, "%02lld:%02lld:%02lld.%03lld", ms / 3600000, ms / 60000 % 60,
                ms / 1000 % 60, ms % 1000);
  return text;
}

std::string escape(std::string_view text) {
  std::string result;
  for (char c : text) {
    if (c == '&') result += "&amp;";
    else if (c == '<') result += "&lt;";
    else if (c == '>') result += "&gt;";
    else result += c;
  }
  return result;
}

bool is_blank(std::string_view line) {
  return line.find_first_not_of(" \t") == std::string_view::npos;
}

bool has_arrow(std::string_view line) { return line.find("-->") != std::string_view::npos; }

// Returns whether a block that is no cue begins with this word.
bool begins_block(std::string_view line, std::string_view word) {
  return line.substr(0, word.size()) == word &&
         (line.size() == word.size() || line[word.size()] == ' ' || line[word.size()] == '\t');
}

std::string_view trim(std::string_view text) {
  size_t first = text.find_first_not_of(" \t\n");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\n") - first + 1);
}

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    size_t end = text.find_first_of("\r\n");
    lines.push_back(text.substr(0, end));
    if (end == std::string_view::npos) break;
    bool both = text[end] == '\r' && end + 1 < text.size() && text[end + 1] == '\n';
    text.remove_prefix(end + (both ? 2 : 1));
  }
  return lines;
}

// Reads exactly `count` digits at the beginning of `text`, which loses them.
std::optional<int> read_digits(std::string_view& text, size_t count) {
  int value = 0;
  if (text.size() < count) return {};
  for (char c : text.substr(0, count)) {
    if (c < '0' || c > '9') return {};
    value = value * 10 + (c - '0');
  }
  text.remove_prefix(count);
  return value;
}

bool take(std::string_view& text, char c) {
  if (text.empty() || text[0] != c) return false;
  text.remove_prefix(1);
  return true;
}

// Reads [h...h:]mm:ss.mmm; `text` loses it. Hours have any number of digits, up to nine.
std::optional<double> read_time(std::string_view& text) {
  size_t digits = 0;
  while (digits < text.size() && text[digits] >= '0' && text[digits] <= '9') digits++;
  if (digits == 0 || digits > 9) return {};
  const int first = *read_digits(text, digits);
  if (!take(text, ':')) return {};
  auto second = read_digits(text, 2);
  if (!second) return {};
  std::optional<int> third;
  if (take(text, ':')) {
    third = read_digits(text, 2);
    if (!third) return {};
  } else if (digits != 2) {
    return {};
  }
  if (!take(text, '.')) return {};
  auto ms = read_digits(text, 3);
  if (!ms) return {};
  int hours = third ? first : 0, minutes = third ? *second : first,
      seconds = third ? *third : *second;
  if (minutes > 59 || seconds > 59) return {};
  return hours * 3600.0 + minutes * 60 + seconds + *ms / 1000.0;
}

// Resolves the references of a text.
std::string resolve(std::string_view text) {
  std::string result;
  for (size_t i = 0; i < text.size();) {
    const size_t bytes = text[i] == '&' ? read_character_reference(text.substr(i), result) : 0;
    if (bytes == 0) result += text[i];
    i += std::max(bytes, size_t(1));
  }
  return result;
}

// Returns the text of a cue without its tags; the name in <v Name> goes to `speaker`.
std::string plain_text(std::string_view text, std::string& speaker) {
  std::string result;
  while (!text.empty()) {
    const size_t begin = std::min(text.find('<'), text.size());
    result += resolve(text.substr(0, begin));
    text.remove_prefix(begin);
    if (text.empty()) break;
    const size_t end = std::min(text.find('>'), text.size());
    const std::string_view tag = text.substr(1, end - 1);
    const size_t name = tag.find_first_of(" \t\n");  // after "v", or "v.loud"
    if (speaker.empty() && name != std::string_view::npos &&
        tag.substr(0, std::min(tag.find('.'), name)) == "v")
      speaker = resolve(trim(tag.substr(name)));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return std::string(trim(result));
}

}  // namespace

std::string write_subtitles(const std::vector<SubtitleCue>& cues) {
  std::string text = "WEBVTT\n";
  size_t number = 1;
  for (const SubtitleCue& cue : cues) {
    for (const std::string& part :
         {std::string("\n"), std::to_string(number++), std::string("\n"), write_time(cue.begin),
          std::string(" --> "), write_time(cue.end)})
      text += part;
    text += '\n';
    if (!cue.speaker.empty()) text.append("<v ").append(escape(cue.speaker)).append(">");
    // An empty line would end the cue.
    std::string body;
    for (std::string_view line : lines_of(cue.text)) {
      if (is_blank(line)) continue;
      body += escape(line);
      body += '\n';
    }
    text += body.empty() ? "\n" : body;
  }
  return text;
}

Subtitles load_subtitles(std::string_view text, const std::string& file) {
  auto fail = [&](size_t line, const std::string& what) {
    throw LoadError(file, "line " + std::to_string(line + 1), what);
  };
  if (text.substr(0, 3) == "\xef\xbb\xbf") text.remove_prefix(3);
  const std::vector<std::string_view> lines = lines_of(text);
  size_t broken = find_broken_utf8(text);
  if (broken != std::string_view::npos)
    fail(lines_of(text.substr(0, broken + 1)).size() - 1, "is not UTF-8");
  if (lines.empty() || !begins_block(lines[0], "WEBVTT")) fail(0, "does not begin with WEBVTT");
  Subtitles read;
  size_t at = 1;
  auto ends = [&] { return at >= lines.size() || is_blank(lines[at]); };
  while (!ends() && !has_arrow(lines[at])) at++;  // the header
  while (at < lines.size()) {
    if (is_blank(lines[at])) {
      at++;
      continue;
    }
    const size_t first = at;
    const bool other = begins_block(lines[at], "NOTE") || begins_block(lines[at], "STYLE") ||
                       begins_block(lines[at], "REGION");
    if (!other && !has_arrow(lines[at])) at++;  // the cue's name
    if (other || ends() || !has_arrow(lines[at])) {
      if (!other)
        read.notes.emplace_back(int(first) + 1, "a block without times is no cue, and left out");
      while (!ends()) at++;
      continue;
    }
    SubtitleCue cue;
    std::string_view rest = trim(lines[at]);
    auto begin = read_time(rest);
    rest = trim(rest);
    bool arrow = rest.substr(0, 3) == "-->";
    rest = arrow ? trim(rest.substr(3)) : rest;
    auto end = read_time(rest);
    if (!begin || !arrow || !end) fail(at, "times are written 00:00:01.500 --> 00:00:04.000");
    if (*end < *begin) fail(at, "a cue ends before it begins");
    cue.begin = *begin;
    cue.end = *end;
    std::string body;
    cue.line = int(at) + 2;
    for (at++; !ends() && !has_arrow(lines[at]); at++) body.append(lines[at]).append(1, '\n');
    cue.text = plain_text(body, cue.speaker);
    if (read.cues.size() == most_cues) fail(at - 1, "there are more than 100,000 cues");
    if (!cue.text.empty()) read.cues.push_back(std::move(cue));
  }
  std::stable_sort(read.cues.begin(), read.cues.end(),
                   [](const SubtitleCue& a, const SubtitleCue& b) { return a.begin < b.begin; });
  return read;
}

}  // namespace wellspring::avatar
