// Problem: the force sweep over planar springs costs roots, divisions and shuffles; twice as wide they cost
// little more. No fused multiply-add: each number is rounded as two by two.

#include <carom/joints/spring_pull.h>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace carom {

#if defined(__x86_64__)

namespace {

#define CAROM_AVX2 [[gnu::target("avx2")]]
#define CAROM_AVX2_INLINE [[gnu::target("avx2"), gnu::always_inline]] inline

/// Two points, of the springs i and i + 2.
CAROM_AVX2_INLINE __m256d points(const double* x, Index low, Index high) {
  return _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_loadu_pd(x + low)), _mm_loadu_pd(x + high), 1);
}

CAROM_AVX2_INLINE __m256d property(const double* values, Index stride, Index i) {
  return stride == 0 ? _mm256_broadcast_sd(values) : _mm256_loadu_pd(values + i);
}

CAROM_AVX2_INLINE void add(double* load, __m128d force) {
  _mm_storeu_pd(load, _mm_add_pd(_mm_loadu_pd(load), force));
}

CAROM_AVX2_INLINE void subtract(double* load, __m128d force) {
  _mm_storeu_pd(load, _mm_sub_pd(_mm_loadu_pd(load), force));
}

/// Adds `factor` times the distances of four springs (of 0 and 2, of 1 and 3) to the loads of their ends.
CAROM_AVX2_INLINE void apply(double* load, const Index* from, const Index* to, __m256d factor, __m256d even,
                             __m256d odd) {
  const __m256d even_force = _mm256_mul_pd(_mm256_movedup_pd(factor), even);
  const __m256d odd_force = _mm256_mul_pd(_mm256_permute_pd(factor, 0xF), odd);
  const __m128d a = _mm256_castpd256_pd128(even_force), c = _mm256_extractf128_pd(even_force, 1);
  const __m128d b = _mm256_castpd256_pd128(odd_force), d = _mm256_extractf128_pd(odd_force, 1);
  add(load + from[0], a);
  subtract(load + to[0], a);
  add(load + from[1], b);
  subtract(load + to[1], b);
  add(load + from[2], c);
  subtract(load + to[2], c);
  add(load + from[3], d);
  subtract(load + to[3], d);
}

template <bool Together, bool WithPotential>
CAROM_AVX2 Index pull(const PlanarSprings& springs, Index first, Index last, const double* q, const double* v,
                      double* spring_load, double* dashpot_load, PairSum* potential) {
  PairSum sum;
  if constexpr (WithPotential) sum = *potential;
  Index i = first;
  for (; i + 3 < last; i += 4) {
    const Index* const from = springs.from + i;
    const Index* const to = springs.to + i;
    const __m256d even = _mm256_sub_pd(points(q, to[0], to[2]), points(q, from[0], from[2]));
    const __m256d odd = _mm256_sub_pd(points(q, to[1], to[3]), points(q, from[1], from[3]));
    const __m256d even_rate = _mm256_sub_pd(points(v, to[0], to[2]), points(v, from[0], from[2]));
    const __m256d odd_rate = _mm256_sub_pd(points(v, to[1], to[3]), points(v, from[1], from[3]));
    const __m256d x = _mm256_unpacklo_pd(even, odd), y = _mm256_unpackhi_pd(even, odd);
    const __m256d x_rate = _mm256_unpacklo_pd(even_rate, odd_rate);
    const __m256d y_rate = _mm256_unpackhi_pd(even_rate, odd_rate);
    const __m256d square = _mm256_add_pd(_mm256_mul_pd(x, x), _mm256_mul_pd(y, y));
    const __m256d length = _mm256_sqrt_pd(square);
    const __m256d apart = _mm256_cmp_pd(square, _mm256_setzero_pd(), _CMP_NEQ_UQ);
    const __m256d inverse = _mm256_and_pd(_mm256_div_pd(_mm256_set1_pd(1.0), length), apart);
    const __m256d stretch =
        _mm256_sub_pd(length, property(springs.free_length, springs.free_length_stride, i));
    const __m256d tension = _mm256_mul_pd(property(springs.stiffness, springs.stiffness_stride, i), stretch);
    const __m256d spring = _mm256_mul_pd(tension, inverse);
    const __m256d closing = _mm256_add_pd(_mm256_mul_pd(x, x_rate), _mm256_mul_pd(y, y_rate));
    const __m256d dashpot =
        _mm256_mul_pd(_mm256_mul_pd(property(springs.damping, springs.damping_stride, i), closing),
                      _mm256_mul_pd(inverse, inverse));
    if constexpr (WithPotential) {
      const __m256d term = _mm256_mul_pd(_mm256_mul_pd(_mm256_set1_pd(0.5), tension), stretch);
      sum.add(_mm256_castpd256_pd128(term));
      sum.add(_mm256_extractf128_pd(term, 1));
    }
    if constexpr (Together) {
      apply(spring_load, from, to, _mm256_add_pd(spring, dashpot), even, odd);
    } else {
      apply(spring_load, from, to, spring, even, odd);
      apply(dashpot_load, from, to, dashpot, even, odd);
    }
  }
  if constexpr (WithPotential) *potential = sum;
  return i;
}

#undef CAROM_AVX2
#undef CAROM_AVX2_INLINE

}  // namespace

Index pull_by_fours(const PlanarSprings& springs, Index first, Index last, const double* q, const double* v,
                    double* spring_load, double* dashpot_load, PairSum* potential) {
  static const bool available = __builtin_cpu_supports("avx2") != 0;
  if (!available) return first;
  const bool together = dashpot_load == nullptr;
  const auto chosen = together ? (potential != nullptr ? pull<true, true> : pull<true, false>)
                               : (potential != nullptr ? pull<false, true> : pull<false, false>);
  return chosen(springs, first, last, q, v, spring_load, dashpot_load, potential);
}

#else

Index pull_by_fours(const PlanarSprings& /*springs*/, Index first, Index /*last*/, const double* /*q*/,
                    const double* /*v*/, double* /*spring_load*/, double* /*dashpot_load*/,
                    PairSum* /*potential*/) {
  return first;
}

#endif

}  // namespace carom
