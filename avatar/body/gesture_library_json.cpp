// SPDX-License-Identifier: Apache-2.0
// Reads the JSON of a gesture library.
#include <algorithm>
#include <limits>
#include <map>

#include "avatar/body/gesture.h"
#include "avatar/face/library_json.h"
#include "base/read_file.h"

namespace wellspring::avatar {
namespace {

using nlohmann::json;

constexpr double radian = 3.14159265358979323846 / 180;
constexpr const char* arm_fields[] = {"forward", "side", "turn",  "elbow", "pronate",
                                      "flex",    "tilt", "curl",  "thumb", "index",
                                      "middle",  "ring", "little"};
constexpr const char* head_fields[] = {"turn", "nod", "tilt"};
constexpr const char* chest_fields[] = {"turn", "bow", "lean"};

size_t channel_of(const std::string& name) { return size_t(find_gesture_channel(name)); }
bool is_weight(size_t channel) {
  return channel == channel_of("left.weight") || channel == channel_of("right.weight");
}

using Poses = std::map<std::string, std::map<std::string, float>>;

struct Reader : LibraryReader {
  Poses poses;

  float degrees(const json& value, const std::string& where) const {
    if (!value.is_number()) fail(where, "a number of degrees is expected");
    double angle = value.get<double>();
    if (!(std::abs(angle) <= 360)) fail(where, "more than a whole turn");
    return float(angle * radian);
  }

  void read_poses(const json& root) {
    const json* found = find(root, "poses");
    if (!found) return;
    object(*found, "/poses");
    for (const auto& [name, pose] : found->items()) {
      std::string where = "/poses/" + name;
      for (const auto& [field, value] : object(pose, where).items()) {
        if (std::find(std::begin(arm_fields), std::end(arm_fields), field) == std::end(arm_fields))
          fail(where + "/" + field, "no such angle of an arm is known");
        poses[name][field] = degrees(value, where + "/" + field);
      }
    }
  }

  // Reads the channels that this key names over those of the key before.
  void read_arm(const json& arm, const std::string& where, const std::string& side, GestureRow& row,
                std::vector<bool>& said) const {
    auto set = [&](const std::string& field, float value) {
      size_t channel = channel_of(side + "." + field);
      row[channel] = value;
      said[channel] = true;
    };
    for (const auto& [field, value] : object(arm, where).items()) {
      if (field != "pose") continue;
      auto pose = value.is_string() ? poses.find(value.get<std::string>()) : poses.end();
      if (pose == poses.end()) fail(where + "/pose", "no pose of this name in /poses");
      for (const char* angle : arm_fields) {  // a pose sets the whole arm
        auto given = pose->second.find(angle);
        set(angle, given == pose->second.end() ? 0 : given->second);
      }
    }
    for (const auto& [field, value] : arm.items()) {
      std::string place = where + "/" + field;
      if (field == "pose") continue;
      if (find_gesture_channel(side + "." + field) < 0)
        fail(place, "no such angle of an arm is known");
      set(field, field == "weight" ? number(value, place, 0, 1) : degrees(value, place));
    }
  }

  void read_trunk(const json& part, const std::string& where, const std::string& prefix,
                  GestureRow& row, std::vector<bool>& said) const {
    for (const auto& [field, value] : object(part, where).items()) {
      int channel = find_gesture_channel(prefix + "." + field);
      if (channel < 0) fail(where + "/" + field, "no such angle is known");
      row[size_t(channel)] = degrees(value, where + "/" + field);
      said[size_t(channel)] = true;
    }
  }

  void read_keys(const json& entry, const std::string& where, GestureClip& clip) const {
    const json& keys = list(entry, where, "keys", most_gesture_keys);
    if (keys.size() < 2) fail(where + "/keys", "two keys at least are expected");
    std::vector<bool> ever(gesture_channels, false);
    for (size_t k = 0; k < keys.size(); k++) {
      std::string place = where + "/keys/" + std::to_string(k);
      const json& key = object(keys[k], place);
      only(key, place, {"time", "left", "right", "head", "chest", "shoulders"});
      float time = number(key, place, "time", -1, 0, double(longest_gesture));
      if (time < 0) fail(place + "/time", "is missing");
      if (k == 0 ? time != 0 : !(time > clip.times.back() + 1e-3f))
        fail(place + "/time", k == 0 ? "the first key is at 0" : "is not after the key before");
      GestureRow row{};
      if (k > 0) row = clip.rows.back();
      std::vector<bool> said(gesture_channels, false);
      if (const json* arm = find(key, "left")) read_arm(*arm, place + "/left", "left", row, said);
      if (const json* arm = find(key, "right"))
        read_arm(*arm, place + "/right", "right", row, said);
      if (const json* part = find(key, "head"))
        read_trunk(*part, place + "/head", "head", row, said);
      if (const json* part = find(key, "chest"))
        read_trunk(*part, place + "/chest", "chest", row, said);
      if (const json* value = find(key, "shoulders")) {
        row[channel_of("shoulders")] = degrees(*value, place + "/shoulders");
        said[channel_of("shoulders")] = true;
      }
      // An arm's angle that is named here first was the same from the beginning: it is not seen
      // while the arm has no weight.
      for (size_t c = 0; c < channel_of("left.weight"); c++)
        if (said[c] && !ever[c]) {
          ever[c] = true;
          for (GestureRow& earlier : clip.rows) earlier[c] = row[c];
        }
      clip.times.push_back(time);
      clip.rows.push_back(row);
    }
    clip.seconds = clip.times.back();
    for (size_t c = channel_of("left.weight"); c < told_channels; c++)
      if (clip.rows.front()[c] != 0 || clip.rows.back()[c] != 0)
        fail(where + "/keys",
             "a gesture begins and ends at rest: weights, head, chest and shoulders 0");
  }

  void read_swings(const json& entry, const std::string& where, GestureClip& clip) const {
    const json& swings = list(entry, where, "swings", 32);
    for (size_t i = 0; i < swings.size(); i++) {
      std::string place = where + "/swings/" + std::to_string(i);
      const json& given = object(swings[i], place);
      only(given, place, {"channel", "degrees", "hertz", "from", "to", "phase"});
      Swing swing;
      const json* channel = find(given, "channel");
      swing.channel =
          channel && channel->is_string() ? find_gesture_channel(channel->get<std::string>()) : -1;
      if (swing.channel < 0 || is_weight(size_t(swing.channel)))
        fail(place + "/channel", "no such channel is known");
      const json* angle = find(given, "degrees");
      if (!angle) fail(place + "/degrees", "is missing");
      swing.amplitude = degrees(*angle, place + "/degrees");
      swing.hertz = number(given, place, "hertz", 1, 0, 10);
      swing.from = number(given, place, "from", 0, 0, double(clip.seconds));
      swing.to = number(given, place, "to", double(clip.seconds), 0, double(clip.seconds));
      swing.phase = number(given, place, "phase", 0, -1, 1);
      if (!(swing.to > swing.from)) fail(place + "/to", "is not after \"from\"");
      clip.swings.push_back(swing);
    }
  }
};

// Makes monotone slopes (Fritsch, Carlson 1980; weights of Brodlie): no value between two keys
// leaves the range of the two, and a motion does not stop at a key that it passes.
void make_slopes(GestureClip& clip) {
  clip.slopes.assign(clip.rows.size(), GestureRow{});
  for (size_t i = 1; i + 1 < clip.rows.size(); i++)
    for (size_t c = 0; c < gesture_channels; c++) {
      float h0 = clip.times[i] - clip.times[i - 1], h1 = clip.times[i + 1] - clip.times[i];
      float d0 = (clip.rows[i][c] - clip.rows[i - 1][c]) / h0;
      float d1 = (clip.rows[i + 1][c] - clip.rows[i][c]) / h1;
      if (d0 * d1 <= 0) continue;
      float a = 2 * h1 + h0, b = h1 + 2 * h0;
      clip.slopes[i][c] = (a + b) / (a / d0 + b / d1);
    }
}

GestureClip mirror(const GestureClip& clip) {
  GestureClip mirrored = clip;
  size_t arm = channel_of("right.forward"), weight = channel_of("left.weight");
  auto swap_row = [&](GestureRow& row) {
    for (size_t i = 0; i < arm; i++) std::swap(row[i], row[arm + i]);
    std::swap(row[weight], row[weight + 1]);
    for (const char* name : {"head.turn", "head.tilt", "chest.turn", "chest.lean"})
      row[channel_of(name)] = -row[channel_of(name)];
  };
  for (GestureRow& row : mirrored.rows) swap_row(row);
  for (Swing& swing : mirrored.swings) {
    size_t c = size_t(swing.channel);
    GestureRow row{};
    row[c] = swing.amplitude;
    swap_row(row);
    for (size_t i = 0; i < gesture_channels; i++)
      if (row[i] != 0) swing.channel = int(i), swing.amplitude = row[i];
  }
  return mirrored;
}

void finish(GestureClip& clip) {
  make_slopes(clip);
  for (size_t s = 0; s < 2; s++) {
    size_t weight = channel_of(s == 0 ? "left.weight" : "right.weight");
    clip.uses_arm[s] = std::any_of(clip.rows.begin(), clip.rows.end(),
                                   [&](const GestureRow& row) { return row[weight] > 0; });
  }
}

constexpr const char* aim_names[] = {"none", "finger", "palm"};

}  // namespace

GestureLibrary read_gestures(std::string_view text, const std::string& file) {
  Reader reader{{file}, {}};
  json root = reader.parse(text, "wellspring-gestures");
  reader.only(root, "", {"format", "version", "about", "poses", "gestures"});
  reader.read_poses(root);
  GestureLibrary library;
  const json& list = reader.list(root, "", "gestures", most_gestures);
  for (size_t i = 0; i < list.size(); i++) {
    std::string where = "/gestures/" + std::to_string(i);
    const json& entry = reader.object(list[i], where);
    GestureClip clip;
    std::string name = reader.name(entry, where);
    if (find_gesture(library, name) >= 0) reader.fail(where + "/name", "is there twice: " + name);
    if (reader.find(entry, "mirror_of")) {
      reader.only(entry, where, {"name", "about", "mirror_of"});
      int of = find_gesture(library, reader.name(entry, where, "mirror_of"));
      if (of < 0) reader.fail(where + "/mirror_of", "no gesture of this name before this one");
      clip = mirror(library.clips[size_t(of)]);
    } else {
      reader.only(entry, where, {"name", "about", "stroke", "hold", "aim", "keys", "swings"});
      reader.read_keys(entry, where, clip);
      clip.stroke = reader.number(entry, where, "stroke", 0.5 * double(clip.seconds), 0,
                                  double(clip.seconds));
      clip.hold = reader.number(entry, where, "hold", -1, 0, double(clip.seconds));
      reader.read_swings(entry, where, clip);
      if (const json* aim = reader.find(entry, "aim")) {
        auto known = std::find(std::begin(aim_names), std::end(aim_names), *aim);
        if (known == std::end(aim_names))
          reader.fail(where + "/aim", "none, finger or palm is expected");
        clip.aim = Aim(known - std::begin(aim_names));
      }
    }
    clip.name = name;
    if (const json* about = reader.find(entry, "about"); about && about->is_string())
      clip.about = about->get<std::string>();
    finish(clip);
    library.clips.push_back(std::move(clip));
  }
  return library;
}

GestureLibrary load_gestures(const std::string& file) {
  return read_gestures(read_file(file, most_library_bytes), file);
}

}  // namespace wellspring::avatar
