// SPDX-License-Identifier: Apache-2.0
#include "kiosk/gesture/gesture_file.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/load_error.h"
#include "base/read_file.h"
#include "base/write_file.h"
#include "wire/json.h"

namespace wellspring::kiosk {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr size_t largest_file = 16 << 20;  // bytes
constexpr size_t most_places = 100'000, most_gestures = 200;

json read_json(const std::string& file) {
  auto parsed = parse_json(read_file(file, largest_file));
  if (const auto* wrong = std::get_if<WireError>(&parsed))
    throw LoadError(file, "", wrong->message);
  json root = std::move(std::get<json>(parsed));
  if (!root.is_object()) throw LoadError(file, "", "is no JSON object");
  return root;
}

// Reads a file's values by name; the first fault is thrown with its place.
struct Reader {
  const std::string& file;

  [[noreturn]] void fail(const std::string& where, const std::string& what) const {
    throw LoadError(file, where, what);
  }
  const json& member(const json& object, const std::string& where, const char* name) const {
    if (!object.is_object() || !object.contains(name)) fail(where + "/" + name, "missing");
    return object[name];
  }
  const json& list(const json& value, const std::string& where, size_t least, size_t most) const {
    if (!value.is_array()) fail(where, "is no list");
    if (value.size() < least || value.size() > most)
      fail(where, "has " + std::to_string(value.size()) + " entries, not " + std::to_string(least) +
                      (least == most ? "" : " to " + std::to_string(most)));
    return value;
  }
  double number(const json& value, const std::string& where, double least, double most) const {
    const double x = value.is_number() ? value.get<double>() : NAN;
    if (!(x >= least && x <= most)) {
      char range[80];
      std::snprintf(range, sizeof range, "is no number from %g to %g", least, most);
      fail(where, range);
    }
    return x;
  }
  double number(const json& object, const std::string& where, const char* name, double least,
                double most) const {
    return number(member(object, where, name), where + "/" + name, least, most);
  }
  std::vector<double> numbers(const json& object, const std::string& where, const char* name,
                              size_t count, double least, double most) const {
    const std::string here = where + "/" + name;
    const json& values = list(member(object, where, name), here, count, count);
    std::vector<double> out;
    for (size_t i = 0; i < count; i++)
      out.push_back(number(values[i], here + "/" + std::to_string(i), least, most));
    return out;
  }
  std::string text(const json& object, const std::string& where, const char* name) const {
    const auto at = object.find(name);
    if (at == object.end()) return {};
    const std::string text = at->is_string() ? at->get<std::string>() : std::string("\n");
    const bool plain =
        std::none_of(text.begin(), text.end(), [](unsigned char c) { return c < ' '; });
    if (!plain || text.size() > most_label)
      fail(where + "/" + name, "is no text of at most 32 bytes");
    return text;
  }
  void check_sum(const double* values, size_t count, const std::string& where) const {
    double sum = 0;
    for (size_t i = 0; i < count; i++) sum += values[i];
    if (std::abs(sum - 1) > 1e-6) fail(where, "does not sum to 1");
  }

  Hmm hmm(const json& object, const std::string& where, int most) const {
    constexpr double one = 1 + 1e-6;  // sums are rounded
    Hmm out;
    const json& rows = list(member(object, where, "output"), where + "/output", 1, size_t(most));
    out.states = int(rows.size());
    const size_t n = rows.size();
    out.initial = numbers(object, where, "initial", n, 0, one);
    out.transition = numbers(object, where, "transition", n * n, 0, one);
    check_sum(out.initial.data(), n, where + "/initial");
    for (size_t i = 0; i < n; i++) {
      const std::string row = where + "/output/" + std::to_string(i);
      check_sum(&out.transition[i * n], n, where + "/transition, row " + std::to_string(i));
      list(rows[i], row, orientation_codes, orientation_codes);
      out.output.emplace_back();
      for (size_t o = 0; o < orientation_codes; o++)
        out.output[i][o] = number(rows[i][o], row + "/" + std::to_string(o), 0, one);
      check_sum(out.output[i].data(), orientation_codes, row);
    }
    return out;
  }
};

HandPath load_recording(const std::string& file) {
  const json root = read_json(file);
  const Reader reader{file};
  HandPath path{reader.text(root, "", "label"), reader.text(root, "", "variant"), {}};
  const json& places = reader.list(reader.member(root, "", "places"), "/places", 2, most_places);
  for (size_t i = 0; i < places.size(); i++) {
    const std::string where = "/places/" + std::to_string(i);
    reader.list(places[i], where, 3, 3);
    const double time = reader.number(places[i][0], where + "/0", -1e9, 1e9);
    if (i > 0 && time <= path.places.back().time)
      reader.fail(where + "/0", "is not later than the place before");
    const double reach = OrientationCoder::reach;
    path.places.push_back({time, vec2(reader.number(places[i][1], where + "/1", -reach, reach),
                                      reader.number(places[i][2], where + "/2", -reach, reach))});
  }
  return path;
}

json to_json(const Hmm& hmm) {
  return {{"initial", hmm.initial}, {"transition", hmm.transition}, {"output", hmm.output}};
}

}  // namespace

std::vector<HandPath> load_recordings(const std::string& folder) {
  std::error_code error;
  std::vector<std::string> files;
  if (!fs::is_directory(folder, error)) throw LoadError(folder, "", "is no folder");
  for (const auto& entry : fs::recursive_directory_iterator(folder, error))
    if (entry.is_regular_file() && entry.path().extension() == ".json")
      files.push_back(entry.path().string());
  if (error) throw LoadError(folder, "", "cannot be read");
  if (files.empty()) throw LoadError(folder, "", "has no recordings (.json)");
  std::sort(files.begin(), files.end());
  std::vector<HandPath> paths;
  for (const std::string& file : files) paths.push_back(load_recording(file));
  return paths;
}

GestureModels load_gesture_models(const std::string& file) {
  const json root = read_json(file);
  const Reader reader{file};
  GestureModels models;
  const json& gestures =
      reader.list(reader.member(root, "", "gestures"), "/gestures", 1, most_gestures);
  for (size_t i = 0; i < gestures.size(); i++) {
    const std::string where = "/gestures/" + std::to_string(i);
    GestureModel model;
    model.label = reader.text(gestures[i], where, "label");
    if (model.label.empty()) reader.fail(where + "/label", "missing");
    model.variant = reader.text(gestures[i], where, "variant");
    model.hmm = reader.hmm(gestures[i], where, most_states);
    model.hmm.ends_in_last = true;
    const size_t count = count_measures(model.hmm.states);
    auto measures = [&](const char* name, double least) {
      return reader.numbers(gestures[i], where, name, count, least, 1e6);
    };
    model.mean = measures("mean", -1e6);
    model.deviation = measures("deviation", 1e-6);
    model.other_mean = measures("other_mean", -1e6);
    model.other_deviation = measures("other_deviation", 1e-6);
    model.usual_difference = reader.number(gestures[i], where, "usual_difference", -1e6, 1e6);
    model.usual_evidence = reader.number(gestures[i], where, "usual_evidence", -1e6, 1e6);
    model.least = reader.number(gestures[i], where, "least", 0, 1e6);
    model.dwell = reader.number(gestures[i], where, "dwell", 0, 60);
    models.gestures.push_back(std::move(model));
  }
  models.other = reader.hmm(reader.member(root, "", "other"), "/other", 1000);
  return models;
}

void save_gesture_models(const GestureModels& models, const std::string& file) {
  json gestures = json::array();
  for (const GestureModel& model : models.gestures) {
    json item = to_json(model.hmm);
    item["label"] = model.label;
    if (!model.variant.empty()) item["variant"] = model.variant;
    item["mean"] = model.mean;
    item["deviation"] = model.deviation;
    item["other_mean"] = model.other_mean;
    item["other_deviation"] = model.other_deviation;
    item["usual_difference"] = model.usual_difference;
    item["usual_evidence"] = model.usual_evidence;
    item["least"] = model.least;
    item["dwell"] = model.dwell;
    gestures.push_back(std::move(item));
  }
  write_file(file, json{{"gestures", gestures}, {"other", to_json(models.other)}}.dump(1) + "\n");
}

}  // namespace wellspring::kiosk
