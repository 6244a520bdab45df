// SPDX-License-Identifier: Apache-2.0
// Defines the messages between a kiosk's eye and the server: observations, and what is asked of
// them. Plain values, as in messages.h.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/vec.h"

namespace wellspring::wire {

struct Expression {  // 0..1 each
  float joy = 0, sadness = 0, anger = 0, fear = 0, disgust = 0, surprise = 0;
  // How pleasant, and how excited, -1..1 (Russell 1980); absent if they are not told.
  std::optional<float> valence{}, arousal{};
  bool operator==(const Expression&) const = default;
};

enum class HandPose : uint8_t {
  other,
  open,   // all fingers are stretched: stop
  fist,   // it grabs
  pinch,  // thumb and index hold something small
  point,  // the index alone is stretched
};
inline constexpr const char* hand_poses[] = {"other", "open", "fist", "pinch", "point"};

// Describes a hand in front of the camera; places in the frame of Person::position.
struct Hand {
  vec3 position{0, 0, 1};  // middle of the palm, metres
  HandPose pose = HandPose::other;
  std::optional<int> fingers{};     // stretched ones, 0..5; absent if they cannot be counted
  std::optional<vec2> points_at{};  // place on the screen's plane that the index points at, metres
  bool operator==(const Hand&) const = default;
};

// Describes one person. position: metres from the screen's centre, +x to the right as the visitor
// sees the screen, +y up, +z out of the screen towards the visitor. rotation: yaw, pitch, roll of
// the head, radians; 0 faces the screen squarely; yaw positive: turned to the screen's right as the
// visitor sees it; pitch positive: looking up; roll positive: head tilted towards the visitor's
// right shoulder.
struct Person {
  uint32_t id = 0;
  vec3 position{0, 0, 1};
  vec3 rotation{0};
  float confidence = 0;
  std::optional<Expression> expression;  // absent if the kiosk does not estimate it
  std::string gesture;                   // empty: none
  // Says how surely a living face is seen, and no picture of one, 0..1; absent: nobody can
  // tell.
  std::optional<float> liveness{};
  std::optional<vec2> gaze{};  // place on the screen's plane that the eyes look at, metres
  std::optional<float> lids{}, mouth{};  // how far they are open, 0 (closed) to 1; absent: unknown
  std::vector<Hand> hands{};             // at most two
  bool operator==(const Person&) const = default;
};

enum class BodyCourse : uint8_t { stays, comes, leaves, passes };
inline constexpr const char* body_courses[] = {"stays", "comes", "leaves", "passes"};

// Describes a body that is seen from afar, perhaps without a face.
struct Body {
  uint32_t id = 0;         // a number of its own: places join bodies and faces
  vec3 position{0, 0, 1};  // middle of the shoulders, in the frame of Person::position, metres
  float height = 0;        // metres from sole to crown, as it would stand; 0: not known
  BodyCourse course = BodyCourse::stays;
  bool seated = false;       // in a wheelchair or on a chair
  bool raised_hand = false;  // a wrist is above the shoulders
  float confidence = 0;      // 0..1
  bool operator==(const Body&) const = default;
};

enum class Presence : uint8_t { absent, motion, person };
const char* to_string(Presence presence);

// The fault of a kiosk's camera.
enum class CameraState : uint8_t {
  good,
  dark,     // the picture is black
  frozen,   // the picture does not change at all, not even by noise
  missing,  // there is no camera
  slow,     // fewer than 8 pictures a second
};
inline constexpr const char* camera_states[] = {"good", "dark", "frozen", "missing", "slow"};

// Tells what a kiosk's eye can see: true: it does; false: it is asked for, and its network's
// weights are not installed; absent: it is not asked for. Without `faces`, cascades find them, and
// estimate head rotations poorly.
struct EyeParts {
  std::optional<bool> faces = true, mesh{}, expression{}, bodies{}, hands{}, objects{};
  static void list(auto& parts, auto& fields) {
    fields.boolean("faces", parts.faces, "");
    fields.boolean("mesh", parts.mesh, "");
    fields.boolean("expression", parts.expression, "");
    fields.boolean("bodies", parts.bodies, "");
    fields.boolean("hands", parts.hands, "");
    fields.boolean("objects", parts.objects, "");
  }
  bool operator==(const EyeParts&) const = default;
};

// Shows the state of a kiosk's calibration of its camera: where the person is to stand, and for
// which share of the needed time they have been steady there.
struct CalibrationStep {
  enum class What : uint8_t { near_mark, far_mark, done, failed };
  What what = What::near_mark;
  float metres = 0;    // distance of the mark from the screen; 0 once it is done or has failed
  float progress = 0;  // 0..1
  bool operator==(const CalibrationStep&) const = default;
};
inline constexpr const char* calibration_steps[] = {"near", "far", "done", "failed"};

// Describes what a visitor holds to the camera (kiosk/station). Texts are by language: the server
// need not know the objects.
struct Holding {
  std::string id;        // object; empty: only its class is known
  std::string of_class;  // "class" on the wire; empty: the object is of none
  std::map<std::string, std::string> title;
  std::map<std::string, std::string> hint;  // asks the visitor for something; empty: for nothing
  // Says where its middle is, and how it is turned, as a person's are; absent if its size is not
  // known.
  std::optional<vec3> position, rotation;
  bool operator==(const Holding&) const = default;
};

struct Observation {
  double time = 0;  // seconds, the kiosk's clock (a video file's own time)
  Presence state = Presence::absent;
  std::vector<Person> people;  // nearest first
  CameraState camera = CameraState::good;
  std::string name;  // name of kiosk and camera, for technicians; may be empty
  std::optional<CalibrationStep> calibration;  // during a calibration nobody is a guest
  std::string kiosk{};                         // kiosk's name; empty: the only one of the house
  EyeParts parts{};
  std::optional<Holding> holding{};  // absent: nothing that is known
  std::vector<Body> bodies{};        // nearest first
  bool operator==(const Observation&) const = default;
};

// ---- server to kiosk ----

// Says which results of a kiosk's cameras are used at the moment; the rest need not be computed.
struct EyeNeeds {
  bool faces = true;                        // false: presence is enough
  bool expression = true, gestures = true;  // gestures: hands, too
  bool operator==(const EyeNeeds&) const = default;
};

struct EyeOrder {
  std::string stage;  // stage of the kiosk (show/kiosk/kiosk.h)
  EyeNeeds needs;
  bool idle = false;  // the house is closed: a look now and then is enough
  bool operator==(const EyeOrder&) const = default;
};

}  // namespace wellspring::wire
