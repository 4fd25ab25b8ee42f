#include <carom/core/errors.h>
#include <carom/core/whole_file.h>

#include "tests/integrators/throws.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

namespace {

using namespace carom;

TEST(WholeFile, ReadsBackWhatWasWritten) {
  const std::string path = (std::filesystem::path(testing::TempDir()) / "carom_whole_file").string();
  std::string content("line\r\n\0\xff", 8);
  content += std::string(100000, 'x');  // several blocks
  write_file(path, content, "thing");
  EXPECT_EQ(read_file(path, "thing"), content);
  write_file(path, "", "thing");
  EXPECT_EQ(read_file(path, "thing"), "");
  EXPECT_FALSE(std::filesystem::exists(path + ".unfinished"));
  std::filesystem::remove(path);
  EXPECT_THROWS(FileError, read_file(path, "thing"), "thing '" + path + "': cannot be read");
}

TEST(WholeFile, ADirectoryIsNoFile) {
  const std::string path = testing::TempDir();
  EXPECT_THROWS(FileError, read_file(path, "thing"), path, "cannot be read");
  EXPECT_THROWS(FileError, write_file(path + "/nowhere/file", "x", "thing"), "cannot be written");
}

}  // namespace
