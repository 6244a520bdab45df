// SPDX-License-Identifier: Apache-2.0
#include "show/questions/words.h"

#include <algorithm>
#include <cstdint>
#include <map>
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

// What is left out, with base letters only.
const std::map<std::string, std::set<std::string>> stop_words = {
    {"en", {"a",    "about", "all",   "an",    "and",   "any",    "are",  "as",   "at",    "be",
            "been", "but",   "by",    "can",   "could", "did",    "do",   "does", "for",   "from",
            "had",  "has",   "have",  "he",    "her",   "here",   "him",  "his",  "how",   "i",
            "in",   "is",    "it",    "its",   "know",  "made",   "many", "may",  "me",    "much",
            "my",   "of",    "on",    "or",    "our",   "please", "say",  "she",  "so",    "some",
            "tell", "that",  "the",   "their", "them",  "there",  "they", "this", "to",    "was",
            "we",   "were",  "what",  "when",  "where", "which",  "who",  "whom", "whose", "why",
            "will", "with",  "would", "you",   "your",  "thing"}},
    {"de",
     {"aber",   "alle",   "als",     "am",      "an",      "auch",  "auf",   "aus",    "bei",
      "bitte",  "da",     "das",     "dem",     "den",     "denn",  "der",   "des",    "die",
      "dir",    "du",     "ein",     "eine",    "einem",   "einen", "einer", "er",     "es",
      "etwas",  "fur",    "gibt",    "hat",     "haben",   "hatte", "hier",  "ich",    "ihr",
      "ihre",   "im",     "in",      "ist",     "kann",    "man",   "mir",   "mit",    "nach",
      "nicht",  "noch",   "oder",    "sich",    "sie",     "sind",  "so",    "uber",   "um",
      "und",    "uns",    "viel",    "viele",   "vom",     "von",   "wann",  "war",    "waren",
      "warum",  "was",    "welche",  "welcher", "welches", "wem",   "wen",   "wer",    "wie",
      "wo",     "woher",  "wozu",    "wird",    "wurde",   "zu",    "zum",   "zur",    "weisst",
      "wissen", "erzahl", "erzahle", "woraus",  "womit",   "wofur", "wieso", "weshalb"}},
    {"sk", {"a",      "aby",   "aj",    "ako",   "aka", "ake",   "aky",    "ale",    "alebo", "ano",
            "bol",    "bola",  "boli",  "bolo",  "byt", "co",    "do",     "ho",     "im",    "ja",
            "je",     "jej",   "jeho",  "ich",   "k",   "kam",   "kde",    "ked",    "kedy",  "kto",
            "ktora",  "ktore", "ktory", "kolko", "ku",  "ma",    "mi",     "moze",   "my",    "na",
            "nie",    "o",     "od",    "po",    "pre", "preco", "pri",    "prosim", "s",     "sa",
            "si",     "so",    "su",    "ta",    "tam", "tato",  "ten",    "tento",  "to",    "tu",
            "ty",     "u",     "v",     "vam",   "vo",  "vy",    "z",      "za",     "ze",    "zo",
            "povedz", "vies",  "toto",  "coho",  "cim", "comu",  "odkial", "kam",    "kade"}},
    {"fr",
     {"a",       "ai",   "au",   "aux",  "avec", "ce",       "ces",   "cet",   "cette", "combien",
      "comment", "d",    "dans", "de",   "des",  "dit",      "du",    "elle",  "en",    "est",
      "et",      "eu",   "fait", "il",   "ils",  "j",        "je",    "l",     "la",    "le",
      "les",     "leur", "lui",  "mais", "me",   "moi",      "n",     "ne",    "nous",  "on",
      "ont",     "ou",   "par",  "pas",  "pour", "pourquoi", "qu",    "quand", "que",   "quel",
      "quelle",  "qui",  "quoi", "s",    "sa",   "se",       "ses",   "son",   "sont",  "sur",
      "t",       "tu",   "un",   "une",  "vous", "y",        "savez", "etait"}},
    {"es", {"a",      "al",    "como",  "con",  "cual", "cuando", "cuanto", "cuanta", "de",   "del",
            "dime",   "donde", "e",     "el",   "ella", "en",     "era",    "e",      "esa",  "ese",
            "eso",    "esta",  "este",  "esto", "fue",  "ha",     "hay",    "la",     "la",   "le",
            "lo",     "lo",    "me",    "mi",   "muy",  "no",     "o",      "para",   "pero", "por",
            "porque", "que",   "quien", "se",   "ser",  "si",     "sobre",  "son",    "su",   "su",
            "tiene",  "tu",    "un",    "una",  "y",    "ya",     "yo",     "sabe",   "estan"}}};

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
  auto found = stop_words.find(lang.substr(0, lang.find('-')));
  const std::set<std::string>* left_out = found == stop_words.end() ? nullptr : &found->second;
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

}  // namespace wellspring::show
