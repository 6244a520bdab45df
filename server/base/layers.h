// SPDX-License-Identifier: Apache-2.0
// Gives each layer a namespace of its own, which sees the names of the layers that it may include
// (tests/structure/includes.test.mjs); names of `base` lie in wellspring itself. A file that sees
// the same name in two layers writes it with its layer.
#pragma once

namespace wellspring {
namespace config {}
namespace about {}
namespace json {}
namespace wire {}
namespace ledger {}
namespace image {}
namespace spectrum {}
namespace store {}
namespace volume {}
namespace scan {}
namespace lawn {}
namespace collection {}
namespace plan {}
namespace frame {}
namespace attention {}
namespace denoise {}
namespace gltf {}
namespace world {}
namespace light {}
namespace cache {}
namespace workers {}
namespace picture {}
namespace avatar {}
namespace show {}
namespace museum {}
namespace stream {}
namespace kiosk {}

namespace spectrum {
using namespace json;
}  // namespace spectrum

namespace frame {
using namespace image;
}  // namespace frame

namespace store {
using namespace spectrum;
using namespace image;
using namespace json;
}  // namespace store

namespace volume {
using namespace store;
using namespace image;
using namespace json;
}  // namespace volume

namespace scan {
using namespace gltf;
using namespace store;
using namespace image;
using namespace json;
}  // namespace scan

namespace lawn {
using namespace image;
using namespace json;
}  // namespace lawn

namespace collection {
using namespace json;
}  // namespace collection

namespace wire {
using namespace json;
}  // namespace wire

namespace attention {
using namespace frame;
}  // namespace attention

namespace world {
using namespace spectrum;
using namespace gltf;
using namespace image;
using namespace store;
using namespace volume;
using namespace scan;
using namespace lawn;
}  // namespace world

namespace light {
using namespace spectrum;
using namespace world;
using namespace store;
using namespace volume;
using namespace scan;
using namespace lawn;
using namespace frame;
}  // namespace light

namespace cache {
using namespace light;
using namespace world;
using namespace frame;
}  // namespace cache

namespace workers {
using namespace cache;
using namespace light;
using namespace world;
using namespace frame;
}  // namespace workers

namespace picture {
using namespace spectrum;
using namespace cache;
using namespace denoise;
using namespace light;
using namespace world;
using namespace scan;
using namespace lawn;
using namespace frame;
}  // namespace picture

namespace avatar {
using namespace gltf;
using namespace json;
}  // namespace avatar

namespace show {
using namespace spectrum;
using namespace collection;
using namespace picture;
using namespace workers;
using namespace store;
using namespace volume;
using namespace scan;
using namespace lawn;
using namespace cache;
using namespace denoise;
using namespace light;
using namespace world;
using namespace gltf;
using namespace attention;
using namespace frame;
using namespace image;
using namespace avatar;
using namespace wire;
using namespace json;
using namespace ledger;
}  // namespace show

namespace museum {
using namespace show;
using namespace wire;
using namespace ledger;
}  // namespace museum

namespace stream {
using namespace wire;
}  // namespace stream

namespace kiosk {
using namespace wire;
using namespace json;
}  // namespace kiosk

// Programs put layers together, and tests test them.
namespace program {
using namespace config;
using namespace about;
using namespace json;
using namespace wire;
using namespace ledger;
using namespace image;
using namespace spectrum;
using namespace store;
using namespace volume;
using namespace scan;
using namespace lawn;
using namespace collection;
using namespace plan;
using namespace frame;
using namespace attention;
using namespace denoise;
using namespace gltf;
using namespace world;
using namespace light;
using namespace cache;
using namespace workers;
using namespace picture;
using namespace avatar;
using namespace show;
using namespace museum;
using namespace stream;
using namespace kiosk;
}  // namespace program

namespace test {
using namespace program;
}  // namespace test
namespace scenes {
using namespace program;
}  // namespace scenes
namespace fuzz {
using namespace test;
}  // namespace fuzz
namespace mitsuba {
using namespace program;
}  // namespace mitsuba

}  // namespace wellspring
