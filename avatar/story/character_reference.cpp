// SPDX-License-Identifier: Apache-2.0
#include "avatar/story/character_reference.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "avatar/speech/text.h"

namespace wellspring::avatar {
namespace {

// From U+00A0 on, one a code point.
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

// Numbers 128 to 159, as HTML reads them: those of Windows' code page.
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

// Code point of a name; 0: there is none.
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

// Code point of "#233" or "#xe9"; 0: none that may stand in a text.
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

}  // namespace wellspring::avatar
