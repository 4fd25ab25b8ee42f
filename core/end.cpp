#include <carom/core/end.h>
#include <carom/core/system.h>

#include <string>

namespace carom {

template <int D>
void check_end(const PartCheck& check, const End<D>& end, std::string_view quantity) {
  check.body(end.body, quantity, true);
  check.finite({end.point.data(), static_cast<std::size_t>(D)}, std::string(quantity) + ".point", "m");
  if (end.body == ground || end.point.isZero(0.0)) return;
  check.oriented_body(end.body, std::string(quantity) + ", off the centre,");
}

template CAROM_API void check_end<2>(const PartCheck&, const End<2>&, std::string_view);
template CAROM_API void check_end<3>(const PartCheck&, const End<3>&, std::string_view);

}  // namespace carom
