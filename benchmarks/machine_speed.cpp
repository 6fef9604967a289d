// Attainable speed of one core, as JSON: stream triad, and products of matrices of the sizes that
// Samara uses, by the same BLAS.
#include <algorithm>
#include <chrono>
#include <complex>
#include <cstdio>
#include <vector>

// The header of BLAS needs it first.
#include <petscsys.h>
// clang-format off
#include <petscblaslapack.h>
// clang-format on

extern "C" {
// NOLINTNEXTLINE(readability-identifier-naming)
void zgemm_(const char*, const char*, const PetscBLASInt*, const PetscBLASInt*, const PetscBLASInt*,
            const std::complex<double>*, const std::complex<double>*, const PetscBLASInt*,
            const std::complex<double>*, const PetscBLASInt*, const std::complex<double>*,
            std::complex<double>*, const PetscBLASInt*);
}

namespace {

using Complex = std::complex<double>;

/// Seconds of the fastest of some runs.
template <class Work>
double fastest(int runs, const Work& work) {
  double best = 1e30;
  for (int run = 0; run < runs; ++run) {
    const auto start = std::chrono::steady_clock::now();
    work();
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
    best = std::min(best, passed.count());
  }
  return best;
}

/// a = b + s c of arrays beyond all caches [GB/s].
double triad() {
  constexpr std::size_t size = 16'000'000;
  std::vector<double> a(size, 1.0);
  const std::vector<double> b(size, 2.0);
  const std::vector<double> c(size, 3.0);
  double factor = 0.5;
  const double seconds = fastest(10, [&] {
    for (std::size_t i = 0; i < size; ++i) a[i] = b[i] + factor * c[i];
    factor = a[size / 2] * 1e-3;  // so that no run is left out
  });
  return 3.0 * sizeof(double) * size / seconds * 1e-9;
}

void multiply(PetscBLASInt n, const double* a, const double* b, double* c) {
  const double minus = -1.0;
  const double one = 1.0;
  BLASgemm_("N", "N", &n, &n, &n, &minus, a, &n, b, &n, &one, c, &n);
}
void multiply(PetscBLASInt n, const Complex* a, const Complex* b, Complex* c) {
  const Complex minus = -1.0;
  const Complex one = 1.0;
  zgemm_("N", "N", &n, &n, &n, &minus, a, &n, b, &n, &one, c, &n);
}

/// C = C - A B with n x n matrices, many different ones in turn [GFlop/s].
template <class Scalar>
double product(PetscBLASInt n) {
  const auto area = static_cast<std::size_t>(n) * static_cast<std::size_t>(n);
  const std::size_t sets = std::max<std::size_t>(1, 200'000 / area);
  const std::vector<Scalar> values(3 * sets * area, Scalar(1e-3));
  std::vector<Scalar> results(sets * area, Scalar(0.0));
  const double one = sizeof(Scalar) == sizeof(double) ? 2.0 : 8.0;
  const double operations = one * static_cast<double>(sets) * static_cast<double>(area) * n;
  const auto repeats = static_cast<int>(std::max(1.0, 2e8 / operations));
  const double seconds = fastest(5, [&] {
    for (int repeat = 0; repeat < repeats; ++repeat)
      for (std::size_t set = 0; set < sets; ++set)
        multiply(n, values.data() + 2 * set * area, values.data() + (2 * set + 1) * area,
                 results.data() + set * area);
  });
  return operations * repeats / seconds * 1e-9;
}

}  // namespace

int main() {
  std::printf(
      "{\"triad\": %.2f, \"dgemm_18\": %.2f, \"dgemm_54\": %.2f, \"dgemm_1000\": %.2f, "
      "\"zgemm_18\": %.2f}\n",
      triad(), product<double>(18), product<double>(54), product<double>(1000),
      product<Complex>(18));
}
