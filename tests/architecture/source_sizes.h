#pragma once

// Sizes of classes and functions, read from the text of a source file: enough C++ for sources that
// clang-format has arranged, without templates in comparisons outside function bodies.

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace carom_test {

/// Size of a class, struct or union with a body.
struct ClassSize {
  std::string name;      ///< with the classes around it: Outer::Inner
  std::size_t line = 0;  ///< where it begins
  std::string bases;     ///< as they are written
  int functions = 0;     ///< declared or defined in it, overloads and defaulted ones too; friends are not
  int overrides = 0;     ///< those of them that override one of a base
  int members = 0;       ///< data of each object
};

/// Size of a function with a body.
struct FunctionSize {
  std::string name;       ///< as it is written
  std::size_t line = 0;   ///< where it begins
  std::size_t lines = 0;  ///< from its first word to the brace that closes it
};

/// Sizes of all in a file.
struct SourceSizes {
  std::vector<ClassSize> classes;
  std::vector<FunctionSize> functions;
};

/// A word, a number, a literal or a sign of code.
struct Token {
  std::string text;
  std::size_t line = 0;
};

/// Words and signs of a source file, without comments and preprocessor lines; of #if the first branch.
class Tokens {
public:
  /// Reads a file.
  explicit Tokens(std::string_view code) : code_(code) {
    while (at_ < code_.size()) read_one();
  }
  /// In their order.
  [[nodiscard]] const std::vector<Token>& all() const { return tokens_; }

private:
  [[nodiscard]] bool begins(std::string_view text) const { return code_.substr(at_).starts_with(text); }
  static bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

  void skip_to(std::size_t place) {
    place = std::min(place, code_.size());
    line_ += static_cast<std::size_t>(std::count(code_.begin() + static_cast<std::ptrdiff_t>(at_),
                                                 code_.begin() + static_cast<std::ptrdiff_t>(place), '\n'));
    at_ = place;
  }
  void skip_past(std::string_view text, std::size_t from) {
    const std::size_t place = code_.find(text, from);
    skip_to(place == std::string_view::npos ? code_.size() : place + text.size());
  }
  void add(std::string text) {
    if (skipped_branches_ == 0) tokens_.push_back({std::move(text), line_});
  }

  void read_one() {
    const char c = code_[at_];
    if (std::isspace(static_cast<unsigned char>(c)) != 0) {
      skip_to(at_ + 1);
    } else if (begins("//")) {
      skip_past("\n", at_);
    } else if (begins("/*")) {
      skip_past("*/", at_ + 2);
    } else if (c == '#') {
      read_directive();
    } else if (begins("R\"")) {
      add("\"");
      const std::size_t open = code_.find('(', at_);
      skip_past(")" + std::string(code_.substr(at_ + 2, open - at_ - 2)) + "\"", open);
    } else if (c == '"' || c == '\'') {
      add(std::string(1, c));
      std::size_t end = at_ + 1;
      while (end < code_.size() && code_[end] != c) end += code_[end] == '\\' ? 2U : 1U;
      skip_to(end + 1);
    } else if (is_word(c)) {
      std::size_t end = at_;
      // A digit separator is part of its number.
      while (end < code_.size() &&
             (is_word(code_[end]) || (std::isdigit(static_cast<unsigned char>(c)) != 0 &&
                                      (code_[end] == '\'' || code_[end] == '.')))) {
        ++end;
      }
      add(std::string(code_.substr(at_, end - at_)));
      skip_to(end);
    } else {
      const std::size_t size = begins("::") || begins("->") ? 2 : 1;
      add(std::string(code_.substr(at_, size)));
      skip_to(at_ + size);
    }
  }

  void read_directive() {
    std::size_t end = at_;
    do {
      end = std::min(code_.find('\n', end + 1), code_.size());
    } while (end < code_.size() && code_[end - 1] == '\\');
    const std::string_view directive = code_.substr(at_, end - at_);
    if (directive.starts_with("#if")) {
      if (skipped_branches_ > 0) ++skipped_branches_;
    } else if (directive.starts_with("#el")) {
      if (skipped_branches_ == 0) skipped_branches_ = 1;
    } else if (directive.starts_with("#endif")) {
      if (skipped_branches_ > 0) --skipped_branches_;
    }
    skip_to(end);
  }

  std::string_view code_;
  std::size_t at_ = 0;
  std::size_t line_ = 1;
  int skipped_branches_ = 0;  // depth of #if in a branch that is left out
  std::vector<Token> tokens_;
};

/// Reads declarations one after another and counts them; bodies of functions are skipped.
class SourceReader {
public:
  /// Reads a file.
  explicit SourceReader(std::string_view code) : tokens_(Tokens(code).all()) {
    while (at_ < tokens_.size()) read_declaration(none);
  }
  /// Sizes found.
  [[nodiscard]] SourceSizes take() && { return std::move(sizes_); }

private:
  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  [[nodiscard]] bool is(std::string_view text, std::size_t ahead = 0) const {
    return at_ + ahead < tokens_.size() && tokens_[at_ + ahead].text == text;
  }

  // Skips from an opening bracket past the one that closes it.
  void skip_brackets() {
    int depth = 0;
    do {
      if (is("(") || is("{") || is("[")) ++depth;
      if (is(")") || is("}") || is("]")) --depth;
      ++at_;
    } while (depth > 0 && at_ < tokens_.size());
  }
  void skip_angles() {
    int depth = 0;
    do {
      if (is("<")) ++depth;
      if (is(">")) --depth;
      is("(") || is("{") || is("[") ? skip_brackets() : void(++at_);
    } while (depth > 0 && at_ < tokens_.size());
  }
  void skip_past_semicolon() {
    while (at_ < tokens_.size() && !is(";")) is("(") || is("{") || is("[") ? skip_brackets() : void(++at_);
    ++at_;
  }
  void read_scope(std::size_t owner) {
    ++at_;
    while (at_ < tokens_.size() && !is("}")) read_declaration(owner);
    ++at_;
  }

  // A declaration in the class of index `owner`, or in a namespace.
  void read_declaration(std::size_t owner) {
    const std::size_t begin = at_;
    if (is(";") || is("}")) {
      ++at_;
      return;
    }
    if ((is("public") || is("protected") || is("private")) && is(":", 1)) {
      at_ += 2;
      return;
    }
    if (is("using") || is("typedef") || is("static_assert")) return skip_past_semicolon();
    if (is("friend")) return read_friend();
    while (is("template")) {
      ++at_;
      if (is("<")) skip_angles();
    }
    const bool is_linkage = is("extern") && is("\"", 1);
    if (is("namespace") || (is("inline") && is("namespace", 1)) || is_linkage) {
      while (at_ < tokens_.size() && !is("{") && !is(";")) ++at_;
      return is("{") ? read_scope(none) : void(++at_);
    }
    if (is("class") || is("struct") || is("union")) {
      if (const std::size_t body = class_body(); body != none) return read_class(owner, begin, body);
      if (is(";", 2)) return skip_past_semicolon();  // declared only
    }
    if (is("enum")) {
      while (at_ < tokens_.size() && !is("{") && !is(";")) ++at_;
      if (is("{")) skip_brackets();
      if (owner != none && !is(";")) count_members(owner);
      return skip_past_semicolon();
    }
    read_variable_or_function(owner, begin);
  }

  void read_friend() {
    while (at_ < tokens_.size() && !is(";") && !is("{")) is("(") ? skip_brackets() : void(++at_);
    is("{") ? skip_brackets() : void(++at_);
  }

  // Where the body of the class begins that is named here; `none` for a declaration without one.
  [[nodiscard]] std::size_t class_body() {
    const std::size_t begin = at_;
    int angles = 0;
    while (at_ < tokens_.size() && !is(";") && !is("{") && !is("=") && !(is("(") && angles == 0)) {
      if (is("<")) ++angles;
      if (is(">")) --angles;
      is("[") || is("(") ? skip_brackets() : void(++at_);
    }
    const std::size_t body = is("{") ? at_ : none;
    at_ = begin;
    return body;
  }

  void read_class(std::size_t owner, std::size_t begin, std::size_t body) {
    std::string name, bases;
    bool named = false;
    while (at_ < body) {
      if (is("[") || is("(")) {  // an attribute
        skip_brackets();
        continue;
      }
      const std::string& text = tokens_[at_++].text;
      if (named || text == ":" || text == "<") {
        bases += text == ":" ? "" : text + ' ';
        named = true;
      } else if (text != "final" && text != "class" && text != "struct" && text != "union") {
        name = text;
      }
    }
    const std::string outer = owner == none ? "" : sizes_.classes[owner].name + "::";
    const std::size_t self = sizes_.classes.size();
    sizes_.classes.push_back({outer + name, tokens_[begin].line, bases, 0, 0, 0});
    at_ = body;
    read_scope(self);
    if (owner != none && !is(";")) count_members(owner);
    skip_past_semicolon();
  }

  // Counts the names from here to the semicolon.
  void count_members(std::size_t owner) {
    int names = 1;
    int angles = 0;
    bool in_value = false;
    while (at_ < tokens_.size() && !is(";")) {
      if (is("=")) in_value = true;
      if (!in_value && is("<")) ++angles;
      if (!in_value && is(">")) --angles;
      if (is(",") && angles == 0) {
        ++names;
        in_value = false;
      }
      is("(") || is("{") || is("[") ? skip_brackets() : void(++at_);
    }
    sizes_.classes[owner].members += names;
  }

  void read_variable_or_function(std::size_t owner, std::size_t begin) {
    bool is_static = false;
    int angles = 0;
    while (at_ < tokens_.size()) {
      is_static = is_static || is("static");
      if (is("operator")) {
        const std::size_t name = at_;
        at_ += is("(", 1) ? 3U : 2U;  // operator() has its brackets in its name
        while (at_ < tokens_.size() && !is("(")) ++at_;
        return read_function(owner, begin, name);
      }
      if (is("alignas") || is("decltype") || is("explicit") || is("noexcept") || is("requires")) {
        ++at_;
        if (is("(")) skip_brackets();
        continue;
      }
      if (is("(") && angles == 0) {
        if (is("*", 1) || is("&", 1)) break;  // a pointer to a function or an array
        return read_function(owner, begin, name_before(at_, begin));
      }
      if (is(";") || is("{") || is("=") || (is(",") && angles == 0)) break;
      if (is("<")) ++angles;
      if (is(">")) --angles;
      is("(") || is("[") ? skip_brackets() : void(++at_);
    }
    at_ = begin;
    if (owner != none && !is_static) count_members(owner);
    skip_past_semicolon();
  }

  // Where the name before a list of parameters begins: Class<D>::name, ~Class.
  [[nodiscard]] std::size_t name_before(std::size_t end, std::size_t begin) const {
    std::size_t name = end - 1;
    while (name > begin) {
      const std::string& before = tokens_[name - 1].text;
      if (before != "::" && before != "~" && tokens_[name].text != "::") break;
      --name;
      if (tokens_[name].text != ">") continue;
      for (int angles = 1; angles > 0 && name > begin;) {
        --name;
        if (tokens_[name].text == ">") ++angles;
        if (tokens_[name].text == "<") --angles;
      }
      if (name > begin) --name;
    }
    return name;
  }

  // From the list of parameters on.
  void read_function(std::size_t owner, std::size_t begin, std::size_t name) {
    std::string text;
    for (std::size_t i = name; i < at_; ++i) text += tokens_[i].text;
    if (owner != none) {
      ++sizes_.classes[owner].functions;
      text.insert(0, sizes_.classes[owner].name + "::");
    }
    skip_brackets();
    while (at_ < tokens_.size() && !is(";") && !is("{") && !is("=")) {
      if (owner != none && (is("override") || is("final"))) {
        ++sizes_.classes[owner].overrides;
      }
      if (is(":")) {
        skip_initialisers();
        break;
      }
      is("(") || is("[") ? skip_brackets() : void(++at_);
    }
    if (!is("{")) return skip_past_semicolon();
    skip_brackets();
    const std::size_t first = tokens_[begin].line;
    sizes_.functions.push_back({text, first, tokens_[at_ - 1].line - first + 1});
  }

  // Of the members by a constructor: name(...) or name{...}, with commas between.
  void skip_initialisers() {
    do {
      ++at_;
      while (at_ < tokens_.size() && !is("(") && !is("{")) is("<") ? skip_angles() : void(++at_);
      skip_brackets();
      while (is(".")) ++at_;
    } while (is(","));
  }

  std::vector<Token> tokens_;
  std::size_t at_ = 0;
  SourceSizes sizes_;
};

/// Sizes of all classes and functions in a source file.
inline SourceSizes source_sizes(std::string_view code) { return SourceReader(code).take(); }

}  // namespace carom_test
