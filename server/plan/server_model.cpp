// SPDX-License-Identifier: Apache-2.0
#include "plan/server_model.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace wellspring::plan {
namespace {

constexpr int nobody = -1;
constexpr int tick_task = 0, drawing_task = 1, first_encoding = 2;
// These are the constants of the same names, or of the same meaning, of server/show.
constexpr double on_time = 0.0005, longest_gap = 0.5, presenting = 0.012;
constexpr double listening_interval = 0.01, least_wait = 0.002;
constexpr double line_share = 0.85, most_keyframes = 10, wide_share = 1 / 8.0;
constexpr double soon = 0.3, smoothed = 0.1;
constexpr double learning_rate = 1.5, rested_rate = 0.2, settled_seconds = 5;
constexpr double standing_weight = 4, slice_seconds = 0.025;
constexpr double credit_seconds = 1;  // seconds of workers' time that are kept while nobody asks
constexpr double least_samples = 1000, most_a_pixel = 0.5;
constexpr int max_in_flight = 2;
// The scripted stroll of the measurements: seconds ahead, and then in a turn.
constexpr double ahead = 2.5, turning = 2.094;

bool is_in_turn(const Guest& guest, double now) {
  return std::fmod(now + guest.phase, ahead + turning) > ahead;
}

}  // namespace

ServerModel::ServerModel(int index, Hall& hall)
    : index_(index),
      hall_(hall),
      cores_(hall.machine.cores, hall.machine.others),
      width_(width_on(hall.machine.cores, hall.costs.serial)) {}

void ServerModel::come(int index, double now) {
  here_.push_back(index);
  if (here_.size() == 1 && ticking_ == Ticking::waits) plan_tick(now);
}

void ServerModel::leave(int index, double now) {
  std::erase(here_, index);
  std::erase(asking_, index);
  std::ranges::replace(to_present_, index, nobody);
  guest(index).visit++;
}

void ServerModel::begin_counting(double now) {
  counts_ = true;
  used_before_ = cores_.used(now);
  rendered_ = ticked_ = sent_ = 0;
}

void ServerModel::plan_work(double now) {
  if (const double end = cores_.next_end(); std::isfinite(end))
    hall_.events.push(std::max(end, now), {EventKind::work, index_, -1, ++work_number_});
}

void ServerModel::plan_tick(double time) {
  hall_.events.push(time, {EventKind::tick, index_, -1, ++tick_number_});
}

int ServerModel::seq_at(const Guest& guest, double now) const {
  return int((now - hall_.demand.latency - guest.came_at) / hall_.demand.input_interval);
}

void ServerModel::count_walkers() {
  walkers_ = 0, showing_ = 0;
  for (const int index : here_) {
    const Guest& one = guest(index);
    if (!is_walking(one)) continue;
    walkers_++;
    showing_ += one.warping + one.encoding / cores_.cores();
  }
}

// ---- Ticks.

void ServerModel::tick(uint64_t number, double now) {
  if (number != tick_number_ || ticking_ != Ticking::waits || here_.empty()) return;
  tick_began_ = now;
  was_free_ = drawing_ == Drawing::nothing || drawing_ended_;
  if (drawing_ended_) finish_drawing();
  count_walkers();
  ticking_ = Ticking::reads;
  cores_.add(tick_task, hall_.costs.tick + hall_.costs.tick_visitor * double(here_.size()), 1, now);
  plan_work(now);
}

void ServerModel::work(uint64_t number, double now) {
  if (number != work_number_) return;
  for (int id; (id = cores_.finish(now)) >= 0;) {
    if (id == drawing_task) {
      drawing_took_ = now - drawing_began_;
      drawing_ended_ = true;
      if (counts_) rendered_ += drawing_took_;
      if (ticking_ == Ticking::waits) plan_tick(now);
    } else if (id >= first_encoding) {
      send(id - first_encoding, now);
    } else if (ticking_ == Ticking::reads) {
      if (was_free_) decide(now);
      to_present_ = here_;
      std::ranges::stable_sort(to_present_, {}, [&](int one) { return guest(one).pictured_at; });
      presented_ = 0, present_began_ = now;
      present(now);
    } else if (const int index = to_present_[presented_ - 1]; index != nobody) {
      Guest& one = guest(index);
      one.warping += (now - warp_began_ - one.warping) * (one.warping > 0 ? smoothed : 1);
      const double pixels = hall_.demand.pixels;
      encode(index, seq_at(one, tick_began_), hall_.costs.encode_picture.at(pixels),
             hall_.costs.picture_bytes.at(pixels), false, now);
      present(now);
    } else {
      present(now);  // whoever it was for has left
    }
  }
  plan_work(now);
}

void ServerModel::present(double now) {
  while (presented_ < to_present_.size() && now - present_began_ <= presenting) {
    const int index = to_present_[presented_++];
    if (index == nobody || !show(index, now)) continue;
    ticking_ = Ticking::warps;
    return;
  }
  end_tick(now);
}

void ServerModel::end_tick(double now) {
  if (counts_) ticked_ += now - tick_began_;
  ticking_ = Ticking::waits;
  if (!here_.empty()) plan_tick(drawing_ended_ ? now : now + wait(now));
}

// Returns the seconds until the next tick, if the renderer does not end before.
double ServerModel::wait(double now) const {
  double seconds = listening_interval;
  for (const int index : here_) {
    const Guest& one = hall_.guests[size_t(index)];
    if (one.doing == Doing::rests || one.drawn_seq < 0) continue;
    if (one.unshown || (is_walking(one) && !hall_.demand.local))
      seconds = std::min(seconds, one.pictured_at + 1 / picture_rate(one) - now);
  }
  return std::max(seconds, least_wait);
}

// ---- Drawing.

KeyframePace ServerModel::pace_of(const Guest& one, double now) const {
  const Demand& demand = hall_.demand;
  const double longest = longest_use(demand.local, is_in_turn(one, now));
  const double drawing =
      one.drawing > 0 ? one.drawing : hall_.costs.draw.at(demand.pixels) / width_;
  return pace_keyframe(drawing, walkers_, one.scale, longest);
}

double ServerModel::picture_rate(const Guest& one) const {
  const Demand& demand = hall_.demand;
  const CostCurve& sizes = demand.local ? hall_.costs.keyframe_bytes : hall_.costs.picture_bytes;
  const double bytes = sizes.at(demand.pixels * one.scale * one.scale);
  const double rate = std::min(finished_rate(showing_), line_share * demand.bandwidth / bytes);
  return std::max(demand.local ? std::min(rate, most_keyframes) : rate, 1.0);
}

double ServerModel::drawing_rate(const Guest& one, double now) const {
  if (!is_walking(one)) return now - one.stood_at < settled_seconds ? learning_rate : rested_rate;
  return std::min(picture_rate(one), 1 / pace_of(one, now).period);
}

// Returns the renderer's seconds for samples of the picture that is begun.
double ServerModel::sampling(const Guest& one, int waiting, double now) const {
  const double pixels = hall_.demand.pixels * job_scale_ * job_scale_;
  const double speed = hall_.costs.samples * cores_.cores();
  const double drawing = (one.drawing > 0 ? one.drawing : hall_.costs.draw.at(pixels) / width_) *
                         job_scale_ / one.scale;
  return sampling_seconds(drawing, 1 / drawing_rate(one, now), waiting, walkers_,
                          least_samples / speed, most_a_pixel * pixels / speed);
}

// Takes from what was asked for what workers trace until the next keyframe, but for the time that
// requests and answers are on their way. Returns the seconds that are left for the renderer.
double ServerModel::left_to_trace(Guest& one, double now) {
  const double speed = hall_.costs.samples * cores_.cores(), asked = job_sampling_ * speed;
  double traced = 0;
  if (hall_.worker_samples > 0) {
    const double most = hall_.worker_samples * credit_seconds;
    credit_ = std::min(credit_ + (now - credited_at_) * hall_.worker_samples, most);
    credited_at_ = now;
    const double useful =
        std::max(now - std::max(one.drawn_at, one.came_at) - hall_.worker_trip, 0.0);
    traced = std::min(credit_, useful * hall_.worker_samples);
    credit_ -= traced;
  }
  if (counts_) one.counted.samples += std::max(traced, asked);
  return std::max(asked - traced, 0.0) / speed;
}

void ServerModel::finish_drawing() {
  drawing_ended_ = false;
  const Drawing what = std::exchange(drawing_, Drawing::nothing);
  if (what == Drawing::samples) {
    for (const int index : asking_) guest(index).served += drawing_took_ / double(asking_.size());
    asking_.clear();
    return;
  }
  Guest& one = guest(drawn_);
  if (one.visit != drawn_visit_) return;
  one.served += drawing_took_ * (is_walking(one) ? 1 : standing_weight);
  if (what == Drawing::wide) {
    one.wide_drawn = true, one.wide_at = tick_began_;
    one.wide_unsent = hall_.demand.local;
    return;
  }
  one.drawing *= job_scale_ / one.scale;
  one.drawing += (drawing_took_ - one.drawing) * (one.drawing > 0 ? soon : 1);
  one.scale = job_scale_;
  one.drawn_seq = job_seq_;
  one.unshown = true;
  one.asked_seconds = is_walking(one) ? left_to_trace(one, tick_began_) : 0;
  one.drawn_at = job_time_;
  one.wide_drawn = false;
  if (counts_) one.counted.keyframes++;
}

int ServerModel::next_to_draw(double now, int& waiting, double& least_served) const {
  int least = -1, first = -1;
  waiting = 0;
  auto without = [](const Guest& one) { return std::max(one.sent_at, one.came_at); };
  auto since = [&](const Guest& one) {
    return std::pair(std::max(one.served, served_), std::max(one.drawn_at, one.came_at));
  };
  auto gap = [&](const Guest& one) { return std::max(without(one), one.drawn_at); };
  for (const int index : here_) {
    const Guest& one = hall_.guests[size_t(index)];
    if (one.doing == Doing::rests || one.in_flight >= max_in_flight) continue;
    if (!is_walking(one) && one.unshown) continue;
    if (now - one.drawn_at < 1 / drawing_rate(one, now) - on_time) continue;
    waiting++;
    if (least < 0 || since(one) < since(hall_.guests[size_t(least)])) least = index;
    if (!is_walking(one) || now - without(one) <= longest_gap) continue;
    if (first < 0 || gap(one) < gap(hall_.guests[size_t(first)])) first = index;
  }
  if (least >= 0) least_served = std::max(hall_.guests[size_t(least)].served, served_);
  return first < 0 ? least : first;
}

void ServerModel::decide(double now) {
  double seconds = 0;
  for (const int index : here_)
    if (Guest& one = guest(index); one.asked_seconds > 0) {
      seconds += std::exchange(one.asked_seconds, 0.0);
      asking_.push_back(index);
    }
  if (!asking_.empty()) {
    drawing_ = Drawing::samples, drawing_began_ = now;
    return cores_.hold(drawing_task, seconds, cores_.cores(), now);
  }
  int waiting = 0;
  double served = 0;
  if (const int next = next_to_draw(now, waiting, served); next >= 0) {
    served_ = served;
    draw(next, waiting, now);
  }
}

void ServerModel::draw(int index, int waiting, double now) {
  Guest& one = guest(index);
  const Costs& costs = hall_.costs;
  one.served = std::max(one.served, served_);
  drawn_ = index, drawn_visit_ = one.visit;
  drawing_began_ = now, job_time_ = tick_began_;
  const bool walks = is_walking(one);
  const bool wide = walks && one.drawn_seq >= 0 && !one.wide_drawn && costs.wide_rate > 0 &&
                    now - one.wide_at >= 1 / costs.wide_rate;
  if (wide) {
    drawing_ = Drawing::wide;
    return cores_.add(drawing_task, costs.draw.at(hall_.demand.pixels * wide_share), width_, now);
  }
  drawing_ = Drawing::keyframe;
  job_scale_ = walks && one.drawn_seq >= 0 ? pace_of(one, now).scale : 1;
  job_seq_ = seq_at(one, tick_began_);
  job_sampling_ = walks ? sampling(one, waiting, now) : 0;
  const double slice = walks ? 0 : slice_seconds * width_;
  const double pixels = hall_.demand.pixels * job_scale_ * job_scale_;
  cores_.add(drawing_task, costs.draw.at(pixels) + slice, width_, now);
}

// ---- Pictures on their way.

// Shows a visitor what is new. Returns whether a picture is warped first.
bool ServerModel::show(int index, double now) {
  Guest& one = guest(index);
  const Costs& costs = hall_.costs;
  if (one.doing == Doing::rests || one.in_flight >= max_in_flight || one.encodes ||
      one.drawn_seq < 0)
    return false;
  const double pixels = hall_.demand.pixels * one.scale * one.scale;
  if (hall_.demand.local || !is_walking(one)) {
    const CostCurve& work = hall_.demand.local ? costs.encode_keyframe : costs.encode_picture;
    const CostCurve& sizes = hall_.demand.local ? costs.keyframe_bytes : costs.picture_bytes;
    if (one.unshown) {
      encode(index, one.drawn_seq, work.at(pixels), sizes.at(pixels), false, now);
    } else if (std::exchange(one.wide_unsent, false)) {
      const double few = hall_.demand.pixels * wide_share;
      encode(index, -1, work.at(few), sizes.at(few), true, now);
    }
    return false;
  }
  const bool waits = one.pictured_at > now;
  if (waits && !one.unshown) return false;
  if (!waits && now - one.pictured_at < 1 / picture_rate(one) - on_time) return false;
  warp_began_ = now;
  cores_.add(tick_task, costs.warp.at(hall_.demand.pixels), cores_.cores(), now);
  return true;
}

void ServerModel::encode(int index, int seq, double cost, double bytes, bool wide, double now) {
  Guest& one = guest(index);
  one.encodes = true, one.encode_began = now;
  one.in_flight++;
  if (!wide) {
    const double period = 1 / picture_rate(one);
    one.pictured_at = std::clamp(one.pictured_at + period, now - 0.5 * period, now);
    one.sent_at = now;
    one.unshown = false;
  }
  size_t slot = 0;
  while (slot < encodings_.size() && encodings_[slot].guest >= 0) slot++;
  if (slot == encodings_.size()) encodings_.emplace_back();
  encodings_[slot] = {index, seq, one.visit, bytes, wide};
  cores_.add(first_encoding + int(slot), cost, 1, now);
}

void ServerModel::send(int slot, double now) {
  const Encoding sent = std::exchange(encodings_[size_t(slot)], {});
  Guest& one = guest(sent.guest);
  if (one.visit != sent.visit) return;
  one.encodes = false;
  if (!sent.wide) {
    const double took = now - one.encode_began;
    one.encoding += (took - one.encoding) * (one.encoding > 0 ? smoothed : 1);
  }
  if (counts_) one.counted.bytes += sent.bytes, sent_ += sent.bytes;
  network_free_ = std::max(now, network_free_) + sent.bytes / hall_.machine.bandwidth;
  one.line_free = std::max(network_free_, one.line_free) + sent.bytes / hall_.demand.bandwidth;
  hall_.events.push(one.line_free + hall_.demand.latency,
                    {EventKind::arrival, index_, sent.guest, sent.visit, sent.seq});
}

}  // namespace wellspring::plan
