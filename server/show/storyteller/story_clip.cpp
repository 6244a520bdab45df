// SPDX-License-Identifier: Apache-2.0
#include "show/storyteller/story_clip.h"

#include <algorithm>

#include "show/storyteller/story_marks.h"

namespace wellspring::show {

std::vector<StoryMoment> act_story(const Exhibit& exhibit, const Character& character,
                                   const mat4& placement, const StoryText& story,
                                   const std::vector<std::shared_ptr<const Speech>>& spoken,
                                   const ClipSettings& settings) {
  Storyteller storyteller{&character, placement};
  StorytellerState state;
  StorytellerEvents events;
  Voice voice;
  tell(voice, story);
  AskSpeech ask = [&](const Utterance&) {
    size_t line = size_t(voice.sentence);
    return SpeechState{line < spoken.size() ? spoken[line] : nullptr, false, settings.lang};
  };
  StorytellerInput input;
  input.humanlike = settings.humanlike;
  input.guests = {{1, vec3(placement * vec4(settings.guest, 1)), vec3(0), true}};
  // She has stood there for a while, has seen who is there and has greeted.
  Pose pose = make_rest_pose(character);
  for (int i = 0; i < 150; i++) {
    input.dt = 1.0f / 30;
    input.time += double(input.dt);
    tick_storyteller(state, storyteller, input, pose, events);
  }
  std::vector<StoryMoment> moments;
  const double step = 1 / std::clamp(settings.fps, 1.0, 240.0);
  for (double time = 0; time < settings.seconds && !voice.queue.empty(); time += step) {
    VoiceEvents said = advance_voice(voice, time == 0 ? 0 : float(step), ask);
    input.dt = float(step);
    input.time += step;
    input.telling = !voice.story.empty();
    input.speaking = speaking(voice);
    input.visemes.reset();
    if (heard(voice)) input.visemes = mouth_shape(voice);
    input.story = make_cue(exhibit, voice, said);
    tick_storyteller(state, storyteller, input, pose, events);
    moments.push_back({time, double(voice.elapsed), voice.sentence, pose});
  }
  return moments;
}

}  // namespace wellspring::show
