// SPDX-License-Identifier: Apache-2.0
// An exhibit of an IIIF manifest: what hangs, what is said of it, and what is refused.
#include "show/proposal/new_gallery.h"

#include <gtest/gtest.h>

#include "base/load_error.h"
#include "image/image.h"
#include "unit/show/exhibit/room_package.h"

namespace wellspring::test {
namespace {

// Returns a picture's canvas of version 3; `body` is its painting's picture.
json canvas_3(int width, int height, const json& body, const json& more = json::object()) {
  json canvas = {
      {"id", "https://a.example/canvas"},
      {"type", "Canvas"},
      {"width", width},
      {"height", height},
      {"items",
       {{{"type", "AnnotationPage"},
         {"items", {{{"type", "Annotation"}, {"motivation", "painting"}, {"body", body}}}}}}}};
  canvas.update(more);
  return canvas;
}
json file_body(const std::string& name) { return {{"id", name}, {"type", "Image"}}; }
json service_body(const std::string& address) {
  return {{"id", address + "/full/max/0/default.jpg"},
          {"type", "Image"},
          {"service", {{{"id", address}, {"type", "ImageService3"}, {"profile", "level1"}}}}};
}
json manifest_3(const json& canvases) {
  return {{"@context", "http://iiif.io/api/presentation/3/context.json"},
          {"id", "https://a.example/manifest.json"},
          {"type", "Manifest"},
          {"label", {{"de", {"Zwei Bilder"}}, {"en", {"Two pictures"}}}},
          {"rights", "http://creativecommons.org/publicdomain/mark/1.0/"},
          {"items", canvases}};
}

struct Hung {
  Folder folder;
  Hung() {
    Image8 image{40, 20, {}};
    image.rgb.resize(40 * 20 * 3, 120);
    const std::vector<uint8_t> png = encode_png(image, "", "a.png");
    std::filesystem::create_directories(folder.path / "some");
    folder.write("some/a b.PNG", std::string(png.begin(), png.end()));
  }
  NewExhibit make(const json& manifest) const {
    std::filesystem::remove_all(folder.path / "content");
    return make_new_gallery(folder.file("content"), "mine",
                            folder.write("manifest.json", manifest.dump()));
  }
  json exhibit() const { return json::parse(folder.read("content/mine/exhibit.json")); }
  std::string refusal(const json& manifest) const {
    try {
      make(manifest);
    } catch (const LoadError& error) {
      return error.what();
    }
    return "";
  }
};

TEST(NewGallery, PicturesOfFilesHangInARoomThatPassesItsCheck) {
  const Hung hung;
  const json physical = {{"profile", "http://iiif.io/api/annex/services/physdim"},
                         {"physicalScale", 0.1},
                         {"physicalUnits", "cm"}};
  const NewExhibit made = hung.make(
      manifest_3({canvas_3(40, 20, file_body("some/a%20b.PNG"), {{"service", {physical}}}),
                  canvas_3(400, 200, file_body("some/a%20b.PNG"), {{"label", {{"none", {"B"}}}}}),
                  canvas_3(20, 400, file_body("some/a%20b.PNG"))}));
  std::vector<Problem> problems;
  const Exhibit exhibit = read_exhibit(made.folder, problems);
  World world(exhibit.scene);
  check_places(exhibit, world, problems);
  check_sides(exhibit, world, problems);
  check_light(exhibit, world, problems);
  for (const Problem& problem : problems) ADD_FAILURE() << to_string(problem);
  ASSERT_EQ(exhibit.pieces.size(), 3u);
  EXPECT_NEAR(exhibit.pieces[0].width, 0.04f, 1e-4f) << "as the manifest tells";
  EXPECT_NEAR(exhibit.pieces[1].width, 1.8f, 1e-4f);
  EXPECT_NEAR(exhibit.pieces[2].width, 0.06f, 1e-4f) << "1.2 m high";
  EXPECT_EQ(exhibit.viewpoints.size(), 4u);
  EXPECT_EQ(exhibit.languages, (std::vector<std::string>{"de", "en"}));
  EXPECT_EQ(exhibit.points[1].title.at("de"), "B") << "a label without a language";
  EXPECT_EQ(exhibit.scene.lights.size(), 3u);
  EXPECT_FALSE(hung.exhibit().contains("allowed_hosts"));
  for (size_t i = 0; i < 3; i++) {
    const Viewpoint& view = exhibit.viewpoints[i + 1].view;
    const Hit hit = world.intersect({vec3(view.position - exhibit.scene.origin),
                                     0,
                                     {0, std::sin(view.pitch), -std::cos(view.pitch)}});
    EXPECT_EQ(exhibit.scene.objects[world.object_of(hit.instance)], exhibit.pieces[i].id);
  }
}

TEST(NewGallery, ServicesStayWhereTheyAreAndTheirHostsAreTold) {
  const Hung hung;
  const json facts =
      json::array({{{"label", {{"en", {"Artist"}}}}, {"value", {{"en", {"<b>Jan</b> &amp; Co."}}}}},
                   {{"label", {{"en", {"Weather"}}}}, {"value", {{"en", {"x"}}}}}});
  const NewExhibit made = hung.make(
      manifest_3({canvas_3(40, 20, service_body("https://iiif.example/x"), {{"metadata", facts}}),
                  canvas_3(40, 20, service_body("http://127.0.0.1:8080/y"))}));
  const json exhibit = hung.exhibit();
  EXPECT_EQ(exhibit["allowed_hosts"], json::array({"iiif.example", "127.0.0.1:8080"}));
  EXPECT_EQ(exhibit["pieces"][0]["source"], "https://iiif.example/x");
  EXPECT_EQ(exhibit["pieces"][0]["provenance"]["creator"]["en"], "Jan & Co.");
  EXPECT_EQ(exhibit["pieces"][0]["provenance"]["rights"]["de"],
            "http://creativecommons.org/publicdomain/mark/1.0/");
  EXPECT_EQ(exhibit["pieces"][0]["provenance"].size(), 2u);
  std::string told;
  for (const std::string& line : made.told) told += line + "\n";
  EXPECT_NE(told.find("iiif.example, 127.0.0.1:8080"), std::string::npos) << told;
}

TEST(NewGallery, VersionTwoIsReadToo) {
  const Hung hung;
  const json service = {{"@context", "http://iiif.io/api/image/2/context.json"},
                        {"@id", "https://iiif.example/z"},
                        {"profile", "http://iiif.io/api/image/2/level1.json"}};
  const json image = {{"resource",
                       {{"@id", "https://iiif.example/z/full/full/0/default.jpg"},
                        {"@type", "dctypes:Image"},
                        {"service", service}}}};
  hung.make({{"@type", "sc:Manifest"},
             {"label", "Old"},
             {"attribution", "A house"},
             {"metadata", {{{"label", "Date"}, {"value", "1504"}}}},
             {"sequences",
              {{{"canvases",
                 {{{"@type", "sc:Canvas"},
                   {"label", {{"@value", "Blatt"}, {"@language", "de"}}},
                   {"width", 300},
                   {"height", 400},
                   {"images", {image}}}}}}}}});
  const json piece = hung.exhibit()["pieces"][0];
  EXPECT_EQ(piece["source"], "https://iiif.example/z");
  EXPECT_EQ(piece["label"], (json{{"de", "Blatt"}}));
  EXPECT_EQ(piece["provenance"]["date"]["de"], "1504");
  EXPECT_EQ(piece["provenance"]["rights"]["de"], "A house");
  EXPECT_EQ(piece["width_m"], 0.9);
}

TEST(NewGallery, WrongManifestsAreRefusedWithTheirPlaceAndLeaveNothing) {
  const Hung hung;
  hung.folder.write("text.png", "no picture");
  const json good = canvas_3(40, 20, service_body("https://iiif.example/x"));
  json wide = good, other = good, list = good;
  wide["width"] = 0, other["type"] = "Range", list["items"] = 7;
  const std::pair<json, std::string> wrong[] = {
      {json::array(), ": is no object"},
      {{{"a", 1}}, "manifest.json: /type: is missing"},
      {{{"type", "Collection"}}, "/type: 'Collection' is no manifest"},
      {{{"@type", "sc:Manifest"}}, "/sequences: is missing"},
      {manifest_3(json::array()), "/items: shows no picture"},
      {manifest_3({good, wide}), "/items/1/width: is no number above 0"},
      {manifest_3(json::array({other})), "/items/0/type: is no canvas"},
      {manifest_3(json::array({list})), "/items/0/items: is no list"},
      {manifest_3(json::array({canvas_3(1, 1, file_body("../a.png"))})),
       "/items/0: '../a.png' leaves"},
      {manifest_3(json::array({canvas_3(1, 1, file_body("/etc/passwd"))})),
       "/items/0: '/etc/passwd' leaves"},
      {manifest_3(json::array({canvas_3(1, 1, file_body("none.png"))})),
       "/items/0: there is no file"},
      {manifest_3(json::array({canvas_3(1, 1, file_body("text.png"))})), "text.png: is no picture"},
      {manifest_3(json::array({canvas_3(1, 1, file_body("https://a.example/a.jpg"))})),
       "shows no picture"}};
  for (const auto& [manifest, told] : wrong)
    EXPECT_NE(hung.refusal(manifest).find(told), std::string::npos)
        << hung.refusal(manifest) << ", expected " << told;
  EXPECT_FALSE(std::filesystem::exists(hung.folder.path / "content" / "mine"));
}

}  // namespace
}  // namespace wellspring::test
