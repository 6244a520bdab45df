// SPDX-License-Identifier: Apache-2.0
// Layers of the two published networks, by level: those of a stage read and leave one resolution.
#pragma once
#include <string>
#include <vector>

namespace wellspring::denoise {

// Names of its layers in turn; 0: full resolution.
struct StageForm {
  int level;
  std::vector<std::string> layers;
  bool pools;
};
inline const std::vector<StageForm> plain_form = {
    {0, {"enc_conv0", "enc_conv1"}, true},
    {1, {"enc_conv2"}, true},
    {2, {"enc_conv3"}, true},
    {3, {"enc_conv4"}, true},
    {4, {"enc_conv5a", "enc_conv5b"}, false},
    {3, {"dec_conv4a", "dec_conv4b"}, false},
    {2, {"dec_conv3a", "dec_conv3b"}, false},
    {1, {"dec_conv2a", "dec_conv2b"}, false},
    {0, {"dec_conv1a", "dec_conv1b", "dec_conv0"}, false}};
inline const std::vector<StageForm> large_form = {
    {0, {"enc_conv1a", "enc_conv1b"}, true},
    {1, {"enc_conv2a", "enc_conv2b"}, true},
    {2, {"enc_conv3a", "enc_conv3b"}, true},
    {3, {"enc_conv4a", "enc_conv4b"}, true},
    {4, {"enc_conv5a", "enc_conv5b"}, false},
    {3, {"dec_conv4a", "dec_conv4b"}, false},
    {2, {"dec_conv3a", "dec_conv3b"}, false},
    {1, {"dec_conv2a", "dec_conv2b"}, false},
    {0, {"dec_conv1a", "dec_conv1b", "dec_conv1c"}, false}};

}  // namespace wellspring::denoise
