// SPDX-License-Identifier: Apache-2.0
#include "show/http/iiif.h"

#include <algorithm>
#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <semaphore>

#include "base/load_error.h"
#include "base/log.h"
#include "show/http/iiif_image.h"
#include "show/http/pages.h"
#include "store/picture/sample_picture.h"

namespace wellspring::show {

using nlohmann::json;

namespace {

constexpr int iiif_jpeg_quality = 88;
constexpr const char* image_context = "http://iiif.io/api/image/3/context.json";
constexpr const char* image_profile = "http://iiif.io/api/image/3/level2.json";
constexpr const char* presentation_context = "http://iiif.io/api/presentation/3/context.json";
// A picture that takes this much, in texels read and pixels written, is one of two that are made at
// a time, so that pages and tiles have threads left.
constexpr int64_t large_cost = int64_t(1) << 22;
std::counting_semaphore<2> large_places{2};

HttpReply iiif_reply(const json& body, int status = 200) {
  HttpReply reply;
  reply.status = status;
  reply.body = body.dump(-1, ' ', false, json::error_handler_t::replace);
  return reply;
}

HttpReply refuse_iiif(int status, const char* code, const std::string& message) {
  HttpReply reply = iiif_reply({{"error", {{"code", code}, {"message", message}}}}, status);
  reply.headers["Cache-Control"] = "no-store";
  return reply;
}

// Lets a reply be kept, unless exhibits change.
HttpReply kept_a_day(HttpReply reply, const IiifSources& sources) {
  if (reply.status != 200) return reply;
  reply.headers["ETag"] = make_etag(reply.body);
  reply.headers["Cache-Control"] = sources.changes ? "no-store" : "public, max-age=86400";
  return reply;
}

// Returns the address of all that is served here: the house's own if that is the one asked for,
// since a proxy may speak TLS for it, else the one asked for.
std::string base_address(const std::string& house, const std::string& asked) {
  const auto name = [](const std::string& site) { return site.substr(site.find("://") + 3); };
  const bool is_house = !house.empty() && (asked.empty() || name(house) == name(asked));
  return (is_house ? house : asked) + "/iiif/";
}

// Names a piece of a served exhibit.
struct ServedPiece {
  IiifExhibit served;
  const ExhibitPiece* piece = nullptr;

  const PicturePyramid& pyramid() const { return *piece->picture->pyramid; }
  int64_t width() const { return pyramid().levels()[0].width; }
  int64_t height() const { return pyramid().levels()[0].height; }
  std::string address(const HttpQuestion& question) const {
    return base_address(served.address, question.site) + escaped(served.exhibit->id) + "~" +
           escaped(piece->id);
  }
};

ServedPiece find_piece(const IiifSources& sources, const std::string& id) {
  const size_t tilde = id.find('~');
  if (tilde == id.npos) return {};
  const IiifExhibit served = sources.find(id.substr(0, tilde));
  if (!served.exhibit) return {};
  const auto& pieces = served.exhibit->pieces;
  const auto found = std::ranges::find(pieces, id.substr(tilde + 1), &ExhibitPiece::id);
  return found == pieces.end() || !found->picture ? ServedPiece{} : ServedPiece{served, &*found};
}

json sides_of(int64_t width, int64_t height) { return {{"width", width}, {"height", height}}; }

// Lists the tiles of levels whose texels are whole numbers of the picture's, down to the first
// level that is one tile.
json describe_tiles(const std::vector<PyramidLevel>& levels) {
  json tiles = json::array();
  for (const PyramidLevel& level : levels) {
    const int64_t scale = iiif_scale(level, levels[0]);
    if (scale == 0) continue;
    const json size = sides_of(level.tile_width, level.tile_height);
    const auto same = std::ranges::find_if(tiles, [&](const json& one) {
      return one["width"] == size["width"] && one["height"] == size["height"];
    });
    json& tile = same == tiles.end() ? tiles.emplace_back(size) : *same;
    tile["scaleFactors"].push_back(scale);
    if (level.columns() == 1 && level.rows() == 1) break;
  }
  return tiles;
}

HttpReply answer_info(const ServedPiece& asked, const HttpQuestion& question) {
  const std::vector<PyramidLevel>& levels = asked.pyramid().levels();
  json info = {{"@context", image_context},
               {"id", asked.address(question)},
               {"type", "ImageService3"},
               {"protocol", "http://iiif.io/api/image"},
               {"profile", "level2"},
               {"width", asked.width()},
               {"height", asked.height()},
               {"maxWidth", most_iiif_side},
               {"maxHeight", most_iiif_side},
               {"tiles", describe_tiles(levels)},
               {"sizes", json::array()},
               {"preferredFormats", json::array({"jpg"})},
               {"extraQualities", json::array({"color", "gray", "bitonal"})},
               {"extraFormats", json::array()},
               {"extraFeatures", json::array({"canonicalLinkHeader", "mirroring",
                                              "profileLinkHeader", "sizeUpscaling"})}};
  for (size_t i = levels.size(); i-- > 0;)
    if (std::max(levels[i].width, levels[i].height) <= most_iiif_side)
      info["sizes"].push_back(sides_of(levels[i].width, levels[i].height));
  HttpReply reply = iiif_reply(info);
  if (question.accept.find("application/ld+json") != std::string::npos)
    reply.content_type = fmt::format("application/ld+json;profile=\"{}\"", image_context);
  reply.headers["Vary"] = "Accept";
  return reply;
}

std::string encode_iiif(const Image8& image, IiifRequest::Format format) {
  const std::vector<uint8_t> bytes = [&] {
    if (format == IiifRequest::Format::png) return encode_png(image, "", "a picture of IIIF");
    std::vector<uint8_t> jpeg;
    encode_jpeg(image, iiif_jpeg_quality, false, jpeg);
    return jpeg;
  }();
  return {bytes.begin(), bytes.end()};
}

HttpReply answer_image(const ServedPiece& asked, std::string_view request_text,
                       const HttpQuestion& question) {
  const IiifQuestion read = read_iiif_request(request_text, asked.width(), asked.height());
  if (read.status != 200) return refuse_iiif(read.status, "bad_request", read.problem);
  HttpReply reply;
  const IiifRequest& request = read.request;
  const PicturePyramid& pyramid = asked.pyramid();
  if (const auto tile = find_iiif_tile(pyramid, request); !tile.empty()) {
    reply.body.assign(tile.begin(), tile.end());
  } else {
    const bool is_large = iiif_cost(pyramid, request) > large_cost;
    if (is_large && !large_places.try_acquire()) {
      reply = refuse_iiif(503, "busy",
                          "two large pictures are being made; please come back in a moment");
      reply.headers["Retry-After"] = "2";
      return reply;
    }
    struct Leave {
      bool is_large;
      ~Leave() {
        if (is_large) large_places.release();
      }
    } const leave{is_large};
    reply.body = encode_iiif(make_iiif_image(pyramid, request), request.format);
  }
  const bool is_png = request.format == IiifRequest::Format::png;
  reply.content_type = is_png ? "image/png" : "image/jpeg";
  reply.headers["Link"] = fmt::format("<{}/{}>;rel=\"canonical\", <{}>;rel=\"profile\"",
                                      asked.address(question), read.canonical, image_profile);
  return reply;
}

// Writes a text in each language that it has, as the Presentation API has them.
json in_languages(const LocalText& text) {
  json all = json::object();
  for (const auto& [lang, words] : text) all[lang] = json::array({words});
  return all;
}

// Writes what a canvas says of a piece: its label, its text, its provenance.
void describe_point(const PointOfInterest& point, json& canvas) {
  if (!point.title.empty()) canvas["label"] = in_languages(point.title);
  if (!point.text.empty()) canvas["summary"] = in_languages(point.text);
  json metadata = json::array();
  for (const auto& [element, value] : point.provenance) {
    std::string label = element;
    if (!label.empty() && label[0] >= 'a' && label[0] <= 'z') label[0] = char(label[0] - 'a' + 'A');
    metadata.push_back({{"label", in_languages({{"en", label}})}, {"value", in_languages(value)}});
  }
  if (!metadata.empty()) canvas["metadata"] = std::move(metadata);
}

json describe_canvas(const ServedPiece& shown, const HttpQuestion& question) {
  const Exhibit& exhibit = *shown.served.exhibit;
  const std::string address = shown.address(question), id = address + "/canvas";
  const int64_t width = shown.width(), height = shown.height();
  const IiifSize largest = largest_iiif_size(width, height);
  json canvas = {{"id", id}, {"type", "Canvas"}, {"width", width}, {"height", height}};
  canvas["label"] = {{"none", json::array({shown.piece->id})}};
  if (const PointOfInterest* point = find_point(exhibit, shown.piece->id))
    describe_point(*point, canvas);
  const json service = {{"id", address}, {"type", "ImageService3"}, {"profile", "level2"}};
  const json body = {{"id", address + "/full/max/0/default.jpg"},
                     {"type", "Image"},
                     {"format", "image/jpeg"},
                     {"width", largest.width},
                     {"height", largest.height},
                     {"service", json::array({service})}};
  const json annotation = {{"id", id + "/painting"},
                           {"type", "Annotation"},
                           {"motivation", "painting"},
                           {"body", body},
                           {"target", id}};
  const json page = {
      {"id", id + "/page"}, {"type", "AnnotationPage"}, {"items", json::array({annotation})}};
  canvas["items"] = json::array({page});
  const json size = {{"@context", "http://iiif.io/api/annex/services/physdim/1/context.json"},
                     {"id", id + "/size"},
                     {"type", "PhysicalDimensions"},
                     {"profile", "http://iiif.io/api/annex/services/physdim"},
                     {"physicalScale", double(shown.piece->width) * 100 / double(width)},
                     {"physicalUnits", "cm"}};
  canvas["service"] = json::array({size});
  return canvas;
}

HttpReply answer_manifest(const IiifExhibit& served, const HttpQuestion& question) {
  const Exhibit& exhibit = *served.exhibit;
  json items = json::array();
  for (const ExhibitPiece& piece : exhibit.pieces)
    if (piece.picture) items.push_back(describe_canvas({served, &piece}, question));
  if (items.empty())
    return refuse_iiif(404, "no_pieces", "there are no large pictures in '" + exhibit.id + "'");
  json manifest = {
      {"@context", presentation_context},
      {"id", base_address(served.address, question.site) + escaped(exhibit.id) + "/manifest.json"},
      {"type", "Manifest"},
      {"label", in_languages(exhibit.title)}};
  if (!exhibit.description.empty()) manifest["summary"] = in_languages(exhibit.description);
  manifest["items"] = std::move(items);
  HttpReply reply = iiif_reply(manifest);
  if (question.accept.find("application/ld+json") != std::string::npos)
    reply.content_type = fmt::format("application/ld+json;profile=\"{}\"", presentation_context);
  reply.headers["Vary"] = "Accept";
  return reply;
}

// The path behind /iiif/.
HttpReply answer_path(const IiifSources& sources, const HttpQuestion& question,
                      const std::string& path) {
  const std::string id = path.substr(0, path.find('/'));
  const std::string rest = path.substr(std::min(id.size() + 1, path.size()));
  if (rest == "manifest.json")
    if (const IiifExhibit served = sources.find(id); served.exhibit)
      return kept_a_day(answer_manifest(served, question), sources);
  const ServedPiece asked = find_piece(sources, id);
  if (!asked.piece)
    return refuse_iiif(404, "unknown_picture", "there is no picture '" + id + "' here");
  if (rest.empty()) {
    const std::string address = asked.address(question) + "/info.json";
    HttpReply reply = iiif_reply({{"info", address}}, 303);
    reply.headers["Location"] = address;
    return reply;
  }
  return kept_a_day(
      rest == "info.json" ? answer_info(asked, question) : answer_image(asked, rest, question),
      sources);
}

}  // namespace

HttpReply answer_iiif(const IiifSources& sources, const HttpQuestion& question) {
  const std::string below = "/iiif/";
  HttpReply reply;
  try {
    if (question.method == "OPTIONS") {
      reply.status = 204;
      reply.headers["Access-Control-Allow-Methods"] = "GET, HEAD, OPTIONS";
      reply.headers["Access-Control-Allow-Headers"] = "*";
      reply.headers["Access-Control-Max-Age"] = "86400";
    } else {
      reply = answer_path(sources, question,
                          question.path.substr(std::min(below.size(), question.path.size())));
    }
  } catch (const LoadError& error) {
    log::debug("{}: {}", question.path, error.what());
    reply = refuse_iiif(500, "unreadable", "the picture's file cannot be read there");
  }
  // Pages of other sites may show and read it.
  reply.headers["Access-Control-Allow-Origin"] = "*";
  reply.headers["Access-Control-Expose-Headers"] = "Link";
  reply.headers["Cross-Origin-Resource-Policy"] = "cross-origin";
  return reply;
}

}  // namespace wellspring::show
