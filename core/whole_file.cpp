#include <carom/core/errors.h>
#include <carom/core/whole_file.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace carom {

namespace {

[[noreturn]] void fail(std::string_view what, const std::string& path, const char* how) {
  throw FileError(std::string(what) + " '" + path + "': cannot be " + how);
}

}  // namespace

bool is_special_file(const std::string& path) {
  std::error_code unknown;
  const auto status = std::filesystem::status(path, unknown);
  return std::filesystem::exists(status) && !std::filesystem::is_regular_file(status);
}

std::string read_file(const std::string& path, std::string_view what) {
  // A device may never end, and reading a pipe may wait for ever.
  if (is_special_file(path)) fail(what, path, "read: it is not a regular file");
  std::ifstream file(path, std::ios::binary);
  if (!file) fail(what, path, "read");
  std::string content;
  // By blocks: iterators over the buffer would let the error of a directory pass as another exception.
  std::array<char, 1 << 14> block{};
  do {
    file.read(block.data(), static_cast<std::streamsize>(block.size()));
    content.append(block.data(), static_cast<std::size_t>(file.gcount()));
  } while (file);
  if (file.bad()) fail(what, path, "read");
  return content;
}

void write_file(const std::string& path, std::string_view content, std::string_view what) {
  // Renaming would put a regular file in the place of a device.
  if (is_special_file(path)) fail(what, path, "written: it is not a regular file");
  const std::string unfinished = path + ".unfinished";
  std::ofstream file(unfinished, std::ios::binary | std::ios::trunc);
  file << content;
  file.close();
  if (!file || std::rename(unfinished.c_str(), path.c_str()) != 0) {
    std::remove(unfinished.c_str());
    fail(what, path, "written");
  }
}

}  // namespace carom
