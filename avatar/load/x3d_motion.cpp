// SPDX-License-Identifier: Apache-2.0
#include "avatar/load/x3d_motion.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>
#include <tuple>
#include <unordered_map>

#include "avatar/figure/hanim_names.h"
#include "base/load_error.h"

namespace wellspring::avatar {
namespace {

// Maps turns and ways from the humanoid's own coordinates to humanoid space.
struct Turner {
  mat3 linear{1};
  quat turn{1, 0, 0, 0};
  explicit Turner(const mat4& root) : linear(root) {
    vec3 x = linear[0], y = linear[1];
    float lx = glm::length(x), ly = glm::length(y);
    if (!(lx > 1e-12f) || !(ly > 1e-12f)) return;
    x /= lx;
    y = y / ly - x * dot(x, y / ly);
    if (!(glm::length(y) > 1e-6f)) return;
    y = glm::normalize(y);
    turn = glm::normalize(glm::quat_cast(mat3(x, y, cross(x, y))));
  }
  quat operator()(quat q) const { return turn * q * glm::conjugate(turn); }
  vec3 operator()(vec3 v) const { return linear * v; }
};

std::vector<MotionJoint> skeleton_of(const Character& character) {
  std::vector<MotionJoint> joints;
  for (const Joint& joint : character.joints)
    joints.push_back({joint.name, joint.parent, joint.center});
  return joints;
}

void append(std::vector<float>& values, quat q) {
  values.insert(values.end(), {q.x, q.y, q.z, q.w});
}
void append(std::vector<float>& values, vec3 v) { values.insert(values.end(), {v.x, v.y, v.z}); }

std::vector<std::string> words_of(std::string text) {
  for (char& c : text)
    if (c == ',' || c == '"') c = ' ';
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word && words.size() < 100'000;) words.push_back(word);
  return words;
}

int find_named_joint(const Character& character, const std::string& written) {
  std::string name = hanim_joint_name(written);
  int joint = name.empty() ? -1 : find_joint(character, name);
  return joint >= 0 ? joint : find_joint(character, written);
}

// Returns whether a recording says where the root is, not how far it has gone from rest: no root is
// on average half its own height above itself.
bool gives_places(const std::vector<float>& heights, float rest_height) {
  double mean = 0;
  for (float h : heights) mean += double(h) / double(heights.size());
  return rest_height > 0.1f && mean > 0.5 * double(rest_height);
}

// Returns the lowest joint of the whole motion, sampled.
float lowest_joint(const Motion& motion) {
  float low = INFINITY;
  MotionPose pose;
  std::vector<vec3> place(motion.joints.size());
  std::vector<quat> turned(motion.joints.size());
  for (int s = 0; s < 64; s++) {
    eval_motion(motion, double(motion.duration) * s / 63, false, pose);
    for (size_t j = 0; j < motion.joints.size(); j++) {
      const MotionJoint& joint = motion.joints[j];
      vec3 rest = joint.center + pose.translations[j];
      if (joint.parent >= 0) {
        size_t p = size_t(joint.parent);
        place[j] = place[p] + turned[p] * (rest - motion.joints[p].center);
        turned[j] = turned[p] * pose.rotations[j];
      } else {
        place[j] = rest, turned[j] = pose.rotations[j];
      }
      if (std::isfinite(place[j].y)) low = std::min(low, place[j].y);
    }
  }
  return std::isfinite(low) ? low : 0;
}

void read_hanim_motion(HumanoidReader& reader, const X3dNode& node, const Turner& turner) {
  X3dFile& file = reader.file;
  Character& character = reader.character;
  std::string name = string_of(node, "name");
  Motion motion;
  motion.name = name.empty() ? node.def : name;
  motion.joints = skeleton_of(character);
  motion.loop = bool_of(node, "loop", false);
  auto done = [&] { character.motions.push_back(std::move(motion)); };

  struct Group {
    int joint = -1;
    std::vector<std::string> channels;
  };
  std::vector<Group> groups;
  size_t width = 0;
  std::vector<std::string> words = words_of(string_of(node, "channels"));
  for (size_t i = 0; i < words.size();) {
    char* end = nullptr;
    long count = std::strtol(words[i++].c_str(), &end, 10);
    if (*end || count < 0 || size_t(count) > words.size() - i) {
      warn_once(file.warnings,
                where(node) + ": channels are no counted lists of names: not played");
      return done();
    }
    Group group;
    for (long k = 0; k < count; k++) group.channels.push_back(words[i++]);
    width += group.channels.size();
    groups.push_back(std::move(group));
  }
  std::vector<std::string> joints = words_of(string_of(node, "joints"));
  if (joints.size() != groups.size())
    warn_once(file.warnings, where(node) + ": " + std::to_string(joints.size()) +
                                 " joints but channels of " + std::to_string(groups.size()));
  for (size_t g = 0; g < std::min(groups.size(), joints.size()); g++) {
    if (joints[g] == "IGNORED") continue;
    groups[g].joint = find_named_joint(character, joints[g]);
    if (groups[g].joint < 0)
      warn_once(file.warnings,
                where(node) + ": moves '" + joints[g].substr(0, 60) + "', which the figure lacks");
  }
  std::vector<float> values = floats_of(file, node, "values");
  if (width == 0 || values.size() < width) {
    if (!values.empty() || width > 0)
      warn_once(file.warnings, where(node) + ": no whole frame to play");
    return done();
  }
  size_t frames = values.size() / width;
  if (values.size() % width)
    warn_once(file.warnings, where(node) + ": the last frame is not whole and left out");
  size_t first = 0, last = frames - 1;
  std::vector<int> start = ints_of(file, node, "startFrame"),
                   stop = ints_of(file, node, "endFrame");
  if (!start.empty() && start[0] > 0) first = std::min(size_t(start[0]), frames - 1);
  if (!stop.empty() && stop[0] > int(first)) last = std::min(size_t(stop[0]), frames - 1);
  float step = float_of(file, node, "frameDuration", 0.1f);
  if (!(step > 1e-5f && step < 100)) step = 0.1f;
  std::vector<float> times;
  for (size_t f = first; f <= last; f++) times.push_back(float(f - first) * step);
  motion.duration = times.back();

  std::vector<std::string> enabled = words_of(string_of(node, "channelsEnabled"));
  auto is_on = [&](size_t channel) {
    return channel >= enabled.size() ||
           (enabled[channel] != "false" && enabled[channel] != "FALSE");
  };
  size_t column = 0;
  for (const Group& group : groups) {
    size_t own = column;
    column += group.channels.size();
    if (group.joint < 0) continue;
    MotionTrack turns{TrackKind::rotation, TrackCurve::linear, group.joint, times, {}, {}};
    MotionTrack ways{TrackKind::translation, TrackCurve::linear, group.joint, times, {}, {}};
    bool any_turn = false, any_way = false, unknown = false;
    std::vector<float> heights;
    for (size_t f = first; f <= last; f++) {
      quat q(1, 0, 0, 0);
      vec3 way(0);
      for (size_t k = 0; k < group.channels.size(); k++) {
        const std::string& channel = group.channels[k];
        float value = values[f * width + own + k];
        int axis = channel.empty() ? -1 : (channel[0] | 32) - 'x';
        bool position = channel.size() > 1 && channel.find("osition") != std::string::npos;
        bool rotation = channel.find("otation") != std::string::npos;
        if (axis < 0 || axis > 2 || !(position || rotation)) {
          unknown = true;
          continue;
        }
        if (!is_on(own + k)) continue;
        vec3 unit(0);
        unit[axis] = 1;
        if (rotation) q = q * glm::angleAxis(value * pi / 180, unit), any_turn = true;
        else way[axis] = value, any_way = true;
      }
      append(turns.values, turner(q));
      append(ways.values, turner(way));
      heights.push_back(turner(way).y);
    }
    if (unknown) warn_once(file.warnings, where(node) + ": channels of unknown kind are left out");
    if (any_turn) motion.tracks.push_back(std::move(turns));
    if (!any_way) continue;
    const Joint& joint = character.joints[size_t(group.joint)];
    float low = INFINITY;
    for (const Joint& other : character.joints) low = std::min(low, other.center.y);
    bool places = joint.parent < 0 && gives_places(heights, joint.center.y - low);
    if (places)
      for (size_t i = 0; i < ways.values.size(); i++) ways.values[i] -= joint.center[int(i % 3)];
    motion.tracks.push_back(std::move(ways));
    if (!places) continue;
    warn_once(file.warnings,
              where(node) + ": gives the root's place: its feet are put on the floor");
    size_t root_track = motion.tracks.size() - 1;
    std::swap(motion.tracks[root_track], motion.tracks[0]);
  }
  if (!motion.tracks.empty() && motion.tracks[0].kind == TrackKind::translation) {
    float low = INFINITY;
    for (const Joint& joint : character.joints) low = std::min(low, joint.center.y);
    float lift = low - lowest_joint(motion);
    for (size_t i = 1; i < motion.tracks[0].values.size(); i += 3)
      motion.tracks[0].values[i] += lift;
  }
  done();
}

// Follows TimeSensor -> interpolator -> joint.
struct Router {
  HumanoidReader& reader;
  const Turner& turner;
  int humanoid;
  std::unordered_map<std::string, int> by_def;
  std::unordered_map<int, int> joint_of;  // node -> joint
  std::unordered_map<int, std::vector<const X3dRoute*>> from;
  std::set<const X3dRoute*> followed;
  size_t looked_at = 0, numbers = 0;
  static constexpr size_t most_links = 200'000, most_numbers = 16'000'000;

  Router(HumanoidReader& of, const Turner& turns, int node)
      : reader(of), turner(turns), humanoid(node) {
    for (size_t i = 0; i < of.file.nodes.size(); i++)
      if (!of.file.nodes[i].def.empty()) by_def[of.file.nodes[i].def] = int(i);
    for (size_t j = 0; j < of.joint_node.size(); j++) joint_of[of.joint_node[j]] = int(j);
    for (const X3dRoute& route : of.file.routes)
      if (auto found = by_def.find(route.from_node); found != by_def.end())
        from[found->second].push_back(&route);
  }
  static bool is_field(const std::string& written, const char* field) {
    return written == field || written == std::string("set_") + field ||
           written == std::string(field) + "_changed";
  }

  void follow(int sensor) {
    X3dFile& file = reader.file;
    const X3dNode& timer = file.nodes[size_t(sensor)];
    Motion motion;
    motion.name = timer.def;
    std::set<int> curves;  // a ROUTE may be written twice
    std::set<std::tuple<int, int, std::string>> led;
    float cycle = float_of(file, timer, "cycleInterval", 1);
    if (!(cycle > 1e-3f && cycle < 1e6f)) cycle = 1;
    motion.duration = cycle;
    motion.loop = bool_of(timer, "loop", false);
    for (const X3dRoute* to_curve : from[sensor]) {
      auto curve = by_def.find(to_curve->to_node);
      if (curve == by_def.end() || !is_field(to_curve->from_field, "fraction") ||
          !is_field(to_curve->to_field, "fraction"))
        continue;
      if (!curves.insert(curve->second).second) continue;
      for (const X3dRoute* to_joint : from[curve->second]) {
        auto target = by_def.find(to_joint->to_node);
        if (target == by_def.end() || !is_field(to_joint->from_field, "value")) continue;
        if (++looked_at > most_links)
          throw LoadError(file.path, where(timer), "ROUTEs lead to too many joints");
        if (!led.insert({curve->second, target->second, to_joint->to_field}).second ||
            add_track(motion, curve->second, target->second, to_joint->to_field, cycle))
          followed.insert({to_curve, to_joint});
      }
    }
    if (motion.tracks.empty() || reader.character.motions.size() >= most_motions) return;
    motion.joints = skeleton_of(reader.character);
    reader.character.motions.push_back(std::move(motion));
  }

  // Adds a track. False: there is nothing to follow, or it leads to nothing that a figure moves.
  bool add_track(Motion& motion, int curve_node, int target, const std::string& field,
                 float cycle) {
    X3dFile& file = reader.file;
    const X3dNode& curve = file.nodes[size_t(curve_node)];
    const X3dNode& node = file.nodes[size_t(target)];
    auto found = joint_of.find(target);
    int joint = found != joint_of.end() ? found->second : target == humanoid ? 0 : -1;
    bool rotation = is_field(field, "rotation"), translation = is_field(field, "translation");
    bool weight = is_field(field, "weight") && node.type == "HAnimDisplacer";
    if (!weight && (joint < 0 || !(rotation || translation))) return false;
    size_t width = rotation ? 4 : translation ? 3 : 1;
    MotionTrack track{rotation      ? TrackKind::rotation
                      : translation ? TrackKind::translation
                                    : TrackKind::displacer,
                      TrackCurve::linear,
                      joint,
                      {},
                      {},
                      {}};
    std::vector<float> keys = floats_of(file, curve, "key"),
                       values = floats_of(file, curve, "keyValue");
    numbers += keys.size() + values.size() + 100;
    if (numbers > most_numbers)
      throw LoadError(file.path, where(curve), "interpolators have too many keys in all");
    size_t count = std::min(keys.size(), values.size() / width);
    if (keys.size() * width != values.size())
      warn_once(file.warnings, where(curve) + ": " + std::to_string(keys.size()) + " keys but " +
                                   std::to_string(values.size()) + " numbers");
    if (count == 0) return false;
    if (curve.type.rfind("Spline", 0) == 0 || curve.type.rfind("Squad", 0) == 0)
      warn_once(file.warnings, curve.type + " is followed in straight lines from key to key");
    for (size_t k = 0; k < count; k++) {
      const float* v = values.data() + k * width;
      float at = keys[k] * cycle;
      if (k > 0 && at < track.times.back()) {
        warn_once(file.warnings, where(curve) + ": keys go backwards, the rest is left out");
        break;
      }
      track.times.push_back(at);
      if (rotation) {
        vec3 axis(v[0], v[1], v[2]);
        float length = glm::length(axis);
        append(track.values,
               length > 1e-9f ? turner(glm::angleAxis(v[3], axis / length)) : quat(1, 0, 0, 0));
      } else if (translation) {
        append(track.values, turner(vec3(v[0], v[1], v[2])));
      } else {
        track.values.push_back(v[0]);
      }
    }
    if (weight) {
      std::string name = string_of(node, "name");
      track.target = int(motion.displacers.size());
      motion.displacers.push_back(name.empty() ? node.def : name);
    }
    motion.tracks.push_back(std::move(track));
    return true;
  }
};

}  // namespace

void read_x3d_motions(HumanoidReader& reader, int humanoid) {
  Turner turner(reader.root);
  for (size_t i = 0; i < reader.file.nodes.size(); i++)
    if (reader.file.nodes[i].type == "HAnimMotion" &&
        reader.character.motions.size() < most_motions)
      read_hanim_motion(reader, reader.file.nodes[i], turner);
  Router router(reader, turner, humanoid);
  for (size_t i = 0; i < reader.file.nodes.size(); i++)
    if (reader.file.nodes[i].type == "TimeSensor" && !reader.file.nodes[i].def.empty())
      router.follow(int(i));
  if (size_t idle = reader.file.routes.size() - router.followed.size())
    warn_once(reader.file.warnings,
              std::to_string(idle) + " of " + std::to_string(reader.file.routes.size()) +
                  " ROUTEs are no way from a TimeSensor to a joint or displacer: not followed");
}

}  // namespace wellspring::avatar
