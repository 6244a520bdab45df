// SPDX-License-Identifier: Apache-2.0
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStdIO.h>

#include <array>
#include <sstream>

#include "base/load_error.h"
#include "frame/linear_picture.h"

namespace wellspring {
namespace {

// The names of a file's red, green and blue: plain, a lone Y, or those of the first layer with all
// three.
std::array<std::string, 3> color_channels(const Imf::ChannelList& channels,
                                          const std::string& path) {
  if (channels.findChannel("R") && channels.findChannel("G") && channels.findChannel("B"))
    return {"R", "G", "B"};
  if (channels.findChannel("Y")) return {"Y", "Y", "Y"};
  for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
    std::string name = channel.name();
    if (name.size() < 2 || name.compare(name.size() - 2, 2, ".R") != 0) continue;
    std::string layer = name.substr(0, name.size() - 1);
    if (channels.findChannel(layer + "G") && channels.findChannel(layer + "B"))
      return {layer + "R", layer + "G", layer + "B"};
  }
  throw LoadError(path, "channels", "no R, G and B, and no Y");
}

}  // namespace

std::vector<char> encode_exr(const Frame& frame, const std::string& path,
                             const std::string& comment) {
  try {
    Imf::Header header(frame.width, frame.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    if (!comment.empty()) Imf::addComments(header, comment);
    Imf::FrameBuffer buffer;
    auto add = [&](const char* name, const float* plane, size_t step) {
      header.channels().insert(name, Imf::Channel(Imf::FLOAT));
      buffer.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(const_cast<float*>(plane)),
                                     step, step * size_t(frame.width)));
    };
    add("R", &frame.color[0].x, sizeof(vec3));
    add("G", &frame.color[0].y, sizeof(vec3));
    add("B", &frame.color[0].z, sizeof(vec3));
    if (frame.depth.size() == frame.color.size()) add("Z", frame.depth.data(), sizeof(float));
    Imf::StdOSStream stream;
    {
      Imf::OutputFile file(stream, header);
      file.setFrameBuffer(buffer);
      file.writePixels(frame.height);
    }  // the offset table is written when the file closes
    std::string bytes = stream.str();
    return {bytes.begin(), bytes.end()};
  } catch (const std::exception& error) {
    throw LoadError(path, "", std::string("cannot be written as OpenEXR: ") + error.what());
  }
}

Frame decode_exr(std::istream& in, const std::string& path) {
  try {
    std::ostringstream whole;
    whole << in.rdbuf();
    Imf::StdISStream stream;
    stream.str(whole.str());
    Imf::InputFile file(stream);
    const auto& window = file.header().dataWindow();
    int64_t width = int64_t(window.max.x) - window.min.x + 1,
            height = int64_t(window.max.y) - window.min.y + 1;
    if (width < 1 || height < 1 || width > largest_picture_side || height > largest_picture_side)
      throw LoadError(path, "dataWindow", "picture must have 1 to 16384 pixels a side");
    std::array<std::string, 3> names = color_channels(file.header().channels(), path);
    Frame frame;
    frame.width = int(width);
    frame.height = int(height);
    std::vector<float> planes[3];
    Imf::FrameBuffer buffer;
    for (int c = 0; c < (names[0] == names[1] ? 1 : 3); c++) {
      planes[c].resize(size_t(width * height));
      // OpenEXR addresses pixels by their window coordinates.
      char* origin =
          reinterpret_cast<char*>(planes[c].data()) -
          (ptrdiff_t(window.min.x) + ptrdiff_t(window.min.y) * width) * ptrdiff_t(sizeof(float));
      buffer.insert(names[size_t(c)],
                    Imf::Slice(Imf::FLOAT, origin, sizeof(float), sizeof(float) * size_t(width)));
    }
    file.setFrameBuffer(buffer);
    file.readPixels(window.min.y, window.max.y);
    frame.color.resize(size_t(width * height));
    for (size_t i = 0; i < frame.color.size(); i++)
      frame.color[i] =
          planes[1].empty() ? vec3(planes[0][i]) : vec3(planes[0][i], planes[1][i], planes[2][i]);
    return frame;
  } catch (const LoadError&) {
    throw;
  } catch (const std::exception& error) {
    throw LoadError(path, "", std::string("not readable as OpenEXR: ") + error.what());
  }
}

}  // namespace wellspring
