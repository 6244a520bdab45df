// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/pieces/piece_choices.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/unicode.h"
#include "show/exhibit/pieces/exhibit_scans.h"
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

template <class Named>
std::vector<std::string> ids_of(const std::vector<Named>& all) {
  std::vector<std::string> ids;
  for (const Named& one : all) ids.push_back(one.id);
  return ids;
}

// Returns how much of its second layer a choice mixes in.
float mixed_in(const PieceChoice& choice) { return choice.by == Blend::none ? 0 : choice.share; }
bool is_mixture(const PieceChoice& choice) {
  return choice.by == Blend::none || choice.by == Blend::fade;
}

// Lets layers fade into one another, where that is what the two choices differ by.
void glide_layers(const PieceChoice& from, const PieceChoice& to, float share, PieceChoice& now) {
  if (!is_mixture(from) || !is_mixture(to)) return;
  const float before = mixed_in(from), after = mixed_in(to);
  auto mix_in = [&](int layer, int over, float most) {
    now.layer = layer, now.over = over, now.by = Blend::fade;
    now.share = std::lerp(before, most, share);
  };
  const bool same_over = before == 0 || after == 0 || from.over == to.over;
  if (from.layer == to.layer && before + after > 0 && same_over)
    mix_in(to.layer, after > 0 ? to.over : from.over, after);
  else if (from.layer != to.layer && after == 0 && (before == 0 || from.over == to.layer))
    mix_in(from.layer, to.layer, 1);
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
  if (piece.volume) choice.turn = float(glm::radians(order.turn));
  if (piece.has_inside()) {
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

std::string choose_told(const Exhibit& exhibit, const std::string& id, const PieceMark& mark,
                        PieceChoices& choices) {
  const int number = find_piece(exhibit, id);
  if (number < 0)
    return "there is no piece '" + id + "'" + did_you_mean(id, ids_of(exhibit.pieces));
  const ExhibitPiece& piece = exhibit.pieces[size_t(number)];
  for (const std::string& layer : {mark.layer, mark.over})
    if (find_layer(piece, layer) < 0)
      return no_layer(id, layer) + did_you_mean(layer, ids_of(piece.layers));
  if (mark.turn && !piece.volume)
    return "the piece '" + id + "' is no volume: only these are turned";
  if (mark.cut && !piece.has_inside())
    return "the piece '" + id + "' is no volume or scan: only these are cut";
  const PieceChoice before = choice_of(choices, size_t(number));
  PieceOrder order{.name = id, .layer = mark.layer, .over = mark.over, .share = mark.share};
  if (order.layer.empty() && before.layer > 0) order.layer = piece.layers[size_t(before.layer)].id;
  if (!order.over.empty()) order.by = PieceBlend::fade;
  order.turn = mark.turn.value_or(glm::degrees(before.turn));
  order.low = before.low, order.high = before.high, order.plane = before.plane;
  order.tilt = before.tilt;
  if (mark.cut) order.high.z = 1 - *mark.cut;
  return choose_piece(exhibit, order, choices);
}

PieceChoices glide(const PieceChoices& from, const PieceChoices& to, float share) {
  PieceChoices all(std::max(from.size(), to.size()));
  for (size_t i = 0; i < all.size(); i++) {
    const PieceChoice before = choice_of(from, i), after = choice_of(to, i);
    PieceChoice& now = all[i] = after;
    if (before == after) continue;
    now.turn = before.turn + share * std::remainder(after.turn - before.turn, 2 * pi);
    now.low = glm::mix(before.low, after.low, share);
    now.high = glm::mix(before.high, after.high, share);
    glide_layers(before, after, share, now);
  }
  return all;
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
  int scan = 0;
  for (size_t i = 0; i < pieces.size(); i++)
    if (pieces[i].is_scan())
      world.show_scan(scan++, look_of(exhibit, pieces[i], choice_of(choices, i)));
}

}  // namespace wellspring::show
