#include <carom/core/errors.h>
#include <carom/core/nearest_name.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>

namespace carom {

namespace {

char small(char letter) { return static_cast<char>(std::tolower(static_cast<unsigned char>(letter))); }

/// Number of letters to add, leave out, change or exchange with their neighbours (optimal string alignment).
std::size_t distance(std::string_view a, std::string_view b) {
  // Rows of the table: the present one and the two before it.
  std::array<std::vector<std::size_t>, 3> rows;
  for (std::vector<std::size_t>& row : rows) row.assign(b.size() + 1, 0);
  for (std::size_t j = 0; j <= b.size(); ++j) rows[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::vector<std::size_t>& now = rows[i % 3];
    const std::vector<std::size_t>&before = rows[(i + 2) % 3], &earlier = rows[(i + 1) % 3];
    now[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const bool same = small(a[i - 1]) == small(b[j - 1]);
      now[j] = std::min({before[j] + 1, now[j - 1] + 1, before[j - 1] + (same ? 0 : 1)});
      const bool exchanged =
          i > 1 && j > 1 && small(a[i - 1]) == small(b[j - 2]) && small(a[i - 2]) == small(b[j - 1]);
      if (exchanged) now[j] = std::min(now[j], earlier[j - 2] + 1);
    }
  }
  return rows[a.size() % 3][b.size()];
}

}  // namespace

std::string nearest_name(std::string_view given, const std::vector<std::string_view>& known) {
  std::string_view nearest;
  std::size_t least = 0;
  for (const std::string_view name : known) {
    const std::size_t longer = std::max(name.size(), given.size());
    const std::size_t shorter = std::min(name.size(), given.size());
    if (3 * (longer - shorter) > longer) continue;
    const std::size_t apart = distance(given, name);
    if (3 * apart > longer || (!nearest.empty() && apart >= least)) continue;
    nearest = name;
    least = apart;
  }
  return std::string(nearest);
}

void refuse_name(std::string_view what, std::string_view name, const std::vector<std::string_view>& known) {
  const std::string part(what), nearest = nearest_name(name, known);
  const std::string meant = nearest.empty() ? "" : "the nearest is '" + nearest + "'; ";
  throw ModelError(part + " '" + std::string(name) + "': there is none; " + meant +
                   "allowed: the name of a " + part + " of this system");
}

}  // namespace carom
