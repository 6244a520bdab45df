// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "base/load_error.h"
#include "json/fields.h"
#include "kiosk/station/code.h"
#include "kiosk/station/learn.h"
#include "wire/limits.h"
#include "kiosk/tree/tree_file.h"

namespace wellspring::kiosk {
namespace {

namespace fs = std::filesystem;

constexpr size_t most_objects = 300, most_photos = 12;
constexpr uintmax_t most_photo_bytes = uintmax_t(64) << 20;
constexpr int least_side = 64;
constexpr double one_color = 12;  // most that a plain background differs from its mean

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(), [](char c) { return char(std::tolower(uint8_t(c))); });
  return text;
}

std::string side_of(const std::string& stem) {
  const std::string name = lower(stem);
  const size_t end = name.find_first_of("-_ 0123456789");
  return name.substr(0, end);
}

// Finds what is not background: what is opaque, or what differs from a border of one colour.
cv::Rect find_object(const cv::Mat& picture) {
  const cv::Rect whole(0, 0, picture.cols, picture.rows);
  cv::Mat mask;
  if (picture.channels() == 4) {
    cv::extractChannel(picture, mask, 3);
    double least = 255;
    cv::minMaxLoc(mask, &least);
    if (least > 127) mask.release();
    else mask = mask > 127;
  }
  if (mask.empty()) {
    cv::Mat bgr = picture, border;
    if (picture.channels() == 4) cv::cvtColor(picture, bgr, cv::COLOR_BGRA2BGR);
    const int edge = std::max(2, std::min(bgr.cols, bgr.rows) / 50);
    mask = cv::Mat::ones(bgr.size(), CV_8U);
    mask(cv::Rect(edge, edge, bgr.cols - 2 * edge, bgr.rows - 2 * edge)) = 0;
    cv::Scalar mean, deviation;
    cv::meanStdDev(bgr, mean, deviation, mask);
    if (std::max({deviation[0], deviation[1], deviation[2]}) > one_color) return whole;
    cv::Mat far;
    cv::absdiff(bgr, mean, far);
    cv::Mat channels[3];
    cv::split(far, channels);
    mask = (cv::max(cv::max(channels[0], channels[1]), channels[2]) > 3 * one_color);
    cv::morphologyEx(mask, mask, cv::MORPH_OPEN, cv::Mat::ones(3, 3, CV_8U));
  }
  const cv::Rect found = cv::boundingRect(mask);
  // A border all round belongs to a background; a strip at one side may be the object's own.
  const bool inside =
      found.x > 0 && found.y > 0 && found.br().x < picture.cols && found.br().y < picture.rows;
  if (!inside || found.width < least_side || found.height < least_side) return whole;
  return found;
}

Photo load_photo(const fs::path& file) {
  std::error_code error;
  if (fs::file_size(file, error) > most_photo_bytes || error)
    throw LoadError(file.string(), "", "is too large or cannot be read");
  cv::Mat picture;
  try {
    picture = cv::imread(file.string(), cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception&) {  // an empty picture is told below
  }
  if (picture.empty()) throw LoadError(file.string(), "", "is no PNG or JPEG that can be read");
  if (picture.depth() == CV_16U) picture.convertTo(picture, CV_8U, 1 / 257.0);
  if (picture.depth() != CV_8U) throw LoadError(file.string(), "", "has not 8 or 16 bits");
  if (std::min(picture.cols, picture.rows) < least_side)
    throw LoadError(file.string(), "", "is smaller than " + std::to_string(least_side) + " pixels");
  if (picture.channels() == 1) cv::cvtColor(picture, picture, cv::COLOR_GRAY2BGR);
  cv::Mat part = picture(find_object(picture)), bgr;
  if (part.channels() == 4) {
    // Grey stands for transparent parts, so that it has no edges of its own but the object's.
    std::vector<cv::Mat> channels;
    cv::split(part, channels);
    bgr = cv::Mat(part.size(), CV_8UC3, cv::Scalar::all(128));
    cv::Mat color;
    cv::cvtColor(part, color, cv::COLOR_BGRA2BGR);
    color.copyTo(bgr, channels[3] > 127);
  } else {
    bgr = part.clone();
  }
  constexpr int most = 480;  // more is not needed of a photograph
  if (std::max(bgr.cols, bgr.rows) > most) {
    const double scale = double(most) / std::max(bgr.cols, bgr.rows);
    cv::resize(bgr, bgr, {}, scale, scale, cv::INTER_AREA);
  }
  Photo photo{file.string(), side_of(file.stem().string()), bgr.cols, bgr.rows, {}};
  photo.bgr.assign(bgr.data, bgr.data + bgr.total() * 3);
  return photo;
}

void read_texts(FieldReader& fields, const char* name, size_t most_bytes, Texts& texts) {
  const auto value = fields.take(name);
  if (!value || !value->object()) return;
  for (const auto& [language, text] : FieldReader(*value).members()) {
    if (language.empty() || language.size() > max_language || texts.size() >= max_languages)
      text.fail("is of no language, or of one too many");
    text.text(texts[language], most_bytes, Need::required);
  }
}

vec2 read_size(const JsonValue& value) {
  double size[2] = {0, 0};
  value.numbers(2, 0.001, 10, size);
  return {size[0], size[1]};
}

void read_object_file(const std::string& file, LearnObject& object) {
  const std::string text = read_json_text(file);
  const nlohmann::json value = parse_json_file(file, text);
  Faults faults(file, true, text);
  FieldReader fields(value, faults);
  read_texts(fields, "title", max_text_bytes, object.title);
  read_texts(fields, "text", 4000, object.text);
  read_texts(fields, "class", max_text_bytes, object.of_class);
  if (const auto size = fields.take("size")) {
    if (size->value().is_object())
      for (const auto& [side, one] : FieldReader(*size).members())
        object.sizes[lower(side)] = read_size(one);
    else object.sizes[""] = read_size(*size);
  }
  if (const auto hints = fields.take("hints"); hints && hints->object()) {
    FieldReader names(*hints);
    for (const auto& [name, texts] : names.members())
      read_texts(names, name.c_str(), max_text_bytes, object.hints[name]);
  }
  fields.finish();
}

std::vector<fs::path> sorted(const fs::path& folder) {
  std::vector<fs::path> out;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) out.push_back(entry.path());
  if (error) throw LoadError(folder.string(), "", "cannot be read: " + error.message());
  std::ranges::sort(out);
  return out;
}

}  // namespace

std::vector<LearnObject> load_objects(const std::string& folder) {
  std::vector<LearnObject> objects;
  for (const fs::path& place : sorted(folder)) {
    if (!fs::is_directory(place) || place.filename().string().starts_with('.')) continue;
    LearnObject& object = objects.emplace_back();
    object.id = place.filename().string();
    if (object.id.size() > max_text_bytes)
      throw LoadError(place.string(), "", "has too long a name");
    if (objects.size() > most_objects)
      throw LoadError(folder, "", "has more than " + std::to_string(most_objects) + " objects");
    for (const fs::path& file : sorted(place)) {
      const std::string end = lower(file.extension().string());
      if (file.filename() == "object.json") read_object_file(file.string(), object);
      if (end != ".png" && end != ".jpg" && end != ".jpeg") continue;
      if (object.photos.size() >= most_photos)
        throw LoadError(place.string(), "",
                        "has more than " + std::to_string(most_photos) + " photographs");
      object.photos.push_back(load_photo(file));
      const Photo& photo = object.photos.back();
      cv::Mat gray;
      cv::cvtColor(
          cv::Mat(photo.height, photo.width, CV_8UC3, const_cast<uint8_t*>(photo.bgr.data())), gray,
          cv::COLOR_BGR2GRAY);
      cv::copyMakeBorder(gray, gray, 30, 30, 30, 30, cv::BORDER_CONSTANT, 255);
      if (!object.code.empty()) continue;
      const auto codes = read_codes(gray.cols, gray.rows, gray.data);
      if (codes.empty()) continue;
      object.code = codes[0];
      const bool plain = std::ranges::none_of(object.code, [](char c) { return uint8_t(c) < 32; });
      if (!plain || object.code.size() > most_code_bytes)
        throw LoadError(photo.file, "", "has a code that is no text, or too long a one");
    }
    if (object.photos.empty())
      throw LoadError(place.string(), "", "has no photograph (.png, .jpg, .jpeg)");
    if (object.title.empty()) object.title["en"] = object.id;
  }
  if (objects.empty()) throw LoadError(folder, "", "has no folder of an object");
  return objects;
}

}  // namespace wellspring::kiosk
