// SPDX-License-Identifier: Apache-2.0
// The network against loops that do what its definition says, on small weights made here.
#include "denoise/tile.h"
#include "denoise/unet.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <random>

#include "base/load_error.h"

namespace wellspring::test {
namespace {

// Makes weights of few channels each, none a multiple of a vector's.
Weights make_weights(bool large) {
  std::mt19937 random(7);
  Weights weights;
  auto add = [&](const std::string& name, int out, int in) {
    std::normal_distribution<float> spread(0, std::sqrt(2.0f / float(9 * in)));
    Tensor& weight = weights[name + ".weight"];
    weight.sizes = {out, in, 3, 3};
    weight.values.resize(size_t(out) * size_t(in) * 9);
    for (float& value : weight.values) value = spread(random);
    Tensor& bias = weights[name + ".bias"];
    bias.sizes = {out};
    bias.values.resize(size_t(out));
    for (float& value : bias.values) value = 0.1f * spread(random);
  };
  if (large) {
    add("enc_conv1a", 5, 9), add("enc_conv1b", 6, 5), add("enc_conv2a", 7, 6);
    add("enc_conv2b", 8, 7), add("enc_conv3a", 9, 8), add("enc_conv3b", 10, 9);
    add("enc_conv4a", 11, 10), add("enc_conv4b", 12, 11), add("enc_conv5a", 13, 12);
    add("enc_conv5b", 14, 13), add("dec_conv4a", 9, 14 + 10), add("dec_conv4b", 8, 9);
    add("dec_conv3a", 7, 8 + 8), add("dec_conv3b", 6, 7), add("dec_conv2a", 5, 6 + 6);
    add("dec_conv2b", 9, 5), add("dec_conv1a", 6, 9 + 9), add("dec_conv1b", 4, 6);
    add("dec_conv1c", 3, 4);
  } else {
    add("enc_conv0", 5, 9), add("enc_conv1", 6, 5), add("enc_conv2", 7, 6), add("enc_conv3", 8, 7);
    add("enc_conv4", 9, 8), add("enc_conv5a", 10, 9), add("enc_conv5b", 17, 10);
    add("dec_conv4a", 9, 17 + 8), add("dec_conv4b", 8, 9), add("dec_conv3a", 7, 8 + 7);
    add("dec_conv3b", 6, 7), add("dec_conv2a", 5, 6 + 6), add("dec_conv2b", 9, 5);
    add("dec_conv1a", 6, 9 + 9), add("dec_conv1b", 4, 6), add("dec_conv0", 3, 4);
  }
  return weights;
}

// planes[channel][y * width + x]
struct Planes {
  int width = 0, height = 0;
  std::vector<std::vector<float>> planes;
};

Planes convolve(const Planes& in, const Weights& weights, const std::string& name) {
  const Tensor &weight = weights.at(name + ".weight"), &bias = weights.at(name + ".bias");
  Planes out{in.width, in.height, {}};
  EXPECT_EQ(weight.sizes[1], int(in.planes.size()));
  for (int o = 0; o < weight.sizes[0]; o++) {
    std::vector<float> plane(size_t(in.width) * size_t(in.height));
    for (int y = 0; y < in.height; y++)
      for (int x = 0; x < in.width; x++) {
        double sum = bias.values[size_t(o)];
        for (size_t i = 0; i < in.planes.size(); i++)
          for (int k = 0; k < 9; k++) {
            int sx = x + k % 3 - 1, sy = y + k / 3 - 1;
            if (sx < 0 || sy < 0 || sx >= in.width || sy >= in.height) continue;
            sum += double(weight.values[(size_t(o) * in.planes.size() + i) * 9 + size_t(k)]) *
                   double(in.planes[i][size_t(sy) * size_t(in.width) + size_t(sx)]);
          }
        plane[size_t(y) * size_t(in.width) + size_t(x)] = float(std::max(sum, 0.0));
      }
    out.planes.push_back(std::move(plane));
  }
  return out;
}

Planes resize(const Planes& in, int width, int height, bool pool) {
  Planes out{width, height, {}};
  for (const auto& plane : in.planes) {
    std::vector<float> made;
    for (int y = 0; y < height; y++)
      for (int x = 0; x < width; x++) {
        auto at = [&](int px, int py) { return plane[size_t(py) * size_t(in.width) + size_t(px)]; };
        if (pool)
          made.push_back(std::max({at(2 * x, 2 * y), at(2 * x + 1, 2 * y), at(2 * x, 2 * y + 1),
                                   at(2 * x + 1, 2 * y + 1)}));
        else made.push_back(at(x / 2, y / 2));
      }
    out.planes.push_back(std::move(made));
  }
  return out;
}
Planes halve(const Planes& in) { return resize(in, in.width / 2, in.height / 2, true); }
Planes join(const Planes& below, const Planes& level) {
  Planes out = resize(below, level.width, level.height, false);
  out.planes.insert(out.planes.end(), level.planes.begin(), level.planes.end());
  return out;
}

Planes run_by_loops(const Planes& input, const Weights& weights, bool large) {
  auto chain = [&](Planes at, std::vector<std::string> names) {
    for (const auto& name : names) at = convolve(at, weights, name);
    return at;
  };
  std::vector<Planes> pooled = {input};
  for (int level = 1; level <= 4; level++) {
    std::string n = std::to_string(level);
    std::vector<std::string> names;
    if (large) names = {"enc_conv" + n + "a", "enc_conv" + n + "b"};
    else if (level == 1) names = {"enc_conv0", "enc_conv1"};
    else names = {"enc_conv" + n};
    pooled.push_back(halve(chain(pooled.back(), names)));
  }
  Planes at = chain(pooled[4], {"enc_conv5a", "enc_conv5b"});
  for (int level = 4; level >= 1; level--) {
    std::string n = std::to_string(level);
    at = chain(join(at, pooled[size_t(level - 1)]), {"dec_conv" + n + "a", "dec_conv" + n + "b"});
  }
  return convolve(at, weights, large ? "dec_conv1c" : "dec_conv0");
}

InputPixels random_input(int width, int height) {
  std::mt19937 random(3);
  InputPixels input(size_t(width) * size_t(height) * input_channels);
  for (auto& value : input) value = uint16_t(random() & 0xffff);
  return input;
}

void expect_as_loops(int width, int height, bool large) {
  SCOPED_TRACE(std::to_string(width) + "x" + std::to_string(height));
  Weights weights = make_weights(large);
  InputPixels input = random_input(width, height);
  Planes padded{(width + 15) / 16 * 16, (height + 15) / 16 * 16, {}};
  padded.planes.assign(input_channels,
                       std::vector<float>(size_t(padded.width) * size_t(padded.height), 0.0f));
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++)
      for (size_t c = 0; c < input_channels; c++)
        padded.planes[c][size_t(y) * size_t(padded.width) + size_t(x)] =
            float(input[(size_t(y) * size_t(width) + size_t(x)) * input_channels + c]) / 65535.0f;
  Planes expected = run_by_loops(padded, weights, large);
  UNet net(weights, "test");
  net.start(width, height, input);
  while (net.advance(0)) {}
  double most = 0, largest = 0;
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++)
      for (int c = 0; c < 3; c++) {
        float want = expected.planes[size_t(c)][size_t(y) * size_t(padded.width) + size_t(x)];
        float is = net.output()[size_t(y) * size_t(width) + size_t(x)][c];
        most = std::max(most, double(std::abs(want - is)));
        largest = std::max(largest, double(want));
      }
  EXPECT_GT(largest, 0.01);
  // In bfloat16 each of 16 layers rounds what it hands on to 8 bits.
  const double rounding = best_format().bfloat16 ? 16 * std::ldexp(1.0, -9) : 2e-5;
  EXPECT_LT(most, rounding * std::max(1.0, largest));
}

TEST(UNet, ComputesWhatLoopsDo) {
  if (unet_problem()) GTEST_SKIP() << unet_problem();
  expect_as_loops(48, 32, false);
  expect_as_loops(1, 1, false);
  expect_as_loops(17, 31, false);
  expect_as_loops(150, 40, false);  // several tiles, which do not show
  expect_as_loops(40, 270, false);
  expect_as_loops(33, 18, true);
  expect_as_loops(140, 35, true);
}

RawVector<vec3> run_with(UNet& net, int threads, const InputPixels& input, int width, int height) {
  oneapi::tbb::task_arena arena(threads);
  return arena.execute([&] {
    net.start(width, height, input);
    while (net.advance(threads == 1 ? 0 : 1)) {}
    return net.output();
  });
}

TEST(UNet, GivesTheSameBitsForAnyNumberOfThreads) {
  if (unet_problem()) GTEST_SKIP() << unet_problem();
  oneapi::tbb::global_control threads(oneapi::tbb::global_control::max_allowed_parallelism, 4);
  UNet net(make_weights(false), "test");
  InputPixels input = random_input(300, 140);
  RawVector<vec3> one = run_with(net, 1, input, 300, 140);
  for (int count : {2, 4}) {
    RawVector<vec3> many = run_with(net, count, input, 300, 140);
    EXPECT_TRUE(std::equal(one.begin(), one.end(), many.begin(), many.end()));
  }
}

TEST(UNet, AnotherSizeAndBackIsAsNew) {
  if (unet_problem()) GTEST_SKIP() << unet_problem();
  UNet net(make_weights(false), "test");
  InputPixels small = random_input(20, 20), wide = random_input(200, 50);
  RawVector<vec3> before = run_with(net, 2, small, 20, 20);
  run_with(net, 2, wide, 200, 50);
  RawVector<vec3> after = run_with(net, 2, small, 20, 20);
  EXPECT_TRUE(std::equal(before.begin(), before.end(), after.begin(), after.end()));
}

TEST(UNet, StopsWhenToldAndGoesOnWhereItWas) {
  if (unet_problem()) GTEST_SKIP() << unet_problem();
  UNet net(make_weights(false), "test");
  InputPixels input = random_input(300, 140);
  RawVector<vec3> whole = run_with(net, 2, input, 300, 140);
  net.start(300, 140, input);
  std::atomic<bool> stop{true};
  int pieces = 1;
  while (net.advance(1e9, &stop)) pieces++;
  EXPECT_GE(pieces, 9);  // a level at least is a piece
  EXPECT_TRUE(std::equal(whole.begin(), whole.end(), net.output().begin()));
}

TEST(UNet, RefusesWeightsOfAnotherNetwork) {
  auto error_with = [](const std::function<void(Weights&)>& change) {
    Weights weights = make_weights(false);
    change(weights);
    try {
      UNet net(weights, "net.tza");
    } catch (const LoadError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(error_with([](Weights&) {}), "");
  EXPECT_EQ(error_with([](Weights& w) { w.erase("dec_conv2b.bias"); }),
            "net.tza: dec_conv2b.bias: is missing");
  EXPECT_EQ(error_with([](Weights& w) { w.erase("dec_conv2b.weight"); }),
            "net.tza: dec_conv2b.weight: is missing");
  EXPECT_EQ(error_with([](Weights& w) { w["dec_conv2b.bias"].sizes = {4}; }),
            "net.tza: dec_conv2b.bias: has another shape");
  EXPECT_EQ(error_with([](Weights& w) {
              w["dec_conv3a.weight"].sizes = {7, 15, 1, 9};
            }),
            "net.tza: dec_conv3a.weight: has another shape");
  EXPECT_EQ(error_with([](Weights& w) { w["more.bias"].sizes = {1}; }),
            "net.tza: more.bias: belongs to no layer of the network");
  EXPECT_NE(error_with([](Weights& w) { w.clear(); }), "");
}

}  // namespace
}  // namespace wellspring::test
