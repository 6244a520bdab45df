// SPDX-License-Identifier: Apache-2.0
#include "show/questions/question_index.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>

namespace wellspring::show {

namespace {

constexpr size_t stem_letters = 6;

// Base letters of U+00C0 to U+017F; '*' is no letter, digits stand for two.
constexpr std::string_view base_letters =
    "aaaaaa1ceeeeiiiidnooooo*ouuuuy23aaaaaa1ceeeeiiiidnooooo*ouuuuy2y"
    "aaaaaaccccccccddddeeeeeeeeeegggggggghhhhiiiiiiiiii44jjkkkllllllllllnnnnnnnnnoooooo55rrrrrr"
    "ssssssssttttttuuuuuuuuuuuuwwyyyzzzzzzs";
static_assert(base_letters.size() == 0x180 - 0xC0);
constexpr std::string_view pairs[] = {"", "ae", "th", "ss", "ij", "oe"};

// Words that say nothing of a question's topic, by language, with base letters only.
const std::map<std::string, std::set<std::string>>& stop_words() {
  static const std::map<std::string, std::set<std::string>> words =
      nlohmann::json::parse(stop_words_json());
  return words;
}

// One code point from `at` on, which goes behind it; 0 for a byte that begins none.
uint32_t next_code_point(const std::string& text, size_t& at) {
  const auto byte = [&](size_t i) { return i < text.size() ? uint8_t(text[i]) : 0u; };
  const uint32_t first = byte(at++);
  if (first < 0x80) return first;
  const int more = first >= 0xF0 ? 3 : first >= 0xE0 ? 2 : first >= 0xC0 ? 1 : 0;
  if (more == 0) return 0;
  uint32_t point = first & (0x3Fu >> more);
  for (int i = 0; i < more && (byte(at) & 0xC0) == 0x80; i++)
    point = point << 6 | (byte(at++) & 0x3F);
  return point;
}

// As a part of a stem; "" for what is no letter or digit.
std::string letters_of(uint32_t point) {
  if ((point >= 'a' && point <= 'z') || (point >= '0' && point <= '9')) return {char(point)};
  if (point >= 'A' && point <= 'Z') return {char(point - 'A' + 'a')};
  if (point < 0xC0 || point >= 0x180) return {};
  const char letter = base_letters[point - 0xC0];
  if (letter == '*') return {};
  if (letter >= '1' && letter <= '5') return std::string(pairs[letter - '0']);
  return {letter};
}

void add_word(std::vector<Word>& words, Word& word, const std::set<std::string>* left_out) {
  std::string& stem = word.stem;
  const bool counts = !stem.empty() && !(left_out && left_out->contains(stem));
  if (stem.size() > 3 && stem.back() == 's' && stem[stem.size() - 2] != 's') stem.pop_back();
  if (stem.size() > stem_letters) stem.resize(stem_letters);
  if (stem.size() > 4 && std::string_view("aeiouy").find(stem.back()) != std::string_view::npos)
    stem.pop_back();
  if (counts) words.push_back(std::move(word));
  word = {};
}

}  // namespace

std::vector<Word> words_of(const std::string& text, const std::string& lang) {
  auto found = stop_words().find(lang.substr(0, lang.find('-')));
  const std::set<std::string>* left_out = found == stop_words().end() ? nullptr : &found->second;
  std::vector<Word> words;
  Word word;
  for (size_t at = 0; at < text.size();) {
    const size_t begin = at;
    const std::string letters = letters_of(next_code_point(text, at));
    if (letters.empty()) add_word(words, word, left_out);
    else word.stem += letters, word.spoken += text.substr(begin, at - begin);
  }
  add_word(words, word, left_out);
  return words;
}

namespace {

constexpr float k1 = 1.2f, b = 0.75f;  // as the source recommends
constexpr float title_weight = 2,
                further_weight = 1.5f;  // weights of a word there, against one that is said
constexpr float next_weight = 0.4f;     // weight of a word in a story's next sentence
// The score is multiplied by these for a written answer, an explanation, a part of a narration.
constexpr float answer_weight = 1.5f, explains_weight = 1.25f, narrates_weight = 1;
constexpr float sure_share = 0.5f, partly_share = 0.25f;

const LocalText no_answer = {
    {"en", "That I do not know, I am sorry. Ask me about what you see around you."},
    {"de", "Das weiß ich leider nicht. Fragen Sie mich nach dem, was Sie hier sehen."},
    {"sk", "To, žiaľ, neviem. Opýtajte sa ma na to, čo tu vidíte."},
    {"fr", "Cela, je ne le sais pas, hélas. Demandez-moi ce que vous voyez autour de vous."},
    {"es", "Eso no lo sé, lo siento. Pregúnteme por lo que ve a su alrededor."}};
const LocalText with_caution = {{"en", "I am not sure that this is what you mean."},
                                {"de", "Ich bin nicht sicher, ob Sie das meinen."},
                                {"sk", "Nie som si istá, či máte na mysli toto."},
                                {"fr", "Je ne suis pas sûre que ce soit votre question."},
                                {"es", "No estoy segura de que sea lo que pregunta."}};

LocalScript script_of(const LocalText& text) {
  LocalScript script;
  for (const auto& [lang, line] : plain_line(text)) script[lang] = {line};
  return script;
}

LocalScript lines_from(const LocalScript& script, size_t first, size_t count) {
  LocalScript part;
  for (const auto& [lang, lines] : script)
    for (size_t i = first; i < std::min(first + count, lines.size()); i++)
      part[lang].push_back(lines[i]);
  return part;
}

void add_passages(const Exhibit& exhibit, std::vector<Passage>& passages) {
  for (const AnsweredQuestion& one : exhibit.questions) {
    Passage& passage = passages.emplace_back();
    passage.title = one.question.front();
    for (const LocalText& way : one.question)
      for (const auto& [lang, text] : way) passage.further[lang] += text + " ";
    passage.said = script_of(one.answer);
  }
  for (const PointOfInterest& point : exhibit.points) {
    if (point.text.empty()) continue;
    Passage& passage = passages.emplace_back();
    passage.kind = Passage::Kind::object;
    passage.id = point.id, passage.title = point.title, passage.said = script_of(point.text);
    for (const auto& [element, value] : point.provenance)
      for (const auto& [lang, text] : value) passage.further[lang] += text + " ";
  }
  auto add_script = [&](Passage::Kind kind, const std::string& id, const LocalText& title,
                        const LocalScript& script) {
    for (size_t i = 0; i < line_count(script); i++)
      passages.push_back({kind, id, title, lines_from(script, i, 2), {}});
  };
  for (const StoryText& story : exhibit.stories)
    add_script(Passage::Kind::story, story.id, story.title, story.text);
  for (const TourPlan& tour : exhibit.tours)
    for (const TourStop& stop : tour.stops) add_script(Passage::Kind::tour, tour.id, {}, stop.text);
  if (!exhibit.book) return;
  for (const BookPage& page : exhibit.book->topics)
    for (const LocalText& text : page.text)
      passages.push_back({Passage::Kind::topic, page.id, page.title, script_of(text), {}});
}

void add_words(QuestionIndex::Entry& entry, const std::string& text, const std::string& lang,
               float weight) {
  for (const Word& word : words_of(text, lang)) {
    entry.counts[word.stem] += weight;
    entry.length += weight;
  }
}

bool narrates(Passage::Kind kind) {
  return kind == Passage::Kind::story || kind == Passage::Kind::tour;
}
float weight_of(Passage::Kind kind) {
  if (kind == Passage::Kind::answer) return answer_weight;
  return narrates(kind) ? narrates_weight : explains_weight;
}

QuestionIndex::Entry entry_of(const Passage& passage, const std::string& lang) {
  QuestionIndex::Entry entry;
  auto lines = passage.said.find(lang);
  if (lines == passage.said.end()) return entry;
  float weight = 1;
  for (const StoryLine& line : lines->second) {
    add_words(entry, line.text, lang, weight);
    weight = next_weight;
  }
  if (auto title = passage.title.find(lang); title != passage.title.end())
    add_words(entry, title->second, lang, narrates(passage.kind) ? next_weight : title_weight);
  if (auto further = passage.further.find(lang); further != passage.further.end())
    add_words(entry, further->second, lang, further_weight);
  return entry;
}

float weight_of(const QuestionIndex::Language& language, const std::string& stem) {
  auto found = language.documents.find(stem);
  const float with = found == language.documents.end() ? 0 : float(found->second);
  return std::log(1 + (float(language.entries.size()) - with + 0.5f) / (with + 0.5f));
}

const std::pair<const std::string, QuestionIndex::Language>* language_in(const QuestionIndex& index,
                                                                         const Exhibit& exhibit,
                                                                         const std::string& lang) {
  for (const std::string& tag : {lang, lang.substr(0, lang.find('-')), exhibit.languages.front()})
    if (auto found = index.languages.find(tag); found != index.languages.end()) return &*found;
  return nullptr;
}

}  // namespace

QuestionIndex make_question_index(const Exhibit& exhibit) {
  QuestionIndex index;
  add_passages(exhibit, index.passages);
  std::set<std::string> tags;
  for (const Passage& passage : index.passages)
    for (const auto& [lang, lines] : passage.said) tags.insert(lang);
  for (const std::string& lang : tags) {
    QuestionIndex::Language& language = index.languages[lang];
    float length = 0;
    for (const Passage& passage : index.passages) {
      const auto& entry = language.entries.emplace_back(entry_of(passage, lang));
      for (const auto& [stem, count] : entry.counts) language.documents[stem]++;
      length += entry.length;
    }
    language.mean_length = std::max(1.0f, length / float(language.entries.size()));
  }
  return index;
}

FoundAnswer find_answer(const QuestionIndex& index, const Exhibit& exhibit,
                        const std::string& question, const std::string& lang) {
  FoundAnswer best;
  const auto* in = language_in(index, exhibit, lang);
  if (!in) return best;
  const auto& [tag, language] = *in;
  std::map<std::string, std::string> asked;  // stem -> as asked
  for (const Word& word : words_of(question, tag)) asked.emplace(word.stem, word.spoken);
  float all = 0;
  for (const auto& [stem, spoken] : asked) all += weight_of(language, stem);
  for (size_t i = 0; i < language.entries.size() && all > 0; i++) {
    const QuestionIndex::Entry& entry = language.entries[i];
    FoundAnswer found{FoundAnswer::Kind::none, int(i), 0, 0, {}};
    for (const auto& [stem, spoken] : asked) {
      auto count = entry.counts.find(stem);
      if (count == entry.counts.end()) continue;
      const float weight = weight_of(language, stem);
      const float long_text = 1 - b + b * entry.length / language.mean_length;
      found.score += weight * count->second * (k1 + 1) / (count->second + k1 * long_text);
      found.share += weight / all;
      found.words.push_back(spoken);
    }
    found.score *= weight_of(index.passages[i].kind);
    if (found.score > best.score) best = std::move(found);
  }
  if (best.share >= sure_share) best.kind = FoundAnswer::Kind::sure;
  else if (best.share >= partly_share) best.kind = FoundAnswer::Kind::partly;
  else best = {};
  return best;
}

LocalScript words_for(const QuestionIndex& index, const FoundAnswer& found) {
  if (found.kind == FoundAnswer::Kind::none) return script_of(no_answer);
  LocalScript said = index.passages[size_t(found.passage)].said;
  if (found.kind == FoundAnswer::Kind::sure) return said;
  const LocalScript caution = script_of(with_caution);
  for (auto& [lang, lines] : said)
    if (auto before = caution.find(lang.substr(0, lang.find('-'))); before != caution.end())
      lines.insert(lines.begin(), before->second.front());
  return said;
}

}  // namespace wellspring::show
