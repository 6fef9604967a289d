#include "sample_products.hpp"

#include <array>

// The library is compiled for all processors of an architecture. These loops are compiled for
// others as well, of which the loader chooses.
#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && __GNUC__ >= 12 && \
    !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define SAMARA_FOR_EACH_PROCESSOR \
  __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#define SAMARA_INLINE inline __attribute__((always_inline))
#else
#define SAMARA_FOR_EACH_PROCESSOR
#define SAMARA_INLINE inline
#endif

namespace samara::analysis {
namespace {

/// Of neighbouring samples from `at` on, as many together as there are left. The sums stay in
/// registers. @returns the first sample that is left
template <int together, int vectors>
SAMARA_INLINE std::ptrdiff_t add_samples(const SampledRow& row, const double* values,
                                         std::ptrdiff_t distance, double* sums, std::ptrdiff_t at) {
  for (; at + together <= row.samples; at += together) {
    std::array<std::array<double, together>, vectors> total{};
    for (std::size_t e = 0; e < row.count; ++e) {
      const double* own = row.sampled + row.numbers[e] * row.samples + at;
      const double* other = values + row.columns[e] * row.samples + at;
      for (std::size_t v = 0; v < vectors; ++v, other += distance)
        for (std::size_t i = 0; i < together; ++i) total[v][i] += own[i] * other[i];
    }
    double* to = sums + at;
    for (std::size_t v = 0; v < vectors; ++v, to += distance)
      for (std::size_t i = 0; i < together; ++i) to[i] += total[v][i];
  }
  return at;
}

template <int vectors>
SAMARA_INLINE void add_all(const SampledRow& row, const double* values, std::ptrdiff_t distance,
                           double* sums) {
  std::ptrdiff_t at = add_samples<16, vectors>(row, values, distance, sums, 0);
  at = add_samples<8, vectors>(row, values, distance, sums, at);
  at = add_samples<4, vectors>(row, values, distance, sums, at);
  at = add_samples<2, vectors>(row, values, distance, sums, at);
  add_samples<1, vectors>(row, values, distance, sums, at);
}

SAMARA_FOR_EACH_PROCESSOR
void add_one(const SampledRow& row, const double* values, std::ptrdiff_t distance, double* sums) {
  add_all<1>(row, values, distance, sums);
}

SAMARA_FOR_EACH_PROCESSOR
void add_two(const SampledRow& row, const double* values, std::ptrdiff_t distance, double* sums) {
  add_all<2>(row, values, distance, sums);
}

}  // namespace

void add_products(const SampledRow& row, const double* values, std::ptrdiff_t vectors,
                  std::ptrdiff_t distance, double* sums) {
  std::ptrdiff_t vector = 0;
  for (; vector + 2 <= vectors; vector += 2)
    add_two(row, values + vector * distance, distance, sums + vector * distance);
  if (vector < vectors)
    add_one(row, values + vector * distance, distance, sums + vector * distance);
}

}  // namespace samara::analysis
