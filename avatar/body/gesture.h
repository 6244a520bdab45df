// SPDX-License-Identifier: Apache-2.0
// Moves arms, head and chest by a few meaningful angles. The same angles fit every figure: the rig
// knows how its arms hang. A gesture is a clip of them; clips pass over into each other without a
// jump of place or speed (inertial blending: the rest of a broken-off motion is a spring that comes
// to rest).
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "avatar/figure/spring_bones.h"
#include "base/vec.h"

namespace wellspring::avatar {

// Holds the storyteller's body language: motions by name. They are data (docs/expressions.md
// describes the JSON); the library that comes with the program is compiled in, an exhibit can bring
// its own.

// Holds the angles of one arm, radians. If all are zero, it hangs straight down, palm to the thigh.
struct ArmPose {
  float forward = 0, side = 0;  // the upper arm's rise to the front, away from the body
  float turn = 0;            // the upper arm's turn about itself: the bent forearm swings inwards
  float elbow = 0;           // bend of the elbow
  float pronate = 0;         // palm from inwards to backwards (or down, when the forearm is level)
  float flex = 0, tilt = 0;  // wrist towards the palm, towards the thumb
  float curl = 0;            // fingers, mean of their joints
  std::array<float, 5> finger{};  // bend beyond `curl`, thumb to little finger
};

// Holds a moment of a gesture. As a row of floats its members are channels.
struct GestureMotion {
  std::array<ArmPose, 2> arm;         // left, right
  std::array<float, 2> weight{0, 0};  // share of these arms over the resting ones, 0..1
  vec3 head{0};  // over the gaze: turn to its own left, nod (down positive), tilt to its own right;
                 // radians
  vec3 chest{0};        // turn to its own left, bow, lean to its own right; radians
  float shoulders = 0;  // collar bones raised, radians
  // Shares by which finger or hand are turned to the place spoken of, 0..1 (left, right); not in
  // the data, made of the clip's `aim` and weight.
  std::array<float, 2> finger_aim{0, 0}, palm_aim{0, 0};
};
inline constexpr size_t gesture_channels = sizeof(GestureMotion) / sizeof(float);
inline constexpr size_t told_channels = gesture_channels - 4;  // channels that the data can set
using GestureRow = std::array<float, gesture_channels>;
// Finds a channel by name: "right.forward", "left.index", "head.nod", "chest.bow", "shoulders",
// ...; -1: no such channel.
int find_gesture_channel(std::string_view name);

// Makes a channel swing: amplitude * sin(2 pi (hertz (t - from) + phase)), fading in and out.
struct Swing {
  int channel = 0;
  float amplitude = 0, hertz = 1, from = 0, to = 1, phase = 0;
};

// part of the hand that turns to the place spoken of
enum class Aim : uint8_t { none, finger, palm };

struct GestureClip {
  std::string name, about;
  float seconds = 1;
  float stroke = 0;  // time when its meaning is plain, s; meets the word it belongs to
  float hold = -1;   // time drawn out when it shall last longer, s; < 0: none
  Aim aim = Aim::none;
  std::vector<float> times;              // times of the keys, growing, from 0 to `seconds`
  std::vector<GestureRow> rows, slopes;  // values at the keys and their change a second
  std::vector<Swing> swings;
  std::array<bool, 2> uses_arm{false, false};
};

struct GestureLibrary {
  std::vector<GestureClip> clips;
};

inline constexpr size_t most_gestures = 1000, most_gesture_keys = 1000;
inline constexpr float longest_gesture = 600;  // seconds

// Evaluates a clip at time `t` (0..seconds, others are clamped). It has no state.
GestureMotion eval_gesture(const GestureClip& clip, float t);

// Returns the library that comes with the program, and the index of a name; -1: no such gesture.
const GestureLibrary& default_gestures();
int find_gesture(std::string_view name);
int find_gesture(const GestureLibrary& library, std::string_view name);

// Reads JSON as docs/expressions.md has it. Throws LoadError; `file` names it in messages.
GestureLibrary read_gestures(std::string_view json, const std::string& file);
GestureLibrary load_gestures(const std::string& file);

// Holds what the arms are asked to do in one tick.
struct GestureOrder {
  int clip = -1;      // clip that begins now; -1: nothing new
  float size = 1;     // size at which the clip is played, 0..1
  float lead = 0;     // seconds until its stroke is due; < 0: as the clip has it
  float seconds = 0;  // wanted length, s; if it exceeds the clip's, the held moment is drawn out
  bool mirrored = false;  // left and right are swapped
};

struct GestureState {
  int clip = -1;
  float time = 0;            // seconds since the clip began; negative: it waits for its word
  float size = 1, hold = 0;  // hold: seconds added to the held moment
  bool mirrored = false;
  std::array<float, 2> free{1, 1};  // how far each arm may move in the last tick, 0..1
  // Holds what earlier motions left, one spring a channel of GestureMotion; at rest when `blending`
  // is false.
  std::array<Spring, gesture_channels> left_over;
  bool blending = false;
};

// Advances the running clip by dt after taking `order`. `rest` holds the arms without any gesture,
// `free` says how far each may leave it, 0..1. The returned arms are final; their `weight` says how
// much of them is gesture, 0..1.
GestureMotion tick_gesture(GestureState& state, const GestureLibrary& library,
                           const GestureOrder& order, const std::array<ArmPose, 2>& rest, float dt,
                           const std::array<float, 2>& free = {1, 1});

// Swaps left and right.
void swap_sides(GestureMotion& motion);
ArmPose mix(const ArmPose& a, const ArmPose& b, float t);
// Keeps an arm within what human arms can do (American Academy of Orthopaedic Surgeons' normal
// ranges).
ArmPose limit_arm(const ArmPose& arm);

// Return arms at rest: hanging, and hands folded in front of the body. `spread` is the figure's
// own.
ArmPose hanging_arm(float spread);
ArmPose folded_arm(int side);

}  // namespace wellspring::avatar
