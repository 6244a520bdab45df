// SPDX-License-Identifier: Apache-2.0
#include "avatar/story/subtitle.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "avatar/speech/text.h"
#include "base/load_error.h"

namespace wellspring {

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

// Digits at the beginning of `text`, which loses them.
std::optional<int> read_digits(std::string_view& text, size_t least, size_t most) {
  size_t count = 0;
  int value = 0;
  while (count < text.size() && count < most && text[count] >= '0' && text[count] <= '9')
    value = value * 10 + (text[count++] - '0');
  if (count < least) return {};
  text.remove_prefix(count);
  return value;
}

bool take(std::string_view& text, char c) {
  if (text.empty() || text[0] != c) return false;
  text.remove_prefix(1);
  return true;
}

// [hh:]mm:ss.mmm; `text` loses it.
std::optional<double> read_time(std::string_view& text) {
  auto first = read_digits(text, 2, 6);
  if (!first || !take(text, ':')) return {};
  auto second = read_digits(text, 2, 2);
  if (!second) return {};
  std::optional<int> third;
  if (take(text, ':')) {
    third = read_digits(text, 2, 2);
    if (!third) return {};
  }
  if (!take(text, '.')) return {};
  auto ms = read_digits(text, 3, 3);
  if (!ms) return {};
  int hours = third ? *first : 0, minutes = third ? *second : *first,
      seconds = third ? *third : *second;
  if (minutes > 59 || seconds > 59) return {};
  return hours * 3600.0 + minutes * 60 + seconds + *ms / 1000.0;
}

// Text of a cue without its tags; the name in <v Name> goes to `speaker`.
std::string plain_text(std::string_view text, std::string& speaker) {
  std::string result;
  for (size_t i = 0; i < text.size();) {
    std::string_view rest = text.substr(i);
    if (text[i] == '<') {
      size_t end = rest.find('>');
      std::string_view tag = rest.substr(1, end == std::string_view::npos ? end : end - 1);
      if (speaker.empty() && !tag.empty() && tag[0] == 'v' &&
          tag.find(' ') != std::string_view::npos)
        speaker = std::string(trim(tag.substr(tag.find(' '))));
      i = end == std::string_view::npos ? text.size() : i + end + 1;
      continue;
    }
    static constexpr std::pair<std::string_view, std::string_view> entities[] = {
        {"&amp;", "&"},       {"&lt;", "<"}, {"&gt;", ">"},
        {"&nbsp;", "\u00a0"}, {"&lrm;", ""}, {"&rlm;", ""}};
    bool found = false;
    for (auto [entity, meaning] : entities)
      if (!found && rest.substr(0, entity.size()) == entity) {
        result += meaning;
        i += entity.size();
        found = true;
      }
    if (!found) result += text[i++];
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

std::vector<SubtitleCue> load_subtitles(std::string_view text, const std::string& file) {
  auto fail = [&](size_t line, const std::string& what) {
    throw LoadError(file, "line " + std::to_string(line + 1), what);
  };
  if (text.substr(0, 3) == "\xef\xbb\xbf") text.remove_prefix(3);
  std::vector<std::string_view> lines = lines_of(text);
  size_t broken = find_broken_utf8(text);
  if (broken != std::string_view::npos)
    fail(lines_of(text.substr(0, broken + 1)).size() - 1, "is not UTF-8");
  bool signed_ = !lines.empty() && lines[0].substr(0, 6) == "WEBVTT" &&
                 (lines[0].size() == 6 || lines[0][6] == ' ' || lines[0][6] == '\t');
  if (!signed_) fail(0, "does not begin with WEBVTT");
  std::vector<SubtitleCue> cues;
  size_t at = 1;
  while (at < lines.size() && !is_blank(lines[at])) at++;  // the header
  while (at < lines.size()) {
    if (is_blank(lines[at])) {
      at++;
      continue;
    }
    std::string_view first = lines[at];
    bool other = first.substr(0, 4) == "NOTE" || first == "STYLE" || first == "REGION";
    if (!other && first.find("-->") == std::string_view::npos) at++;  // the cue's name
    if (!other) {
      if (at >= lines.size() || lines[at].find("-->") == std::string_view::npos)
        fail(std::min(at, lines.size() - 1), "a cue has no times");
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
      for (at++; at < lines.size() && !is_blank(lines[at]); at++)
        body.append(lines[at]).append(1, '\n');
      cue.text = plain_text(body, cue.speaker);
      if (cues.size() == most_cues) fail(at - 1, "there are more than 100,000 cues");
      if (!cue.text.empty()) cues.push_back(std::move(cue));
    }
    while (at < lines.size() && !is_blank(lines[at])) at++;
  }
  std::stable_sort(cues.begin(), cues.end(),
                   [](const SubtitleCue& a, const SubtitleCue& b) { return a.begin < b.begin; });
  return cues;
}

}  // namespace wellspring
