// SPDX-License-Identifier: Apache-2.0
// Finished pictures on request (still.jpg), in a given time: as many samples as fit, at least one a
// pixel, by the light that the show knows. They have their own copy of the world, so that a running
// show is never waited for; the last few are remembered. Who may ask for how much is the desk's
// (show/http/still_desk.h). Thread-safe; may take minutes.
#pragma once
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "base/clock.h"
#include "show/exhibit/exhibit.h"
#include "show/exhibit/pieces/piece_choices.h"
#include "wire/messages.h"

namespace wellspring::show {

struct Show;  // show/state/show.h

struct StillJob {
  int viewpoint = 0, width = 640, height = 360;
  double seconds =
      8;        // seconds of the thread that makes it, unless one sample a pixel takes longer
  int spp = 0;  // samples a pixel at most; 0: as many as fit
  bool denoise = true;  // by the network, if there are weights
  // In place of the viewpoint's own; metres, radians.
  std::optional<dvec3> position;
  std::optional<float> yaw, pitch, roll, fov;
  PieceChoices pieces;
  LensOrder lens;  // a glass over it; without `at` there is none
  bool operator==(const StillJob&) const = default;
  double pixels() const { return double(width) * height; }
};

inline constexpr int max_still_spp = 1024;

// One that was made.
struct StillPicture {
  std::string jpeg;
  int spp = 0;  // samples a pixel that it has
  enum class Denoised : uint8_t { yes, not_asked, no_weights } denoised = Denoised::not_asked;
};

// Holds the costs of pictures in seconds of the thread that makes them, so that others' work does
// not count.
struct StillCosts {
  double trace_seconds = 0, denoise_seconds = 0;  // the latter without samples: guides, network
  int spp = 0;                                    // samples a pixel in the former
  int elsewhere = 0;                              // samples a pixel that workers traced besides
};

class StillRoom {
 public:
  // Borrows `show`'s exhibit for its lifetime (not its world, which moves). The storyteller who is
  // there stands in its first pose, and lamps are as at first. Bounds of an order: see
  // still.cpp.
  // `clock`: seconds that its time is taken by.
  explicit StillRoom(const Show& show, std::function<double()> clock = thread_seconds_now);
  ~StillRoom();
  // A JPEG, whose comment says what it has, on at most `cores`. Empty: given up, as `given_up` (any
  // thread, every few milliseconds) said so. `denoise_seconds`: of its time that are kept for that.
  StillPicture make(const StillJob& order, const std::function<bool()>& given_up = {},
                    int cores = 1, double denoise_seconds = 0, StillCosts* costs = nullptr);
  // Measures the costs of a small picture, which is made and not remembered.
  StillCosts measure(const StillJob& order);
  std::optional<StillPicture> find(const StillJob& order);  // among those that are remembered
  bool denoises() const;

 private:
  struct Kept {
    StillJob order;
    StillPicture picture;
  };
  struct Scenery;
  std::unique_ptr<Scenery> scenery_;
  std::mutex mutex_;      // guards the members below
  std::list<Kept> kept_;  // newest first
};

// The query of still.jpg: which finished picture is asked for, within which bounds.

struct StillQuestion {
  StillJob job;
  int status = 200;           // status of HTTP; 200: `job` may be done
  std::string code, problem;  // otherwise the fault, and its field
};

StillQuestion read_still_question(const Exhibit& exhibit,
                                  const std::map<std::string, std::string>& query);

}  // namespace wellspring::show
