// SPDX-License-Identifier: Apache-2.0
#include "kiosk/gesture/gesture_file.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numeric>

#include "base/load_error.h"
#include "base/write_file.h"
#include "json/fields.h"

namespace wellspring::kiosk {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr size_t most_places = 100'000, most_gestures = 200;

void check_sum(FieldReader& fields, const char* name, size_t row, const double* values,
               size_t count) {
  const double sum = std::accumulate(values, values + count, 0.0);
  if (std::abs(sum - 1) > 1e-6)
    fields.fail(name, "row " + std::to_string(row) + " does not sum to 1");
}

Hmm read_hmm(FieldReader& fields, size_t most) {
  constexpr double one = 1 + 1e-6;  // sums are rounded
  Hmm out;
  const auto rows = fields.list("output", 1, most, "rows", Need::required);
  const size_t n = rows.size();
  out.states = int(n);
  out.initial = fields.numbers("initial", n, 0, one);
  out.transition = fields.numbers("transition", n * n, 0, one);
  check_sum(fields, "initial", 0, out.initial.data(), n);
  for (size_t i = 0; i < n; i++) {
    check_sum(fields, "transition", i, &out.transition[i * n], n);
    auto& row = out.output.emplace_back();
    rows[i].numbers(orientation_codes, 0, one, row.data());
    check_sum(fields, "output", i, row.data(), orientation_codes);
  }
  return out;
}

HandPath load_recording(const std::string& file) {
  const json root = parse_json_file(file, read_json_text(file));
  Faults faults(file);
  FieldReader fields(root, faults);
  HandPath path;
  fields.text("label", path.label, "", Need::optional, most_label);
  fields.text("variant", path.variant, "", Need::optional, most_label);
  for (const JsonValue& one : fields.list("places", 2, most_places, "places", Need::required)) {
    const auto numbers = one.list(3, 3, "three numbers");
    const double reach = OrientationCoder::reach;
    HandPlace place;
    numbers[0].number(-1e9, 1e9, place.time);
    numbers[1].number(-reach, reach, place.place.x);
    numbers[2].number(-reach, reach, place.place.y);
    if (!path.places.empty() && place.time <= path.places.back().time)
      numbers[0].fail("is not later than the place before");
    path.places.push_back(place);
  }
  return path;
}

GestureModel read_gesture(FieldReader& fields) {
  GestureModel model;
  fields.text("label", model.label, "", Need::required, most_label);
  fields.text("variant", model.variant, "", Need::optional, most_label);
  model.hmm = read_hmm(fields, most_states);
  model.hmm.ends_in_last = true;
  const size_t count = count_measures(model.hmm.states);
  model.mean = fields.numbers("mean", count, -1e6, 1e6);
  model.deviation = fields.numbers("deviation", count, 1e-6, 1e6);
  model.other_mean = fields.numbers("other_mean", count, -1e6, 1e6);
  model.other_deviation = fields.numbers("other_deviation", count, 1e-6, 1e6);
  fields.number("usual_difference", -1e6, 1e6, model.usual_difference, "", Need::required);
  fields.number("usual_evidence", -1e6, 1e6, model.usual_evidence, "", Need::required);
  fields.number("least", 0, 1e6, model.least, "", Need::required);
  fields.number("dwell", 0, 60, model.dwell, "", Need::required);
  return model;
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
  const json root = parse_json_file(file, read_json_text(file));
  Faults faults(file);
  FieldReader fields(root, faults);
  GestureModels models;
  for (const JsonValue& one : fields.list("gestures", 1, most_gestures, "gestures", Need::required))
    fields.read_object(one,
                       [&](FieldReader& part) { models.gestures.push_back(read_gesture(part)); });
  fields.part(
      "other", "", [&](FieldReader& part) { models.other = read_hmm(part, 1000); }, Need::required);
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
