// SPDX-License-Identifier: Apache-2.0
#include "base/read_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <thread>
#include <vector>

#include "base/load_error.h"
#include "base/write_file.h"
#include "unit/folder.h"

namespace wellspring::test {
namespace {

std::string error_of(const std::string& file, size_t most_bytes,
                     FileKind kind = FileKind::regular) {
  try {
    read_file(file, most_bytes, kind);
  } catch (const LoadError& error) {
    EXPECT_EQ(error.file, file);
    return error.what_;
  }
  return "";
}

TEST(ReadFile, IsWholeUpToItsBound) {
  const test::Folder folder;
  const std::string text(100'000, 'x'), file = folder.write("a", text);
  EXPECT_EQ(read_file(file, text.size()), text);
  EXPECT_EQ(read_file<std::vector<uint8_t>>(file, text.size()).size(), text.size());
  EXPECT_EQ(error_of(folder.write("b", std::string((2 << 20) + 1, 'x')), 2 << 20),
            "is larger than 2 MiB");
  EXPECT_EQ(read_file(folder.write("empty", ""), 0), "");
  EXPECT_GT(read_file("/proc/self/status", 1 << 20).size(), 0u);  // says it has no bytes
}

TEST(ReadFile, NamesWhatCannotBeRead) {
  const test::Folder folder;
  EXPECT_EQ(error_of(folder.file("none"), 1), "cannot be read: No such file or directory");
  EXPECT_EQ(error_of(folder.path.string(), 1, FileKind::regular_or_pipe), "is no regular file");
}

TEST(ReadFile, PipesAreReadOnlyIfTheyMayBe) {
  const test::Folder folder;
  const std::string pipe = folder.file("pipe"), text(100'000, 'x');
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(error_of(pipe, 1 << 20), "is no regular file");
  std::thread writer([&] { write_file(pipe, text); });
  EXPECT_EQ(read_file(pipe, 1 << 20, FileKind::regular_or_pipe), text);
  writer.join();
  EXPECT_TRUE(std::filesystem::is_fifo(pipe));
  std::thread second([&] { std::ofstream(pipe) << text.substr(0, 60'000); });
  EXPECT_EQ(error_of(pipe, 1000, FileKind::regular_or_pipe), "is larger than 0 MiB");
  second.join();
}

}  // namespace
}  // namespace wellspring::test
