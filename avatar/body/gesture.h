// SPDX-License-Identifier: Apache-2.0
// Arms, head and chest by a few meaningful angles. The same angles fit every figure: the rig knows
// how its arms hang. A gesture is a clip of them; clips pass over into each other without a jump of
// place or speed (inertial blending: what the broken-off motion leaves is a spring that comes to
// rest).
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "avatar/figure/spring_bones.h"
#include "base/vec.h"

namespace wellspring::avatar {

// The storyteller's body language: motions by name. They are data (docs/expressions.md describes
// the JSON); the library that comes with the program is compiled in, an exhibit can bring its own.

// One arm; radians. All zero: it hangs straight down, palm to the thigh.
struct ArmPose {
  float forward = 0, side = 0;  // upper arm raised to the front, away from the body
  float turn = 0;               // upper arm about itself: the bent forearm swings inwards
  float elbow = 0;              // bent
  float pronate = 0;         // palm from inwards to backwards (or down, when the forearm is level)
  float flex = 0, tilt = 0;  // wrist towards the palm, towards the thumb
  float curl = 0;            // fingers, mean of their joints
  std::array<float, 5> finger{};  // more than `curl`, thumb to little finger
};

// A moment of a gesture. As a row of floats these are its channels.
struct GestureMotion {
  std::array<ArmPose, 2> arm;         // left, right
  std::array<float, 2> weight{0, 0};  // of them over the resting arms, 0..1
  vec3 head{0};  // over the gaze: turn to its own left, nod (down positive), tilt to its own right;
                 // radians
  vec3 chest{0};        // turn to its own left, bow, lean to its own right; radians
  float shoulders = 0;  // collar bones raised, radians
  // How far finger or hand are turned to the place spoken of, 0..1 (left, right); not in the data,
  // made of the clip's `aim` and weight.
  std::array<float, 2> finger_aim{0, 0}, palm_aim{0, 0};
};
inline constexpr size_t gesture_channels = sizeof(GestureMotion) / sizeof(float);
inline constexpr size_t told_channels = gesture_channels - 4;  // those that the data tell
using GestureRow = std::array<float, gesture_channels>;
// "right.forward", "left.index", "head.nod", "chest.bow", "shoulders", ...; -1: no such channel.
int find_gesture_channel(std::string_view name);

// A channel that swings: amplitude * sin(2 pi (hertz (t - from) + phase)), fading in and out.
struct Swing {
  int channel = 0;
  float amplitude = 0, hertz = 1, from = 0, to = 1, phase = 0;
};

enum class Aim : uint8_t { none, finger, palm };  // what of the hand turns to the place spoken of

struct GestureClip {
  std::string name, about;
  float seconds = 1;
  float stroke = 0;  // when its meaning is plain: meets the word it belongs to
  float hold = -1;   // the moment that is drawn out when it shall last longer; < 0: none
  Aim aim = Aim::none;
  std::vector<float> times;              // of the keys, growing, from 0 to seconds
  std::vector<GestureRow> rows, slopes;  // values at the keys and their change a second
  std::vector<Swing> swings;
  std::array<bool, 2> uses_arm{false, false};
};

struct GestureLibrary {
  std::vector<GestureClip> clips;
};

inline constexpr size_t most_gestures = 1000, most_gesture_keys = 1000;
inline constexpr float longest_gesture = 600;  // seconds

// At time `t` of a clip (0..seconds, others are clamped). No state.
GestureMotion eval_gesture(const GestureClip& clip, float t);

// The library that comes with the program, and where a name stands in it; -1: no such gesture.
const GestureLibrary& default_gestures();
int find_gesture(std::string_view name);
int find_gesture(const GestureLibrary& library, std::string_view name);

// JSON as docs/expressions.md has it. Throws LoadError; `file` names it in messages.
GestureLibrary read_gestures(std::string_view json, const std::string& file);
GestureLibrary load_gestures(const std::string& file);

// What is asked of the arms in one tick.
struct GestureOrder {
  int clip = -1;      // begins now; -1: nothing new
  float size = 1;     // 0..1: how large the clip is played
  float lead = 0;     // seconds until its stroke is due; < 0: as the clip has it
  float seconds = 0;  // how long it shall last; longer than the clip: its held moment is drawn out
  bool mirrored = false;  // left for right
};

struct GestureState {
  int clip = -1;
  float time = 0;            // since the clip began; negative: it waits for its word
  float size = 1, hold = 0;  // hold: seconds added to the held moment
  bool mirrored = false;
  std::array<float, 2> free{1, 1};  // as last told
  // What earlier motions left, one spring a channel of GestureMotion; at rest when `blending` is
  // false.
  std::array<Spring, gesture_channels> left_over;
  bool blending = false;
};

// Advances the running clip by dt after taking `order`. `rest` are the arms without any gesture,
// `free` says how far each may leave it, 0..1. The arms of the answer are final, `weight` says how
// much of them is gesture, 0..1.
GestureMotion tick_gesture(GestureState& state, const GestureLibrary& library,
                           const GestureOrder& order, const std::array<ArmPose, 2>& rest, float dt,
                           const std::array<float, 2>& free = {1, 1});

// Left for right.
void swap_sides(GestureMotion& motion);
ArmPose mix(const ArmPose& a, const ArmPose& b, float t);
// Within what human arms can do (American Academy of Orthopaedic Surgeons' normal ranges).
ArmPose limit_arm(const ArmPose& arm);

// Arms at rest: hanging, and hands folded in front of the body. `spread` is the figure's own.
ArmPose hanging_arm(float spread);
ArmPose folded_arm(int side);

}  // namespace wellspring::avatar
