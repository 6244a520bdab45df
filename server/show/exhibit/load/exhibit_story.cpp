// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/load/exhibit_story.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "avatar/body/gesture.h"
#include "avatar/face/expression.h"
#include "avatar/story/story_speech.h"
#include "base/load_error.h"
#include "base/unicode.h"
#include "json/text.h"
#include "show/exhibit/exhibit_files.h"
#include "show/exhibit/pieces/piece_choices.h"

namespace wellspring::show {

using nlohmann::json;

namespace {

bool is_story_name(const std::string& text) {
  std::string extension = std::filesystem::path(text).extension().string();
  bool known = extension == ".story" || extension == ".ssml" || extension == ".xml" ||
               extension == ".txt" || extension == ".vtt";
  return known && text.find_first_of("<> \n") == std::string::npos;
}

struct StoryReader {
  const Exhibit& exhibit;
  FieldReader& fields;
  std::vector<Problem>& problems;

  // Adds the lines of a text; `where` is its place in exhibit.json, or its file.
  template <class Read>
  void add(std::vector<StoryLine>& lines, const std::string& where, const Read& read) {
    try {
      StoryScript script = read();
      for (const StoryNote& note : script.notes)
        problems.push_back({where, to_string(note.place), note.what, false});
      for (StoryLine& line : script.lines) {
        line.file = where;
        lines.push_back(std::move(line));
      }
    } catch (const LoadError& error) {
      problems.push_back({where, error.where, error.what_});
    }
  }

  void read(const json& value, const std::string& place, bool may_be_text,
            std::vector<StoryLine>& lines) {
    const std::string where = exhibit.folder + "/exhibit.json: " + fields.where() + "/" + place;
    if (value.is_array() && !value.empty()) {
      for (size_t i = 0; i < value.size(); i++) {
        if (!value[i].is_string()) fields.fail(place + "/" + std::to_string(i), "must be a text");
        else
          add(lines, where + "/" + std::to_string(i),
              [&] { return read_story_line(value[i].get<std::string>(), where); });
      }
    } else if (value.is_string() && is_story_name(value.get<std::string>())) {
      std::string name = value.get<std::string>();
      std::string path = package_file(fields, place.c_str(), exhibit.folder, name);
      if (path.empty()) return;
      add(lines, path, [&] { return load_story(path); });
    } else if (value.is_string() && may_be_text) {
      add(lines, where, [&] { return read_story(value.get<std::string>(), where); });
    } else {
      fields.fail(place,
                  "must be a list of sentences, or the name of a .story, .ssml, .txt or .vtt file");
    }
  }
};

struct Checker {
  const Exhibit& exhibit;
  std::vector<Problem>& problems;

  void note(const StoryLine& line, const MarkupPlace& place, const std::string& what) {
    problems.push_back({line.file, to_string(place), what, false});
  }

  static bool knows(const GestureLibrary& library, const std::string& name) {
    return find_gesture(library, name) >= 0;
  }

  // The libraries of all storytellers.
  std::vector<const GestureLibrary*> libraries() const {
    std::vector<const GestureLibrary*> list;
    for (const StorytellerPlace& one : exhibit.storytellers)
      list.push_back(one.gestures ? &*one.gestures : &default_gestures());
    if (list.empty()) list.push_back(&default_gestures());
    return list;
  }

  void check_gesture(const StoryLine& line, const StoryMark& mark) {
    for (const GestureLibrary* library : libraries()) {
      if (knows(*library, mark.name)) continue;
      std::vector<std::string> names;
      for (const GestureClip& clip : library->clips) names.push_back(clip.name);
      note(line, mark.place,
           "there is no gesture '" + mark.name + "'" + did_you_mean(mark.name, names));
      return;
    }
  }

  void check_emotion(const StoryLine& line, const StoryMark& mark) {
    if (find_emotion(mark.name) >= 0) return;
    const std::vector<std::string> names(emotion_names.begin(), emotion_names.end());
    note(line, mark.place,
         "there is no emotion '" + mark.name + "'" + did_you_mean(mark.name, names));
  }

  void check_show(const StoryLine& line, const StoryMark& mark) {
    PieceChoices choices;
    const std::string wrong = choose_told(exhibit, mark.name, mark.piece, choices);
    if (!wrong.empty()) note(line, mark.place, wrong);
  }

  void check_mark(const StoryLine& line, const StoryMark& mark) {
    if (mark.name.empty()) return;
    bool object = mark.kind == StoryMarkKind::look || mark.kind == StoryMarkKind::point;
    if (object && !find_point(exhibit, mark.name))
      note(line, mark.place, unknown_object(exhibit, mark.name));
    if (mark.kind == StoryMarkKind::hold && find_prop(exhibit, mark.name) < 0)
      note(line, mark.place, unknown_prop(exhibit, mark.name));
    if (mark.kind == StoryMarkKind::view && find_viewpoint(exhibit, mark.name) < 0)
      note(line, mark.place, unknown_viewpoint(exhibit, mark.name));
    if (mark.kind == StoryMarkKind::show) check_show(line, mark);
    if (mark.kind == StoryMarkKind::emotion) check_emotion(line, mark);
    if (mark.kind == StoryMarkKind::gesture) check_gesture(line, mark);
  }

  void check(const std::string& what, const LocalScript& script) {
    for (const auto& [lang, lines] : script)
      for (const StoryLine& line : lines)
        for (const StoryMark& mark : line.marks) check_mark(line, mark);
    for (const auto& [lang, lines] : script)
      if (lines.size() != script.begin()->second.size())
        problems.push_back({exhibit.folder + "/exhibit.json", what,
                            "has " + std::to_string(lines.size()) + " sentences in '" + lang +
                                "' and " + std::to_string(script.begin()->second.size()) + " in '" +
                                script.begin()->first +
                                "'; subtitles of one will not go with the other",
                            false});
  }
};

}  // namespace

// Returns the JSON Schema of a text that is told.
static nlohmann::ordered_json script_schema(bool may_be_text) {
  const nlohmann::ordered_json text = {{"type", "string"}};
  const nlohmann::ordered_json by_language = FieldReader::map_schema(
      {{"anyOf", nlohmann::ordered_json::array({text, FieldReader::list_schema(text, 1)})}});
  if (!may_be_text) return by_language;
  return {{"anyOf", nlohmann::ordered_json::array({text, by_language})}};
}

LocalScript read_script(const Exhibit& exhibit, FieldReader& fields, const char* name,
                        bool may_be_text, std::vector<Problem>& problems, Need need) {
  LocalScript script;
  const auto field = fields.take(name, script_schema(may_be_text),
                                 "for each language sentences, or a file of them", need);
  if (!field) return script;
  const json& value = field->value();
  StoryReader reader{exhibit, fields, problems};
  if (value.is_string() && may_be_text) {
    reader.read(value, name, may_be_text, script[exhibit.languages.front()]);
    return script;
  }
  if (!value.is_object()) return field->fail("must hold a text for each language"), script;
  for (const auto& [lang, text] : value.items()) {
    std::string place = std::string(name) + "/" + lang;
    if (!is_language_tag(lang)) fields.fail(place, "is no language tag such as en");
    else reader.read(text, place, may_be_text, script[lang]);
  }
  std::erase_if(script, [](const auto& entry) { return entry.second.empty(); });
  return script;
}

LocalText read_sounds(const Exhibit& exhibit, FieldReader& fields, const char* name,
                      const LocalScript& script) {
  LocalText sounds;
  const auto field = fields.take(name, FieldReader::map_schema({{"type", "string"}}),
                                 "recordings: for each language a file");
  if (!field) return sounds;
  FieldReader::read_object(*field, [&](FieldReader& files) {
    for (const auto& [lang, value] : files.members()) {
      std::string file;
      if (!value.text(file, max_text_bytes, Need::required)) continue;
      std::string path = package_file(files, lang.c_str(), exhibit.folder, file);
      if (!script.contains(lang)) value.fail("is a recording without a text");
      else if (!path.empty()) sounds[lang] = path;
    }
  });
  return sounds;
}

VoiceManner read_manner(FieldReader& fields, const char* name, const VoiceManner& otherwise) {
  VoiceManner manner = otherwise;
  fields.part(name, "how the synthesiser speaks for it", [&](FieldReader& voice) {
    double words = manner.words_per_minute, pitch = manner.pitch;
    voice.number("words_per_minute", 80, 450, words);
    voice.number("pitch", 0, 100, pitch);
    manner.words_per_minute = int(words), manner.pitch = int(pitch);
    voice.text("variant", manner.variant, "f3, m2, ...");
    bool plain = std::all_of(manner.variant.begin(), manner.variant.end(), [](unsigned char c) {
      return std::isalnum(c) || c == '-' || c == '_';
    });
    if (!plain || manner.variant.size() > 40) voice.fail("variant", "is no name such as f3");
  });
  return manner;
}

void check_marks(const Exhibit& exhibit, std::vector<Problem>& problems) {
  Checker checker{exhibit, problems};
  for (const StorytellerPlace& storyteller_place : exhibit.storytellers) {
    checker.check("greetings of '" + storyteller_place.id + "'", storyteller_place.greetings);
    checker.check("farewells of '" + storyteller_place.id + "'", storyteller_place.farewells);
  }
  for (const StoryText& story : exhibit.stories)
    checker.check("story '" + story.id + "'", story.text);
  for (const TourPlan& tour : exhibit.tours)
    for (size_t i = 0; i < tour.stops.size(); i++) {
      std::string what = "tour '" + tour.id + "', stop " + std::to_string(i + 1);
      checker.check(what, tour.stops[i].text);
      checker.check(what, tour.stops[i].way_text);
    }
}

void read_questions(Exhibit& exhibit, FieldReader& root) {
  root.parts("questions", most_questions, "what visitors may ask, and what is said to it",
             [&](FieldReader& fields) {
               AnsweredQuestion one;
               one.question =
                   read_local_texts(fields, "question", SIZE_MAX,
                                    "ways to ask it; the first is offered", Need::required);
               one.answer = read_local_text(fields, "answer", "", Need::required);
               if (!one.question.empty() && !one.answer.empty())
                 exhibit.questions.push_back(std::move(one));
             });
}

namespace {

constexpr double longest = 3600;  // seconds that a kiosk may be told to wait
constexpr double smallest_screen = 0.1, largest_screen = 10;  // metres

// Reads the times that are given; the others stay as they are.
void read_times(KioskTimes& times, FieldReader& fields) {
  auto read = [&](const char* name, double& seconds, const char* about) {
    fields.number(name, 0, longest, seconds, about);
  };
  read("hold_person", times.hold_person, "seconds that a head counts as there after it was seen");
  read("sleep_after", times.sleep_after, "seconds without motion");
  read("leave_after", times.leave_after, "seconds without a head or a touch of an engaged guest");
  read("leave_untouched", times.leave_untouched,
       "seconds without a touch of a guest whom no camera sees");
  read("leave_playing", times.leave_playing, "likewise while something plays");
  read("farewell", times.farewell, "its length in seconds");
  read("sleep_latest", times.sleep_latest, "seconds from its beginning, where nothing moves");
}

// Reads which tree its cameras tell objects by, and which objects that names. Solvers' own data is
// read by `wellspring check` and by kiosks (kiosk/tree/tree_file.h).
void read_station(Exhibit& exhibit, FieldReader& fields, KioskSettings& kiosk) {
  std::string name;
  if (!fields.text("station", name, "file of ./wellspring station: what guests may hold up"))
    return;
  kiosk.station.clear(), kiosk.held.clear();
  if (!add_served_file(exhibit, fields, "station", name, Medium::station)) return;
  kiosk.station = name;
  try {
    const std::string& path = exhibit.files.at(name).path;
    const json tree = parse_json_file(path, read_json_text(path));
    const auto nodes = tree.find("nodes");
    if (nodes == tree.end() || !nodes->is_object())
      return fields.fail("station", "'" + name + "' has no nodes");
    for (const json& node : *nodes) {
      if (!node.is_object() || node.value("kind", json()) != "model") continue;
      if (const json id = node.value("id", json()); id.is_string()) kiosk.held.push_back(id);
    }
  } catch (const LoadError& error) {
    fields.fail("station", "'" + name + "' " + error.what_);
  }
}

}  // namespace

void read_kiosks(Exhibit& exhibit, FieldReader& root) {
  std::set<std::string> named;
  root.parts("kiosks", SIZE_MAX, "", [&](FieldReader& fields) {
    std::string name;
    fields.text("name", name, "as its page and its cameras say it", Need::required);
    if (!named.insert(name).second) fields.fail("name", "'" + name + "' is taken by another kiosk");
    auto is_it = [&](const KioskSettings& one) { return one.name == name; };
    auto kiosk = std::find_if(exhibit.kiosks.begin(), exhibit.kiosks.end(), is_it);
    if (kiosk == exhibit.kiosks.end())
      kiosk = exhibit.kiosks.insert(kiosk, KioskSettings{.name = name});
    fields.text("viewpoint", kiosk->viewpoint, "its window; without it the storyteller's");
    if (!kiosk->viewpoint.empty() && find_viewpoint(exhibit, kiosk->viewpoint) < 0)
      fields.fail("viewpoint", unknown_viewpoint(exhibit, kiosk->viewpoint));
    fields.text("teller", kiosk->teller, "id of the storyteller who comes there");
    if (!kiosk->teller.empty() && find_storyteller(exhibit, kiosk->teller) < 0)
      fields.fail("teller", unknown_storyteller(exhibit, kiosk->teller));
    fields.number("volume", 0, 1, kiosk->volume);
    fields.part("screen", "its lit part: the picture follows the guest's head",
                [&](FieldReader& screen) {
                  kiosk->screen = {};
                  screen.number("width", smallest_screen, largest_screen, kiosk->screen.width,
                                "metres", Need::required);
                  screen.number("height", smallest_screen, largest_screen, kiosk->screen.height,
                                "metres", Need::required);
                });
    read_station(exhibit, fields, *kiosk);
    fields.part("times", "how long it waits",
                [&](FieldReader& times) { read_times(kiosk->times, times); });
  });
}

}  // namespace wellspring::show
