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

/// Of some neighbouring samples, with some vectors. The sums stay in registers.
template <int together, int vectors>
SAMARA_INLINE void add_samples(const SampledRow& row, const double* values, std::ptrdiff_t distance,
                               double* sums) {
  std::array<std::array<double, together>, vectors> total{};
  for (std::size_t e = 0; e < row.count; ++e) {
    const double* own = row.sampled + row.numbers[e] * row.samples;
    const double* other = values + row.columns[e] * row.samples;
    for (std::size_t v = 0; v < vectors; ++v, other += distance)
      for (std::size_t i = 0; i < together; ++i) total[v][i] += own[i] * other[i];
  }
  for (std::size_t v = 0; v < vectors; ++v, sums += distance)
    for (std::size_t i = 0; i < together; ++i) sums[i] += total[v][i];
}

template <int vectors>
SAMARA_INLINE void add_all(const SampledRow& all, const double* values, std::ptrdiff_t distance,
                           double* sums) {
  SampledRow row = all;
  for (std::ptrdiff_t at = 0; at < all.samples;) {
    const std::ptrdiff_t left = all.samples - at;
    row.sampled = all.sampled + at;
    const double* some = values + at;
    double* to = sums + at;
    if (left >= 16) {
      add_samples<16, vectors>(row, some, distance, to);
      at += 16;
    } else if (left >= 8) {
      add_samples<8, vectors>(row, some, distance, to);
      at += 8;
    } else if (left >= 4) {
      add_samples<4, vectors>(row, some, distance, to);
      at += 4;
    } else if (left >= 2) {
      add_samples<2, vectors>(row, some, distance, to);
      at += 2;
    } else {
      add_samples<1, vectors>(row, some, distance, to);
      at += 1;
    }
  }
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
