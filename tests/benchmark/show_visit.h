// SPDX-License-Identifier: Apache-2.0
// A visitor of a running server who is led along a recorded walk of the castle, at 1280x720 over
// loopback, and how right every picture is that is shown meanwhile. So that each picture's pose is
// known exactly, the client sends the poses itself, sixty a second, and a picture's header tells
// the last that it follows. (Of turns so quick that four fifths of a warp were unknown, the pose is
// a predicted one.) The storytellers are sent away. A page that draws for itself follows the input
// at once (web/display/walker.js), so such a visitor's camera is where the recorded walk has it.
#pragma once
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "cache_visit_trace.h"
#include "screen.h"
#include "show_truth.h"
#include "stream_server.h"

namespace wellspring::test {

inline constexpr int shown_width = 1280, shown_height = 720;

struct ShownPicture {
  uint32_t seq = 0;               // the pose that it shows: poses[seq - 1]
  uint32_t late = 0;              // the pose that the visitor has when it arrives
  double arrived = 0, asked = 0;  // seconds since the walk began; asked: its pose was sent
  std::vector<uint8_t> message;
};

struct ShownWalk {
  bool local = false;                        // the pictures are keyframes, for a LocalDisplay
  std::vector<std::vector<uint8_t>> before;  // messages of pictures, in the two seconds at rest
  std::vector<ShownPicture> pictures;
  double seconds = 0, keyframes = 0;
};

// A recorded walk; without a name the one that is asked for, `stroll` without options.visit_trace.
// Throws LoadError.
VisitTrace load_walk(const BenchOptions& options, std::string name = {});

// Says how somebody visits.
struct WalkWay {
  bool local = false;  // hello {display: "local"}
  uint16_t port = 0;   // port of a line to the server; 0: there is none
};
// Two seconds at rest after the first picture, then the walk. Throws std::runtime_error where the
// visit ends by itself.
ShownWalk walk_along(const ServerProcess& server, const std::vector<Viewpoint>& poses,
                     const WalkWay& way = {});

// Judges pictures of one walk, at all of its poses or at some. Each pose has a window of its own,
// a sixty-fourth of the picture: those of a second cover all of it.
class WalkJudge {
 public:
  // All poses have the field of view of the exhibit's start, as those that are sent.
  WalkJudge(const BenchOptions& options, const VisitTrace& trace);
  const std::vector<Viewpoint>& poses() const { return poses_; }  // sixty a second
  const ShowTruth& truth() const { return truth_; }
  // Adds NAME.flip of the poses that pictures show, NAME.flip_late of those that the visitor has
  // when they arrive, NAME.flip_worst of the worst half second, and their rates, sizes and times.
  void add(BenchReport& report, const std::string& name, const ShownWalk& walk,
           nlohmann::json where);
  // Adds NAME.flip of what the visitor has at the moments of the poses, sixty a second, against
  // these poses, NAME.flip_drawn of keyframes seen from where they were drawn, and NAME.flip_worst,
  // rates, sizes and times likewise. Returns the first.
  double add_had(BenchReport& report, const std::string& name, const ShownWalk& walk,
                 nlohmann::json where);

 private:
  bool is_judged(uint32_t seq) const { return (seq - 1) % every_ == 0; }
  const Converged& converge(uint32_t seq);
  ShowTruth truth_;
  std::vector<Viewpoint> poses_;
  uint32_t every_ = 1;                       // so many poses one is judged
  std::map<uint32_t, Converged> converged_;  // by seq
};

// Takes what a visit is sent until that moment of seconds_now(), and says that it was shown.
// `take` is called with each picture's message. Throws std::runtime_error where the visit ends by
// itself.
void look_until(WsClient& client, double moment, const std::function<void(const WsMessage&)>& take);

// Opens a visit of that size and sends the storytellers away.
void join_alone(WsClient& client, const ServerProcess& server, const WalkWay& way = {});

}  // namespace wellspring::test
