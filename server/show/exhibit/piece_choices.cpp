// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/piece_choices.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "wire/messages.h"

namespace wellspring::show {
namespace {

int find_piece(const Exhibit& exhibit, const std::string& id) {
  const auto found = std::ranges::find(exhibit.pieces, id, &ExhibitPiece::id);
  return found == exhibit.pieces.end() ? -1 : int(found - exhibit.pieces.begin());
}

// Returns the number of a layer, the first of an empty id; -1: there is no such layer.
int find_layer(const ExhibitPiece& piece, const std::string& id) {
  if (id.empty()) return 0;
  const auto found = std::ranges::find(piece.layers, id, &PieceLayer::id);
  return found == piece.layers.end() ? -1 : int(found - piece.layers.begin());
}

std::string no_layer(const std::string& piece, const std::string& id) {
  return "the piece '" + piece + "' has no layer '" + id + "'";
}

PictureLayer layer_in(const PieceLayer& layer, const std::string& language) {
  return {picture_in(layer, language), layer.shown.placing};
}

ShownPicture shown_picture(const ExhibitPiece& piece, const PieceChoice& choice,
                           const std::string& language) {
  ShownPicture shown;
  shown.base = layer_in(piece.layers[size_t(choice.layer)], language);
  if (choice.by == Blend::none) return shown;
  shown.over = layer_in(piece.layers[size_t(choice.over)], language);
  shown.blend = choice.by, shown.share = choice.share;
  return shown;
}

}  // namespace

PieceChoice choice_of(const PieceChoices& choices, size_t piece) {
  return piece < choices.size() ? choices[piece] : PieceChoice{};
}

std::string choose_piece(const Exhibit& exhibit, const PieceOrder& order, PieceChoices& choices) {
  const int number = find_piece(exhibit, order.name);
  if (number < 0) return "there is no piece '" + order.name + "'";
  const ExhibitPiece& piece = exhibit.pieces[size_t(number)];
  static_assert(int(PieceBlend::difference) == int(Blend::difference));
  PieceChoice choice{find_layer(piece, order.layer), find_layer(piece, order.over), Blend(order.by),
                     order.share};
  if (choice.layer < 0) return no_layer(order.name, order.layer);
  if (choice.over < 0) return no_layer(order.name, order.over);
  if (choice.by == Blend::none) choice = {choice.layer};
  if (piece.volume) {
    choice.turn = float(glm::radians(order.turn));
    choice.low = glm::clamp(order.low, 0.0f, 1.0f),
    choice.high = glm::clamp(order.high, 0.0f, 1.0f);
    if (piece.nebula) choice.tilt = int(std::lround(std::min(order.tilt, 75.0)));
    const float length = glm::length(vec3(order.plane));
    if (length > 0) choice.plane = vec4(vec3(order.plane) / length, order.plane.w);
  }
  choices.resize(exhibit.pieces.size());
  choices[size_t(number)] = choice;
  return {};
}

std::string look_through(const Exhibit& exhibit, const LensOrder& order, PieceChoices& choices) {
  if (order.name.empty()) return {};
  const int number = find_piece(exhibit, order.name);
  if (number < 0) return "there is no piece '" + order.name + "'";
  const int layer = find_layer(exhibit.pieces[size_t(number)], order.layer);
  if (layer < 0) return no_layer(order.name, order.layer);
  choices.resize(exhibit.pieces.size());
  PieceChoice& choice = choices[size_t(number)];
  const int before = std::exchange(choice.layer, layer);
  choice.over = 0, choice.by = Blend::none;
  if (order.difference) choice.layer = before, choice.over = layer, choice.by = Blend::difference;
  return {};
}

std::string piece_language(const Exhibit& exhibit, const std::string& language) {
  const auto& known = exhibit.piece_languages;
  for (const std::string& tag : {language, language.substr(0, language.find('-'))}) {
    if (tag == exhibit.languages.front()) return "";
    if (std::ranges::find(known, tag) != known.end()) return tag;
  }
  return "";
}

const std::shared_ptr<const LargePicture>& picture_in(const PieceLayer& layer,
                                                      const std::string& language) {
  const auto found = layer.spoken.find(language);
  return found == layer.spoken.end() ? layer.shown.picture : found->second;
}

bool changes_volume(const Exhibit& exhibit, const PieceChoices& before, const PieceChoices& now) {
  for (size_t i = 0; i < exhibit.pieces.size(); i++)
    if (exhibit.pieces[i].volume && choice_of(before, i) != choice_of(now, i)) return true;
  return false;
}

void show_pieces(const Exhibit& exhibit, const ShownPieces& all, World& world) {
  const PieceChoices& choices = all.choices;
  const std::vector<ExhibitPiece>& pieces = exhibit.pieces;
  const std::span<const ShownPicture> shown = world.pictures();
  for (size_t i = 0; i < pieces.size(); i++) {
    const int image = pieces[i].image;
    if (image < 0 || pieces[i].layers.empty()) continue;
    ShownPicture now = shown_picture(pieces[i], choice_of(choices, i), all.language);
    if (shown[size_t(image)] != now) world.show_picture(image, now);
  }
}

}  // namespace wellspring::show
