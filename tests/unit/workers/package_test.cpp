// SPDX-License-Identifier: Apache-2.0
// A worker gets the files of a package whole, or says why not; nothing that it gets leaves its
// folder.
#include "workers/package/package.h"

#include <gtest/gtest.h>

#include "unit/folder.h"
#include "workers/package/fetch.h"
#include "workers/package/shelf.h"

namespace wellspring::test {
namespace {

namespace fs = std::filesystem;
using What = PackageFetch::What;

const std::string large(700'000, 'x');  // three parts

// A server's package, and a worker's folder.
struct Both {
  Folder server, worker;
  PackageShelf shelf{server.file("room"), server.file("room.maps")};
  double now = 100;
  int parts = 0;

  Both() {
    fs::create_directories(server.path / "room/figures");
    server.write("room/exhibit.json", "{}");
    server.write("room/scene.glb", large);
    server.write("room/empty", "");
    server.write("room/.hidden", "no");
    server.write("room/figures/guide.x3d", "<X3D/>");
  }
  // Carries questions and answers until the fetch ends, or so many parts have come.
  std::optional<PackageFetch::Result> carry(PackageFetch& fetch, int most = 1000) {
    for (int i = 0; i < most && fetch.busy(); i++, now += 0.01)
      if (const auto question = fetch.ask(now)) {
        parts++;
        fetch.take(shelf.answer(*question), now);
      }
    return fetch.take_result();
  }
  PackageFetch make_fetch(uint64_t most = 1 << 30) {
    return PackageFetch(worker.path.string(), most);
  }
  std::string read(const std::string& folder, const std::string& name) const {
    std::ifstream in(fs::path(folder) / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
};

TEST(PackageFetch, BringsEveryFile) {
  Both both;
  both.server.write("room.maps", "light");
  PackageFetch fetch = both.make_fetch();
  ASSERT_TRUE(fetch.begin(1, "room", What::package, both.now));
  const auto result = both.carry(fetch);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->problem, "");
  EXPECT_EQ(both.read(result->folder, "room/scene.glb"), large);
  EXPECT_EQ(both.read(result->folder, "room/figures/guide.x3d"), "<X3D/>");
  EXPECT_EQ(both.read(result->folder, "room.maps"), "light");
  EXPECT_TRUE(fs::exists(fs::path(result->folder) / "room/empty"));
  EXPECT_FALSE(fs::exists(fs::path(result->folder) / "room/.hidden"));
}

TEST(PackageFetch, GoesOnWithHalfAFileAfterAKill) {
  Both both;
  {
    PackageFetch killed = both.make_fetch();
    killed.begin(1, "room", What::package, both.now);
    both.carry(killed, 5);
    ASSERT_TRUE(killed.busy());
  }
  PackageFetch fetch = both.make_fetch();
  both.parts = 0;
  fetch.begin(2, "room", What::package, both.now);
  const auto result = both.carry(fetch);
  ASSERT_TRUE(result && result->problem.empty());
  EXPECT_EQ(both.read(result->folder, "room/scene.glb"), large);
  EXPECT_LT(both.parts, 7) << "the hash of the list, and what was missing";
}

TEST(PackageFetch, BringsOnlyWhatHasChanged) {
  Both both;
  PackageFetch fetch = both.make_fetch();
  fetch.begin(1, "room", What::package, both.now);
  const auto first = both.carry(fetch);
  ASSERT_TRUE(first);
  both.server.write("room/exhibit.json", "{\"id\":1}");
  both.parts = 0;
  EXPECT_FALSE(fetch.begin(1, "room", What::package, both.now)) << "not at once";
  both.now += 60;
  ASSERT_TRUE(fetch.begin(1, "room", What::package, both.now));
  const auto second = both.carry(fetch);
  ASSERT_TRUE(second);
  EXPECT_EQ(both.parts, 3) << "the list's hash, the list, one file";
  EXPECT_EQ(both.read(second->folder, "room/exhibit.json"), "{\"id\":1}");
  EXPECT_EQ(both.read(first->folder, "room/exhibit.json"), "{}") << "somebody may still read it";
}

TEST(PackageFetch, TakesWhatIsHereAlready) {
  Both both;
  fs::create_directories(both.worker.path / "own/room");
  both.worker.write("own/room/scene.glb", large);
  PackageFetch fetch = both.make_fetch();
  fetch.use(both.worker.file("own/room"));
  fetch.begin(1, "room", What::package, both.now);
  const auto result = both.carry(fetch);
  ASSERT_TRUE(result && result->problem.empty());
  EXPECT_EQ(both.parts, 4);
  EXPECT_EQ(both.read(result->folder, "room/scene.glb"), large);
}

TEST(PackageFetch, LetsOneProcessFetchAtATime) {
  Both both;
  PackageFetch first = both.make_fetch(), second = both.make_fetch();
  ASSERT_TRUE(first.begin(1, "room", What::package, both.now));
  EXPECT_FALSE(second.begin(1, "room", What::package, both.now));
  ASSERT_TRUE(both.carry(first));
  both.parts = 0;
  ASSERT_TRUE(second.begin(1, "room", What::package, both.now));
  const auto result = both.carry(second);
  ASSERT_TRUE(result);
  EXPECT_EQ(both.parts, 2) << "the list's hash, and the list";
  EXPECT_EQ(both.read(result->folder, "room/scene.glb"), large);
}

TEST(PackageFetch, BringsMapsAlone) {
  Both both;
  both.server.write("room/light.maps", "shipped");
  both.server.write("room.maps", "baked");
  PackageFetch fetch = both.make_fetch();
  fetch.begin(1, "room", What::maps, both.now);
  const auto result = both.carry(fetch);
  ASSERT_TRUE(result);
  ASSERT_EQ(result->maps.size(), 2u);
  EXPECT_EQ(both.read("", result->maps[0]), "baked");
  EXPECT_EQ(both.read("", result->maps[1]), "shipped");
  EXPECT_EQ(both.parts, 4);
}

TEST(PackageFetch, SaysWhyItFails) {
  Both both;
  PackageFetch small = both.make_fetch(1000);
  small.begin(1, "room", What::package, both.now);
  auto result = both.carry(small);
  ASSERT_TRUE(result);
  EXPECT_NE(result->problem.find("--fetch-most"), std::string::npos) << result->problem;

  PackageFetch none = both.make_fetch(0);
  EXPECT_FALSE(none.begin(1, "room", What::package, both.now));

  PackageFetch alone = both.make_fetch();
  alone.begin(1, "room", What::package, both.now);
  for (int i = 0; i < 100 && alone.busy(); i++, both.now++) alone.ask(both.now);
  result = alone.take_result();
  ASSERT_TRUE(result);
  EXPECT_NE(result->problem.find("does not answer"), std::string::npos) << result->problem;
}

TEST(PackageFetch, IsNotMisledByDamagedOrForeignParts) {
  Both both;
  PackageFetch fetch = both.make_fetch();
  fetch.begin(1, "room", What::package, both.now);
  bool damaged = false;
  while (fetch.busy()) {
    both.now += 0.01;
    const auto question = fetch.ask(both.now);
    if (!question) continue;
    FilePart part = both.shelf.answer(*question);
    FilePart other = part;
    other.server = 2;
    fetch.take(other, both.now);
    other = part, other.offset += 7;
    fetch.take(other, both.now);
    if (part.size == large.size()) part.bytes[0] ^= 1, damaged = true;
    fetch.take(part, both.now);
    fetch.take(part, both.now);  // twice
  }
  ASSERT_TRUE(damaged);
  const auto result = fetch.take_result();
  ASSERT_TRUE(result);
  EXPECT_NE(result->problem.find("damaged"), std::string::npos) << result->problem;
}

TEST(PackageFetch, SaysSoIfTheServersFilesChangeMeanwhile) {
  Both both;
  PackageFetch fetch = both.make_fetch();
  fetch.begin(1, "room", What::package, both.now);
  both.carry(fetch, 3);
  ASSERT_TRUE(fetch.busy());
  both.server.write("room/scene.glb", "other");
  both.server.write("room/exhibit.json", "[]  ");
  both.server.write("room/figures/guide.x3d", "<X3D />");
  const auto result = both.carry(fetch);
  ASSERT_TRUE(result);
  EXPECT_NE(result->problem.find("changed"), std::string::npos) << result->problem;
}

TEST(PackageList, RefusesPathsThatLeaveTheirFolder) {
  PackageList read;
  const auto is_read = [&](std::vector<std::string> paths) {
    PackageList list;
    for (std::string& path : paths) list.push_back({std::move(path), 1, {}});
    return read_list(write_list(list), read);
  };
  EXPECT_TRUE(is_read({"room/a", "room/b/c"}));
  for (const char* bad : {"", "/etc/passwd", "..", "room/../x", "room//x", "room/.", "room\\x"})
    EXPECT_FALSE(is_read({bad})) << bad;
  EXPECT_FALSE(is_read({"room/a", "room/a"}));
  EXPECT_FALSE(is_read({"room/a", "room/a/b"}));
  EXPECT_FALSE(is_read({"room/b", "room/a"}));
  const std::string whole = write_list({{"room/a", 1, {}}});
  for (size_t size = 0; size < whole.size(); size++)
    EXPECT_FALSE(read_list(whole.substr(0, size), read)) << size;
}

}  // namespace
}  // namespace wellspring::test
