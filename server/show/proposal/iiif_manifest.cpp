// SPDX-License-Identifier: Apache-2.0
#include "show/proposal/iiif_manifest.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <string_view>

#include "base/load_error.h"
#include "base/unicode.h"
#include "json/text.h"
#include "show/exhibit/json_fields.h"
#include "store/remote/http_get.h"

namespace wellspring::show {
namespace {

using Value = nlohmann::json;

constexpr size_t most_plain_bytes = 4000;                   // bytes of one text
constexpr double least_width_m = 0.005, most_width_m = 30;  // metres that are believed

// Names of facts in the languages of many manifests, and the elements that they are.
struct FactName {
  const char* name;
  const char* element;
};
constexpr FactName fact_names[] = {{"creator", "creator"},
                                   {"artist", "creator"},
                                   {"author", "creator"},
                                   {"painter", "creator"},
                                   {"maker", "creator"},
                                   {"künstler", "creator"},
                                   {"künstler/in", "creator"},
                                   {"urheber", "creator"},
                                   {"autor", "creator"},
                                   {"auteur", "creator"},
                                   {"artiste", "creator"},
                                   {"créateur", "creator"},
                                   {"date", "date"},
                                   {"dates", "date"},
                                   {"created", "date"},
                                   {"date created", "date"},
                                   {"datum", "date"},
                                   {"datierung", "date"},
                                   {"fecha", "date"},
                                   {"type", "type"},
                                   {"format", "format"},
                                   {"medium", "format"},
                                   {"technique", "format"},
                                   {"technik", "format"},
                                   {"publisher", "publisher"},
                                   {"subject", "subject"},
                                   {"identifier", "identifier"},
                                   {"shelfmark", "identifier"},
                                   {"accession number", "identifier"},
                                   {"inventory number", "identifier"},
                                   {"inventarnummer", "identifier"},
                                   {"source", "source"},
                                   {"rights", "rights"},
                                   {"license", "rights"}};

// Returns the text without tags, with entities read and spaces joined, cut at most_plain_bytes.
std::string plain_text(std::string_view markup) {
  struct Entity {
    std::string_view name, text;
  };
  constexpr Entity entities[] = {{"&amp;", "&"},   {"&lt;", "<"},  {"&gt;", ">"},
                                 {"&quot;", "\""}, {"&#39;", "'"}, {"&nbsp;", " "}};
  std::string plain;
  const auto add = [&](char c) {
    if (uint8_t(c) > ' ' && c != 127) plain += c;
    else if (!plain.empty() && plain.back() != ' ') plain += ' ';
  };
  for (size_t i = 0; i < markup.size(); i++) {
    const std::string_view rest = markup.substr(i);
    const bool is_tag = rest.size() > 1 && rest[0] == '<' &&
                        (std::isalpha(uint8_t(rest[1])) || rest[1] == '/' || rest[1] == '!');
    const size_t close = is_tag ? rest.find('>') : rest.npos;
    if (close != rest.npos) {
      const std::string_view tag = rest.substr(0, 3);
      if (tag == "<br" || tag == "<p>" || tag == "</p" || tag == "<li") add(' ');
      i += close;
      continue;
    }
    const auto entity = std::ranges::find_if(
        entities, [&](const Entity& one) { return rest.starts_with(one.name); });
    if (entity == std::end(entities)) {
      add(rest[0]);
      continue;
    }
    for (const char c : entity->text) add(c);
    i += entity->name.size() - 1;
  }
  if (plain.size() > most_plain_bytes) {
    size_t end = most_plain_bytes;
    while (end > 0 && (uint8_t(plain[end]) & 0xc0) == 0x80) end--;
    plain.resize(end);
  }
  while (!plain.empty() && plain.back() == ' ') plain.pop_back();
  return nfc(plain);
}

void add_text(LocalText& to, const std::string& tag, const Value& text) {
  if (!text.is_string()) return;
  const std::string plain = plain_text(text.get_ref<const std::string&>());
  if (plain.empty()) return;
  std::string& all = to[is_language_tag(tag) && tag != "none" ? tag : ""];
  if (all.size() + plain.size() > most_plain_bytes) return;
  all += (all.empty() ? "" : "; ") + plain;
}

// Reads a text of either version: {"en": ["..."]}, "...", {"@value": "...", "@language": "en"}, or
// a list of those.
LocalText texts_of(const Value& value) {
  LocalText texts;
  const auto add = [&](const Value& one) {
    if (one.is_string()) add_text(texts, "", one);
    else if (one.is_object() && one.contains("@value")) {
      const Value tag = one.value("@language", Value());
      add_text(texts, tag.is_string() ? tag.get<std::string>() : "", one["@value"]);
    } else if (one.is_object()) {
      for (const auto& [tag, list] : one.items()) {
        if (!list.is_array()) add_text(texts, tag, list);
        else
          for (const Value& text : list) add_text(texts, tag, text);
      }
    }
  };
  if (value.is_array()) std::ranges::for_each(value, add);
  else add(value);
  return texts;
}

// Returns the member; null where there is none.
const Value& member(const Value& of, const char* name) {
  static const Value none;
  if (!of.is_object()) return none;
  const auto found = of.find(name);
  return found == of.end() ? none : *found;
}
std::string word(const Value& of, const char* name) {
  const Value& found = member(of, name);
  return found.is_string() ? found.get<std::string>() : "";
}
// Returns the address of version 3, or of version 2.
std::string id_of(const Value& of) {
  const std::string id = word(of, "id");
  return id.empty() ? word(of, "@id") : id;
}
// Calls each(value) for one, or for each of a list.
template <class Each>
void each_of(const Value& value, const Each& each) {
  if (value.is_array())
    for (const Value& one : value) each(one);
  else if (value.is_object()) each(value);
}

bool is_image_service(const Value& service) {
  const std::string type = word(service, "type") + word(service, "@type");
  if (type.find("ImageService") != type.npos) return true;
  const Value& profile = member(service, "profile");
  const Value& first = profile.is_array() && !profile.empty() ? profile.front() : profile;
  const std::string text =
      (first.is_string() ? first.get<std::string>() : "") + " " + word(service, "@context");
  return text.find("iiif.io/api/image") != text.npos ||
         text.find("library.stanford.edu/iiif/image-api") != text.npos;
}

// Returns the metres of a canvas's unit; nothing if no service tells them.
std::optional<double> metres_a_unit(const Value& canvas) {
  std::optional<double> found;
  for (const char* name : {"service", "services"})
    each_of(member(canvas, name), [&](const Value& service) {
      const std::string kind =
          word(service, "profile") + word(service, "@context") + word(service, "type");
      if (kind.find("physdim") == kind.npos && !service.contains("physicalScale")) return;
      const Value& scale = member(service, "physicalScale");
      const std::string unit = word(service, "physicalUnits");
      const double metres = unit == "mm"   ? 1e-3
                            : unit == "cm" ? 1e-2
                            : unit == "in" ? 0.0254
                            : unit == "m"  ? 1
                                           : 0;
      if (!scale.is_number() || metres == 0) return;
      if (const double all = scale.get<double>() * metres; std::isfinite(all) && all > 0)
        found = all;
    });
  return found;
}

std::string lower_case(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = char(c | 0x20);
  while (!text.empty() && (text.back() == ':' || text.back() == ' ')) text.pop_back();
  return text;
}

// Adds what metadata and rights of a manifest or a canvas tell, where nothing is told yet.
void add_provenance(const Value& from, std::map<std::string, LocalText>& to) {
  std::map<std::string, LocalText> found;
  each_of(member(from, "metadata"), [&](const Value& fact) {
    LocalText value = texts_of(member(fact, "value"));
    if (value.empty()) return;
    for (const auto& [tag, label] : texts_of(member(fact, "label")))
      for (const FactName& known : fact_names)
        if (lower_case(label) == known.name && !found.contains(known.element)) {
          found[known.element] = value;
          return;
        }
  });
  LocalText rights = texts_of(member(member(from, "requiredStatement"), "value"));
  if (rights.empty()) rights = texts_of(member(from, "attribution"));
  const LocalText licence =
      texts_of(from.contains("rights") ? member(from, "rights") : member(from, "license"));
  if (!licence.empty()) {
    const std::string& address = licence.begin()->second;
    if (rights.empty()) rights[""] = address;
    else
      for (auto& [tag, text] : rights) text += "; " + address;
  }
  if (!rights.empty()) found["rights"] = rights;
  for (auto& [element, text] : found) to.try_emplace(element, std::move(text));
}

// Reads one file; errors name the place as a JSON pointer.
struct ManifestReader {
  const std::string& file;
  const Value all;
  IiifManifest made;
  bool third = true;
  std::map<std::string, LocalText> common;  // provenance of the whole

  [[noreturn]] void fail(const std::string& where, const std::string& what) const {
    throw LoadError(file, where, what);
  }
  const Value& list(const Value& of, const std::string& at, const char* name) const {
    const Value& found = member(of, name);
    if (found.is_null()) fail(at + "/" + name, "is missing");
    if (!found.is_array()) fail(at + "/" + name, "is no list");
    if (found.size() > most_canvases)
      fail(at + "/" + name, fmt::format("has more than {} items", most_canvases));
    return found;
  }
  double side(const Value& canvas, const std::string& at, const char* name) const {
    const Value& found = member(canvas, name);
    if (found.is_null()) fail(at + "/" + name, "is missing");
    if (!found.is_number() || !(found.get<double>() > 0) || !(found.get<double>() <= 1e9))
      fail(at + "/" + name, "is no number above 0");
    return found.get<double>();
  }

  // Adds the pictures that are painted on a canvas to `images`; of a choice the first.
  void add_image(const Value& body, std::vector<const Value*>& images) const {
    const std::string type = word(body, "type") + word(body, "@type");
    if (type == "oa:Choice") return add_image(member(body, "default"), images);
    if (type == "Choice") {
      const Value& items = member(body, "items");
      if (items.is_array() && !items.empty()) add_image(items.front(), images);
    } else if (type == "oa:SpecificResource") {
      add_image(member(body, "full"), images);
    } else if (type == "SpecificResource") {
      add_image(member(body, "source"), images);
    } else if (type == "Image" || type == "dctypes:Image") {
      images.push_back(&body);
    }
  }
  std::vector<const Value*> images_of(const Value& canvas, const std::string& at) const {
    std::vector<const Value*> images;
    if (!third) {
      for (const Value& image : list(canvas, at, "images"))
        add_image(member(image, "resource"), images);
      return images;
    }
    for (const Value& page : list(canvas, at, "items")) {
      const Value& items = member(page, "items");
      if (!items.is_array()) continue;
      for (const Value& annotation : items)
        if (const Value& motive = member(annotation, "motivation");
            motive == "painting" || motive == Value::array({"painting"}))
          each_of(member(annotation, "body"), [&](const Value& one) { add_image(one, images); });
    }
    return images;
  }

  void find_source(const Value& image, ManifestPicture& picture) const {
    each_of(member(image, "service"), [&](const Value& service) {
      if (picture.is_service || !is_image_service(service)) return;
      picture.source = id_of(service);
      picture.is_service = store::is_http_address(picture.source);
    });
    if (!picture.is_service) picture.source = id_of(image);
  }

  void read_canvas(const Value& canvas, const std::string& at) {
    if (!canvas.is_object()) fail(at, "is no object");
    if (const std::string type = word(canvas, third ? "type" : "@type");
        type != (third ? "Canvas" : "sc:Canvas"))
      fail(at + (third ? "/type" : "/@type"), "is no canvas");
    ManifestPicture picture;
    picture.where = at;
    picture.width = side(canvas, at, "width"), picture.height = side(canvas, at, "height");
    const std::vector<const Value*> images = images_of(canvas, at);
    if (images.empty()) return tell(at, "shows no picture");
    if (images.size() > 1)
      tell(at, fmt::format("shows {} pictures: the first of them hangs", images.size()));
    find_source(*images.front(), picture);
    if (picture.source.empty()) fail(at, "has a picture without an id");
    if (picture.is_service && !store::read_http_address(picture.source))
      fail(at, "'" + picture.source + "' is no http or https address");
    if (picture.source.size() > most_address_bytes - 10)
      return tell(at, "has an address that is too long");
    if (!picture.is_service && store::is_http_address(picture.source))
      return tell(at, "has no image service; download its picture to hang it");
    if (const auto metres = metres_a_unit(canvas)) {
      const double width = *metres * picture.width;
      if (width >= least_width_m && width <= most_width_m) picture.width_m = width;
      else tell(at, fmt::format("would be {:.3g} m wide, which is not believed", width));
    }
    picture.label = texts_of(member(canvas, "label"));
    picture.text = texts_of(member(canvas, third ? "summary" : "description"));
    add_provenance(canvas, picture.provenance);
    for (const auto& [element, text] : common) picture.provenance.try_emplace(element, text);
    made.pictures.push_back(std::move(picture));
  }
  void tell(const std::string& at, const std::string& what) {
    made.told.push_back("the canvas " + at + " " + what);
  }

  void read() {
    if (!all.is_object()) fail("", "is no object");
    const std::string type = word(all, "type"), old = word(all, "@type");
    third = type == "Manifest";
    if (!third && old != "sc:Manifest") {
      const char* place = type.empty() && !old.empty() ? "/@type" : "/type";
      fail(place, type.empty() && old.empty() ? "is missing: this is no IIIF manifest"
                                              : "'" + type + old + "' is no manifest");
    }
    made.id = id_of(all);
    made.label = texts_of(member(all, "label"));
    made.text = texts_of(member(all, third ? "summary" : "description"));
    add_provenance(all, common);
    std::string at = "";
    const Value* from = &all;
    if (!third) {
      const Value& sequences = list(all, "", "sequences");
      if (sequences.empty()) fail("/sequences", "is empty");
      from = &sequences.front(), at = "/sequences/0";
    }
    const char* name = third ? "items" : "canvases";
    const Value& canvases = list(*from, at, name);
    for (size_t i = 0; i < canvases.size(); i++)
      read_canvas(canvases[i], fmt::format("{}/{}/{}", at, name, i));
    if (made.pictures.empty()) fail(at + "/" + name, "shows no picture that could hang");
  }
};

}  // namespace

IiifManifest load_manifest(const std::string& file) {
  const std::string text = wellspring::json::read_json_text(file);
  ManifestReader reader{file, wellspring::json::parse_json_file(file, text), {}, true, {}};
  reader.read();
  return std::move(reader.made);
}

}  // namespace wellspring::show
