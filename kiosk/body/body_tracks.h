// SPDX-License-Identifier: Apache-2.0
// Follows bodies over time, under a number each, and says where one is to be looked for next: the
// network is run for one square at a time, a few times a second, and not at all while everybody is
// near and seen by the face. OpenCV is not known here.
#pragma once
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "kiosk/body/body_place.h"
#include "wire/messages.h"

namespace wellspring::kiosk {

struct BodySettings {
  double look_every = 0.2;    // seconds between two runs of the network
  double follow_every = 0.4;  // seconds between two looks at the same body
  double search_every = 1;    // seconds between two looks at the whole picture while things move
  double arm_every = 0.3;     // seconds between two looks for the wrists of who is near
  double forget = 1.5;        // seconds for which a body is told that is not found any more
  float near = 2;             // metres; who is nearer and has a face needs no body
};

// Holds a face that is followed.
struct FaceInView {
  uint32_t id = 0;
  Box box;          // pixels
  float depth = 1;  // metres along the camera's axis
};

// Holds a wrist and the elbow behind it, pixels.
struct Forearm {
  vec2 elbow{0}, wrist{0};
  bool has_elbow = false;
};

// Says what the network is to look at. `most`: bodies that are sought; 1 where one is expected.
struct BodyLook {
  Cut square;
  size_t most = 1;
};

class BodyTracks {
 public:
  BodyTracks(const Mount& mount, const BodySettings& settings = {});
  // Takes a frame's facts; returns where to look, or nothing. `zones`: what moves, largest first.
  // `arms`: wrists are asked for. A time that runs backwards forgets everybody.
  std::optional<BodyLook> plan(double time, int width, int height, std::span<const Box> zones,
                               std::span<const FaceInView> faces, bool arms);
  // Takes what was found there, in the same frame.
  void take(double time, std::span<const BodyMarks> found, std::span<const FaceInView> faces);
  // Returns who is there at `time`, nearest first, at most six.
  std::vector<wire::Body> bodies(double time) const;
  // Returns whether a body comes near that was seen far away.
  bool somebody_comes() const;
  // Returns whether a body is within arm's reach of the screen and has stayed for a second.
  bool somebody_stays_near(double time) const;
  // Returns the forearms of the body of that face that were seen in the last look; none later.
  std::vector<Forearm> forearms(uint32_t face, double time) const;

 private:
  struct Step {
    double time;
    vec3 place;
  };
  struct Track {
    wire::Body body;
    BodyMarks marks;
    uint32_t face = 0;  // 0: none belongs to it
    int hits = 0;
    bool stirred = false;  // something moved there, or a face belongs to it: it is no picture
    double first = 0, seen = 0, looked = -1e9, course_since = 0;
    float seated = 0;  // evidence: -1 stands, 1 sits
    OneEuro bearing, distance;
    std::deque<Step> way;  // places of the last seconds
  };

  bool counts(const Track& track) const;
  Track* find(const BodyMarks& marks, std::span<const uint32_t> taken);
  void see(Track& track, double time, const BodyMarks& marks, const BodyMeasure& measure);
  void judge_course(Track& track, double time);

  Mount mount_;
  BodySettings settings_;
  std::vector<Track> tracks_;
  std::vector<Cut> candidates_;  // squares of what may be a body, to be looked at closely
  bool wide_ = false;            // the last look was for several bodies
  std::vector<Box> zones_;       // zones of the last plan
  std::optional<float> floor_;
  BodyView view_;
  uint32_t next_id_ = 1;
  size_t next_zone_ = 0;
  double last_time_ = -1e9, looked_ = -1e9, searched_ = -1e9, arms_ = -1e9;
};

}  // namespace wellspring::kiosk
