#include <carom/core/fingerprint.h>

#include <bit>

namespace carom {

void Fingerprint::byte(unsigned char value) {
  constexpr std::uint64_t prime = 0x100000001b3ULL;
  hash_ = (hash_ ^ value) * prime;
}

void Fingerprint::add(std::uint64_t value) {
  for (unsigned shift = 0; shift < 64; shift += 8) byte(static_cast<unsigned char>((value >> shift) & 0xffU));
}

void Fingerprint::add(double value) { add(std::bit_cast<std::uint64_t>(value)); }

void Fingerprint::add(std::span<const double> values) {
  for (const double value : values) add(value);
}

void Fingerprint::add(std::string_view text) {
  for (const char letter : text) byte(static_cast<unsigned char>(letter));
  byte(0);
}

}  // namespace carom
