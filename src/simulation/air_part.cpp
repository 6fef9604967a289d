#include "samara/simulation/air_part.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include <Eigen/QR>

#include "samara/math/rotation.hpp"

namespace samara::simulation {
namespace {

using analysis::Mode;
using analysis::ModeSet;
using Complex = std::complex<double>;
using Eigen::Index;
using Report = components::AirPointReport<Complex>;

/// Least likeness of two shapes of the same mode.
constexpr double least_likeness = 0.5;

bool oscillates(const ModeSet& set, std::size_t m) {
  const Mode& mode = set.modes[m];
  return mode.resolved && !is_of_medium(mode) && set.shapes[m].size() > 0 &&
         std::abs(mode.exponent.imag()) > analysis::zero_exponent * std::max(set.rotor_speed, 1.0);
}

/// The scaled positions of a shape.
Eigen::MatrixXcd positions_of(const turbine::TurbineSystem& system, const Eigen::MatrixXcd& shape) {
  std::vector<Index> rows;
  for (std::size_t i = 0; i < system.unknowns().size(); ++i)
    if (system.unknowns()[i].role == system::UnknownRole::position)
      rows.push_back(static_cast<Index>(i));
  return shape(rows, Eigen::all);
}

/// Both exponents are known up to multiples of the rotor speed, and the air changes frequencies:
/// the largest likeness of the shapes for multiples near the difference of both frequencies.
double likeness_of(const ModeSet& set, const Mode& mode, const Eigen::MatrixXcd& shape,
                   const Mode& other, const Eigen::MatrixXcd& other_shape) {
  constexpr int nearby = 2;
  const double scale = shape.squaredNorm() * other_shape.squaredNorm();
  const Eigen::RowVectorXcd products = shape.conjugate().cwiseProduct(other_shape).colwise().sum();
  if (set.rotor_speed == 0.0) return std::norm(products.sum()) / scale;
  const double apart = other.exponent.imag() - mode.exponent.imag();
  double likeness = 0.0;
  for (int k = -nearby; k <= nearby; ++k) {
    const double turning = (std::round(apart / set.rotor_speed) + k) * set.rotor_speed;
    Complex sum(0.0);
    for (Index n = 0; n < products.size(); ++n)
      sum += products(n) * std::polar(1.0, turning * set.shape_times[static_cast<std::size_t>(n)]);
    likeness = std::max(likeness, std::norm(sum) / scale);
  }
  return likeness;
}

/// Place, turning, force and moment of a station in axes of the steady hub.
struct Change {
  Eigen::Vector3cd place, turning, force, moment;
};

/// Changes of all stations by a shape at an instant, per unit of the shape.
class Changes {
 public:
  Changes(const turbine::TurbineSystem& system, const analysis::PeriodicSolution& steady, double t)
      : system_(system), t_(t) {
    const petsc::Handle<Vec> z = system.make_state();
    const petsc::Handle<Vec> z_dot = system.make_state();
    steady.evaluate(t, z.get(), z_dot.get());
    z_ = petsc::values_of(z.get());
    z_dot_ = petsc::values_of(z_dot.get());
    const auto reports = system.equations().air_report<double>(t, z_, z_dot_, {});
    axes_ = reports.front().front().hub_axes.transpose();
  }

  std::vector<Change> of(const Eigen::VectorXcd& shape) const {
    std::vector<Change> changes;
    const auto real = reports_of(shape.real());
    const auto imaginary = reports_of(shape.imag());
    for (std::size_t k = 0; k < real.size(); ++k)
      for (std::size_t p = 0; p < real[k].size(); ++p) {
        const auto pick = [&](auto part) -> Eigen::Vector3cd {
          const Vector3 re = part(real[k][p]);
          const Vector3 im = part(imaginary[k][p]);
          return axes_.cast<Complex>() *
                 (re.cast<Complex>() + Complex(0.0, 1.0) * im.cast<Complex>());
        };
        changes.push_back({pick([](const Report& r) { return derivative(r.place); }),
                           pick([](const Report& r) { return turning_of(r); }),
                           pick([](const Report& r) { return derivative(r.force); }),
                           pick([](const Report& r) { return derivative(r.couple); })});
      }
    return changes;
  }

 private:
  static constexpr double tiny = 1e-30;  // a complex step

  static Vector3 derivative(const Vec3<Complex>& value) {
    return Vector3(value(0).imag(), value(1).imag(), value(2).imag()) / tiny;
  }
  /// w of de = w x e, from three orthonormal vectors e: half the sum of e x de.
  static Vector3 turning_of(const Report& report) {
    Vector3 sum = Vector3::Zero();
    for (int i = 0; i < 3; ++i) {
      const Vec3<Complex> e = report.section_axes.col(i);
      const Vector3 plain(e(0).real(), e(1).real(), e(2).real());
      sum += math::cross(plain, derivative(e));
    }
    return 0.5 * sum;
  }

  std::vector<std::vector<Report>> reports_of(const Eigen::VectorXd& direction) const {
    std::vector<Complex> z(z_.begin(), z_.end());
    const std::vector<Complex> z_dot(z_dot_.begin(), z_dot_.end());
    for (std::size_t i = 0; i < z.size(); ++i)
      z[i] += Complex(0.0, tiny * direction(static_cast<Index>(i)));
    return system_.equations().air_report<Complex>(t_, z, z_dot, {});
  }

  const turbine::TurbineSystem& system_;
  double t_;
  std::vector<double> z_;
  std::vector<double> z_dot_;
  Matrix3 axes_;
};

/// exp(i h Omega t) of the harmonics from -most to most, instants x harmonics.
Eigen::MatrixXcd harmonics_at(const std::vector<double>& times, Index most, double speed) {
  Eigen::MatrixXcd series(static_cast<Index>(times.size()), 2 * most + 1);
  for (Index k = 0; k < series.rows(); ++k)
    for (Index h = -most; h <= most; ++h)
      series(k, h + most) =
          std::polar(1.0, static_cast<double>(h) * speed * times[static_cast<std::size_t>(k)]);
  return series;
}

Eigen::MatrixXcd pseudo_inverse(const Eigen::MatrixXcd& matrix) {
  return matrix.completeOrthogonalDecomposition().pseudoInverse();
}

/// Rate of a periodic vector times exp(lambda t), divided by exp(lambda t): lambda q + q_dot, with
/// q_dot of the Fourier series through the instants.
Eigen::MatrixXcd rates_of(const Eigen::MatrixXcd& q, Complex exponent,
                          const std::vector<double>& times, double speed) {
  if (q.cols() == 1) return exponent * q;
  const Index most = (q.cols() - 1) / 2;
  const Eigen::MatrixXcd series = harmonics_at(times, most, speed);
  Eigen::MatrixXcd rates = series;
  for (Index h = -most; h <= most; ++h)
    rates.col(h + most) *= Complex(0.0, static_cast<double>(h) * speed);
  return exponent * q + q * (rates * pseudo_inverse(series)).transpose();
}

/// Matrix that maps the values of a periodic vector at instants to those at others, by the Fourier
/// series through the former.
Eigen::MatrixXcd interpolation(const std::vector<double>& from, const std::vector<double>& to,
                               double speed) {
  const Index most = (static_cast<Index>(from.size()) - 1) / 2;
  return (harmonics_at(to, most, speed) * pseudo_inverse(harmonics_at(from, most, speed)))
      .transpose();
}

}  // namespace

double AirPart::whole_work(std::size_t mode) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < lengths.size(); ++i)
    sum += work(static_cast<Index>(mode), static_cast<Index>(i)) * lengths[i];
  return sum;
}

analysis::FloquetOptions options_of_held_air(const ModeSet& modes,
                                             const analysis::FloquetOptions& options) {
  analysis::FloquetOptions of_held = options;
  if (modes.searched && modes.searched->is_of_all) {
    of_held.modes = of_held.least_damped = 0;
    of_held.near_hz.reset();
  }
  return of_held;
}

AirPart find_air_part(const turbine::TurbineSystem& system,
                      const analysis::PeriodicSolution& steady, const ModeSet& modes,
                      const ModeSet& held) {
  AirPart part;
  const model::Turbine& turbine = system.turbine();
  for (const model::Beam& blade : turbine.blades)
    for (int p = 0; p < blade.point_count(); ++p) part.lengths.push_back(blade.point_length(p));
  part.held_damping.assign(modes.modes.size(), std::numeric_limits<double>::quiet_NaN());
  part.likeness.assign(modes.modes.size(), 0.0);
  part.work = Eigen::MatrixXd::Zero(static_cast<Index>(modes.modes.size()),
                                    static_cast<Index>(part.lengths.size()));
  std::vector<Eigen::MatrixXcd> others;
  for (std::size_t k = 0; k < held.modes.size(); ++k)
    others.push_back(oscillates(held, k) ? positions_of(system, held.shapes[k])
                                         : Eigen::MatrixXcd());
  if (held.shape_times != modes.shape_times) {  // other steps, or other harmonics
    const Eigen::MatrixXcd map =
        interpolation(held.shape_times, modes.shape_times, modes.rotor_speed);
    for (Eigen::MatrixXcd& other : others)
      if (other.size() > 0) other = (other * map).eval();
  }
  std::vector<Changes> instants;
  for (const double t : modes.shape_times) instants.emplace_back(system, steady, t);
  for (std::size_t m = 0; m < modes.modes.size(); ++m) {
    if (!oscillates(modes, m)) continue;
    const Mode& mode = modes.modes[m];
    const Eigen::MatrixXcd shape = positions_of(system, modes.shapes[m]);
    for (std::size_t k = 0; k < others.size(); ++k) {
      if (others[k].size() == 0) continue;
      const double likeness = likeness_of(modes, mode, shape, held.modes[k], others[k]);
      if (likeness < least_likeness || likeness <= part.likeness[m]) continue;
      part.likeness[m] = likeness;
      part.held_damping[m] = held.modes[k].damping_ratio;
    }
    const auto n = static_cast<Index>(instants.size());
    const auto stations = static_cast<Index>(part.lengths.size());
    Eigen::MatrixXcd motion(6 * stations, n);
    Eigen::MatrixXcd load(6 * stations, n);
    for (Index k = 0; k < n; ++k) {
      const std::vector<Change> changes =
          instants[static_cast<std::size_t>(k)].of(modes.shapes[m].col(k));
      for (Index s = 0; s < stations; ++s) {
        const Change& change = changes[static_cast<std::size_t>(s)];
        motion.col(k).segment<3>(6 * s) = change.place;
        motion.col(k).segment<3>(6 * s + 3) = change.turning;
        load.col(k).segment<3>(6 * s) = change.force;
        load.col(k).segment<3>(6 * s + 3) = change.moment;
      }
    }
    const Eigen::MatrixXcd rate =
        rates_of(motion, mode.exponent, modes.shape_times, modes.rotor_speed);
    const double cycle = 2.0 * std::numbers::pi / std::abs(mode.exponent.imag());
    for (Index s = 0; s < stations; ++s) {
      const Complex power =
          load.middleRows(6 * s, 6).conjugate().cwiseProduct(rate.middleRows(6 * s, 6)).sum();
      part.work(static_cast<Index>(m), s) = 0.5 * power.real() / static_cast<double>(n) * cycle;
    }
  }
  return part;
}

}  // namespace samara::simulation
