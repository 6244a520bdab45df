// SPDX-License-Identifier: Apache-2.0
// The program wellspring_render from outside: exit status, what it says, and that a replayed sample
// is the picture's. Skipped where the program is not built beside this one.
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "frame/picture_file.h"
#include "image/image.h"
#include "unit/light/statistics.h"

namespace wellspring::test {
namespace {

namespace fs = std::filesystem;

struct Answer {
  int status;
  std::string text;  // stdout and stderr
};

struct RenderProgram : testing::Test {
  fs::path program = fs::read_symlink("/proc/self/exe").parent_path() / "wellspring_render";
  fs::path folder = fs::temp_directory_path() / ("wellspring_render_" + std::to_string(getpid()));

  void SetUp() override {
    if (!fs::exists(program)) GTEST_SKIP() << program << " is not built";
    fs::create_directories(folder);
    // One triangle, two cameras, no light; the buffer is in the file.
    std::ofstream(folder / "scene.gltf")
        << R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1,2]}],
      "nodes":[{"mesh":0},{"name":"front","camera":0,"translation":[0.3,0.3,2]},
               {"name":"side","camera":0,"translation":[0.3,0.3,1]}],
      "cameras":[{"type":"perspective","perspective":{"yfov":0.7,"znear":0.1}}],
      "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
      "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
      "bufferViews":[{"buffer":0,"byteLength":36}],
      "buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";
  }
  void TearDown() override { fs::remove_all(folder); }

  std::string scene() const { return (folder / "scene.gltf").string(); }
  std::string out(const char* name) const { return (folder / name).string(); }
  Answer run(const std::string& arguments) const {
    Answer answer{-1, ""};
    FILE* pipe = popen((program.string() + " " + arguments + " 2>&1").c_str(), "r");
    std::array<char, 512> part;
    while (size_t n = std::fread(part.data(), 1, part.size(), pipe))
      answer.text.append(part.data(), n);
    answer.status = WEXITSTATUS(pclose(pipe));
    return answer;
  }
};

TEST_F(RenderProgram, ListsTechniques) {
  Answer answer = run("--list-techniques");
  EXPECT_EQ(answer.status, 0);
  for (const Technique& t : techniques())
    EXPECT_NE(answer.text.find(std::string(t.name) + "\n"), std::string::npos) << t.name;
}

TEST_F(RenderProgram, ExplainsWhatASceneNeedsWithoutRendering) {
  Answer answer = run(scene() + " --explain --environment 1,1,1");
  EXPECT_EQ(answer.status, 0);
  size_t used = answer.text.find("\nused\n"), left_out = answer.text.find("\nleft out\n");
  ASSERT_NE(used, std::string::npos) << answer.text;
  ASSERT_NE(left_out, std::string::npos) << answer.text;
  EXPECT_LT(answer.text.find("\n  environment "), left_out);
  EXPECT_GT(answer.text.find("\n  dispersion "), left_out);
  EXPECT_EQ(run(folder.string() + "/none.gltf --explain").status, 1);
}

TEST_F(RenderProgram, WritesEveryKindOfPicture) {
  for (const char* name : {"a.png", "a.jpg", "a.pfm", "a.exr"}) {
    Answer answer =
        run(scene() + " --technique direct --camera front --size 20x10 --spp 2 --out " + out(name));
    EXPECT_EQ(answer.status, 0) << answer.text;
    EXPECT_TRUE(fs::exists(folder / name)) << name;
    EXPECT_NE(answer.text.find("no light"), std::string::npos) << "the added light is told";
  }
  EXPECT_EQ(load_linear_picture(out("a.pfm")).color, load_linear_picture(out("a.exr")).color);
}

TEST_F(RenderProgram, ReplaysASampleOfThePicture) {
  std::string rest = " --camera front --size 8x8 --spp 1 --seed 5 --threads 2";
  ASSERT_EQ(run(scene() + rest + " --out " + out("a.pfm")).status, 0);
  Frame frame = load_linear_picture(out("a.pfm"));
  int lit = 0;
  for (int y = 0; y < 8; y++) {
    Answer answer = run(scene() + rest + " --replay 4," + std::to_string(y) + ",0");
    ASSERT_EQ(answer.status, 0) << answer.text;
    size_t at = answer.text.rfind("radiance ");
    ASSERT_NE(at, std::string::npos) << answer.text;
    vec3 c;
    ASSERT_EQ(std::sscanf(answer.text.c_str() + at, "radiance %f %f %f", &c.x, &c.y, &c.z), 3);
    EXPECT_EQ(c, frame.color[size_t(y * 8 + 4)]);
    lit += answer.text.find("hit nothing") == std::string::npos;
  }
  EXPECT_GT(lit, 0);
  EXPECT_EQ(run(scene() + rest + " --replay 8,0,0").status, 2);
}

TEST_F(RenderProgram, CamerasAndLightComeFromTheCommandLineToo) {
  auto picture = [&](const std::string& arguments) {
    Answer answer = run(scene() + " --size 9x9 --spp 2 " + arguments + " --out " + out("b.pfm"));
    EXPECT_EQ(answer.status, 0) << answer.text;
    return load_linear_picture(out("b.pfm")).color;
  };
  auto by_camera = picture("--camera front"), first = picture(""), side = picture("--camera side");
  EXPECT_EQ(by_camera, first);
  EXPECT_NE(by_camera, side);
  auto by_eye = picture("--eye 0.3,0.3,2 --target 0.3,0.3,0 --fov 40.1070456591576");
  for (size_t i = 0; i < by_eye.size(); i++) EXPECT_NEAR(by_eye[i].x, by_camera[i].x, 1e-3f) << i;
  for (vec3 c : picture("--environment none")) EXPECT_EQ(c, vec3(0));
  EXPECT_EQ(picture("--environment 0,0,0.5")[0], vec3(0, 0, 0.5f));
}

// A red and a blue lamp before the triangle, of which an exhibit begins with the blue one alone.
TEST_F(RenderProgram, LampsAreAsTheExhibitBeginsUnlessToldOtherwise) {
  std::ofstream(folder / "lit.gltf")
      << R"({"asset":{"version":"2.0"},"extensionsUsed":["KHR_lights_punctual"],
      "extensions":{"KHR_lights_punctual":{"lights":[
        {"type":"point","color":[1,0,0],"intensity":9},{"type":"point","color":[0,0,1],"intensity":9}]}},
      "scene":0,"scenes":[{"nodes":[0,1,2]}],"nodes":[{"mesh":0},
        {"name":"fire","translation":[0,0,1],"extensions":{"KHR_lights_punctual":{"light":0}}},
        {"name":"moon","translation":[0.5,0.5,1],"extensions":{"KHR_lights_punctual":{"light":1}}}],
      "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
      "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
      "bufferViews":[{"buffer":0,"byteLength":36}],
      "buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";
  std::ofstream(folder / "exhibit.json") << R"({"title":{"en":"Lit"},"scene":"lit.gltf",
        "viewpoints":[{"name":"front","title":{"en":"Front"},"position":[0,0,2]}],"lamps":[
        {"id":"warm","title":{"en":"Fire"},"nodes":["fire"],"on":false},
        {"id":"cold","title":{"en":"Moon"},"nodes":["moon"]}]})";
  const std::string view =
      folder.string() + " --eye 0.25,0.25,1 --target 0.25,0.25,0 --fov 10 --size 5x5 --spp 4";
  auto light = [&](const std::string& arguments) {
    Answer answer = run(view + " " + arguments + " --out " + out("lit.pfm"));
    EXPECT_EQ(answer.status, 0) << answer.text;
    vec3 sum(0);
    for (vec3 c : load_linear_picture(out("lit.pfm")).color) sum += c;
    return sum;
  };
  for (std::string technique : {"path", "gather", "instant_radiosity"}) {
    std::string by = "--technique " + technique + " ";
    vec3 first = light(by), told = light(by + "--lamp warm=on --lamp cold=off");
    EXPECT_EQ(first.x, 0) << technique;
    EXPECT_GT(first.z, 1) << technique;
    EXPECT_GT(told.x, 1) << technique;
    EXPECT_EQ(told.z, 0) << technique;
    EXPECT_EQ(light(by + "--lamp cold=off"), vec3(0)) << technique;
  }
  for (const char* wrong : {"--lamp warm", "--lamp warm=dim", "--lamp =on", "--lamp sun=on"}) {
    Answer answer = run(view + " " + wrong + " --out " + out("x.png"));
    EXPECT_EQ(answer.status, 2) << wrong << ": " << answer.text;
  }
  EXPECT_NE(run(view + " --lamp sun=on --out " + out("x.png")).text.find("warm, cold"),
            std::string::npos);
  EXPECT_EQ(run(scene() + " --lamp warm=on --out " + out("x.png")).status, 2);
}

// Pictures of an exhibit have its exposure, unless another is asked for.
TEST_F(RenderProgram, ExposureIsTheExhibitsUnlessToldOtherwise) {
  auto brightness = [&](const std::string& what, const std::string& arguments) {
    Answer answer = run(what + " --eye 0.25,0.25,1 --target 0.25,0.25,0 --fov 10 --size 5x5 " +
                        "--environment 0.2,0.2,0.2 " + arguments + " --out " + out("x.jpg"));
    EXPECT_EQ(answer.status, 0) << answer.text;
    std::ifstream file(out("x.jpg"), std::ios::binary);
    std::vector<uint8_t> bytes((std::istreambuf_iterator<char>(file)), {});
    return int(decode_jpeg(bytes, "x.jpg").rgb[3 * 12]);
  };
  auto write = [&](const char* exposure) {
    std::ofstream(folder / "exhibit.json")
        << R"({"title":{"en":"Lit"},"scene":"scene.gltf",)" << exposure
        << R"("viewpoints":[{"name":"front","title":{"en":"Front"},"position":[0,0,2]}]})";
  };
  int plain = brightness(scene(), "");
  EXPECT_GT(plain, 20);
  write("");
  EXPECT_EQ(brightness(folder.string(), ""), plain);
  write(R"("exposure":2,)");
  EXPECT_EQ(brightness(folder.string(), ""), brightness(scene(), "--exposure 2"));
  EXPECT_GT(brightness(folder.string(), ""), plain + 20);
  EXPECT_EQ(brightness(folder.string(), "--exposure 1"), plain);
}

TEST_F(RenderProgram, WrongCommandLinesAreStatus2) {
  std::string good = scene() + " --out " + out("x.png");
  for (const char* wrong : {"--technique magic",
                            "--size 10",
                            "--size 0x5",
                            "--size 16385x4",
                            "--size 10x10x10",
                            "--size axb",
                            "--spp 0",
                            "--spp -3",
                            "--spp many",
                            "--fov 180",
                            "--fov -1",
                            "--fov nan",
                            "--eye 0,0,1",
                            "--eye 0,0 --target 0,0,0",
                            "--eye 0,0,inf --target 0,0,0",
                            "--eye 1,1,1 --target 1,1,1",
                            "--camera nobody",
                            "--seed x",
                            "--time -1",
                            "--exposure nan",
                            "--max-depth 0",
                            "--threads -1",
                            "--environment 1,2",
                            "--environment -1,0,0",
                            "--camera front --eye 0,0,1 --target 0,0,0",
                            "--unheard-of"}) {
    Answer answer = run(good + " " + wrong);
    EXPECT_EQ(answer.status, 2) << wrong << ": " << answer.text;
    EXPECT_FALSE(answer.text.empty()) << wrong;
    EXPECT_FALSE(fs::exists(folder / "x.png")) << wrong;
  }
  EXPECT_EQ(run("--out " + out("x.png")).status, 2);
  EXPECT_EQ(run(scene()).status, 2);
  EXPECT_EQ(run(scene() + " --out " + out("x.gif")).status, 2);
  Answer answer = run(good + " --technique magic");
  EXPECT_NE(answer.text.find("path"), std::string::npos)
      << "unknown techniques: the known ones are listed";
  answer = run(good + " --camera nobody");
  EXPECT_NE(answer.text.find("front, side"), std::string::npos) << answer.text;
}

TEST_F(RenderProgram, WrongInputIsStatus1AndNamed) {
  std::ofstream(folder / "bad.gltf") << "{\"asset\":";
  for (const std::string& arguments :
       {out("absent.gltf") + " --out " + out("x.png"), out("bad.gltf") + " --out " + out("x.png"),
        folder.string() + " --out " + out("x.png"), scene() + " --out " + out("no/such/x.png"),
        scene() + " --environment " + out("absent.hdr") + " --out " + out("x.png")}) {
    Answer answer = run("--size 4x4 --spp 1 " + arguments);
    EXPECT_EQ(answer.status, 1) << arguments << ": " << answer.text;
    EXPECT_NE(answer.text.find(folder.string()), std::string::npos)
        << "the file is named: " << answer.text;
  }
}

}  // namespace
}  // namespace wellspring::test
