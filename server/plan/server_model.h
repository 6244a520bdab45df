// SPDX-License-Identifier: Apache-2.0
// Simulates one server: the trip of a frame (ARCHITECTURE.md) in events. A tick reads inputs, gives
// the renderer its next work and shows pictures; the renderer draws one thing at a time on all
// cores; each visitor has an encoder, and a line. Costs are as measured (plan/costs.h), shared
// cores as in plan/shared_cores.h, the rules of pace as in plan/pace.h.
//
// These simplifications were chosen, since what they leave out changes little of how long walkers
// wait:
// - All pictures of a size cost the same; views differ, and nobody walks into walls.
// - A visitor who stands has a picture drawn 1.5 times a second for five seconds, later every five
//   seconds; reconstruction, layers, parts and glasses are left out. They give way to walkers.
// - Samples take the time that they are given; what they do to pictures is not known here.
// - The storyteller's part of a tick is in the measured cost of ticks.
// - JPEG quality does not give way; where the line cannot follow, pictures become fewer.
// - Sockets, proxies and the network's threads cost what is measured with the tick.
#pragma once
#include <vector>

#include "plan/costs.h"
#include "plan/demand.h"
#include "plan/event_queue.h"
#include "plan/guest.h"
#include "plan/pace.h"
#include "plan/shared_cores.h"

namespace wellspring::plan {

enum class EventKind : uint8_t {
  tick,          // a server's tick is due
  work,          // a task of a server's cores ends
  arrival,       // a picture reaches a visitor
  acknowledged,  // and the server hears of it
  turn,          // a visitor walks, stands or rests from now on
  leave,         // a visit ends, and another begins
};

struct Event {
  EventKind kind = EventKind::tick;
  int server = -1, guest = -1;
  uint64_t number = 0;  // says which tick, work or visit is meant: later ones count
  int seq = -1;         // arrival: the input that it shows; -1: it shows none anew
};

// Holds all that the servers of a simulation share.
struct Hall {
  const Costs& costs;
  const Demand& demand;
  const Machine& machine;
  double worker_samples = 0;  // a second, for each server
  double worker_trip = 0;
  std::vector<Guest> guests = {};
  EventQueue<Event> events = {};
};

class ServerModel {
 public:
  ServerModel(int index, Hall& hall);
  void come(int guest, double now);
  void leave(int guest, double now);
  void tick(uint64_t number, double now);
  void work(uint64_t number, double now);
  int connections() const { return int(here_.size()); }
  // Counts from now on.
  void begin_counting(double now);
  // Returns core-seconds, seconds in which the renderer or the tick was at work, and bytes.
  double used(double now) { return cores_.used(now) - used_before_; }
  double rendered() const { return rendered_; }
  double ticked() const { return ticked_; }
  double sent() const { return sent_; }

 private:
  enum class Drawing : uint8_t { nothing, keyframe, wide, samples };
  enum class Ticking : uint8_t { waits, reads, warps };
  Guest& guest(int index) { return hall_.guests[size_t(index)]; }
  int seq_at(const Guest& guest, double now) const;
  bool is_walking(const Guest& guest) const { return guest.doing == Doing::walks; }
  void finish_drawing();
  void decide(double now);
  int next_to_draw(double now, int& waiting, double& least) const;
  void draw(int index, int waiting, double now);
  KeyframePace pace_of(const Guest& guest, double now) const;
  double drawing_rate(const Guest& guest, double now) const;
  double picture_rate(const Guest& guest) const;
  double sampling(const Guest& guest, int waiting, double now) const;
  double left_to_trace(Guest& guest, double now);
  void trace(double now);
  void present(double now);
  bool show(int index, double now);
  void encode(int index, int seq, double cost, double bytes, bool wide, double now);
  void send(int index, double now);
  void end_tick(double now);
  double wait(double now) const;
  void plan_work(double now);
  void plan_tick(double time);
  void count_walkers();

  const int index_;
  Hall& hall_;
  SharedCores cores_;
  const double width_;  // cores that a drawing uses
  std::vector<int> here_;
  int walkers_ = 0;
  double showing_ = 0;  // seconds that a finished picture for each walker takes
  uint64_t tick_number_ = 0, work_number_ = 0;

  Ticking ticking_ = Ticking::waits;
  bool was_free_ = false;
  double tick_began_ = 0, present_began_ = 0, warp_began_ = 0;
  std::vector<int> to_present_;
  size_t presented_ = 0;

  Drawing drawing_ = Drawing::nothing;
  bool drawing_ended_ = false;
  int drawn_ = -1;
  uint32_t drawn_visit_ = 0;
  int job_seq_ = -1;
  double job_time_ = 0, job_scale_ = 1, job_sampling_ = 0, drawing_began_ = 0, drawing_took_ = 0;
  double served_ = 0;  // show::Renderer::served
  std::vector<int> asking_;
  double credit_ = 0, credited_at_ = 0;  // samples that workers can have traced

  struct Encoding {
    int guest = -1, seq = -1;
    uint32_t visit = 0;
    double bytes = 0;
    bool wide = false;
  };
  std::vector<Encoding> encodings_;  // by place among the tasks
  double network_free_ = 0;
  double used_before_ = 0, rendered_ = 0, ticked_ = 0, sent_ = 0;
  bool counts_ = false;
};

}  // namespace wellspring::plan
