// SPDX-License-Identifier: Apache-2.0
#include "avatar/story/timeline.h"

#include <algorithm>

#include "avatar/body/gesture.h"
#include "avatar/speech/text.h"

namespace wellspring::avatar {

namespace {

// Returns when the word at or after byte `at` begins; after the last word, when that ends.
double word_time(const StoryLine& line, const Speech* speech, double seconds, uint32_t at) {
  if (!speech || speech->words.empty()) {
    double all = double(std::max<size_t>(1, count_characters(line.text, line.text.size())));
    return seconds * double(count_characters(line.text, at)) / all;
  }
  for (const SpeechWord& word : speech->words)
    if (word.text_end > at) return word.begin;
  return speech->words.back().end;
}

ActionEvent event_of(const StoryMark& mark) {
  return {mark.kind, mark.name, mark.weight, 0, mark.piece};
}

// Returns how long before its word a mark begins, so that its action is there with the word.
double lead_of(const StoryMark& mark) {
  switch (mark.kind) {
    case StoryMarkKind::gesture: {
      int clip = find_gesture(mark.name);
      return clip >= 0 ? double(default_gestures().clips[size_t(clip)].stroke) : 0;
    }
    case StoryMarkKind::point: return point_lead;
    case StoryMarkKind::look: return look_lead;
    case StoryMarkKind::hold: return mark.name.empty() ? 0 : hold_lead;
    default: return 0;
  }
}

}  // namespace

Timeline make_timeline(const StoryLine& line, const Speech* speech, double seconds) {
  Timeline timeline;
  for (const StoryMark& mark : line.marks) {
    TimelineAction action{word_time(line, speech, seconds, mark.at), event_of(mark)};
    double begin = std::max(action.time - lead_of(mark), earliest_action);
    action.event.lead = float(action.time - begin);
    action.time = begin;
    timeline.actions.push_back(std::move(action));
  }
  std::stable_sort(
      timeline.actions.begin(), timeline.actions.end(),
      [](const TimelineAction& a, const TimelineAction& b) { return a.time < b.time; });
  return timeline;
}

std::vector<const ActionEvent*> advance_timeline(const Timeline& timeline, size_t& cursor,
                                                 double now) {
  std::vector<const ActionEvent*> events;
  while (cursor < timeline.actions.size() && timeline.actions[cursor].time <= now)
    events.push_back(&timeline.actions[cursor++].event);
  return events;
}

void hold(StoryHold& held, const ActionEvent& event) {
  switch (event.kind) {
    case StoryMarkKind::emotion:
      held.emotion = event.name;
      held.emotion_weight = event.name.empty() ? 0 : event.weight;
      break;
    case StoryMarkKind::look: held.look = event.name; break;
    case StoryMarkKind::point:
      held.point = event.name;
      if (!event.name.empty()) held.look = event.name;
      break;
    case StoryMarkKind::hold: held.prop = event.name; break;
    default: break;
  }
}

StoryHold hold_before(const std::vector<StoryLine>& lines, size_t index) {
  StoryHold held;
  for (size_t i = 0; i < std::min(index, lines.size()); i++) {
    for (const StoryMark& mark : lines[i].marks) hold(held, event_of(mark));
    held.point.clear();  // an arm is not held out from one sentence to the next
  }
  return held;
}

}  // namespace wellspring::avatar
