// SPDX-License-Identifier: Apache-2.0
#include "avatar/speech/sound_file.h"

#include <sndfile.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <numbers>
#include <numeric>

#include "base/load_error.h"

namespace wellspring::avatar {

namespace {

constexpr int most_channels = 64;
constexpr sf_count_t block_frames = 4096;

struct CloseSound {
  void operator()(SNDFILE* file) const { sf_close(file); }
};

}  // namespace

Sound load_sound(const std::string& file) {
  std::error_code code;
  auto fail = [&](const std::string& what) { throw LoadError(file, "", what); };
  auto kind = std::filesystem::status(file, code).type();
  if (kind == std::filesystem::file_type::not_found) fail("there is no such file");
  if (kind != std::filesystem::file_type::regular) fail("is no regular file");
  SF_INFO info{};
  std::unique_ptr<SNDFILE, CloseSound> input(sf_open(file.c_str(), SFM_READ, &info));
  if (!input) fail(std::string("no sound can be read: ") + sf_strerror(nullptr));
  if (info.samplerate < 4000 || info.samplerate > 192000)
    fail("its rate of " + std::to_string(info.samplerate) + " Hz is not within 4 to 192 kHz");
  if (info.channels < 1 || info.channels > most_channels)
    fail("it has " + std::to_string(info.channels) + " channels");

  // The header's length is not trusted: samples are counted while they are read.
  Sound sound;
  sound.rate = info.samplerate;
  size_t most = size_t(longest_recording * info.samplerate);
  size_t channels = size_t(info.channels);
  std::vector<float> block(size_t(block_frames) * channels);
  for (;;) {
    sf_count_t got = sf_readf_float(input.get(), block.data(), block_frames);
    if (got <= 0) break;
    for (size_t i = 0; i < size_t(got); i++) {
      float sum = 0;
      for (size_t c = 0; c < channels; c++) sum += block[i * channels + c];
      float value = sum / float(channels);
      sound.samples.push_back(std::isfinite(value) ? std::clamp(value, -4.0f, 4.0f) : 0);
    }
    if (sound.samples.size() > most)
      fail("it is longer than " + std::to_string(int(longest_recording)) + " seconds");
  }
  if (int error = sf_error(input.get()); error != SF_ERR_NO_ERROR)
    throw LoadError(file, "sample " + std::to_string(sound.samples.size()), sf_error_number(error));
  if (sound.samples.empty()) fail("there is no sound in it");
  return sound;
}

std::vector<uint8_t> encode_wav(const std::vector<int16_t>& pcm, int rate) {
  std::vector<uint8_t> bytes;
  bytes.reserve(44 + pcm.size() * 2);
  auto word = [&](const char* text) { bytes.insert(bytes.end(), text, text + 4); };
  auto number = [&](uint32_t value, int count) {
    for (int i = 0; i < count; i++) bytes.push_back(uint8_t(value >> (8 * i)));
  };
  uint32_t size = uint32_t(pcm.size() * 2);
  word("RIFF"), number(36 + size, 4), word("WAVE");
  word("fmt "), number(16, 4), number(1, 2), number(1, 2);
  number(uint32_t(rate), 4), number(uint32_t(rate) * 2, 4), number(2, 2), number(16, 2);
  word("data"), number(size, 4);
  for (int16_t sample : pcm) number(uint16_t(sample), 2);
  return bytes;
}

std::vector<float> resample(const std::vector<float>& samples, int from, int to) {
  if (from == to || samples.empty()) return samples;
  int divisor = std::gcd(from, to);
  size_t up = size_t(to / divisor), down = size_t(from / divisor);
  double cut = std::min(1.0, double(to) / from);  // share of the input's half rate
  int reach = int(std::ceil(16 / cut));
  size_t count = size_t(double(samples.size()) * to / from);
  std::vector<float> out(count);
  // Each phase that occurs has one kernel; rates whose ratio has many phases share 1,024.
  size_t phases = std::min<size_t>(up, 1024);
  std::vector<float> kernels(phases * size_t(2 * reach));
  for (size_t p = 0; p < phases; p++) {
    double offset = double(p) / double(phases), sum = 0;
    float* kernel = &kernels[p * size_t(2 * reach)];
    for (int k = 0; k < 2 * reach; k++) {
      double x = k - reach + 1 - offset, at = std::numbers::pi * x * cut;
      double sinc = std::abs(at) < 1e-9 ? 1 : std::sin(at) / at;
      double hann = std::abs(x) < reach ? 0.5 + 0.5 * std::cos(std::numbers::pi * x / reach) : 0;
      kernel[k] = float(sinc * hann);
      sum += sinc * hann;
    }
    for (int k = 0; k < 2 * reach; k++) kernel[k] /= float(sum);
  }
  for (size_t i = 0; i < count; i++) {
    size_t whole = i * down / up, rest = i * down % up;
    const float* kernel = &kernels[rest * phases / up * size_t(2 * reach)];
    double sum = 0;
    for (int k = 0; k < 2 * reach; k++) {
      ptrdiff_t j = ptrdiff_t(whole) + k - reach + 1;
      if (j >= 0 && j < ptrdiff_t(samples.size())) sum += double(kernel[k] * samples[size_t(j)]);
    }
    out[i] = float(sum);
  }
  return out;
}

std::vector<int16_t> to_pcm(const std::vector<float>& samples) {
  std::vector<int16_t> pcm(samples.size());
  for (size_t i = 0; i < pcm.size(); i++)
    pcm[i] = int16_t(
        std::clamp(std::lround(std::clamp(samples[i], -1.0f, 1.0f) * 32768), -32768L, 32767L));
  return pcm;
}

std::vector<float> from_pcm(const std::vector<int16_t>& pcm) {
  std::vector<float> samples(pcm.size());
  for (size_t i = 0; i < pcm.size(); i++) samples[i] = float(pcm[i]) / 32768;
  return samples;
}

}  // namespace wellspring::avatar
