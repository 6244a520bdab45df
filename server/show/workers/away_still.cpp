// SPDX-License-Identifier: Apache-2.0
#include "show/workers/away_still.h"

#include <algorithm>
#include <numeric>

#include "picture/still/reconstruct_still.h"

namespace wellspring::show {
namespace {

// Differs from the seed of samples that are traced here (StillSettings::seed).
constexpr uint64_t still_sequence = 0x7374696c6c73;
constexpr int most_at_once = 8192, least_at_once = 256;  // requests

}  // namespace

AwayStill::AwayStill(const AwayScene& scene, const View& view, const cache::TraceJob& job, int most,
                     Crew::TraceHere trace)
    : scene_(scene),
      view_(view),
      job_(job),
      trace_(std::move(trace)),
      most_(uint64_t(std::max(most, 0)) * uint64_t(view.width) * uint64_t(view.height)),
      asker_(scene.crew && most > 0 ? scene.crew->begin_apart() : 0) {}

AwayStill::~AwayStill() {
  if (asker_ != 0) scene_.crew->end_apart(asker_);
}

void AwayStill::ask() {
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock || asker_ == 0) return;
  take();
  const int room = std::min(scene_.crew->room(true), most_at_once);
  const int count = int(std::min<uint64_t>(uint64_t(std::max(room, 0)), most_ - asked_));
  if (count < least_at_once) return;
  requests_.clear();
  plan_still(view_, asked_, count, still_sequence, requests_);
  asked_ += uint64_t(count);
  broker_.ask(view_, job_, requests_);
  scene_.crew->send(broker_, {asker_, true, 0, scene_.state, scene_.light, true}, count, trace_);
}

void AwayStill::take() {
  for (const CrewSamples& some : scene_.crew->take_apart(asker_))
    for (const Answer& answer : some.answers)
      for (size_t i = 0; i < answer.samples.size(); i++) {
        light_.resize(size_t(view_.width) * size_t(view_.height));
        counts_.resize(light_.size());
        const size_t pixel = answer.piece.requests[i].pixel;
        light_[pixel] += answer.samples[i].radiance();
        counts_[pixel]++;
      }
}

float AwayStill::add_to(Frame& frame, int here) {
  const std::lock_guard lock(mutex_);
  if (asker_ == 0) return float(here);
  take();
  if (light_.empty()) return float(here);
  for (size_t i = 0; i < light_.size(); i++)
    frame.color[i] = (float(here) * frame.color[i] + light_[i]) / float(here + counts_[i]);
  const double all = std::accumulate(counts_.begin(), counts_.end(), 0.0);
  return float(here) + float(all / double(counts_.size()));
}

}  // namespace wellspring::show
