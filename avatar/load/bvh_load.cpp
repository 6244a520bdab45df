// SPDX-License-Identifier: Apache-2.0
#include "avatar/load/bvh_load.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <unordered_set>

#include "avatar/figure/bone_names.h"
#include "avatar/figure/figure_check.h"
#include "avatar/figure/hanim_names.h"
#include "base/load_error.h"

namespace wellspring::avatar {
namespace {

constexpr size_t most_joints = 4096, depth_limit = 512;

enum class Channel : uint8_t {
  x_position,
  y_position,
  z_position,
  x_rotation,
  y_rotation,
  z_rotation
};

struct BvhJoint {
  std::string name;
  int parent = -1;
  vec3 offset{0};
  std::vector<Channel> channels;
};

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = char(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

struct BvhReader {
  const std::string& path;
  std::string_view text;
  size_t at = 0;
  int line = 1;
  std::vector<BvhJoint> joints;
  std::vector<std::pair<int, vec3>> ends;  // joints, and where their last bones end
  std::vector<std::string> warnings;
  size_t channels = 0;

  [[noreturn]] void fail(const std::string& what) const {
    throw LoadError(path, "line " + std::to_string(line), what);
  }
  static bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f' || c == '\v';
  }
  void skip_blank() {
    for (; at < text.size() && is_blank(text[at]); at++) line += text[at] == '\n';
  }
  std::string_view word() {
    skip_blank();
    size_t begin = at;
    if (at < text.size() && (text[at] == '{' || text[at] == '}')) return text.substr(at++, 1);
    while (at < text.size() && !is_blank(text[at]) && text[at] != '{' && text[at] != '}') at++;
    return text.substr(begin, at - begin);
  }
  std::string_view peek() {
    size_t keep = at;
    int keep_line = line;
    std::string_view next = word();
    at = keep, line = keep_line;
    return next;
  }
  void expect(const char* wanted) {
    std::string_view got = word();
    if (lower(got) != wanted)
      fail("expected " + std::string(wanted) + ", found '" + std::string(got.substr(0, 40)) + "'");
  }
  // Returns the rest of the line: names may have blanks in them.
  std::string name() {
    size_t end = std::min(text.find_first_of("\n{", at), text.size());
    std::string_view rest = text.substr(at, end - at);
    at = end;
    while (!rest.empty() && is_blank(rest.front())) rest.remove_prefix(1);
    while (!rest.empty() && is_blank(rest.back())) rest.remove_suffix(1);
    return std::string(rest.substr(0, 200));
  }
  double number(const char* of) {
    std::string_view w = word();
    if (w.empty()) fail(std::string("the file ends before ") + of);
    std::string_view digits = w[0] == '+' ? w.substr(1) : w;
    double value = 0;
    auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error == std::errc::result_out_of_range) return 0;
    if (error != std::errc() || end != digits.data() + digits.size())
      fail("'" + std::string(w.substr(0, 40)) + "' is no number (" + of + ")");
    if (!std::isfinite(value) || std::abs(value) > 1e9)
      fail(std::string(of) + " is beyond all reason");
    return value;
  }
  vec3 offset() {
    expect("offset");
    vec3 v;
    for (int i = 0; i < 3; i++) v[i] = float(number("an offset"));
    return v;
  }

  void read_channels(BvhJoint& joint) {
    double count = number("the number of channels");
    if (count < 0 || count > 100 || count != std::floor(count))
      fail("a joint cannot have that many channels");
    for (int i = 0; i < int(count); i++) {
      std::string channel = lower(word());
      constexpr const char* names[] = {"xposition", "yposition", "zposition",
                                       "xrotation", "yrotation", "zrotation"};
      size_t which = 0;
      while (which < 6 && channel != names[which]) which++;
      if (which == 6) fail("unknown channel '" + channel.substr(0, 40) + "'");
      joint.channels.push_back(Channel(which));
    }
    channels += joint.channels.size();
  }

  void read_hierarchy() {
    expect("hierarchy");
    expect("root");
    std::vector<int> open;
    add_joint(open);
    while (!open.empty()) {
      std::string key = lower(word());
      if (key == "joint") {
        add_joint(open);
      } else if (key == "end") {
        name();  // "Site", or whatever else is written there
        expect("{");
        ends.push_back({open.back(), offset()});
        while (lower(peek()) == "channels") {
          word();
          BvhJoint nothing;
          read_channels(nothing);
          if (!nothing.channels.empty()) fail("an end site with channels");
        }
        expect("}");
      } else if (key == "channels") {
        if (!joints[size_t(open.back())].channels.empty())
          fail("a joint with two lists of channels");
        read_channels(joints[size_t(open.back())]);
      } else if (key == "}") {
        open.pop_back();
      } else if (key.empty()) {
        fail("the file ends within the hierarchy");
      } else {
        fail("expected JOINT, End Site, CHANNELS or }, found '" + key.substr(0, 40) + "'");
      }
    }
    if (lower(peek()) == "root") {
      word();
      fail("a second root: one figure a file");
    }
  }

  void add_joint(std::vector<int>& open) {
    if (joints.size() >= most_joints) fail("more than " + std::to_string(most_joints) + " joints");
    if (open.size() >= depth_limit)
      fail("joints are nested deeper than " + std::to_string(depth_limit));
    BvhJoint joint;
    joint.name = name();
    if (joint.name.empty()) joint.name = "joint " + std::to_string(joints.size());
    joint.parent = open.empty() ? -1 : open.back();
    expect("{");
    joint.offset = offset();
    open.push_back(int(joints.size()));
    joints.push_back(std::move(joint));
  }

  struct Frames {
    size_t count = 0;
    double seconds = 0;  // length of a frame
    std::vector<float> values;
  };
  Frames read_motion() {
    Frames frames;
    if (peek().empty()) {
      warnings.push_back("the file has no motion");
      return frames;
    }
    expect("motion");
    auto label = [&](const char* wanted) {  // "Frames:", "Frames :", "Frame Time:0.01"
      for (const char* p = wanted; *p; p++) {
        skip_blank();
        if (at >= text.size() || std::tolower(static_cast<unsigned char>(text[at])) != *p)
          fail("expected 'Frames:' and 'Frame Time:'");
        at++;
      }
    };
    label("frames:");
    double count = number("the number of frames");
    if (count < 0 || count != std::floor(count)) fail("the number of frames is none");
    label("frametime:");
    frames.seconds = number("the time of a frame");
    if (!(frames.seconds > 1e-5) || frames.seconds > 100) {
      warnings.push_back("the time of a frame is no time: taken as 1/30 s");
      frames.seconds = 1.0 / 30;
    }
    frames.count = size_t(count);
    // Room is made as numbers come: the file may promise more than it has.
    for (size_t f = 0; f < frames.count; f++)
      for (size_t c = 0; c < channels; c++) {
        if (peek().empty())
          fail("the motion ends in frame " + std::to_string(f) + " of " +
               std::to_string(frames.count));
        frames.values.push_back(float(number("a value of the motion")));
      }
    if (!peek().empty()) warnings.push_back("numbers behind the last frame are ignored");
    if (channels == 0) frames.count = 0;
    return frames;
  }
};

quat turn_of(Channel channel, float degrees) {
  vec3 axis(0);
  axis[int(channel) - int(Channel::x_rotation)] = 1;
  return glm::angleAxis(degrees * pi / 180, axis);
}

// Takes offsets from the first frame if all OFFSETs are zero: some programs write where a joint is
// into the motion alone.
void take_missing_offsets(BvhReader& reader, const BvhReader::Frames& frames) {
  auto& joints = reader.joints;
  auto has_length = [](const BvhJoint& joint) { return joint.offset != vec3(0); };
  if (joints.size() < 2 || std::any_of(joints.begin() + 1, joints.end(), has_length)) return;
  size_t value = 0;
  for (size_t j = 0; j < joints.size(); j++)
    for (Channel channel : joints[j].channels) {
      const size_t at = value++;
      if (j > 0 && channel < Channel::x_rotation && frames.count > 0)
        joints[j].offset[int(channel)] = frames.values[at];
    }
  const bool found = std::any_of(joints.begin() + 1, joints.end(), has_length);
  reader.warnings.push_back(
      found ? "all OFFSETs are zero: bones are as long as the first frame has them"
            : "all OFFSETs are zero, and no frame says where a joint is: the skeleton has no size");
}

// Returns metres a unit of the file: people are between 1 and 2.5 m tall.
float unit_of(float height, std::vector<std::string>& warnings) {
  if (!(height > 1e-6f)) return 1;
  for (float unit : {1.0f, 0.01f, 0.0254f, 0.001f, 0.056444f})  // m, cm, inch, mm, CMU's database
    if (height * unit > 1.0f && height * unit < 2.3f) return unit;
  warnings.push_back("the skeleton is as tall as nobody in any unit: taken as 1.70 m");
  return 1.7f / height;
}

}  // namespace

bool is_bvh(const std::string& text) {
  size_t start = text.compare(0, 3, "\xef\xbb\xbf") == 0 ? 3 : 0;
  start = text.find_first_not_of(" \t\r\n", start);
  return start != std::string::npos &&
         lower(std::string_view(text).substr(start, 9)) == "hierarchy";
}

Character character_from_bvh(const std::string& path, const std::string& text) {
  BvhReader reader{path, text};
  if (text.compare(0, 3, "\xef\xbb\xbf") == 0) reader.at = 3;
  reader.read_hierarchy();
  BvhReader::Frames frames = reader.read_motion();
  take_missing_offsets(reader, frames);

  std::vector<Bone> bones;
  std::vector<vec3> places;
  for (const BvhJoint& joint : reader.joints) {
    vec3 place = joint.parent < 0 ? joint.offset : places[size_t(joint.parent)] + joint.offset;
    bones.push_back({joint.name, joint.parent, place});
    places.push_back(place);
  }
  BoneNames named = name_bones(bones);
  quat turn = upright_turn(named.joints, places);
  vec3 low(INFINITY), high(-INFINITY);
  auto reach = [&](vec3 p) { low = glm::min(low, turn * p), high = glm::max(high, turn * p); };
  for (vec3 place : places) reach(place);
  for (auto [joint, offset] : reader.ends) reach(places[size_t(joint)] + offset);
  float unit = unit_of(high.y - low.y, reader.warnings);

  Character character;
  character.name = std::filesystem::path(path).stem().string();
  character.first_weight = {0};
  vec3 root = turn * places[0];
  vec3 shift(-root.x, -low.y, -root.z);
  std::unordered_set<std::string> taken(named.joints.begin(), named.joints.end());
  Motion motion;
  motion.name = character.name;
  motion.loop = true;
  size_t unknown = 0;
  for (size_t j = 0; j < bones.size(); j++) {
    std::string name = named.joints[j];
    if (name.empty()) {
      unknown++;
      name = bones[j].name;
      while (!taken.insert(name).second) name += "_" + std::to_string(j);
    }
    Joint joint;
    joint.name = name;
    joint.parent = bones[j].parent;
    joint.center = (turn * places[j] + shift) * unit;
    character.joints.push_back(joint);
    motion.joints.push_back({name, joint.parent, joint.center});
  }
  if (named.by_shape)
    reader.warnings.push_back("bones without telling names are joints by their place");
  if (unknown) reader.warnings.push_back(std::to_string(unknown) + " joints are none of H-Anim");

  std::vector<float> times;
  for (size_t f = 0; f < frames.count; f++) times.push_back(float(double(f) * frames.seconds));
  if (!times.empty()) motion.duration = times.back();
  size_t first = 0;
  for (size_t j = 0; j < reader.joints.size() && frames.count > 0; j++) {
    const BvhJoint& joint = reader.joints[j];
    MotionTrack turns{TrackKind::rotation, TrackCurve::linear, int(j), times, {}, {}};
    MotionTrack ways{TrackKind::translation, TrackCurve::linear, int(j), times, {}, {}};
    bool turns_any = false, moves_any = false;
    quat before(1, 0, 0, 0);
    for (size_t f = 0; f < frames.count; f++) {
      quat q(1, 0, 0, 0);
      vec3 place = joint.offset;  // a position takes the offset's place
      const float* value = frames.values.data() + f * reader.channels + first;
      for (Channel channel : joint.channels) {
        if (channel < Channel::x_rotation) place[int(channel)] = *value, moves_any = true;
        else q = q * turn_of(channel, *value), turns_any = true;
        value++;
      }
      q = turn * q * glm::conjugate(turn);
      if (dot(q, before) < 0) q = -q;
      before = q;
      turns.values.insert(turns.values.end(), {q.x, q.y, q.z, q.w});
      vec3 way = j == 0 ? (turn * place) * unit - character.joints[0].center
                        : turn * (place - joint.offset) * unit;
      ways.values.insert(ways.values.end(), {way.x, way.y, way.z});
    }
    first += joint.channels.size();
    if (turns_any) motion.tracks.push_back(std::move(turns));
    if (moves_any) motion.tracks.push_back(std::move(ways));
  }
  if (!motion.tracks.empty()) character.motions.push_back(std::move(motion));
  character.warnings = std::move(reader.warnings);
  std::vector<std::string_view> names;
  for (const Joint& joint : character.joints) names.push_back(joint.name);
  character.loa = level_of_articulation(names);
  check_figure(character);
  return character;
}

}  // namespace wellspring::avatar
