// SPDX-License-Identifier: Apache-2.0
#include "config/config_file.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <sstream>

#include "base/load_error.h"
#include "base/read_file.h"
#include "base/unicode.h"

namespace wellspring::config {
namespace {

constexpr size_t most_bytes = 1 << 20;  // most bytes of a file
constexpr size_t line_width = 98;       // characters in a line of comments
constexpr const char *config_option = "--config", *print_option = "--print-config";

std::string key_of(const CLI::Option& option) { return option.get_lnames().at(0); }
bool is_switch(const CLI::Option& option) { return option.get_items_expected_max() == 0; }
bool is_list(const CLI::Option& option) { return option.get_items_expected_max() > 1; }

// Returns the options that a file may set, in the order in which they were declared.
std::vector<CLI::Option*> keys(CLI::App& app) {
  std::vector<CLI::Option*> found;
  for (CLI::Option* option : app.get_options())
    if (option != app.get_help_ptr() && option->get_configurable() &&
        !option->get_group().empty() && !option->get_lnames().empty())
      found.push_back(option);
  return found;
}

std::string trimmed(const std::string& text) {
  const char* space = " \t\r";
  const size_t first = text.find_first_not_of(space);
  return first == std::string::npos ? ""
                                    : text.substr(first, text.find_last_not_of(space) - first + 1);
}

// Returns the message of an option's check, without the option's name before it.
std::string reason_of(const std::string& said) {
  const size_t at = said.starts_with("--") ? said.find(": ") : std::string::npos;
  return at == std::string::npos ? said : said.substr(at + 2);
}

struct Reader {
  CLI::App& app;
  std::string file;
  std::vector<CLI::Option*> options;
  std::vector<std::string> names;
  std::vector<std::string> problems;
  std::map<std::string, int> first_lines;  // line in which each key stands first
  // Values before the file, and by it.
  std::map<CLI::Option*, std::vector<std::string>> given, values;

  Reader(CLI::App& app, std::string file) : app(app), file(std::move(file)), options(keys(app)) {
    for (CLI::Option* option : options) {
      names.push_back(key_of(*option));
      given[option] = option->results();
    }
  }

  void note(int line, const std::string& what) {
    problems.push_back(file + (line ? ": line " + std::to_string(line) : "") + ": " + what);
  }

  static void set(CLI::Option& option, const std::vector<std::string>& words) {
    option.clear();
    option.add_result(words);
    option.run_callback();
  }

  void take(CLI::Option& option, const std::string& key, const std::string& value, int line) {
    const auto [first, is_first] = first_lines.emplace(key, line);
    if (!is_first && !is_list(option))
      return note(line,
                  key + " stands here again; line " + std::to_string(first->second) + " has it");
    if (is_list(option) && value.empty()) return;
    if (is_switch(option) && value != "true" && value != "false")
      return note(line, key + ": '" + value + "' is not true or false");
    std::vector<std::string>& so_far = values[&option];
    so_far.push_back(is_switch(option) ? option.get_flag_value(key, value) : value);
    try {
      set(option, so_far);
      // The command line and the environment win.
      if (!given[&option].empty()) set(option, given[&option]);
      return;
    } catch (const CLI::ConversionError&) {
      note(line, key + ": '" + value + "' is no value for it");
    } catch (const CLI::ParseError& error) {
      note(line, key + ": " + reason_of(error.what()));
    }
    so_far.pop_back();
    option.clear();
  }

  void read_line(const std::string& text, int line) {
    const std::string words = trimmed(text);
    if (words.empty() || words[0] == '#') return;
    if (words.find('\0') != std::string::npos) return note(line, "is no text");
    const size_t equals = words.find('=');
    if (equals == std::string::npos) return note(line, "is not of the form key = value");
    const std::string key = trimmed(words.substr(0, equals));
    const auto found = std::ranges::find(names, key);
    if (found == names.end())
      return note(line, "there is no key '" + key + "'" + did_you_mean(key, names));
    take(*options[size_t(found - names.begin())], key, trimmed(words.substr(equals + 1)), line);
  }

  void read() {
    std::string text;
    try {
      text = read_file(file, most_bytes, FileKind::regular_or_pipe);
    } catch (const LoadError& error) {
      return note(0, error.what_);
    }
    if (text.starts_with("\xef\xbb\xbf")) text.erase(0, 3);  // byte order mark
    std::istringstream lines(text);
    std::string line;
    for (int number = 1; std::getline(lines, line); number++) read_line(line, number);
  }
};

std::string comment(const std::string& text) {
  std::istringstream words(text);
  std::string word, line = "#", all;
  while (words >> word) {
    if (line.size() + 1 + word.size() > line_width && line != "#") {
      all += line + "\n";
      line = "#";
    }
    line += " " + word;
  }
  return line == "#" ? all : all + line + "\n";
}

std::string join_lines(const std::vector<std::string>& lines) {
  std::string all;
  for (const std::string& line : lines) all += (all.empty() ? "" : "\n") + line;
  return all;
}

}  // namespace

ConfigError::ConfigError(std::vector<std::string> problems_)
    : std::runtime_error(join_lines(problems_)), problems(std::move(problems_)) {}

void add_config(CLI::App& app, const std::string& standard) {
  std::error_code ec;
  CLI::Option* file =
      app.add_option(config_option, "file of options as key = value; the command line wins")
          ->configurable(false);
  if (!standard.empty() && std::filesystem::exists(standard, ec)) file->default_str(standard);
  const std::string prints = "write all options as such a file, as they are now, and end";
  app.add_flag(print_option, prints)->configurable(false);
}

CLI::Option* add_switch(CLI::App& app, const std::string& names, bool& value,
                        const std::string& what) {
  return app.add_flag(names, value, what)->default_str(value ? "true" : "false");
}

void parse_with_config(CLI::App& app, int argc, char** argv) {
  app.parse(argc, argv);
  const CLI::Option& named = *app.get_option(config_option);
  const std::string file = named.count() > 0 ? named.results().back() : named.get_default_str();
  if (!file.empty()) {
    Reader reader(app, file);
    reader.read();
    if (!reader.problems.empty()) throw ConfigError(std::move(reader.problems));
  }
  if (app.count(print_option) == 0) return;
  std::cout << write_config(app);
  throw CLI::Success();
}

std::string write_config(const CLI::App& app) {
  std::string text;
  for (const CLI::Option* option : keys(const_cast<CLI::App&>(app))) {
    text += (text.empty() ? "" : "\n") + comment(option->get_description());
    const std::string key = key_of(*option);
    const std::string standard = option->get_default_str();
    if (option->count() > 0)
      for (const std::string& value : option->reduced_results()) text += key + " = " + value + "\n";
    else text += "#" + key + " = " + (is_list(*option) ? "" : standard) + "\n";
  }
  return text;
}

std::map<std::string, std::string> config_values(const CLI::App& app) {
  std::map<std::string, std::string> values;
  for (const CLI::Option* option : keys(const_cast<CLI::App&>(app)))
    values[key_of(*option)] =
        option->count() > 0 ? join_lines(option->reduced_results()) : option->get_default_str();
  return values;
}

}  // namespace wellspring::config
