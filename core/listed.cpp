#include <carom/core/listed.h>

#include <algorithm>
#include <string_view>

namespace carom {

std::string listed(std::span<const std::string> names, std::size_t most) {
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), most); ++i) text += (i == 0 ? "" : ", ") + names[i];
  if (names.size() > most) text += " and " + std::to_string(names.size() - most) + " more";
  return text;
}

std::vector<std::string> worst_first(std::vector<std::string> names, int worst) {
  if (worst > 0 && worst < static_cast<int>(names.size()))
    std::rotate(names.begin(), names.begin() + worst, names.begin() + worst + 1);
  return names;
}

std::string shortened(const std::string& text, std::size_t most) {
  constexpr std::string_view cut = " ... ";
  constexpr std::size_t share_of_end = 3;  // the end of a message says what is allowed, or names a file
  if (text.size() <= most) return text;
  // Bytes 10xxxxxx go on with a character.
  const auto goes_on = [&](std::size_t i) { return (static_cast<unsigned char>(text[i]) & 0xC0U) == 0x80U; };
  const std::size_t at_end = most / share_of_end;
  std::size_t head = most - at_end - cut.size(), tail = text.size() - at_end;
  while (head > 0 && goes_on(head)) --head;
  while (tail < text.size() && goes_on(tail)) ++tail;
  return text.substr(0, head).append(cut).append(text, tail);
}

}  // namespace carom
