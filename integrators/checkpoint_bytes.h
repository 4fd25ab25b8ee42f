#pragma once

/// \file
/// Numbers of a checkpoint as bytes.

#include <carom/core/errors.h>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace carom {

/// Numbers as bytes, lowest first, whatever the machine.
class CheckpointWriter {
public:
  /// Appends a number, or a list with its size.
  void add(std::uint64_t number) {
    for (unsigned shift = 0; shift < 64; shift += 8)
      bytes_.push_back(static_cast<char>((number >> shift) & 0xffU));
  }
  void add(double number) { add(std::bit_cast<std::uint64_t>(number)); }
  void add(std::int64_t number) { add(static_cast<std::uint64_t>(number)); }
  void add(int number) { add(std::int64_t{number}); }
  template <class Real>
  void add(const std::vector<Real>& numbers) {
    add(std::uint64_t{numbers.size()});
    for (const Real number : numbers) add(static_cast<double>(number));
  }
  /// Bytes so far.
  [[nodiscard]] const std::vector<char>& bytes() const { return bytes_; }

private:
  std::vector<char> bytes_;
};

/// Reads them back. Throws FileError where they cannot be of a checkpoint.
class CheckpointReader {
public:
  /// \param path of the file, for messages
  CheckpointReader(std::string path, std::string_view bytes) : path_(std::move(path)), bytes_(bytes) {}

  /// Reads the next number, or list.
  void get(std::uint64_t& number) {
    if (bytes_.size() < 8) damaged("ends too early");
    number = 0;
    for (unsigned i = 0; i < 8; ++i)
      number |= std::uint64_t{static_cast<unsigned char>(bytes_[i])} << (8 * i);
    bytes_.remove_prefix(8);
  }
  void get(double& number) {
    std::uint64_t bits = 0;
    get(bits);
    number = std::bit_cast<double>(bits);
  }
  void get(std::int64_t& number) {
    std::uint64_t bits = 0;
    get(bits);
    number = static_cast<std::int64_t>(bits);
  }
  void get(int& number) {
    std::int64_t wide = 0;
    get(wide);
    number = static_cast<int>(wide);
  }
  /// A count of things of at least 8 bytes each, which must fit into what is left.
  std::size_t count() {
    std::uint64_t number = 0;
    get(number);
    if (number > bytes_.size() / 8) damaged("a count does not fit");
    return static_cast<std::size_t>(number);
  }
  template <class Real>
  void get(std::vector<Real>& numbers) {
    numbers.resize(count());
    for (Real& kept : numbers) {
      double number = 0.0;
      get(number);
      kept = static_cast<Real>(number);
    }
  }
  /// Demands the end.
  void finish() const {
    if (!bytes_.empty()) damaged("goes on after its end");
  }
  /// Throws FileError.
  [[noreturn]] void damaged(const std::string& how) const {
    throw FileError("checkpoint '" + path_ + "': is damaged: " + how);
  }

private:
  std::string path_;
  std::string_view bytes_;
};

}  // namespace carom
