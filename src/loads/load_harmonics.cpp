#include "samara/loads/load_harmonics.hpp"

#include <cmath>
#include <numbers>
#include <sstream>

#include <Eigen/QR>

#include "samara/base/error.hpp"

namespace samara::loads {
namespace {

constexpr double revolution = 360.0;  // [deg], as azimuths are
constexpr double degree = std::numbers::pi / 180.0;
/// Relative to a revolution: closer azimuths are equal, and a whole revolution may lack this much.
constexpr double same_azimuth = 1e-9;
/// Relative to the largest pivot: below it the rows do not separate the harmonics.
constexpr double least_pivot = 1e-8;

void check_azimuth(const LoadSeries& series, const Eigen::VectorXd& azimuth_deg) {
  if (azimuth_deg.size() != series.times.size())
    throw InternalError("the azimuth differs from its time series in size");
  for (Eigen::Index i = 0; i < azimuth_deg.size(); ++i)
    if (!std::isfinite(azimuth_deg(i)))
      throw InputError("azimuth: row " + std::to_string(i + 1) + " is not a finite number");
}

/// The azimuth without its jumps, if it is kept within a revolution.
Eigen::VectorXd unwrap(Eigen::VectorXd azimuth) {
  if (azimuth.maxCoeff() - azimuth.minCoeff() > revolution * (1.0 + same_azimuth)) return azimuth;
  double turns = 0.0;
  double before = azimuth(0);
  for (Eigen::Index i = 1; i < azimuth.size(); ++i) {
    // A step of half a revolution counts as a step forward.
    turns -= std::ceil((azimuth(i) - before) / revolution - 0.5);
    before = azimuth(i);
    azimuth(i) += turns * revolution;
  }
  return azimuth;
}

/// First row of the last part in which the azimuth grows.
Eigen::Index first_growing_row(const Eigen::VectorXd& azimuth) {
  Eigen::Index first = azimuth.size() - 1;
  while (first > 0 && azimuth(first - 1) < azimuth(first)) --first;
  return first;
}

struct Window {
  Eigen::Index first_row = 0;
  int revolutions = 1;
};

/// The last whole revolutions. The row at their beginning repeats that at their end and is left
/// out.
Window find_window(const Eigen::VectorXd& azimuth) {
  const double end = azimuth(azimuth.size() - 1);
  Window window;
  window.first_row = first_growing_row(azimuth);
  const double turns = (end - azimuth(window.first_row)) / revolution;
  window.revolutions = static_cast<int>(std::floor(turns + same_azimuth));
  if (window.revolutions < 1) {
    std::ostringstream text;
    text << "azimuth: it grows by " << turns * revolution
         << " deg until the end of the time series, harmonics need a whole revolution; hint: "
            "where the rotor stops, an earlier `until`";
    throw InputError(text.str());
  }
  const double begin = end - window.revolutions * revolution;
  while (azimuth(window.first_row) < begin + same_azimuth * revolution) ++window.first_row;
  return window;
}

/// Checks the azimuth of a periodic time series, whose first row is not repeated at its end.
void check_one_revolution(const Eigen::VectorXd& azimuth) {
  const double span = azimuth(azimuth.size() - 1) - azimuth(0);
  if (first_growing_row(azimuth) > 0 || !(span < revolution))
    throw InputError("azimuth: it must grow from row to row, by less than 360 deg in all");
}

/// Columns 1, cos psi, sin psi, cos 2 psi ... at azimuths psi [rad].
Eigen::MatrixXd fourier_columns(const Eigen::VectorXd& psi, Eigen::Index harmonics) {
  Eigen::MatrixXd columns(psi.size(), 2 * harmonics + 1);
  columns.col(0).setOnes();
  for (Eigen::Index k = 1; k <= harmonics; ++k) {
    columns.col(2 * k - 1) = (static_cast<double>(k) * psi.array()).cos();
    columns.col(2 * k) = (static_cast<double>(k) * psi.array()).sin();
  }
  return columns;
}

/// Coefficients of 1, cos, sin ..., a column for each column of `values`.
Eigen::MatrixXd fit(const Eigen::VectorXd& psi, const Eigen::VectorXd& weights,
                    const Eigen::MatrixXd& values, int harmonics) {
  const Eigen::VectorXd roots = weights.cwiseSqrt();
  const Eigen::MatrixXd columns = roots.asDiagonal() * fourier_columns(psi, harmonics);
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factors(columns.rows(), columns.cols());
  factors.setThreshold(least_pivot);
  factors.compute(columns);
  if (factors.rank() < columns.cols())
    throw InputError("azimuth: " + std::to_string(psi.size()) + " rows do not separate " +
                     std::to_string(harmonics) +
                     " harmonics; hint: more rows in a revolution, or fewer harmonics");
  return factors.solve(roots.asDiagonal() * values);
}

/// From c cos + s sin to amplitude and phase.
void take_coefficients(const Eigen::MatrixXd& coefficients, LoadHarmonics& result) {
  const Eigen::Index harmonics = coefficients.rows() / 2;
  result.amplitudes.setZero(harmonics + 1, coefficients.cols());
  result.phases.setZero(harmonics + 1, coefficients.cols());
  result.amplitudes.row(0) = coefficients.row(0);
  for (Eigen::Index c = 0; c < coefficients.cols(); ++c)
    for (Eigen::Index k = 1; k <= harmonics; ++k) {
      const double cosine = coefficients(2 * k - 1, c);
      const double sine = coefficients(2 * k, c);
      result.amplitudes(k, c) = std::hypot(cosine, sine);
      result.phases(k, c) = std::atan2(-sine, cosine);
    }
}

}  // namespace

LoadHarmonics compute_harmonics(const LoadSeries& series, const Eigen::VectorXd& azimuth_deg,
                                int harmonics) {
  check(series);
  check_azimuth(series, azimuth_deg);
  if (harmonics < 0)
    throw InputError("the number of harmonics must be >= 0, not " + std::to_string(harmonics));
  const Eigen::VectorXd azimuth = unwrap(azimuth_deg);
  Window window;
  if (!series.is_periodic())
    window = find_window(azimuth);
  else
    check_one_revolution(azimuth);
  const Eigen::Index rows = azimuth.size() - window.first_row;
  const Eigen::VectorXd used = azimuth.tail(rows);
  const Eigen::VectorXd weights = trapezoidal_weights(used, window.revolutions * revolution);
  LoadHarmonics result;
  result.revolutions = window.revolutions;
  result.first_row = window.first_row;
  take_coefficients(fit(used * degree, weights, series.values.bottomRows(rows), harmonics), result);
  return result;
}

}  // namespace samara::loads
