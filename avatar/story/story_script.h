// SPDX-License-Identifier: Apache-2.0
// Holds a story as its author wrote it, in one language: sentences, how they are spoken, and marks
// for face, hands, eyes and camera between their words. docs/stories.md describes the markup; plain
// text and SSML 1.1 are read by the same reader.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "avatar/speech/text.h"
#include "avatar/story/story_markup.h"

namespace wellspring::avatar {

// Finds the sentences of a paragraph, in any language that ends them with . ! ? or an ellipsis.

struct TextSpan {
  uint32_t begin = 0, end = 0;  // bytes, without spaces around
};

// Finds sentences. A full stop after a number of one or two digits ("13. Jahrhundert") or a single
// letter ("z. B.") ends nothing, nor does one that a small letter follows; closing quotes and
// brackets belong to the sentence.
std::vector<TextSpan> find_sentences(std::string_view text);

struct Speech;

enum class StoryMarkKind : uint8_t { emotion, gesture, look, point, hold, view, show, beat, mark };

// Says how a piece of the exhibit is seen from a mark on. All that is left out stays as it is.
struct PieceMark {
  std::string layer, over;      // ids of layers; `over` is mixed in, empty: none is
  float share = 0.5f;           // 0..1, how much is seen of `over`
  std::optional<float> turn{};  // degrees to the left, by which a volume is turned
  std::optional<float> cut{};   // 0..1, share of its depth that is cut away from the front
};

struct StoryMark {
  StoryMarkKind kind = StoryMarkKind::mark;
  // byte of StoryLine::text before which it stands; the text's size: after the last word
  uint32_t at = 0;
  std::string name;   // emotion, gesture, object, prop, viewpoint, piece or mark; empty: none
  float weight = 1;   // 0..1
  MarkupPlace place;  // in the file
  PieceMark piece{};  // says more where kind is show
};

// This is a sentence: one subtitle, spoken in one breath.
struct StoryLine {
  std::string text;                 // as subtitles show it
  std::vector<SpeechStyle> styles;  // in its bytes
  std::vector<StoryMark> marks;     // in order of `at`
  float pause = 0;                  // seconds of silence after it, besides the breath
  // a narrator's recording, instead of a synthesis; null: none
  std::shared_ptr<const Speech> recording{};
  std::string file;  // file of `place`, for messages
  MarkupPlace place;
};

struct StoryNote {
  MarkupPlace place;
  std::string what;
};

struct StoryScript {
  std::vector<StoryLine> lines;
  std::vector<StoryNote> notes;  // requests that are not met; each unknown tag once
};

inline constexpr float paragraph_pause = 0.6f;
inline constexpr size_t most_line_bytes = 2000;

// Reads a story, which has a line at least. Throws LoadError{file, "line l, column c", what}: as
// read_markup; a time, a number or a name missing or out of range; nothing to say; a sentence
// longer than most_line_bytes.
StoryScript read_story(std::string_view text, const std::string& file);
// Reads a text without markup in the same way: an empty line divides paragraphs.
StoryScript read_plain_story(std::string_view text, const std::string& file);
// Reads subtitles (WebVTT) in the same way. Their cues are one running text: a sentence may go on
// in the next.
StoryScript read_subtitle_story(std::string_view text, const std::string& file);
// Reads one line whatever it says: a greeting, or a sentence of a list. <s> and <p> inside still
// divide.
StoryScript read_story_line(std::string_view text, const std::string& file);

}  // namespace wellspring::avatar
