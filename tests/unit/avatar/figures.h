// SPDX-License-Identifier: Apache-2.0
// Small figures written in the tests, and files to put them in.
#pragma once
#include <atomic>
#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

#include "avatar/load/character_load.h"

namespace wellspring::test {

// A file that exists as long as this does.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& text, const std::string& ending = ".x3d") {
    static std::atomic<int> count = 0;
    path_ = (std::filesystem::temp_directory_path() /
             ("wellspring_avatar_" + std::to_string(::getpid()) + "_" + std::to_string(count++) +
              ending))
                .string();
    std::ofstream(path_, std::ios::binary) << text;
  }
  ~TemporaryFile() { std::filesystem::remove(path_); }
  TemporaryFile(const TemporaryFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

inline std::string x3d(const std::string& scene) {
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<X3D profile='Immersive' "
         "version='4.0'>\n<Scene>\n" +
         scene + "\n</Scene>\n</X3D>\n";
}

inline Character load_text(const std::string& text, const std::string& ending = ".x3d") {
  TemporaryFile file(text, ending);
  return load_character(file.path());
}

// Is it among the character's warnings?
inline bool says(const Character& c, const std::string& text) {
  for (const std::string& warning : c.warnings)
    if (warning.find(text) != std::string::npos) return true;
  return false;
}

// Two joints and a skin of one square (points 0..3), the upper two points half and half.
inline std::string small_skin(const std::string& elbow_extra = "",
                              const std::string& humanoid_extra = "") {
  return x3d(R"(<HAnimHumanoid name='Small' )" + humanoid_extra + R"(>
  <HAnimJoint containerField='skeleton' name='humanoid_root' DEF='root' center='0 0 0'
      skinCoordIndex='0 1 2' skinCoordWeight='1 1 0.5'>
    <HAnimJoint name='vl5' DEF='vl5' center='0 1 0' skinCoordIndex='2 3' skinCoordWeight='0.5 1'>)" +
             elbow_extra + R"(
    </HAnimJoint>
  </HAnimJoint>
  <HAnimJoint USE='root' containerField='joints'/>
  <HAnimJoint USE='vl5' containerField='joints'/>
  <Shape containerField='skin'>
    <Appearance><PhysicalMaterial DEF='Cloth' baseColor='0.5 0.25 0.125' metallic='0' roughness='0.6'/></Appearance>
    <IndexedFaceSet coordIndex='0 1 3 2 -1' solid='false'>
      <Coordinate DEF='points' point='0 0 0, 1 0 0, 0 2 0, 1 2 0'/>
    </IndexedFaceSet>
  </Shape>
  <Coordinate USE='points' containerField='skinCoord'/>
</HAnimHumanoid>)");
}

// A figure with all that the storyteller can move: LOA 1, hands, eyes, lids by displacers. Boxes
// for flesh.
std::string whole_figure();

}  // namespace wellspring::test
