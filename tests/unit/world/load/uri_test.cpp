// SPDX-License-Identifier: Apache-2.0
#include "gltf/file.h"

#include <gtest/gtest.h>

#include "unit/world/load/asset.h"

namespace wellspring::test {
namespace {

namespace fs = std::filesystem;

// A package whose glTF file lies in its folder models.
struct Package {
  TempFolder folder;
  gltf::File file;
  Package() {
    folder.write("package/exhibit.json", "{}");
    const json empty = {{"asset", {{"version", "2.0"}}}};
    const std::string path = folder.write("package/models/scene.gltf", empty.dump());
    file = gltf::load_gltf(path, (folder.path() / "package").string());
  }
  void write(const std::string& name) { folder.write("package/" + name, "x"); }
  // The path in the package that a URI means; "": there is no such file.
  std::string find(const std::string& uri) const {
    const auto found = gltf::find_uri(file, "/images/0/uri", uri);
    return found ? found->lexically_relative(file.package).string() : "";
  }
  std::string refusal(const std::string& uri) const {
    try {
      find(uri);
    } catch (const LoadError& error) {
      EXPECT_EQ(error.where, "/images/0/uri");
      return error.what_;
    }
    ADD_FAILURE() << uri;
    return "";
  }
};

TEST(Uri, DotSegmentsAreResolvedBeforeTheyAreJudged) {
  Package package;
  package.write("textures/a.png");
  package.write("models/tex/b.png");
  EXPECT_EQ(package.find("../textures/a.png"), "textures/a.png");
  EXPECT_EQ(package.find("%2e%2e/textures/./a.png"), "textures/a.png");
  EXPECT_EQ(package.find("tex/../../models/tex/b.png"), "models/tex/b.png");
  EXPECT_EQ(package.find("nowhere/../tex/b.png"), "models/tex/b.png");
  for (const char* uri : {"../../package/textures/a.png", "tex/../../../a.png", "..%2f..%2fa.png",
                          "/textures/a.png", "//host/a.png"})
    EXPECT_NE(package.refusal(uri).find("does not lie inside the package"), std::string::npos);
}

TEST(Uri, EncodedCharactersMeanThemselves) {
  Package package;
  for (const char* name : {"a b.png", "plan#1.png", "100%.png", "a+b.png", "t:1.png", "q?.png"})
    package.write(std::string("models/") + name);
  EXPECT_EQ(package.find("a%20b.png"), "models/a b.png");
  EXPECT_EQ(package.find("a b.png"), "models/a b.png");
  EXPECT_EQ(package.find("plan%231.png"), "models/plan#1.png");
  EXPECT_EQ(package.find("100%25.png"), "models/100%.png");
  EXPECT_EQ(package.find("a+b.png"), "models/a+b.png");
  EXPECT_EQ(package.find("t%3A1.png"), "models/t:1.png");
  EXPECT_EQ(package.find("./t:1.png"), "models/t:1.png");
  EXPECT_EQ(package.find("a+b.png?version=2#top"), "models/a+b.png");
  EXPECT_EQ(package.find("plan#1.png"), "");  // a fragment
  EXPECT_NE(package.refusal("100%.png").find("%25"), std::string::npos);
}

TEST(Uri, SchemesOtherThanDataAreRefusedInAnyCase) {
  Package package;
  for (const char* uri : {"http://a/b.png", "FILE:///etc/passwd", "c:\\b.png", "t:1.png"})
    EXPECT_NE(package.refusal(uri).find("only data: and files"), std::string::npos) << uri;
  EXPECT_NE(package.refusal("tex\\b.png").find("backslash"), std::string::npos);
}

TEST(Uri, DataIsReadHoweverItIsWritten) {
  Package package;
  for (const char* uri : {"data:;base64,AAEC+w==", "DATA:text/plain;BASE64,AAEC+w",
                          "data:a/b;charset=x;base64,AAEC%2Bw%3D%3D", "data:,%00%01%02%fb",
                          "Data:application/octet-stream;Base64,AAEC-w=="}) {
    const auto bytes = gltf::read_uri(package.file, "/buffers/0/uri", uri);
    ASSERT_TRUE(bytes) << uri;
    EXPECT_EQ(*bytes, (gltf::Bytes{0, 1, 2, 0xfb})) << uri;
  }
  EXPECT_THROW(gltf::read_uri(package.file, "/buffers/0/uri", "data:;base64,A*"), LoadError);
  EXPECT_THROW(gltf::read_uri(package.file, "/buffers/0/uri", "data:;base64"), LoadError);
}

TEST(Uri, NamesAreComparedByUnicode) {
  Package package;
  const std::string one = "k\u0159\u00ed\u017e.png", apart = "kr\u030ci\u0301z\u030c.png";
  package.write("models/" + apart);
  EXPECT_EQ(package.find(apart), "models/" + apart);
  EXPECT_EQ(package.find(one), "models/" + apart);
  package.write("models/" + one);
  EXPECT_EQ(package.find(one), "models/" + one);  // byte for byte where that exists
  EXPECT_EQ(package.find(apart), "models/" + apart);
}

TEST(Uri, AMissingFileIsToldWithWhatWasTriedAndWhatIsNear) {
  Package package;
  package.write("textures/brick.png");
  const std::string told =
      gltf::no_such_file(package.file, "/images/0/uri", "../textures/Brick%2epng");
  EXPECT_NE(told.find("../textures/Brick%2epng"), std::string::npos) << told;
  EXPECT_NE(told.find("\"textures/Brick.png\""), std::string::npos) << told;
  EXPECT_NE(told.find("did you mean 'textures/brick.png'"), std::string::npos) << told;
}

}  // namespace
}  // namespace wellspring::test
