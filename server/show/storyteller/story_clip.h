// SPDX-License-Identifier: Apache-2.0
// A story acted without a show: what the storyteller's body does while it is told, moment by
// moment. For pictures to look at, and for tests that it is the same every time.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "avatar/figure/character.h"
#include "avatar/figure/rig.h"
#include "avatar/mind/storyteller.h"
#include "avatar/speech/speech.h"
#include "frame/frame.h"
#include "show/exhibit/exhibit.h"
#include "show/storyteller/held_prop.h"

namespace wellspring::show {

// A figure in a photographer's portrait scene, to look at: soft area lights, a floor that curves up
// into the background.

struct PortraitShot {
  int width = 720, height = 1080, spp = 64;
  bool close = false;  // head and shoulders instead of the whole figure
  float turn =
      0;  // camera's way round the figure, radians; 0: before its face, positive: to its left
  // Thing that it holds, in humanoid space, one of an exhibit's props; null: nothing.
  const Exhibit* exhibit = nullptr;
  HeldProp held;
};

// All cores; seconds. Pictures of the figure that cannot be read are named in `warnings`.
Frame render_portrait(const Character& character, const Pose& pose, const PortraitShot& shot,
                      std::vector<std::string>& warnings);

// A contact sheet: one figure in many poses, each picture with its name below.

struct SheetCell {
  std::string label;
  Pose pose;
};

// `shot` is that of one cell; columns <= 0: as many as make the sheet about as wide as high. All
// cores; seconds a cell. Empty where there is no cell.
Frame render_sheet(const Character& character, const std::vector<SheetCell>& cells,
                   const PortraitShot& shot, int columns, std::vector<std::string>& warnings);

// Writes `text` into a picture with its upper left corner at x, y, in letters 7 * scale pixels
// high; what lies outside is cut off.
void draw_text(Frame& frame, const std::string& text, int x, int y, int scale, vec3 color);
int text_width(const std::string& text, int scale);

struct StoryMoment {
  double time = 0;   // seconds from the beginning
  double sound = 0;  // place in the speech of the sentence that is told
  int sentence = 0;
  Pose pose;
};

struct ClipSettings {
  std::string lang = "en";
  double seconds = 1e9;  // ends earlier when the story does
  double fps = 30;
  bool humanlike = true;
  vec3 guest{0.2f, 1.6f, 1.6f};  // eyes of the one it is told to, humanoid space
};

// `spoken` are the speeches of the story's lines in that language; null: as long as they take to
// read. Objects of `exhibit` are looked and pointed at; its storyteller stands where the exhibit
// has it.
std::vector<StoryMoment> act_story(const Exhibit& exhibit, const Character& character,
                                   const mat4& placement, const StoryText& story,
                                   const std::vector<std::shared_ptr<const Speech>>& spoken,
                                   const ClipSettings& settings);

}  // namespace wellspring::show
