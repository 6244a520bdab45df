// SPDX-License-Identifier: Apache-2.0
#include "correction_queue.h"

#include <algorithm>
#include <cmath>

namespace wellspring::test {
namespace {

CorrectionSettings usable(CorrectionSettings settings) {
  settings.levels = std::clamp(settings.levels, 1, most_sqrt5_levels);
  settings.job = std::max(settings.job, 1);
  settings.decay = settings.decay > 0 ? std::min(settings.decay, 1.0f) : 0.85f;
  return settings;
}

PixelBox clip(const PixelBox& box, const View& view) {
  return {std::max(box.x0, 0), std::max(box.y0, 0), std::min(box.x1, view.width),
          std::min(box.y1, view.height)};
}

}  // namespace

CorrectionQueue::CorrectionQueue(const CorrectionSettings& settings)
    : settings_(usable(settings)), grid_(make_sqrt5_grid(settings_.levels)) {}

bool CorrectionQueue::is_later(const Entry& a, const Entry& b) {
  if (a.region.priority != b.region.priority) return a.region.priority < b.region.priority;
  return a.turn > b.turn;
}

void CorrectionQueue::put(Entry entry) {
  entry.turn = turns_++;
  waiting_.push_back(std::move(entry));
  std::push_heap(waiting_.begin(), waiting_.end(), is_later);
}

CorrectionQueue::Entry CorrectionQueue::begin_of(const CorrectionRegion& region) const {
  Entry entry;
  entry.region = region;
  entry.places = Sqrt5Places(grid_, 1, region.box);
  return entry;
}

bool CorrectionQueue::next_level(Entry& entry) {
  if (++entry.level > grid_.levels) return false;
  entry.region.priority *= settings_.decay;
  entry.places = Sqrt5Places(grid_, entry.level, entry.region.box);
  return true;
}

void CorrectionQueue::submit(CorrectionPlan plan) {
  bool usable = plan.object.size() == size_t(plan.view.width) * size_t(plan.view.height);
  std::vector<CorrectionRegion> regions = std::move(plan.regions);
  std::erase_if(regions, [&](CorrectionRegion& region) {
    region.box = clip(region.box, plan.view);
    bool wanted = std::isfinite(region.priority) && region.priority > 0;
    return !usable || region.object == 0 || region.box.empty() || !wanted;
  });

  std::lock_guard lock(mutex_);
  plans_++;
  std::vector<Entry> known;
  if (plan.view == plan_.view && plan.object == plan_.object) {
    known = std::move(waiting_);
    known.insert(known.end(), done_.begin(), done_.end());
  }
  waiting_.clear();
  done_.clear();
  std::swap(plan_, plan);  // the old one is freed after the lock
  for (const CorrectionRegion& region : regions) {
    auto found = std::find_if(known.begin(), known.end(), [&](const Entry& entry) {
      return entry.region.object == region.object && entry.region.box == region.box;
    });
    Entry entry = found == known.end() ? begin_of(region) : *found;
    if (found != known.end()) known.erase(found);
    entry.region.priority = region.priority * std::pow(settings_.decay, float(entry.level - 1));
    if (entry.level > grid_.levels) done_.push_back(std::move(entry));
    else put(std::move(entry));
  }
}

bool CorrectionQueue::take(CorrectionJob& job) {
  job.places.clear();
  for (;;) {
    std::lock_guard lock(mutex_);
    if (waiting_.empty()) return false;
    std::pop_heap(waiting_.begin(), waiting_.end(), is_later);
    Entry entry = std::move(waiting_.back());
    waiting_.pop_back();
    job.plan = plans_;
    job.view = plan_.view;
    job.age = plan_.age;
    job.object = entry.region.object;
    job.level = entry.level;
    job.priority = entry.region.priority;
    job.position = entry.places.position();
    bool more = true;
    ivec2 place;
    for (int i = 0; i < most_scanned && int(job.places.size()) < settings_.job; i++) {
      if (!(more = entry.places.next(place))) break;
      size_t pixel = size_t(place.y) * size_t(plan_.view.width) + size_t(place.x);
      if (plan_.object[pixel] == job.object) job.places.push_back(place);
      else stats_.skipped++;
    }
    stats_.places += job.places.size();
    // A level that ends with this job is found out by who takes it next, at no cost but this.
    if (more || next_level(entry)) put(std::move(entry));
    else done_.push_back(std::move(entry));
    if (!job.places.empty()) return true;
  }
}

uint64_t CorrectionQueue::plan() const {
  std::lock_guard lock(mutex_);
  return plans_;
}
bool CorrectionQueue::empty() const {
  std::lock_guard lock(mutex_);
  return waiting_.empty();
}
CorrectionStats CorrectionQueue::stats() const {
  std::lock_guard lock(mutex_);
  return stats_;
}

}  // namespace wellspring::test
