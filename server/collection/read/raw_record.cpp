// SPDX-License-Identifier: Apache-2.0
#include "collection/read/raw_record.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "base/load_error.h"

namespace wellspring::collection {

namespace {

constexpr double most_years = 1e6;  // from now, either way
constexpr size_t most_notes = 40;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::string address(const std::string& text) {
  const bool known = text.starts_with("https://") || text.starts_with("http://");
  return known && text.size() < most_text ? text : "";
}

void split_at(std::string_view text, const std::vector<std::string_view>& marks,
              std::vector<std::string>& to) {
  while (!text.empty()) {
    size_t end = text.size(), length = 0;
    for (const std::string_view mark : marks)
      if (const size_t at = text.find(mark); at < end) end = at, length = mark.size();
    if (std::string one = clean_text(text.substr(0, end)); !one.empty())
      to.push_back(std::move(one));
    text.remove_prefix(std::min(end + length, text.size()));
  }
}

}  // namespace

const std::vector<FieldChoice>& field_choices() {
  static const std::vector<FieldChoice> all = {
      {"id",
       &FieldNames::id,
       {"id", "acno", "accession_number", "objectid", "object id", "object number", "inventory",
        "inventory number", "identifier"}},
      {"title", &FieldNames::title, {"title", "name", "label", "_label", "titel", "titre"}},
      {"maker",
       &FieldNames::maker,
       {"artist", "maker", "creator", "author", "artist display name", "artists", "creators"}},
      {"date",
       &FieldNames::date,
       {"year", "date", "datetext", "object date", "creation_date", "dated", "begin_date"}},
      {"subjects", &FieldNames::subjects, {"subjects", "subject", "tags", "keywords", "depicts"}},
      {"materials",
       &FieldNames::materials,
       {"materials", "material", "medium", "technique", "made_of"}},
      {"colors", &FieldNames::colors, {"colors", "colours", "palette", "color", "colour"}},
      {"link", &FieldNames::link, {"url", "link", "link resource", "page"}},
      {"picture",
       &FieldNames::picture,
       {"thumbnail", "thumbnailurl", "image", "picture", "image_url", "primary_image"}}};
  return all;
}

std::string small_letters(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
  return out;
}

std::string clean_text(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const bool blank = uint8_t(c) <= ' ' || c == 0x7f;
    if (!blank) out += c;
    else if (!out.empty() && out.back() != ' ') out += ' ';
    if (out.size() > most_text) break;
  }
  if (out.size() > most_text) {
    size_t end = most_text - 3;
    while (end > 0 && (uint8_t(out[end]) & 0xc0) == 0x80) end--;
    out = out.substr(0, end) + "\u2026";
  }
  while (!out.empty() && out.back() == ' ') out.pop_back();
  return out;
}

std::vector<std::string> split_list(std::string_view text) {
  std::vector<std::string> found;
  for (const std::string_view mark : {"|", ";", ","})
    if (mark == "," || text.find(mark) != std::string_view::npos) {
      split_at(text, {mark}, found);
      break;
    }
  return found;
}

std::vector<std::string> split_materials(std::string_view text) {
  std::vector<std::string> found;
  split_at(small_letters(text), {",", ";", "|", " on ", " and ", " with ", " over "}, found);
  return found;
}

std::optional<double> find_year(std::string_view date) {
  const std::string text = small_letters(date);
  std::vector<double> years;
  bool century = text.find("centur") != std::string::npos ||
                 text.find("jahrhundert") != std::string::npos ||
                 text.find("jh.") != std::string::npos;
  bool before = false;
  for (const char* word : {"bc", "b.c.", "v. chr", "v.chr"})
    before = before || text.find(word) != std::string::npos;
  for (size_t i = 0; i < text.size();) {
    if (!is_digit(text[i])) {
      i++;
      continue;
    }
    size_t end = i;
    while (end < text.size() && is_digit(text[end])) end++;
    double number = 0;
    if (end - i <= 6) std::from_chars(text.data() + i, text.data() + end, number);
    const bool minus = i > 0 && text[i - 1] == '-' && (i == 1 || text[i - 2] == ' ');
    if (century && end - i <= 2) {
      if (number >= 1) years.push_back(100 * number - 50);
    } else if (end - i >= 3 && end - i <= 6) {
      years.push_back(minus ? -number : number);
    } else if (before && end - i <= 2 && years.empty()) {
      // A day comes before its year.
      const std::string_view rest = std::string_view(text).substr(end);
      if (rest.find_first_of("0123456789") == std::string_view::npos) years.push_back(number);
    } else if (!years.empty() && !century && i > 0 && text[i - 1] != ' ' && years.back() >= 100) {
      // "1805-9" and "1914-18" leave out what both years have in common.
      const double unit = end - i == 1 ? 10 : 100;
      const double whole = std::floor(years.back() / unit) * unit + number;
      if (whole > years.back()) years.push_back(whole);
    }
    i = end;
  }
  if (years.empty()) return {};
  // The first two of many years are the span; the others are of other things.
  double year = years.size() == 1 ? years[0] : (years[0] + years[1]) / 2;
  if (before) year = -std::abs(year);
  if (std::abs(year) > most_years) return {};
  return year;
}

std::optional<dvec3> find_lab(std::string_view color) {
  if (color.starts_with('#')) color.remove_prefix(1);
  if (color.size() != 6) return {};
  dvec3 linear(0);
  for (int k = 0; k < 3; k++) {
    int value = 0;
    const char* at = color.data() + 2 * k;
    const auto [end, error] = std::from_chars(at, at + 2, value, 16);
    if (error != std::errc() || end != at + 2 || *at == '-') return {};
    const double coded = value / 255.0;
    linear[k] = coded <= 0.04045 ? coded / 12.92 : std::pow((coded + 0.055) / 1.055, 2.4);
  }
  // IEC 61966-2-1, over its white of D65; CIE 15:2018.
  const double x = (0.4124 * linear.x + 0.3576 * linear.y + 0.1805 * linear.z) / 0.9505;
  const double y = 0.2126 * linear.x + 0.7152 * linear.y + 0.0722 * linear.z;
  const double z = (0.0193 * linear.x + 0.1192 * linear.y + 0.9505 * linear.z) / 1.089;
  auto f = [](double t) {
    return t > 216.0 / 24389 ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116;
  };
  return dvec3(116 * f(y) - 16, 500 * (f(x) - f(y)), 200 * (f(y) - f(z)));
}

void Gathering::note(const std::string& where, const std::string& what) {
  const auto [found, is_new] = note_of_.try_emplace(what, notes_.size());
  if (is_new && notes_.size() < most_notes) {
    notes_.push_back({{file_ + (where.empty() ? "" : ": " + where), what}, 1});
  } else if (is_new) {
    note_of_.erase(found);
  } else {
    notes_[found->second].second++;
  }
}

void Gathering::add_terms(Record& record, TermKind kind, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    const std::string clean = clean_text(name);
    if (clean.empty() || record.terms.size() >= most_terms) continue;
    const auto [found, is_new] =
        terms_.try_emplace({kind, small_letters(clean)}, uint32_t(records_.terms.size()));
    if (is_new) records_.terms.push_back({kind, clean});
    if (std::ranges::find(record.terms, found->second) == record.terms.end())
      record.terms.push_back(found->second);
  }
}

void Gathering::add(RawRecord&& raw, const std::string& where) {
  if (records_.all.size() >= most_records)
    throw LoadError(file_, where,
                    "the collection has more than " + std::to_string(most_records) +
                        " records, which is the most that a map is made of; please give a part of "
                        "it, a file for each department for example");
  Record record;
  record.id = clean_text(raw.id);
  record.title = clean_text(raw.title);
  record.maker = clean_text(raw.maker);
  record.date = clean_text(raw.date);
  record.link = address(raw.link), record.picture = address(raw.picture);
  record.year = raw.year ? raw.year : find_year(raw.date);
  if (record.year && !(std::abs(*record.year) <= most_years)) record.year.reset();
  if (record.id.empty()) record.id = std::to_string(records_.all.size() + 1);
  if (!ids_.insert(record.id).second) {
    note(where, "another record has the same id; the first is kept");
    return;
  }
  if (record.title.empty()) record.title = record.id;
  if (!record.year) note(where, raw.date.empty() ? "no date" : "no year can be found in the date");
  for (const auto& [color, weight] : raw.colors) {
    const std::optional<dvec3> lab = find_lab(color);
    if (!lab) note(where, "a colour is not written as #rrggbb; it is left out");
    else if (!(weight > 0 && weight <= 1e6)) note(where, "a colour's weight is not above 0");
    else if (record.palette.size() < most_swatches)
      record.palette.push_back({*lab, weight, (color[0] == '#' ? "" : "#") + color});
  }
  add_terms(record, TermKind::material, raw.materials);
  add_terms(record, TermKind::subject, raw.subjects);
  if (record.terms.empty() && record.palette.empty())
    note(where, "neither subjects nor materials nor colours");
  records_.all.push_back(std::move(record));
}

Records Gathering::take(const std::string& path) {
  if (records_.all.empty()) {
    std::string why = "there are no records in it";
    if (!notes_.empty()) why += "; " + notes_[0].first.where + ": " + notes_[0].first.what;
    throw LoadError(path, "", why);
  }
  for (auto& [note, count] : notes_) {
    if (count > 1) note.what += " (" + std::to_string(count) + " times, here first)";
    records_.notes.push_back(std::move(note));
  }
  return std::move(records_);
}

}  // namespace wellspring::collection
