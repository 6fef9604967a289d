// Products of sampled entries of a matrix with sampled vectors, by the widest vector instructions
// of the processor.
#pragma once

#include <cstddef>

#include <petscsys.h>

namespace samara::analysis {

/// A row of a matrix whose entries are sampled over a period. The samples of an entry, and those of
/// an unknown of a vector, are next to each other in memory.
struct SampledRow {
  const double* sampled;    ///< those of the entry with the number 0
  const PetscInt* numbers;  ///< of the row's entries
  const PetscInt* columns;
  std::size_t count;  ///< entries
  std::ptrdiff_t samples;
};

/// Adds the products of a row with `vectors` vectors to `sums`: sample by sample, the sum over the
/// entries. Vector v begins at `values` + v `distance`, its sums at `sums` + v `distance`.
void add_products(const SampledRow& row, const double* values, std::ptrdiff_t vectors,
                  std::ptrdiff_t distance, double* sums);

}  // namespace samara::analysis
