// SPDX-License-Identifier: Apache-2.0
// Runs `wellspring clip FIGURE STORY`: a figure acts a story. Writes pictures, the sound and
// subtitles into a folder, with a sheet of some moments to look at; and a film, if ffmpeg is
// installed.
#include <CLI/CLI.hpp>
#include <algorithm>
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
#include "base/read_file.h"
#include "base/write_file.h"
#include "frame/picture_file.h"
#include "image/image.h"
#include "main_shard.h"
#include "show/storyteller/story_clip.h"

namespace wellspring::program {
namespace {

constexpr double say_elsewhere = 10;  // seconds
constexpr size_t most_picture_bytes = 64 << 20;

struct Options {
  std::string figure, story, out = "clip", size = "240x320";
  ClipSettings clip{.lang = "en", .seconds = 8, .fps = 12};
  SpeechRequest voice{
      .text = "", .lang = "en", .words_per_minute = 145, .pitch = 52, .variant = "f3"};
  int spp = 16, columns = 8, sheet_rate = 4;
  double from = 0;
  bool close = false, calm = false;
  Shard shard;                     // which pictures are drawn
  std::vector<std::string> merge;  // folders of all shards' pictures
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

// Holds a clip as it is to be drawn.
struct Clip {
  Character character;
  PortraitShot shot;
  std::vector<StoryLine> lines;
  std::vector<std::shared_ptr<const Speech>> spoken;
  std::vector<StoryMoment> moments;
};

Clip load_clip(Options& options, const PortraitShot& shot) {
  Clip clip{load_character(options.figure), shot, {}, {}, {}};
  StoryText story;
  story.id = std::filesystem::path(options.story).stem().string();
  StoryScript script = load_story(options.story);
  for (const StoryNote& note : script.notes)
    std::cerr << "note: " << options.story << ": " << to_string(note.place) << ": " << note.what
              << "\n";
  options.voice.lang = options.clip.lang;
  options.clip.humanlike = !options.calm;
  SpeechProcess process;
  clip.spoken = speak_lines(process, script.lines, options.voice, options.story);
  story.text[options.clip.lang] = script.lines;
  ClipSettings settings = options.clip;
  settings.seconds += options.from;
  clip.moments = act_story(Exhibit{}, clip.character, mat4(1), story, clip.spoken, settings);
  std::erase_if(clip.moments,
                [&](const StoryMoment& moment) { return moment.time < options.from - 1e-9; });
  if (clip.moments.empty()) throw LoadError(options.story, "", "ends before --from");
  clip.lines = std::move(script.lines);
  return clip;
}

std::string picture_name(size_t i) { return fmt::format("{:04}.png", i); }

// Draws the pictures of the shard.
void draw_pictures(const Options& options, const Clip& clip) {
  const auto [begin, end] = options.shard.stretch(clip.moments.size());
  std::vector<std::string> warnings;
  Progress progress("clip", options.shard.is_whole() ? 0 : say_elsewhere);
  for (size_t i = begin; i < end; i++) {
    progress.tell(double(i - begin) / double(end - begin),
                  fmt::format("{} of {} pictures", i - begin, end - begin));
    Frame frame = render_portrait(clip.character, clip.moments[i].pose, clip.shot, warnings);
    Image8 picture;
    tonemap(frame, Tonemap{}, picture);
    save_image8(options.out + "/" + picture_name(i), picture);
  }
}

// Brings the pictures of all shards into one folder.
void gather_pictures(const Options& options, const Clip& clip) {
  namespace fs = std::filesystem;
  for (size_t i = 0; i < clip.moments.size(); i++) {
    const fs::path to = fs::path(options.out) / picture_name(i);
    const auto has = [&](const std::string& folder) {
      return fs::exists(fs::path(folder) / picture_name(i));
    };
    const auto from = std::ranges::find_if(options.merge, has);
    if (from == options.merge.end())
      throw LoadError(to.string(), "", "is missing: its shard is not done");
    std::error_code error;
    const fs::path found = fs::path(*from) / picture_name(i);
    if (!fs::equivalent(found, to, error))
      fs::copy_file(found, to, fs::copy_options::overwrite_existing);
  }
}

// Sound follows the pictures.
void write_sound(const Options& options, const Clip& clip) {
  const auto& moments = clip.moments;
  const auto& spoken = clip.spoken;
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
  write_file(options.out + "/subtitles.vtt", write_subtitles(join_lines(clip.lines, spoken).cues));
}

Image8 read_picture(const std::string& path) {
  const auto bytes = read_file<std::vector<uint8_t>>(path, most_picture_bytes);
  const ImageCodes codes = decode_png(bytes, int64_t(largest_side) * largest_side, path);
  Image8 picture{codes.width, codes.height, {}};
  for (size_t i = 0; i < codes.codes8.size(); i++)
    if (i % 4 != 3) picture.rgb.push_back(codes.codes8[i]);
  return picture;
}

void write_sheet(const Options& options, const Clip& clip) {
  const size_t all = clip.moments.size();
  size_t every = size_t(std::max(1.0, options.clip.fps / options.sheet_rate));
  int shown = int((all + every - 1) / every);
  int columns = std::min(options.columns, shown), rows = (shown + columns - 1) / columns;
  Image8 sheet{columns * clip.shot.width, rows * clip.shot.height, {}};
  sheet.rgb.resize(size_t(sheet.width) * size_t(sheet.height) * 3);
  for (size_t i = 0; i < all; i += every) {
    const int place = int(i / every);
    paste(read_picture(options.out + "/" + picture_name(i)), sheet,
          place % columns * clip.shot.width, place / columns * clip.shot.height);
  }
  save_image8(options.out + "/sheet.png", sheet);
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
  const Clip clip = load_clip(options, shot);
  std::filesystem::create_directories(options.out);
  if (options.merge.empty()) draw_pictures(options, clip);
  else gather_pictures(options, clip);
  if (!options.shard.is_whole()) {
    std::cout << fmt::format("pictures of shard {} in {}\n", to_text(options.shard), options.out);
    return 0;
  }
  write_sound(options, clip);
  write_sheet(options, clip);
  bool film = make_film(options.out, options.clip.fps);
  std::cout << fmt::format("{} pictures of {:.1f} s, sheet.png, sound.wav, subtitles.vtt{} in {}\n",
                           clip.moments.size(), options.clip.seconds, film ? ", clip.mp4" : "",
                           options.out);
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
  CLI::Option* shard =
      add_shard(app, options.shard, "i/N: a stretch of the pictures, for N machines");
  app.add_option("--merge", options.merge,
                 "folders of the pictures of all shards: the clip is made of them")
      ->excludes(shard);
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
