// SPDX-License-Identifier: Apache-2.0
#include "kiosk/config.h"

#include <gtest/gtest.h>

#include <fstream>

#include "base/load_error.h"
#include "unit/folder.h"

namespace wellspring::test {
namespace {

struct ConfigFile : testing::Test {
  test::Folder folder;
  std::string file = folder.file("kiosk.json");
  KioskConfig config;
  void load(const std::string& text) {
    std::ofstream(file) << text;
    config = {};
    load_config(file, config);
  }
  std::string problem(const std::string& text) {
    try {
      load(text);
    } catch (const LoadError& error) {
      EXPECT_EQ(error.file, file);
      return error.where + ": " + error.what_;
    }
    return "none";
  }
};

TEST_F(ConfigFile, SaysWhatDiffers) {
  load(R"({"camera": {"width": 320, "fov": 90, "mirrored": true},
           "mount": {"offset": [0.1, 0.2, 0.3], "pitch": -10, "roll": 90},
           "presence": {"hold_person": 4}, "hands": false, "name": "hall", "station": "objects.json"})");
  EXPECT_EQ(config.station, "objects.json");
  EXPECT_EQ(config.name, "hall");
  EXPECT_EQ(config.camera.width, 320);
  EXPECT_EQ(config.camera.rate, 30);
  EXPECT_NEAR(config.camera.mount.fov, pi / 2, 1e-6f);
  EXPECT_NEAR(config.camera.mount.pitch, -pi / 18, 1e-6f);
  EXPECT_NEAR(config.camera.mount.roll, pi / 2, 1e-6f);
  EXPECT_TRUE(config.camera.mount.mirrored);
  EXPECT_NEAR(config.camera.mount.offset.z, 0.3f, 1e-6f);
  EXPECT_EQ(config.presence.hold_person, 4);
  EXPECT_EQ(config.presence.hold_motion, PresenceSettings{}.hold_motion);
  EXPECT_FALSE(config.hands);
  load("{}");
  EXPECT_TRUE(config.hands);
  EXPECT_EQ(config.station, "");
}

TEST_F(ConfigFile, NamesWhatIsWrong) {
  EXPECT_NE(problem("{").find("not JSON at line 1, column 2"), std::string::npos) << problem("{");
  EXPECT_NE(problem("[]").find("not an object"), std::string::npos);
  EXPECT_EQ(
      problem(R"({"presence": {"hold": 1}})"),
      "line 1, /presence/hold: is unknown; there are confirm_after, hold_motion, hold_person, "
      "wake_after");
  EXPECT_EQ(problem(R"({"camera": {"fov": 200}})"),
            "line 1, /camera/fov: is not a number from 10 to 170");
  EXPECT_EQ(problem(R"({"camera": {"mirrored": 1}})"),
            "line 1, /camera/mirrored: is not true or false");
  EXPECT_EQ(problem(R"({"mount": {"offset": [1, 2]}})"),
            "line 1, /mount/offset: is not a list of three numbers");
  EXPECT_EQ(problem(R"({"station": 3})"), "line 1, /station: is not a text");
  EXPECT_EQ(problem(R"({"mount": []})"), "line 1, /mount: is not an object");
  EXPECT_EQ(problem(R"({"presence": {"hold_person": null}})"),
            "line 1, /presence/hold_person: is not a number from 0 to 600");
  EXPECT_THROW(load_config(folder.file("none"), config), LoadError);
}

TEST_F(ConfigFile, NamesTheLine) {
  EXPECT_EQ(problem("{\n  \"camera\": {\n    \"width\": 320,\n    \"fov\": 200\n  }\n}\n"),
            "line 4, /camera/fov: is not a number from 10 to 170");
  EXPECT_EQ(problem("{\n\"cameras\": [\n{\"source\": \"0\"},\n{\"name\": \"left\"}\n]}\n"),
            "line 4, /cameras/1/source: is missing");
  EXPECT_EQ(problem("{\n\"hands\": true,\n\n\"nmae\": \"hall\"}").substr(0, 21),
            "line 4, /nmae: is unk");
}

TEST_F(ConfigFile, ListsCamerasThatDifferFromWhatTheyHaveInCommon) {
  const std::string text = R"({"name": "hall", "mount": {"pitch": -10}, "camera": {"fov": 90},
      "cameras": [{"source": "0", "name": "left", "mount": {"offset": [-0.3, 0.2, 0]}},
                  {"source": "1", "fov": 60, "mount": {"pitch": 5}}]})";
  load(text);
  EXPECT_EQ(config.name, "hall");
  ASSERT_EQ(config.cameras.size(), 2u);
  EXPECT_EQ(config.cameras[0].source, "0");
  EXPECT_EQ(config.cameras[0].name, "left");
  EXPECT_NEAR(config.cameras[0].mount.fov, pi / 2, 1e-6f);
  EXPECT_NEAR(config.cameras[0].mount.pitch, -pi / 18, 1e-6f);
  EXPECT_NEAR(config.cameras[0].mount.offset.x, -0.3f, 1e-6f);
  EXPECT_NEAR(config.cameras[1].mount.fov, pi / 3, 1e-6f);
  EXPECT_NEAR(config.cameras[1].mount.pitch, pi / 36, 1e-6f);
  EXPECT_EQ(problem(R"({"cameras": []})"), "line 1, /cameras: is not a list of cameras");
  EXPECT_EQ(problem(R"({"cameras": [{"name": "left"}]})"), "line 1, /cameras/0/source: is missing");
  EXPECT_EQ(problem(R"({"cameras": [{"source": 0}]})"), "line 1, /cameras/0/source: is not a text");
  EXPECT_EQ(problem(R"({"cameras": [{"source": "0", "mount": {"pitch": 90}}]})"),
            "line 1, /cameras/0/mount/pitch: is not a number from -80 to 80");
  // The mount that is found out is that of one of them.
  std::ofstream(file) << text;
  Mount mount{.pitch = 0.1f};
  save_mount(file, "1", mount);
  config = {};
  load_config(file, config);
  EXPECT_NEAR(config.cameras[1].mount.pitch, 0.1f, 1e-4f);
  EXPECT_NEAR(config.cameras[0].mount.pitch, -pi / 18, 1e-6f);
}

TEST_F(ConfigFile, KeepsTheRestWhenTheMountIsWritten) {
  std::ofstream(file) << R"({"presence": {"wake_after": 2}, "mount": {"pitch": 5}})";
  Mount mount{.fov = 1.2f, .offset = {0.1f, -0.2f, 0.05f}, .pitch = -0.25f};
  for (const std::string& name : {file, folder.file("new.json")}) {
    save_mount(name, "0", mount);
    config = {};
    load_config(name, config);
    EXPECT_NEAR(config.camera.mount.pitch, mount.pitch, 1e-4f);
    EXPECT_NEAR(config.camera.mount.fov, mount.fov, 1e-4f);
    EXPECT_LT(glm::length(config.camera.mount.offset - mount.offset), 1e-3f);
    EXPECT_EQ(config.presence.wake_after, name == file ? 2 : PresenceSettings{}.wake_after);
  }
  EXPECT_THROW(save_mount(folder.file("no/where.json"), "0", mount), LoadError);
}

}  // namespace
}  // namespace wellspring::test
