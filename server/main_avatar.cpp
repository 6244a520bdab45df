// SPDX-License-Identifier: Apache-2.0
// Runs `wellspring avatar FILE`: inspects an H-Anim figure, and takes a picture of it as it stands
// there and breathes.
#include <CLI/CLI.hpp>
#include <cmath>
#include <iostream>

#include "about/version.h"
#include "avatar/face/expression_rules.h"
#include "avatar/face/expression_sum.h"
#include "avatar/figure/bone_surface.h"
#include "avatar/figure/figure_check.h"
#include "avatar/figure/joint_constraints.h"
#include "avatar/figure/retarget.h"
#include "avatar/load/character_load.h"
#include "avatar/mind/storyteller.h"
#include "avatar/speech/visemes.h"
#include "base/load_error.h"
#include "base/log.h"
#include "base/unicode.h"
#include "frame/picture_file.h"
#include "show/exhibit/load/exhibit_load.h"
#include "show/storyteller/story_clip.h"

namespace wellspring::program {
namespace {

struct Options {
  std::string file, out, size = "720x1080";
  std::vector<std::string> displacers;
  std::string gesture, motion, skinning, sheet, exhibit, hold;
  std::vector<std::string> expressions;
  std::vector<float> point, appearance;
  std::vector<float> guest;
  bool list_gestures = false, info = false, json = false, close = false, rest = false, calm = false;
  double time = 0;
  float turn = 0, speaking = 0;
  int spp = 64;
};

bool read_size(const std::string& text, PortraitShot& shot) {
  char rest = 0;
  return std::sscanf(text.c_str(), "%dx%d%c", &shot.width, &shot.height, &rest) == 2 &&
         shot.width >= 16 && shot.height >= 16 && shot.width <= 8192 && shot.height <= 8192;
}

// Returns the pose of the figure after `time` seconds of standing there, alone or before a guest;
// `held`: what it holds of that exhibit's props.
Pose pose_at(const Character& character, const Options& options, const Exhibit& exhibit,
             HeldProp& held) {
  Pose pose = make_rest_pose(character);
  if (options.rest) return pose;
  Storyteller storyteller{&character, mat4(1)};
  StorytellerState state;
  StorytellerInput input;
  StorytellerEvents events;
  input.humanlike = !options.calm;
  input.speaking = options.speaking;
  if (options.guest.size() == 3)
    input.guests = {{1, {options.guest[0], options.guest[1], options.guest[2]}, vec3(0), true}};
  auto place = [](const std::vector<float>& at) {
    return at.size() == 3 ? std::optional(vec3(at[0], at[1], at[2])) : std::nullopt;
  };
  input.story.point = place(options.point);
  input.story.look = place(options.appearance);
  input.story.held = find_held_thing(exhibit, options.hold);
  input.story.gesture = options.gesture;
  input.story.gesture_lead = 60;  // seconds; the gesture starts from its beginning
  if (int clip = find_gesture(options.gesture); clip >= 0)
    input.story.gesture_lead = default_gestures().clips[size_t(clip)].stroke;
  constexpr double step = 1.0 / 30;
  tick_storyteller(state, storyteller, input, pose, events);
  input.story.gesture.clear();
  for (double t = 0; t < options.time; t += step) {
    input.dt = float(std::min(step, options.time - t));
    input.time = t + double(input.dt);
    tick_storyteller(state, storyteller, input, pose, events);
    advance_held(exhibit, storyteller, state, pose, true, input.dt, held);
  }
  return pose;
}

std::vector<std::string> gesture_names() {
  std::vector<std::string> names;
  for (const GestureClip& clip : default_gestures().clips) names.push_back(clip.name);
  return names;
}

std::vector<std::string> expression_names() {
  std::vector<std::string> names;
  for (const NamedExpression& known : default_expressions().expressions)
    if (known.name[0] != '_') names.push_back(known.name);
  return names;
}

// Prints the names that stories and the options below may use.
void print_gestures() {
  std::cout << "gestures\n";
  for (const GestureClip& clip : default_gestures().clips)
    std::cout << "  " << clip.name << std::string(16 - std::min<size_t>(15, clip.name.size()), ' ')
              << clip.about << "\n";
  std::cout << "emotions\n  neutral";
  for (std::string_view name : emotion_names) std::cout << " " << name;
  std::cout << "\nexpressions\n  " << list_names(expression_names(), 200) << "\n";
}

// Returns the motion of that name in the figure's file, else the first motion of the file that
// `wanted` names, or the one named after '#'.
Motion find_motion(const Character& character, const std::string& wanted) {
  for (const Motion& motion : character.motions)
    if (motion.name == wanted) return motion;
  std::string file = wanted, name;
  if (size_t hash = wanted.rfind('#'); hash != std::string::npos) {
    file = wanted.substr(0, hash);
    name = wanted.substr(hash + 1);
  }
  Character other = load_character(file);
  for (Motion& motion : other.motions)
    if (name.empty() || motion.name == name) return std::move(motion);
  throw LoadError(file, "", name.empty() ? "has no motion" : "has no motion '" + name + "'");
}

// Shows named expressions instead of the pose's own face. Throws std::invalid_argument for unknown
// names.
void show_expressions(const Character& character, const std::vector<std::string>& settings,
                      Pose& pose) {
  const ExpressionSet& set = default_expressions();
  ExpressionRig rig = make_expression_rig(set, character);
  ExpressionSum sum;
  clear(sum, rig);
  for (const std::string& setting : settings) {
    size_t equals = setting.find('=');
    int expression = find_expression(set, setting.substr(0, equals));
    if (expression < 0) {
      const std::string name = setting.substr(0, equals);
      const std::vector<std::string> names = expression_names();
      throw std::invalid_argument("--expression: there is no '" + name + "'" +
                                  did_you_mean(name, names) + "; there are " +
                                  list_names(names, 200));
    }
    add(sum, rig, expression,
        equals == std::string::npos ? 1 : float(std::atof(setting.c_str() + equals + 1)));
  }
  apply_rotators(sum, rig, pose);
  apply_controls(sum, rig, pose);
}

// Returns a cell for every expression of an emotion, or every mouth shape, over the same pose.
std::vector<SheetCell> sheet_cells(const Character& character, const std::string& sheet,
                                   const Pose& pose) {
  const ExpressionSet& set = default_expressions();
  ExpressionRig rig = make_expression_rig(set, character);
  std::vector<SheetCell> cells;
  auto add_cell = [&](std::string label, int expression) {
    if (expression >= 0 && !shows(rig, expression)) label += " (nothing)";
    ExpressionSum sum;
    clear(sum, rig);
    add(sum, rig, expression, 1);
    cells.push_back({label, pose});
    apply_rotators(sum, rig, cells.back().pose);
    apply_controls(sum, rig, cells.back().pose);
  };
  if (sheet == "visemes") {
    for (size_t i = 0; i < viseme_count; i++) add_cell(viseme_names[i], rig.viseme[i]);
    return cells;
  }
  add_cell("neutral", -1);
  for (size_t i = 0; i < emotion_count; i++)
    add_cell(std::string(emotion_names[i]), rig.emotion[i]);
  return cells;
}

int fail(const std::string& text, int status) {
  std::cerr << text << "\n";
  return status;
}

int run(Options options) {
  PortraitShot shot;
  if (!read_size(options.size, shot)) return fail("--size wants WIDTHxHEIGHT, 16 to 8192 each", 2);
  if (!options.out.empty() && !is_picture_name(options.out))
    return fail("--out: no kind of picture we write", 2);
  if (!(options.time >= 0 && options.time <= 86400))
    return fail("--time wants 0 to 86400 seconds", 2);
  if (!options.guest.empty() && options.guest.size() != 3) return fail("--guest wants x,y,z", 2);
  if (!options.gesture.empty() && find_gesture(options.gesture) < 0) {
    const std::vector<std::string> names = gesture_names();
    return fail("--gesture: there is no '" + options.gesture + "'" +
                    did_you_mean(options.gesture, names) + "; there are " + list_names(names, 200),
                2);
  }
  shot.close = options.close || !options.sheet.empty();
  shot.turn = options.turn * pi / 180;
  shot.spp = options.spp;

  Exhibit exhibit;
  if (!options.exhibit.empty()) {
    exhibit = load_exhibit(options.exhibit);
    shot.exhibit = &exhibit;
  }
  if (!options.hold.empty() && find_prop(exhibit, options.hold) < 0)
    return fail("--hold: " + unknown_prop(exhibit, options.hold), 2);
  Character character = load_character(options.file);
  if (!options.skinning.empty())
    character.skinning =
        options.skinning == "linear" ? Skinning::linear : Skinning::dual_quaternion;
  if (options.json) std::cout << describe_json(character);
  else if (options.info || options.out.empty()) std::cout << describe_text(character);
  if (options.out.empty()) return 0;
  bool is_motion = character.parts.empty();  // a file without a surface is shown by its motion
  add_bone_surface(character);

  if (options.motion.empty() && is_motion && !character.motions.empty())
    options.motion = character.motions[0].name;
  Pose pose = options.motion.empty() ? pose_at(character, options, exhibit, shot.held)
                                     : make_rest_pose(character);
  if (!options.motion.empty()) {
    Motion motion = find_motion(character, options.motion);
    Retarget retarget = make_retarget(motion, character);
    if (!retarget.fits) throw LoadError(options.motion, "", "moves no joint that this figure has");
    apply_motion(motion, retarget, character, options.time, motion.loop, 1, pose);
  }
  if (!options.expressions.empty()) {
    try {
      show_expressions(character, options.expressions, pose);
    } catch (const std::invalid_argument& error) {
      return fail(error.what(), 2);
    }
  }
  for (const std::string& setting : options.displacers) {
    size_t equals = setting.find('=');
    int index = find_displacer(character, setting.substr(0, equals));
    if (index < 0)
      return fail("--displacer: the figure has no '" + setting.substr(0, equals) + "'", 2);
    pose.displacers[size_t(index)] =
        equals == std::string::npos ? 1 : float(std::atof(setting.c_str() + equals + 1));
  }
  follow_expression_rules(character, pose);
  follow_constraints(character, pose);
  std::vector<std::string> warnings;
  Frame frame =
      options.sheet.empty()
          ? render_portrait(character, pose, shot, warnings)
          : render_sheet(character, sheet_cells(character, options.sheet, pose), shot, 0, warnings);
  for (const std::string& warning : warnings) std::cerr << "note: " << warning << "\n";
  save_picture(options.out, frame, Tonemap{});
  return 0;
}

}  // namespace
}  // namespace wellspring::program

int main(int argc, char** argv) {
  using namespace wellspring;
  using namespace wellspring::program;
  if (answer_version(argc, argv)) return 0;
  log::start("avatar");
  CLI::App app{"Inspects an H-Anim figure and takes pictures of it."};
  Options options;
  app.add_option("file", options.file,
                 "file of the figure: X3D, VRML97, glTF, VRM; or BVH, a motion");
  app.add_flag("--list-gestures", options.list_gestures,
               "print the gestures, emotions and expressions that there are, and end");
  app.add_flag("--info", options.info,
               "tell what the figure consists of (the default without --out)");
  app.add_flag("--json", options.json, "the same for programs");
  app.add_option("--motion", options.motion,
                 "shows a motion at --time instead: one of the figure's own by name, or a file\n"
                 "(.bvh, .vrma, .glb, .x3d; FILE#NAME for one of several)");
  app.add_option("--skinning", options.skinning,
                 "how joints bend the skin; without it as the file says")
      ->check(CLI::IsMember({"linear", "dual_quaternion"}));
  app.add_option("--out", options.out, "picture to write: .png .jpg .pfm .exr");
  app.add_option("--sheet", options.sheet, "a labelled picture of each, --size is that of one")
      ->check(CLI::IsMember({"expressions", "visemes"}));
  app.add_option("--time", options.time, "seconds it has stood there");
  app.add_option("--size", options.size, "WIDTHxHEIGHT of the picture");
  app.add_option("--spp", options.spp, "samples a pixel")->check(CLI::Range(1, 65536));
  app.add_flag("--close", options.close, "head and shoulders");
  app.add_option("--turn", options.turn, "degrees the camera goes round the figure, to its left");
  app.add_flag("--rest", options.rest, "the rest pose of the file instead of idling");
  app.add_flag("--calm", options.calm, "without human-like noise");
  app.add_option("--guest", options.guest,
                 "a person's eyes at x,y,z before it: it greets and looks there")
      ->delimiter(',');
  app.add_option("--speaking", options.speaking, "mouth activity, 0 to 1")
      ->check(CLI::Range(0.0f, 1.0f));
  app.add_option("--expression", options.expressions,
                 "NAME or NAME=WEIGHT instead of the pose's face, may repeat and is summed");
  app.add_option("--point", options.point, "points at x,y,z, as a story would have it")
      ->delimiter(',')
      ->expected(3);
  app.add_option("--look", options.appearance, "looks at x,y,z")->delimiter(',')->expected(3);
  app.add_option("--gesture", options.gesture,
                 "motion of the gesture library, seen --time seconds after it began");
  CLI::Option* package =
      app.add_option("--exhibit", options.exhibit, "folder of an exhibit, for its props");
  app.add_option("--hold", options.hold, "holds that prop of the exhibit, for --time seconds")
      ->needs(package);
  app.add_option("--displacer", options.displacers,
                 "NAME or NAME=WEIGHT over the pose, may repeat");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  if (options.list_gestures) {
    print_gestures();
    return 0;
  }
  if (options.file.empty()) return fail("file is required: a figure, or a motion", 2);
  try {
    return run(options);
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
