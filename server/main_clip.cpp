// SPDX-License-Identifier: Apache-2.0
// Runs `wellspring clip FIGURE STORY`: a figure acts a story. Writes pictures, the sound and
// subtitles into a folder, with a sheet of some moments to look at; and a film, if ffmpeg is
// installed.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <fmt/core.h>

#include "about/version.h"
#include "avatar/load/character_load.h"
#include "avatar/speech/process.h"
#include "avatar/speech/sound_file.h"
#include "avatar/story/story_speech.h"
#include "base/child.h"
#include "base/clock.h"
#include "base/load_error.h"
#include "base/log.h"
#include "base/write_file.h"
#include "frame/picture_file.h"
#include "show/storyteller/story_clip.h"

namespace wellspring::program {
namespace {

struct Options {
  std::string figure, story, out = "clip", size = "240x320";
  ClipSettings clip{.lang = "en", .seconds = 8, .fps = 12};
  SpeechRequest voice{
      .text = "", .lang = "en", .words_per_minute = 145, .pitch = 52, .variant = "f3"};
  int spp = 16, columns = 8, sheet_rate = 4;
  double from = 0;
  bool close = false, calm = false;
};

// Copies a picture into a sheet, as far as it fits.
void paste(const Image8& picture, Image8& sheet, int left, int top) {
  for (int y = 0; y < picture.height && top + y < sheet.height; y++)
    for (int x = 0; x < 3 * picture.width && 3 * left + x < 3 * sheet.width; x++)
      sheet.rgb[size_t((top + y) * sheet.width + left) * 3 + size_t(x)] =
          picture.rgb[size_t(y * picture.width) * 3 + size_t(x)];
}

// Puts pictures and sound into one file. False: there is no ffmpeg, or it failed.
bool make_film(const std::string& folder, double fps) {
  std::string rate = fmt::format("{}", fps), pictures = folder + "/%04d.png",
              sound = folder + "/sound.wav", film = folder + "/clip.mp4";
  std::vector<std::string> words = {"ffmpeg",   "-y",      "-loglevel", "error", "-framerate",
                                    rate,       "-i",      pictures,    "-i",    sound,
                                    "-pix_fmt", "yuv420p", "-shortest", film};
  try {
    return Child({.words = std::move(words)}).wait() == 0;
  } catch (const std::exception&) {
    return false;
  }
}

int run(Options& options) {
  PortraitShot shot;
  char rest = 0;
  bool sized =
      std::sscanf(options.size.c_str(), "%dx%d%c", &shot.width, &shot.height, &rest) == 2 &&
      shot.width >= 16 && shot.height >= 16 && shot.width <= 2048 && shot.height <= 2048;
  if (!sized) {
    std::cerr << "--size wants WIDTHxHEIGHT, 16 to 2048 each\n";
    return 2;
  }
  shot.spp = options.spp;
  shot.close = options.close;
  Character character = load_character(options.figure);
  StoryText story;
  story.id = std::filesystem::path(options.story).stem().string();
  StoryScript script = load_story(options.story);
  for (const StoryNote& note : script.notes)
    std::cerr << "note: " << options.story << ": " << to_string(note.place) << ": " << note.what
              << "\n";
  options.voice.lang = options.clip.lang;
  options.clip.humanlike = !options.calm;
  SpeechProcess process;
  auto spoken = speak_lines(process, script.lines, options.voice, options.story);
  story.text[options.clip.lang] = script.lines;
  std::filesystem::create_directories(options.out);

  double seconds = options.clip.seconds;
  options.clip.seconds += options.from;
  auto moments = act_story(Exhibit{}, character, mat4(1), story, spoken, options.clip);
  std::erase_if(moments,
                [&](const StoryMoment& moment) { return moment.time < options.from - 1e-9; });
  if (moments.empty()) throw LoadError(options.story, "", "ends before --from");

  // Sound follows the pictures.
  int rate = spoken.front()->rate;
  std::vector<int16_t> sound(size_t(double(moments.size()) / options.clip.fps * rate));
  for (size_t i = 0; i < moments.size(); i++) {
    const auto& pcm = spoken[std::min(size_t(moments[i].sentence), spoken.size() - 1)]->pcm;
    size_t begin = size_t(double(i) / options.clip.fps * rate),
           end = size_t(double(i + 1) / options.clip.fps * rate);
    for (size_t k = begin; k < std::min(end, sound.size()); k++) {
      long at = long(moments[i].sound * rate) + long(k - begin);
      if (at >= 0 && at < long(pcm.size())) sound[k] = pcm[size_t(at)];
    }
  }
  write_file(options.out + "/sound.wav", encode_wav(sound, rate));
  write_file(options.out + "/subtitles.vtt",
             write_subtitles(join_lines(script.lines, spoken).cues));

  size_t every = size_t(std::max(1.0, options.clip.fps / options.sheet_rate));
  int shown = int((moments.size() + every - 1) / every);
  int columns = std::min(options.columns, shown), rows = (shown + columns - 1) / columns;
  Image8 sheet{columns * shot.width, rows * shot.height, {}};
  sheet.rgb.resize(size_t(sheet.width) * size_t(sheet.height) * 3);
  std::vector<std::string> warnings;
  Progress progress("clip");
  for (size_t i = 0; i < moments.size(); i++) {
    progress.tell(double(i) / double(moments.size()),
                  fmt::format("{} of {} pictures", i, moments.size()));
    Frame frame = render_portrait(character, moments[i].pose, shot, warnings);
    Image8 picture;
    tonemap(frame, Tonemap{}, picture);
    save_image8(options.out + fmt::format("/{:04}.png", i), picture);
    int place = int(i / every);
    if (i % every == 0)
      paste(picture, sheet, place % columns * shot.width, place / columns * shot.height);
  }
  progress.clear();
  save_image8(options.out + "/sheet.png", sheet);
  bool film = make_film(options.out, options.clip.fps);
  std::cout << fmt::format("{} pictures of {:.1f} s, sheet.png, sound.wav, subtitles.vtt{} in {}\n",
                           moments.size(), seconds, film ? ", clip.mp4" : "", options.out);
  return 0;
}

}  // namespace
}  // namespace wellspring::program

int main(int argc, char** argv) {
  using namespace wellspring;
  using namespace wellspring::program;
  if (answer_version(argc, argv)) return 0;
  log::start("clip");
  CLI::App app{
      "A figure acts a story: pictures, sound, subtitles, and a film where ffmpeg is installed."};
  Options options;
  app.add_option("figure", options.figure, "file of the figure")->required();
  app.add_option("story", options.story, ".story, .ssml, .txt or .vtt")->required();
  app.add_option("--lang", options.clip.lang, "language tag")->capture_default_str();
  app.add_option("--out", options.out, "folder to write to")->capture_default_str();
  app.add_option("--from", options.from, "second of the story to begin with")
      ->check(CLI::Range(0.0, 3600.0));
  app.add_option("--seconds", options.clip.seconds)
      ->check(CLI::Range(0.1, 600.0))
      ->capture_default_str();
  app.add_option("--fps", options.clip.fps, "pictures a second")
      ->check(CLI::Range(1.0, 60.0))
      ->capture_default_str();
  app.add_option("--size", options.size, "of each picture")->capture_default_str();
  app.add_option("--spp", options.spp, "samples a pixel")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  app.add_flag("--close", options.close, "head and shoulders");
  app.add_flag("--calm", options.calm, "without human-like noise");
  app.add_option("--sheet-rate", options.sheet_rate, "pictures of the sheet a second")
      ->check(CLI::Range(1, 60));
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    return run(options);
  } catch (const std::exception& error) {
    std::cerr << "clip: " << error.what() << "\n";
    return 1;
  }
}
