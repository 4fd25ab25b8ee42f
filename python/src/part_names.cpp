#include "part_names.h"

namespace carom_python {

namespace {

std::map<carom::Index, std::weak_ptr<PartNames>>& by_token() {
  static std::map<carom::Index, std::weak_ptr<PartNames>> table;
  return table;
}

}  // namespace

void PartNames::add(std::string_view type, carom::Index serial, const std::string& name) {
  const auto [at, is_new] = names_.try_emplace({std::string(type), serial}, name);
  if (!is_new && at->second != name) at->second.clear();
}

std::string PartNames::find(std::string_view type, carom::Index serial) const {
  const auto found = names_.find({std::string(type), serial});
  return found != names_.end() ? found->second : std::string();
}

std::shared_ptr<PartNames> part_names(carom::Index token) {
  std::weak_ptr<PartNames>& known = by_token()[token];
  std::shared_ptr<PartNames> names = known.lock();
  if (!names) {
    names = std::shared_ptr<PartNames>(new PartNames, [token](PartNames* gone) {
      by_token().erase(token);
      delete gone;
    });
    known = names;
  }
  return names;
}

std::string find_part_name(std::string_view type, carom::Index token, carom::Index serial) {
  const auto found = by_token().find(token);
  if (found == by_token().end()) return {};
  const std::shared_ptr<PartNames> names = found->second.lock();
  return names ? names->find(type, serial) : std::string();
}

}  // namespace carom_python
