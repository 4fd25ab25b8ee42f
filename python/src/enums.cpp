#include "enums.h"

#include "bind.h"
#include "record.h"

namespace carom_python {

namespace {

template <class E>
nb::enum_<E> bind_enum(nb::module_& core, const char* key = nullptr) {
  const char* const name = EnumNames<E>::name;
  nb::enum_<E> type(core, name, doc(key != nullptr ? key : name));
  for (const auto& [label, value] : EnumNames<E>::values) {
    type.value(label, value, doc(std::string(name) + "." + label));
  }
  return type;
}

}  // namespace

void bind_enums(nb::module_& core) {
  using namespace carom;
  bind_enum<ForceRule>(core);
  bind_enum<ImpactTimes>(core);
  bind_enum<Iteration>(core);
  bind_enum<EnergyGain>(core);
  bind_enum<ImpactOrder>(core);
  bind_enum<ImpactLaw>(core);
  bind_enum<FlowMethod>(core);
  bind_enum<EventRecords::Choice>(core);
  bind_enum<EventKind>(core);
  bind_enum<ContactMode>(core);
  bind_enum<Outcome>(core);
  bind_enum<StoredEnergy>(core);
  bind_enum<EnergyFlow>(core);
  bind_enum<FindingKind>(core);
  bind_enum<SolverId>(core);
  bind_enum<SetKind>(core);
  bind_enum<LogLevel>(core);
  bind_enum<Quantity>(core);
  bind_enum<FeatureKey::Owner>(core, "FeatureKey.Owner");
}

}  // namespace carom_python
