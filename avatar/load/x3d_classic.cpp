// SPDX-License-Identifier: Apache-2.0
// Reads ClassicVRML (ISO/IEC 19776-2) and VRML97 into the node tree. Fields need no types to be
// read: a value is a node, a list in brackets, or all up to the next name. Instances of the H-Anim
// 1 prototypes become H-Anim nodes; other prototypes are named and left out.
#include <algorithm>
#include <cstring>

#include "avatar/load/x3d_node.h"
#include "base/load_error.h"

namespace wellspring::avatar {
namespace {

enum class TokenType { end, word, string, open_brace, close_brace, open_bracket, close_bracket };

struct Token {
  TokenType type = TokenType::end;
  std::string_view text;  // a string's text has its quotes
  int line = 1;
};

struct Parser {
  X3dFile& file;
  std::string_view text;
  size_t at = 0;
  int line = 1;
  Token token;  // token not yet taken
  std::vector<X3dPendingUse> uses;

  [[noreturn]] void fail(const std::string& what) const {
    throw LoadError(file.path, "line " + std::to_string(token.line), what);
  }

  std::string shown() const {
    return token.type == TokenType::end ? "the end of the file"
                                        : "'" + std::string(token.text.substr(0, 40)) + "'";
  }

  void advance() {
    while (at < text.size()) {
      char c = text[at];
      if (c == '\n') line++;
      if (c == '#') {
        while (at < text.size() && text[at] != '\n') at++;
      } else if (c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == ',') {
        at++;
      } else {
        break;
      }
    }
    token = {TokenType::end, {}, line};
    if (at >= text.size()) return;
    size_t start = at;
    auto single = [&](TokenType type) { token = {type, text.substr(at++, 1), line}; };
    switch (text[at]) {
      case '{': return single(TokenType::open_brace);
      case '}': return single(TokenType::close_brace);
      case '[': return single(TokenType::open_bracket);
      case ']': return single(TokenType::close_bracket);
      case '"':
        for (at++; at < text.size() && text[at] != '"'; at++) {
          if (text[at] == '\n') line++;
          if (text[at] == '\\') at++;
        }
        if (at >= text.size()) {
          at = text.size();
          fail("a string has no end");
        }
        at++;
        token = {TokenType::string, text.substr(start, at - start), token.line};
        return;
      default:
        while (at < text.size() && !std::strchr(" \t\r\n,{}[]\"#", text[at])) at++;
        if (at == start) at++;  // a zero byte
        token = {TokenType::word, text.substr(start, at - start), line};
    }
  }

  bool is_word(const char* word) const {
    return token.type == TokenType::word && token.text == word;
  }
  bool is_any(std::initializer_list<const char*> words) const {
    return std::any_of(words.begin(), words.end(), [&](const char* word) { return is_word(word); });
  }
  std::string take_word(const char* what) {
    if (token.type != TokenType::word) fail(std::string("expected ") + what + ", found " + shown());
    std::string word(token.text);
    advance();
    return word;
  }
  void take(TokenType type, const char* what) {
    if (token.type != type) fail(std::string("expected '") + what + "', found " + shown());
    advance();
  }
  bool is_number() const {
    if (token.type != TokenType::word) return false;
    char c = token.text[0];
    bool digit = c >= '0' && c <= '9';
    return digit || c == '-' || c == '+' || c == '.';
  }

  // Skips from an opening bracket or brace to its partner.
  void skip_block() {
    int depth = 0;
    do {
      if (token.type == TokenType::open_brace || token.type == TokenType::open_bracket) depth++;
      else if (token.type == TokenType::close_brace || token.type == TokenType::close_bracket)
        depth--;
      else if (token.type == TokenType::end) fail("a bracket is never closed");
      advance();
    } while (depth > 0);
  }

  // Skips PROTO, ROUTE and other statements that make no node. False: the token starts something
  // else.
  bool skip_statement() {
    if (is_any({"PROTO", "EXTERNPROTO"})) {
      bool external = is_word("EXTERNPROTO");
      advance();
      std::string name = take_word("a prototype's name");
      if (token.type != TokenType::open_bracket) fail("expected '[', found " + shown());
      if (x3d_type_name(name).rfind("HAnim", 0) != 0)
        warn_once(file.warnings, "prototype '" + name.substr(0, 60) + "' is not expanded");
      skip_block();
      if (!external && token.type == TokenType::open_brace) skip_block();
      else if (external && token.type == TokenType::open_bracket) skip_block();
      else if (external && token.type == TokenType::string) advance();
      return true;
    }
    if (is_word("ROUTE")) {
      std::string words[4];
      for (std::string& word : words) word = take_word("a ROUTE a.b TO c.d");
      size_t from = words[1].find('.'), to = words[3].find('.');
      if (from != std::string::npos && to != std::string::npos)
        add_route(file, {words[1].substr(0, from), words[1].substr(from + 1),
                         words[3].substr(0, to), words[3].substr(to + 1)});
      return true;
    }
    if (is_any({"PROFILE", "COMPONENT"})) {
      advance();
      take_word("a name");
      while (token.type == TokenType::word && (token.text[0] == ':' || is_number()))
        advance();  // "name : level"
      return true;
    }
    if (is_word("META")) {
      advance();
      take(TokenType::string, "a string");
      take(TokenType::string, "a string");
      return true;
    }
    if (is_word("UNIT")) {
      advance();
      std::string category = take_word("a category");
      take_word("a unit's name");
      float factor = float(std::atof(take_word("a factor").c_str()));
      if (category == "length" && factor > 1e-6f && factor < 1e6f) file.length_unit = factor;
      return true;
    }
    if (is_any({"IMPORT", "EXPORT"})) {
      advance();
      take_word("a name");
      if (is_word("AS")) {
        advance();
        take_word("a name");
      }
      return true;
    }
    return false;
  }

  // Reads a node statement into a field of `parent`.
  void parse_node(int parent, const std::string& field, int depth) {
    if (depth > x3d_max_depth)
      fail("nodes are nested deeper than " + std::to_string(x3d_max_depth));
    if (file.nodes.size() >= size_t(x3d_max_nodes))
      fail("more than " + std::to_string(x3d_max_nodes) + " nodes");
    int index = int(file.nodes.size());
    if (is_word("USE")) {
      int use_line = token.line;
      advance();
      std::string name = take_word("a name to USE");
      uses.push_back({parent, file.nodes[size_t(parent)].children.size(), name, use_line});
      file.nodes[size_t(parent)].children.push_back({field, index - 1, false});
      return;
    }
    X3dNode node;
    node.line = token.line;
    if (is_word("DEF")) {
      advance();
      node.def = take_word("a name after DEF");
    }
    node.type = x3d_type_name(take_word("a node"));
    file.nodes[size_t(parent)].children.push_back({field, index, false});
    file.nodes.push_back(std::move(node));
    take(TokenType::open_brace, "{");
    while (token.type != TokenType::close_brace) {
      if (token.type == TokenType::end) fail("a node is never closed");
      if (!skip_statement()) parse_field(index, depth);
    }
    advance();
  }

  void parse_field(int index, int depth) {
    if (is_any({"eventIn", "eventOut", "field", "exposedField", "inputOnly", "outputOnly",
                "initializeOnly", "inputOutput"})) {
      bool valued = !is_any({"eventIn", "eventOut", "inputOnly", "outputOnly"});
      advance();
      take_word("a field's type");
      std::string name = take_word("a field's name");
      if (valued || is_word("IS")) parse_value(index, name, depth);
      return;
    }
    std::string name = take_word("a field's name");
    parse_value(index, name, depth);
  }

  void add_text(std::string& all) {
    if (!all.empty()) all += ' ';
    all += token.text;
    advance();
  }

  void parse_value(int index, const std::string& name, int depth) {
    std::string all;
    if (is_word("IS")) {
      advance();
      take_word("a name after IS");
      return;
    }
    if (token.type == TokenType::open_bracket) {
      advance();
      bool plain = false;
      while (token.type != TokenType::close_bracket) {
        if (token.type == TokenType::end)
          fail("the list of field '" + name.substr(0, 40) + "' is never closed");
        if (skip_statement()) continue;
        bool value = token.type == TokenType::string || is_number() ||
                     is_any({"TRUE", "FALSE", "true", "false"});
        if (value) {
          add_text(all);
          plain = true;
        } else if (is_word("NULL")) {
          advance();
        } else {
          parse_node(index, name, depth + 1);
        }
      }
      advance();
      if (plain) file.nodes[size_t(index)].fields.push_back({name, all});
      return;
    }
    if (is_word("NULL")) return advance();
    if (token.type == TokenType::string || is_any({"TRUE", "FALSE", "true", "false"})) {
      add_text(all);
    } else if (is_number()) {
      while (is_number()) add_text(all);
    } else {
      return parse_node(index, name, depth + 1);
    }
    file.nodes[size_t(index)].fields.push_back({name, all});
  }
};

}  // namespace

X3dFile parse_x3d_classic(const std::string& path, const std::string& text) {
  X3dFile file;
  file.path = path;
  file.nodes.push_back({.type = "Scene", .def = "", .line = 1, .fields = {}, .children = {}});
  Parser parser{.file = file, .text = text, .at = 0, .line = 1, .token = {}, .uses = {}};
  if (text.rfind("\xef\xbb\xbf", 0) == 0) parser.at = 3;
  parser.advance();
  while (parser.token.type != TokenType::end)
    if (!parser.skip_statement()) parser.parse_node(0, "children", 1);
  resolve_uses(file, parser.uses);
  return file;
}

}  // namespace wellspring::avatar
