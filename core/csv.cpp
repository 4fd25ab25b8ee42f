#include <carom/core/csv.h>
#include <carom/core/errors.h>
#include <carom/core/whole_file.h>

#include <array>
#include <charconv>
#include <fstream>
#include <iterator>

namespace carom {

void append_csv(std::string& line, double number) {
  std::array<char, 32> text{};
  line.append(text.data(), std::to_chars(text.data(), text.data() + text.size(), number).ptr);
}

void append_csv(std::string& line, std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) {
    line += text;
    return;
  }
  line += '"';
  for (const char letter : text) {
    if (letter == '"') line += '"';
    line += letter;
  }
  line += '"';
}

CsvWriter::CsvWriter(std::string_view what, const std::string& path)
    : name_(std::string(what) + ": '" + path + "'"), file_(path) {
  demand_written();
}

void CsvWriter::end_line() {
  line_.back() = '\n';
  file_ << line_;
  line_.clear();
  demand_written();
}

void CsvWriter::flush() {
  file_.flush();
  demand_written();
}

void CsvWriter::demand_written() const {
  if (!file_) throw FileError(name_ + " cannot be written");
}

CsvReader::CsvReader(std::string_view what, const std::string& path) : name_(what) {
  name_ += " '" + path + "'";
  if (is_special_file(path)) throw FileError(name_ + " cannot be read: it is not a regular file");
  std::ifstream file(path, std::ios::binary);
  if (file) text_.assign(std::istreambuf_iterator<char>(file), {});
  if (!file) throw FileError(name_ + " cannot be read");
  if (text_.empty()) throw FileError(name_ + " is empty");
  if (text_.back() != '\n') throw FileError(name_ + " was cut off: its last line has no end");
}

bool CsvReader::next(std::vector<std::string>& fields) {
  fields.clear();
  if (at_ == text_.size()) return false;
  line_ = next_line_;
  std::string field;
  bool was_quoted = false;
  while (true) {
    const char letter = text_[at_++];
    if (letter == '"' && field.empty() && !was_quoted) {
      was_quoted = true;
      while (true) {
        if (at_ == text_.size()) refuse("a quote is not closed");
        const char inside = text_[at_++];
        if (inside == '\n') ++next_line_;
        if (inside != '"') {
          field += inside;
        } else if (text_[at_] == '"') {  // the text ends with "\n", so there is a next letter
          field += text_[at_++];
        } else {
          break;
        }
      }
    } else if (letter == ',') {
      fields.push_back(std::move(field));
      field.clear();
      was_quoted = false;
    } else if (letter == '\n') {
      ++next_line_;
      fields.push_back(std::move(field));
      return true;
    } else if (letter == '\r' && text_[at_] == '\n') {
      continue;
    } else if (was_quoted || letter == '"') {
      refuse("a quote is out of place");
    } else {
      field += letter;
    }
  }
}

void CsvReader::refuse(const std::string& problem) const {
  throw FileError(name_ + ", line " + std::to_string(line_) + ": " + problem);
}

}  // namespace carom
