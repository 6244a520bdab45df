// SPDX-License-Identifier: Apache-2.0
// Headers of text share this: words, numbers, and the names of the files that hold the samples.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "volume/format/stored_volume.h"

namespace wellspring::volume {

std::string_view without_blanks(std::string_view text);  // around it
std::string in_small_letters(std::string_view text);
std::vector<std::string> words_of(std::string_view text);
// Returns the numbers that blanks separate; a word that is none becomes NaN.
std::vector<double> numbers_of(std::string_view text);
// Rounds; what is no whole number of 53 bits becomes -1.
int64_t to_whole(double number);

// Returns the lines of a text. A line ends with \n or \r\n.
std::vector<std::string> lines_of(std::string_view text);

// Returns the path of a file of samples that a header names. Throws LoadError if the name leads out
// of the header's folder: files of strangers must not name any file of this machine.
std::string companion(const std::string& header, const std::string& name, const std::string& where);

// Returns the paths that a pattern with one %d (also %i, %u, with width, as of printf) names for
// first, first + step, ... up to last. Throws LoadError.
std::vector<std::string> numbered_files(const std::string& header, const std::string& pattern,
                                        double first, double last, double step,
                                        const std::string& where);

// Sets the parts of samples that are not packed or packed. First so many lines of each file are
// skipped, then so many bytes, of what is unpacked; -1 - n: samples end n bytes before the file
// does. Sizes, times, packing and numbers must be set. Throws LoadError.
void set_parts(StoredVolume& stored, const std::vector<std::string>& files, uint64_t begin,
               int64_t lines, int64_t bytes, const std::string& where);

}  // namespace wellspring::volume
