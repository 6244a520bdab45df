// SPDX-License-Identifier: Apache-2.0
// Reads the JSON of a gesture library.
#include <algorithm>
#include <map>
#include <span>

#include "avatar/body/gesture.h"
#include "avatar/face/library_json.h"
#include "base/read_file.h"

namespace wellspring::avatar {
namespace {

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

Poses read_poses(FieldReader& root) {
  Poses poses;
  root.part("poses", "", [&](FieldReader& all) {
    for (const auto& [name, pose] : all.members())
      all.read_object(pose, [&, &angles = poses[name]](FieldReader& fields) {
        for (const char* field : arm_fields) fields.degrees(field, -360, 360, angles[field]);
      });
  });
  return poses;
}

struct KeyReader {
  const Poses& poses;
  GestureRow& row;
  std::vector<bool>& said;

  void set(const std::string& name, float value) const {
    row[channel_of(name)] = value;
    said[channel_of(name)] = true;
  }
  // Reads the angles that a part of the body names over those of the key before.
  void read_angles(FieldReader& part, const std::string& prefix,
                   std::span<const char* const> fields) const {
    float angle = 0;
    for (const char* field : fields)
      if (part.degrees(field, -360, 360, angle)) set(prefix + "." + field, angle);
  }
  void read_arm(FieldReader& arm, const std::string& side) const {
    std::string name;
    float weight = 0;
    if (arm.text("pose", name)) {
      const auto pose = poses.find(name);
      if (pose == poses.end()) arm.fail("pose", "no pose of this name in /poses");
      for (const auto& [angle, value] : pose->second) set(side + "." + angle, value);
    }
    read_angles(arm, side, arm_fields);
    if (arm.number("weight", 0, 1, weight)) set(side + ".weight", weight);
  }
  void read(FieldReader& key) const {
    float angle = 0;
    for (const char* side : {"left", "right"})
      key.part(side, "", [&](FieldReader& arm) { read_arm(arm, side); });
    key.part("head", "", [&](FieldReader& part) { read_angles(part, "head", head_fields); });
    key.part("chest", "", [&](FieldReader& part) { read_angles(part, "chest", chest_fields); });
    if (key.degrees("shoulders", -360, 360, angle)) set("shoulders", angle);
  }
};

void read_keys(FieldReader& entry, const Poses& poses, GestureClip& clip) {
  std::vector<bool> ever(gesture_channels, false);
  const auto read_key = [&](FieldReader& key) {
    float time = 0;
    key.number("time", 0, double(longest_gesture), time, "", Need::required);
    const bool first = clip.times.empty();
    if (first ? time != 0 : !(time > clip.times.back() + 1e-3f))
      key.fail("time", first ? "the first key is at 0" : "is not after the key before");
    GestureRow row = first ? GestureRow{} : clip.rows.back();
    std::vector<bool> said(gesture_channels, false);
    KeyReader{poses, row, said}.read(key);
    // An arm's angle that is named here first was the same from the beginning: it is not seen
    // while the arm has no weight.
    for (size_t c = 0; c < channel_of("left.weight"); c++)
      if (said[c] && !ever[c]) {
        ever[c] = true;
        for (GestureRow& earlier : clip.rows) earlier[c] = row[c];
      }
    clip.times.push_back(time);
    clip.rows.push_back(row);
  };
  for (const JsonValue& key :
       entry.list("keys", 2, most_gesture_keys, "two keys at least", Need::required))
    entry.read_object(key, read_key);
  clip.seconds = clip.times.back();
  for (size_t c = channel_of("left.weight"); c < told_channels; c++)
    if (clip.rows.front()[c] != 0 || clip.rows.back()[c] != 0)
      entry.fail("keys", "a gesture begins and ends at rest: weights, head, chest and shoulders 0");
}

void read_swing(FieldReader& fields, GestureClip& clip) {
  Swing swing;
  std::string channel;
  fields.text("channel", channel, "", Need::required);
  swing.channel = find_gesture_channel(channel);
  if (swing.channel < 0 || is_weight(size_t(swing.channel)))
    fields.fail("channel", "no such channel is known");
  swing.hertz = 1;
  swing.from = swing.phase = 0;
  swing.to = clip.seconds;
  fields.degrees("degrees", -360, 360, swing.amplitude, "", Need::required);
  fields.number("hertz", 0, 10, swing.hertz);
  fields.number("from", 0, double(clip.seconds), swing.from);
  fields.number("to", 0, double(clip.seconds), swing.to);
  fields.number("phase", -1, 1, swing.phase);
  if (!(swing.to > swing.from)) fields.fail("to", "is not after \"from\"");
  clip.swings.push_back(swing);
}

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

void read_clip(FieldReader& entry, const Poses& poses, GestureClip& clip) {
  read_keys(entry, poses, clip);
  clip.stroke = float(0.5 * double(clip.seconds));
  clip.hold = -1;
  entry.number("stroke", 0, double(clip.seconds), clip.stroke);
  entry.number("hold", 0, double(clip.seconds), clip.hold);
  entry.parts("swings", 32, "", [&](FieldReader& swing) { read_swing(swing, clip); });
  entry.choice("aim", {"none", "finger", "palm"}, clip.aim, "");
}

}  // namespace

GestureLibrary read_gestures(std::string_view text, const std::string& file) {
  const nlohmann::json parsed = parse_json_file(file, text, true);
  Faults faults(file, true);
  FieldReader root(parsed, faults);
  read_library_head(root, "wellspring-gestures");
  const Poses poses = read_poses(root);
  GestureLibrary library;
  root.parts("gestures", most_gestures, "", [&](FieldReader& entry) {
    GestureClip clip;
    std::string name, mirrored;
    entry.name("name", name, "", Need::required);
    if (find_gesture(library, name) >= 0) entry.fail("name", "is there twice: " + name);
    if (entry.name("mirror_of", mirrored, "")) {
      const int index = find_gesture(library, mirrored);
      if (index < 0) entry.fail("mirror_of", "no gesture of this name before this one");
      clip = mirror(library.clips[size_t(index)]);
    } else {
      read_clip(entry, poses, clip);
    }
    clip.name = name;
    entry.text("about", clip.about, "", Need::optional, 4000);
    finish(clip);
    library.clips.push_back(std::move(clip));
  });
  root.finish();
  return library;
}

GestureLibrary load_gestures(const std::string& file) {
  return read_gestures(read_json_text(file), file);
}

}  // namespace wellspring::avatar
