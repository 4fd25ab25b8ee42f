#pragma once

/// \file
/// Comma-separated values: exact digits whatever the locale, texts quoted where they need to be. Not API.

#include <cstddef>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace carom {

/// Appends the shortest digits that read back to the same double.
void append_csv(std::string& line, double number);
/// Appends a text, quoted if it holds a comma, a quote or an end of line.
void append_csv(std::string& line, std::string_view text);

/// Writes the records of a file, one after the other.
class CsvWriter {
public:
  /// Makes the file. Throws FileError if it cannot be written, as the others. \param what names it in
  /// messages
  CsvWriter(std::string_view what, const std::string& path);

  /// Adds a field to the record.
  template <class T>
  void add(const T& field) {
    append_csv(line_, field);
    line_ += ',';
  }
  /// Adds empty fields.
  void skip(std::size_t fields = 1) { line_.append(fields, ','); }
  /// Ends the record and writes it.
  void end_line();
  /// Writes what is still in memory.
  void flush();

private:
  void demand_written() const;

  std::string name_;
  std::ofstream file_;
  std::string line_;
};

/// Reads the records of a file, one after the other. Lines end with "\n" or "\r\n", the last one too: a file
/// without it was cut off.
class CsvReader {
public:
  /// Reads the file. Throws FileError if it cannot be read or was cut off. \param what names it in messages
  CsvReader(std::string_view what, const std::string& path);

  /// Reads the next record into `fields`; false at the end. Throws FileError for a quote out of place.
  bool next(std::vector<std::string>& fields);
  /// Throws the FileError "<what> '<path>', line <line of the last record>: <problem>".
  [[noreturn]] void refuse(const std::string& problem) const;

private:
  std::string name_;
  std::string text_;
  std::size_t at_ = 0;
  int line_ = 0;       // at which the last record began
  int next_line_ = 1;  // at which the next one begins
};

}  // namespace carom
