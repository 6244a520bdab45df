// SPDX-License-Identifier: Apache-2.0
#include "avatar/face/expression_sum.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>

#include "avatar/figure/noise.h"
#include "avatar/speech/visemes.h"

namespace wellspring::avatar {

const std::array<const char*, flex_count> flex_names = {"turn",  "nod",   "tilt",  "sayAh",
                                                        "blink", "brows", "lookX", "lookY",
                                                        "lids",  "sayOo", "smile", "sneer"};

namespace {

// These rows are the applet's. Turn, nod and looks are stirred by the body's and the eyes' own
// noise.
struct Stir {
  Flex flex;
  float amplitude, frequency;
};
constexpr Stir stirs[] = {{Flex::brows, 0.10f, 0.5f}, {Flex::lids, 0.15f, 0.5f}};
constexpr double frames_a_second = 30, applet_time = 3.6;
// seconds, for the integral; noise has about two cells a second
constexpr double longest_step = 1.0 / 50;

double noise_at(Flex flex, size_t side, float frequency, double time) {
  return double(smooth_noise(100 + 2 * uint32_t(flex) + uint32_t(side),
                             applet_time * double(frequency) * time));
}

// Integrates noise: e^(-rate t) is taken inside the integral, Simpson's rule outside.
double integrate(const Stir& stir, size_t side, double value, double rate, double scale,
                 double from, double to, int& drawn) {
  int steps = int(std::ceil((to - from) / longest_step));
  if (steps <= 0) return value;
  double h = (to - from) / steps, whole = std::exp(-rate * h), half = std::exp(-rate * h / 2);
  double a = noise_at(stir.flex, side, stir.frequency, from);
  for (int i = 0; i < steps; i++) {
    double t = from + i * h;
    double b = noise_at(stir.flex, side, stir.frequency, t + h / 2);
    double c = noise_at(stir.flex, side, stir.frequency, t + h);
    value = value * whole + scale * h / 6 * (a * whole + 4 * b * half + c);
    a = c;
  }
  drawn += 2 * steps + 1;
  return value;
}

struct Share {
  Emotion emotion;
  Flex flex;
  float value;
};
constexpr Share shares[] = {
    {Emotion::joy, Flex::smile, 1.1f},       {Emotion::joy, Flex::brows, 0.1f},
    {Emotion::joy, Flex::say_ah, 0.25f},     {Emotion::sadness, Flex::brows, 0.9f},
    {Emotion::sadness, Flex::smile, -0.7f},  {Emotion::sadness, Flex::lids, -0.4f},
    {Emotion::anger, Flex::brows, -1},       {Emotion::anger, Flex::sneer, 0.3f},
    {Emotion::anger, Flex::smile, -0.3f},    {Emotion::fear, Flex::brows, 0.8f},
    {Emotion::fear, Flex::blink, -0.9f},     {Emotion::fear, Flex::say_ah, 0.4f},
    {Emotion::fear, Flex::say_oo, -0.3f},    {Emotion::disgust, Flex::sneer, 1},
    {Emotion::disgust, Flex::smile, -0.3f},  {Emotion::disgust, Flex::brows, -0.3f},
    {Emotion::surprise, Flex::brows, 1},     {Emotion::surprise, Flex::blink, -0.8f},
    {Emotion::surprise, Flex::say_ah, 0.9f}, {Emotion::surprise, Flex::say_oo, 0.1f}};

}  // namespace

void set_target(PerlinFace& face, Flex flex, float target) {
  if (!std::isfinite(target)) target = 0;
  for (PerlinFace::Value& value : face.flex[size_t(flex)]) value.target = target;
}

void add_targets(PerlinFace& face, Emotion emotion, float weight) {
  if (!std::isfinite(weight)) return;
  for (const Share& share : shares)
    if (share.emotion == emotion)
      for (PerlinFace::Value& value : face.flex[size_t(share.flex)])
        value.target += weight * share.value;
}

int tick_perlin(PerlinFace& face, float stir, float settle_seconds, double now, float dt) {
  double rate = std::log(20.0) / std::max(double(settle_seconds), 1e-3);
  float left = float(std::exp(-rate * double(dt)));
  for (auto& sides : face.flex)
    for (PerlinFace::Value& value : sides)
      value.settled = value.target + (value.settled - value.target) * left;
  int drawn = 0;
  for (const Stir& given : stirs)
    for (size_t side = 0; side < 2; side++) {
      PerlinFace::Value& value = face.flex[size_t(given.flex)][side];
      if (!(stir > 0)) {
        value.noise = std::abs(value.noise) < 1e-4f ? 0 : value.noise * left;
        continue;
      }
      // Noise that lies further back than e^-30 is forgotten.
      double span = std::min(double(dt), 30 / rate);
      double before = span < double(dt) ? 0 : double(value.noise);
      double scale = double(stir) * frames_a_second * double(given.amplitude);
      value.noise = float(integrate(given, side, before, rate, scale, now - span, now, drawn));
    }
  return drawn;
}

namespace {

std::string small(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = char(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

// Finds joints that have flesh on them or below: turning another one shows nothing.
std::vector<bool> joints_seen(const Character& character) {
  std::vector<bool> seen(character.joints.size(), false);
  for (const JointWeight& weight : character.weights)
    if (weight.weight > 0.3f && weight.joint < seen.size()) seen[weight.joint] = true;
  for (size_t j = seen.size(); j-- > 0;)
    if (seen[j] && character.joints[j].parent >= 0) seen[size_t(character.joints[j].parent)] = true;
  return seen;
}

void add_parts(std::vector<ExpressionPart>& to, const std::vector<ExpressionPart>& parts,
               float weight) {
  for (const ExpressionPart& part : parts) {
    auto known = std::find_if(to.begin(), to.end(), [&](const ExpressionPart& other) {
      return other.index == part.index;
    });
    if (known == to.end()) to.push_back({part.index, weight * part.weight});
    else known->weight += weight * part.weight;
  }
}

// Multiplies out everything nested. Expressions use only earlier ones, so one pass in order will
// do.
void flatten(ExpressionRig& rig) {
  const ExpressionSet& set = *rig.set;
  size_t count = set.expressions.size();
  rig.controls.resize(count);
  rig.rotations.resize(count);
  for (size_t e = 0; e < count; e++) {
    const NamedExpression& expression = set.expressions[e];
    for (const ExpressionPart& part : expression.parts) {
      size_t index = size_t(part.index);
      if (expression.kind == NamedExpression::Kind::rotation) {
        if (rig.joints[index] >= 0) add_parts(rig.rotations[e], {{part.index, 1}}, part.weight);
      } else if (expression.kind == NamedExpression::Kind::deform) {
        const ExpressionRig::Drive& drive = rig.drives[index];
        if (drive.displacer >= 0 || drive.rotator >= 0)
          add_parts(rig.controls[e], {{part.index, 1}}, part.weight);
      } else {
        add_parts(rig.controls[e], rig.controls[index], part.weight);
        add_parts(rig.rotations[e], rig.rotations[index], part.weight);
      }
    }
    bool nothing = rig.controls[e].empty() && rig.rotations[e].empty() && !expression.parts.empty();
    if (nothing && expression.otherwise >= 0) {
      rig.controls[e] = rig.controls[size_t(expression.otherwise)];
      rig.rotations[e] = rig.rotations[size_t(expression.otherwise)];
      nothing = rig.controls[e].empty() && rig.rotations[e].empty();
    }
    // A name like "_name" is only a fallback or a member of groups; nobody misses it.
    if (nothing && expression.name[0] != '_') rig.missing.push_back(expression.name);
  }
}

bool is_left(const std::string& name) { return name.ends_with("_l"); }
bool is_right(const std::string& name) { return name.ends_with("_r"); }

vec3 rotation_vector(quat q) {
  if (q.w < 0) q = -q;  // q and -q are the same turn: the shorter way
  vec3 axis(q.x, q.y, q.z);
  float sine = glm::length(axis);
  if (sine < 1e-9f) return vec3(0);
  return axis * (2 * std::atan2(sine, q.w) / sine);
}

quat turn_by(vec3 v) {
  float angle = glm::length(v);
  return angle < 1e-9f ? quat(1, 0, 0, 0) : glm::angleAxis(angle, v / angle);
}

// Scales other kinds of lips and lids by what the protected movement leaves.
void scale_kind(ExpressionSum& sum, const ExpressionRig& rig, ControlKind kind, float scale) {
  for (size_t c = 0; c < sum.controls.size(); c++)
    if (rig.set->controls[c].kind == kind) sum.controls[c] *= scale;
}

float between_0_and_1(float v) { return v > 0 ? std::min(v, 1.0f) : 0; }  // NaN: 0

}  // namespace

ExpressionRig make_expression_rig(const ExpressionSet& set, const Character& character) {
  ExpressionRig rig;
  rig.set = &set;
  std::map<std::string, int> displacers;
  for (size_t d = 0; d < character.displacers.size(); d++)
    displacers.emplace(small(character.displacers[d].name), int(d));
  auto find = [&](const std::vector<std::string>& names) {
    for (const std::string& name : names)
      if (auto known = displacers.find(small(name)); known != displacers.end())
        return known->second;
    return -1;
  };
  std::vector<bool> seen = joints_seen(character);
  for (const Rotator& rotator : set.rotators) {
    int joint = find_joint(character, rotator.joint);
    rig.joints.push_back(joint >= 0 && seen[size_t(joint)] ? joint : -1);
  }
  for (const Control& control : set.controls) {
    ExpressionRig::Drive drive;
    bool sided = is_left(control.name) || is_right(control.name);
    drive.displacer = find(control.displacers);
    if (drive.displacer < 0) {
      drive.displacer = find(control.shared);
      drive.scale = sided ? 0.5f : 1.0f;
    }
    if (drive.displacer < 0 && control.rotator >= 0 && rig.joints[size_t(control.rotator)] >= 0)
      drive = {-1, control.rotator, 1};
    rig.drives.push_back(drive);
  }
  flatten(rig);
  for (size_t i = 0; i < emotion_count; i++)
    rig.emotion[i] = find_expression(set, emotion_names[i]);
  for (size_t i = 0; i < viseme_count; i++)
    rig.viseme[i] = find_expression(set, "viseme_" + std::string(viseme_names[i]));
  rig.breathe = find_expression(set, "breathe");
  for (size_t f = 0; f < flex_count; f++)
    for (size_t side = 0; side < 2; side++)
      for (size_t sign = 0; sign < 2; sign++)
        rig.flex[f][side][sign] =
            find_expression(set, std::string("_flex.") + flex_names[f] + (side ? ".r" : ".l") +
                                     (sign ? ".plus" : ".minus"));
  return rig;
}

bool shows(const ExpressionRig& rig, int expression) {
  return expression >= 0 && size_t(expression) < rig.controls.size() &&
         !(rig.controls[size_t(expression)].empty() && rig.rotations[size_t(expression)].empty());
}

void clear(ExpressionSum& sum, const ExpressionRig& rig) {
  sum.controls.assign(rig.drives.size(), 0);
  sum.rotators.assign(rig.joints.size(), 0);
}

void add(ExpressionSum& sum, const ExpressionRig& rig, int expression, float weight) {
  if (expression < 0 || size_t(expression) >= rig.controls.size() || !std::isfinite(weight)) return;
  if (weight == 0) return;
  for (const ExpressionPart& part : rig.controls[size_t(expression)])
    sum.controls[size_t(part.index)] += weight * part.weight;
  for (const ExpressionPart& part : rig.rotations[size_t(expression)])
    sum.rotators[size_t(part.index)] += weight * part.weight;
}

void add(ExpressionSum& sum, const ExpressionSum& other, float weight) {
  if (!std::isfinite(weight)) return;
  for (size_t i = 0; i < std::min(sum.controls.size(), other.controls.size()); i++)
    sum.controls[i] += weight * other.controls[i];
  for (size_t i = 0; i < std::min(sum.rotators.size(), other.rotators.size()); i++)
    sum.rotators[i] += weight * other.rotators[i];
}

ExpressionSum mean(const ExpressionRig& rig, const std::vector<ExpressionSum>& sums,
                   const std::vector<float>& weights) {
  ExpressionSum result;
  clear(result, rig);
  double total = 0, size = 0;
  for (float weight : weights)
    if (std::isfinite(weight)) total += double(weight), size += std::abs(double(weight));
  // Weights that cancel have no mean: dividing by their sum would blow rounding up to a grimace.
  if (!(std::abs(total) > 1e-5 * size) || size == 0) return result;
  for (size_t i = 0; i < std::min(sums.size(), weights.size()); i++)
    add(result, sums[i], float(double(weights[i]) / total));
  return result;
}

void protect(ExpressionSum& sum, const ExpressionRig& rig, const Protected& what) {
  float talking = between_0_and_1(what.talking);
  if (talking > 0) {
    // A mouth that speaks smiles less, and opens for its words alone.
    scale_kind(sum, rig, ControlKind::mouth, 1 - 0.45f * talking);
    scale_kind(sum, rig, ControlKind::parts_lips, 1 - 0.9f * talking);
    scale_kind(sum, rig, ControlKind::viseme, 1 - 0.9f * talking);
  }
  // p, b, m close the lips; f and v nearly. The other shapes share what they leave.
  std::array<float, 15> shape{};
  float others = 0;
  for (size_t i = 1; i < 15; i++) {
    shape[i] = between_0_and_1(what.visemes[i]);
    if (i > 2) others += shape[i];
  }
  float lips = std::max(shape[1], 0.9f * shape[2]);
  if (lips > 0) {
    scale_kind(sum, rig, ControlKind::parts_lips, 1 - lips);
    scale_kind(sum, rig, ControlKind::viseme, 1 - lips);
    float room = 1 - shape[1];
    if (others > room)
      for (size_t i = 3; i < 15; i++) shape[i] *= room / others;
  }
  for (size_t i = 1; i < 15; i++) add(sum, rig, rig.viseme[i], shape[i]);

  for (size_t c = 0; c < sum.controls.size(); c++) {
    const Control& control = rig.set->controls[c];
    if (control.kind != ControlKind::blink && control.kind != ControlKind::opens_lids) continue;
    float left = between_0_and_1(what.closing[0]), right = between_0_and_1(what.closing[1]);
    float closing = is_left(control.name)    ? left
                    : is_right(control.name) ? right
                                             : std::max(left, right);
    float& value = sum.controls[c];
    if (control.kind == ControlKind::opens_lids) value *= 1 - closing;
    else value = between_0_and_1(value), value += (1 - value) * closing;
  }
}

void apply_rotators(const ExpressionSum& sum, const ExpressionRig& rig, Pose& pose) {
  // Rotators of one joint may come in any order: their rotation vectors are summed, and turn it
  // once.
  size_t count = std::min(sum.rotators.size(), rig.joints.size());
  for (size_t r = 0; r < count; r++) {
    int joint = rig.joints[r];
    if (joint < 0 || size_t(joint) >= pose.rotations.size()) continue;
    auto end = rig.joints.begin() + ptrdiff_t(r);
    if (std::find(rig.joints.begin(), end, joint) != end) continue;
    vec3 turn(0);
    for (size_t other = r; other < count; other++)
      if (rig.joints[other] == joint && sum.rotators[other] != 0)
        turn += rotation_vector(eval_rotator(rig.set->rotators[other], sum.rotators[other]));
    if (turn == vec3(0)) continue;
    quat& rotation = pose.rotations[size_t(joint)];
    rotation = glm::normalize(rotation * turn_by(turn));
  }
}

void apply_controls(const ExpressionSum& sum, const ExpressionRig& rig, Pose& pose) {
  for (const ExpressionRig::Drive& drive : rig.drives)
    if (drive.displacer >= 0 && size_t(drive.displacer) < pose.displacers.size())
      pose.displacers[size_t(drive.displacer)] = 0;
  for (size_t c = 0; c < std::min(sum.controls.size(), rig.drives.size()); c++) {
    float weight = between_0_and_1(sum.controls[c]);
    if (weight == 0) continue;
    const ExpressionRig::Drive& drive = rig.drives[c];
    if (drive.displacer >= 0 && size_t(drive.displacer) < pose.displacers.size()) {
      pose.displacers[size_t(drive.displacer)] += weight * drive.scale;
    } else if (drive.rotator >= 0) {
      int joint = rig.joints[size_t(drive.rotator)];
      if (joint < 0 || size_t(joint) >= pose.rotations.size()) continue;
      quat& rotation = pose.rotations[size_t(joint)];
      quat turn = eval_rotator(rig.set->rotators[size_t(drive.rotator)], weight);
      rotation = glm::normalize(rotation * turn);
    }
  }
}

Emotions add(const Emotions& a, const Emotions& b, float weight) {
  Emotions sum = a;
  for (size_t i = 0; i < emotion_count; i++) {
    float term = weight * b.weight[i];
    if (std::isfinite(term)) sum.weight[i] += term;
  }
  return sum;
}

Emotions mix(const Emotions& a, const Emotions& b, float t) {
  t = between_0_and_1(t);
  if (t == 1) return b;
  Emotions result;
  return add(add(result, a, 1 - t), b, t);
}

Emotions bounded(const Emotions& sum) {
  Emotions result;
  float total = 0;
  for (size_t i = 0; i < emotion_count; i++) result.weight[i] = between_0_and_1(sum.weight[i]);
  auto cancel = [&](Emotion a, Emotion b) {
    float common = std::min(result[a], result[b]);
    result[a] -= common;
    result[b] -= common;
  };
  cancel(Emotion::joy, Emotion::sadness);
  cancel(Emotion::anger, Emotion::fear);
  for (float v : result.weight) total += v;
  if (total > 1)
    for (float& v : result.weight) v /= total;
  return result;
}

}  // namespace wellspring::avatar
