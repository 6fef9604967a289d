// The NREL 5 MW turbine by Ritz's method in displacements, with polynomials over the whole length
// of tower and blades: the shapes of ElastoDyn and BeamDyn, or many. Nothing of the mixed element
// is used.
#pragma once

#include <cmath>
#include <vector>

#include <Eigen/Dense>

#include "samara/math/quadrature.hpp"
#include "samara/model/turbine.hpp"

namespace samara::test {

/// Places and weights of Gauss rules between the stations of a beam.
struct Span {
  explicit Span(const model::BeamDefinition& beam) {
    const math::QuadratureRule rule = math::gauss_rule(6);
    for (std::size_t s = 1; s < beam.sections.size(); ++s) {
      const double from = beam.sections[s - 1].at;
      const double to = beam.sections[s].at;
      for (std::size_t q = 0; q < rule.points.size(); ++q) {
        at.push_back(from + (to - from) * rule.points[q]);
        length.push_back((to - from) * rule.weights[q] * beam.length);
        section.push_back(model::interpolate_section(beam, at.back()));
      }
    }
  }
  std::vector<double> at, length;
  std::vector<model::SectionDefinition> section;
};

using Polynomial = std::vector<double>;  ///< coefficients of x^0, x^1, ...

/// The derivative of order d at x.
inline double value(const Polynomial& p, double x, int d) {
  double sum = 0.0;
  for (int i = static_cast<int>(p.size()) - 1; i >= d; --i) {
    double factor = p[static_cast<std::size_t>(i)];
    for (int j = 0; j < d; ++j) factor *= i - j;
    sum = sum * x + factor;
  }
  return sum;
}

/// x^power times Legendre's polynomials of 2 x - 1, `count` of them.
inline std::vector<Polynomial> polynomials(int power, int count) {
  std::vector<Polynomial> legendre{{1.0}, {-1.0, 2.0}};
  for (int k = 1; k + 1 < count; ++k) {
    const Polynomial& last = legendre[static_cast<std::size_t>(k)];
    const Polynomial& before = legendre[static_cast<std::size_t>(k - 1)];
    Polynomial next(last.size() + 1, 0.0);
    for (std::size_t i = 0; i < last.size(); ++i) {
      next[i] -= (2.0 * k + 1.0) / (k + 1.0) * last[i];
      next[i + 1] += 2.0 * (2.0 * k + 1.0) / (k + 1.0) * last[i];
    }
    for (std::size_t i = 0; i < before.size(); ++i) next[i] -= k / (k + 1.0) * before[i];
    legendre.push_back(next);
  }
  legendre.resize(static_cast<std::size_t>(count));
  for (Polynomial& p : legendre) p.insert(p.begin(), static_cast<std::size_t>(power), 0.0);
  return legendre;
}

inline std::vector<double> hertz(const Eigen::VectorXd& squares) {
  std::vector<double> found;
  for (const double square : squares) found.push_back(std::sqrt(square) / (2.0 * pi));
  return found;
}

/// A blade that turns, its root clamped, in polynomials of one degree for displacements u2, u3 and
/// rotations t2, t3 over the whole length: Ritz's method for what BeamDyn's one element spans.
struct RitzBlade {
  Eigen::VectorXd squares;   ///< omega^2
  Eigen::VectorXd momentum;  ///< of a mode of mass 1: int m r u2 (in the plane of rotation)
  double polar = 0.0;        ///< int m r^2
  double mass = 0.0;

  /// A blade at rest that bends alone, as ElastoDyn has it: curvatures about the section's own
  /// axes, which twist, are second derivatives of `edge` and `flap`.
  RitzBlade(const model::TurbineDefinition& turbine, const std::vector<Polynomial>& edge,
            const std::vector<Polynomial>& flap) {
    constexpr int pieces = 2000;
    const double l = turbine.blades.beam.length;
    const double ds = l / pieces;
    const auto n = static_cast<Eigen::Index>(edge.size() + flap.size());
    Eigen::MatrixXd M = Eigen::MatrixXd::Zero(n, n);
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd in_plane = Eigen::VectorXd::Zero(n);
    Eigen::MatrixXd slope = Eigen::MatrixXd::Zero(2, n);
    Eigen::MatrixXd moved = Eigen::MatrixXd::Zero(2, n);
    for (int i = 0; i < pieces; ++i) {
      const double x = (i + 0.5) / pieces;
      const model::SectionDefinition section = model::interpolate_section(turbine.blades.beam, x);
      const double dm = section.mass(0, 0) * ds;
      const double r = turbine.hub.radius + x * l;
      Eigen::MatrixXd bent = Eigen::MatrixXd::Zero(2, n);  // edge, flap
      for (Eigen::Index k = 0; k < n; ++k) {
        const auto at = static_cast<std::size_t>(k);
        const bool is_edge = at < edge.size();
        bent(is_edge ? 0 : 1, k) =
            value(is_edge ? edge[at] : flap[at - edge.size()], x, 2) / (l * l);
      }
      Eigen::Matrix2d turn;
      turn << std::cos(section.twist), std::sin(section.twist), -std::sin(section.twist),
          std::cos(section.twist);
      const Eigen::DiagonalMatrix<double, 2> stiffness(section.stiffness(5, 5) * ds,
                                                       section.stiffness(4, 4) * ds);
      K += bent.transpose() * stiffness * bent;
      slope += 0.5 * ds * turn * bent;
      moved += 0.5 * ds * slope;
      M += dm * moved.transpose() * moved;
      in_plane += dm * r * moved.row(0).transpose();
      moved += 0.5 * ds * slope;
      slope += 0.5 * ds * turn * bent;
      mass += dm;
      polar += dm * r * r;
    }
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> pairs(K, M);
    squares = pairs.eigenvalues();
    momentum = pairs.eigenvectors().transpose() * in_plane;
  }

  RitzBlade(const model::TurbineDefinition& turbine, int degree, double speed) {
    const Span span(turbine.blades.beam);
    const double l = turbine.blades.beam.length;
    const std::vector<Polynomial> shapes = polynomials(1, degree);
    const int n = degree;
    Eigen::MatrixXd M = Eigen::MatrixXd::Zero(4 * n, 4 * n);
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(4 * n, 4 * n);
    Eigen::VectorXd in_plane = Eigen::VectorXd::Zero(4 * n);
    double tension = 0.0;  // summed from the tip
    for (std::size_t q = span.at.size(); q-- > 0;) {
      const model::SectionDefinition& section = span.section[q];
      const double r = turbine.hub.radius + span.at[q] * l;
      const double line_mass = section.mass(0, 0);
      const double dm = line_mass * span.length[q];
      mass += dm;
      polar += dm * r * r;
      tension += 0.5 * dm * r * speed * speed;
      // Rows: u2, u3, t2, t3 and derivatives.
      Eigen::MatrixXd f = Eigen::MatrixXd::Zero(4, 4 * n);
      Eigen::MatrixXd f1 = Eigen::MatrixXd::Zero(4, 4 * n);
      for (int k = 0; k < n; ++k)
        for (int c = 0; c < 4; ++c) {
          f(c, c * n + k) = value(shapes[static_cast<std::size_t>(k)], span.at[q], 0);
          f1(c, c * n + k) = value(shapes[static_cast<std::size_t>(k)], span.at[q], 1) / l;
        }
      // The section's axes are turned by the twist about -b1.
      Eigen::Matrix2d turn;
      turn << std::cos(section.twist), -std::sin(section.twist), std::sin(section.twist),
          std::cos(section.twist);
      Eigen::MatrixXd shear(2, 4 * n);
      shear << f1.row(0) - f.row(3), f1.row(1) + f.row(2);
      const auto add = [&](Eigen::MatrixXd& to, const Eigen::MatrixXd& rows, double first,
                           double second) {
        const Eigen::DiagonalMatrix<double, 2> weight(first * span.length[q],
                                                      second * span.length[q]);
        to += rows.transpose() * weight * rows;
      };
      add(K, turn * shear, section.stiffness(1, 1), section.stiffness(2, 2));
      add(K, turn * f1.bottomRows(2), section.stiffness(4, 4), section.stiffness(5, 5));
      add(K, f1.topRows(2), tension, tension);
      add(K, f.topRows(2), -line_mass * speed * speed, 0.0);
      add(M, f.topRows(2), line_mass, line_mass);
      add(M, turn * f.bottomRows(2), section.mass(4, 4), section.mass(5, 5));
      in_plane += dm * r * f.row(0).transpose();
      tension += 0.5 * dm * r * speed * speed;
    }
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> pairs(K, M);
    squares = pairs.eigenvalues();
    momentum = pairs.eigenvectors().transpose() * in_plane;
  }
};

/// Bodies on the tower top as they turn about one horizontal axis.
struct Top {
  double mass = 0.0, height = 0.0, side = 0.0, inertia = 0.0;  ///< inertia about the tower top

  void add(double m, double up, double aside, double own) {
    height = (height * mass + up * m) / (mass + m);
    side = (side * mass + aside * m) / (mass + m);
    mass += m;
    inertia += own + m * (up * up + aside * aside);
  }
};

/// ElastoDyn's tower shapes of the 5 MW turbine (its deck; x^2 to x^6): two fore-aft, two
/// side-side.
inline std::vector<Polynomial> fore_aft_shapes() {
  return {{0.0, 0.0, 0.7004, 2.1963, -5.6202, 6.2275, -2.504},
          {0.0, 0.0, -70.5319, -63.7623, 289.737, -176.513, 22.0706}};
}
inline std::vector<Polynomial> side_side_shapes() {
  return {{0.0, 0.0, 1.385, -1.7684, 3.0871, -2.2395, 0.5357},
          {0.0, 0.0, -121.21, 184.415, -224.904, 298.536, -135.838}};
}

/// The tower in given shapes with what stands on it, by Ritz, weight included. `blade` adds the
/// lowest `blade_modes` collective modes of three blades, whose edgewise part turns against the
/// roll, and `shaft` [N m/rad] a shaft that twists behind a generator that does not turn.
inline std::vector<double> tower_frequencies(const model::TurbineDefinition& turbine,
                                             const std::vector<Polynomial>& shapes, Top top,
                                             const RitzBlade* blade, Eigen::Index blade_modes = 3,
                                             double shaft = 0.0) {
  const Span span(turbine.tower);
  const double h = turbine.tower.length;
  const double g = turbine.gravity;
  const auto n = static_cast<Eigen::Index>(shapes.size());
  const Eigen::Index of_blade = blade != nullptr ? blade_modes : 0;
  const Eigen::Index of_shaft = shaft > 0.0 ? 1 : 0;
  const auto row = [&](double x, int d) {
    Eigen::VectorXd v(n);
    for (Eigen::Index i = 0; i < n; ++i)
      v(i) = value(shapes[static_cast<std::size_t>(i)], x, d) / std::pow(h, d);
    return v;
  };
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(n + of_blade + of_shaft, n + of_blade + of_shaft);
  Eigen::MatrixXd K = M;
  const auto add = [n](Eigen::MatrixXd& to, double weight, const Eigen::VectorXd& v) {
    to.topLeftCorner(n, n) += weight * v * v.transpose();
  };
  double above = top.mass;
  for (std::size_t q = span.at.size(); q-- > 0;) {
    const double dm = span.section[q].mass(0, 0) * span.length[q];
    above += 0.5 * dm;
    add(M, dm, row(span.at[q], 0));
    add(K, span.section[q].stiffness(4, 4) * span.length[q], row(span.at[q], 2));
    add(K, -above * g * span.length[q], row(span.at[q], 1));
    above += 0.5 * dm;
  }
  const Eigen::VectorXd moves = row(1.0, 0);
  const Eigen::VectorXd turns = row(1.0, 1);
  add(M, top.mass, moves + top.height * turns);
  add(M, top.inertia - top.mass * top.height * top.height, turns);
  add(K, -top.mass * g * top.height, turns);
  for (Eigen::Index k = 0; k < of_blade; ++k) {
    M(n + k, n + k) = 3.0;
    K(n + k, n + k) = 3.0 * blade->squares(k);
    M.block(0, n + k, n, 1) = 3.0 * blade->momentum(k) * turns;
    M.block(n + k, 0, 1, n) = 3.0 * blade->momentum(k) * turns.transpose();
  }
  if (of_shaft > 0) {
    const Eigen::Index q = n + of_blade;
    const double rotor = turbine.hub.inertia.y() + 3.0 * blade->polar;
    M(q, q) = rotor;
    K(q, q) = shaft;
    M.col(q).head(n) = rotor * turns;
    M.col(q).segment(n, of_blade) = 3.0 * blade->momentum.head(of_blade);
    M.row(q) = M.col(q).transpose();
  }
  return hertz(Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(K, M).eigenvalues());
}

/// Nacelle, hub and rigid blades, about the lateral axis (fore-aft motion) or the downwind one.
inline Top top_of(const model::TurbineDefinition& turbine, bool fore_aft, const RitzBlade* blade) {
  const double up = turbine.shaft.height + turbine.shaft.overhang * std::sin(turbine.shaft.tilt);
  const double back = turbine.shaft.overhang * std::cos(turbine.shaft.tilt);
  const model::NacelleDefinition& nacelle = turbine.nacelle;
  Top top;
  top.add(nacelle.mass, nacelle.center_of_mass.z(), fore_aft ? nacelle.center_of_mass.y() : 0.0,
          0.0);
  top.add(turbine.hub.mass, up, fore_aft ? back : 0.0, fore_aft ? 0.0 : turbine.hub.inertia.y());
  if (blade != nullptr)
    top.add(3.0 * blade->mass, up, fore_aft ? back : 0.0, (fore_aft ? 1.5 : 3.0) * blade->polar);
  return top;
}

}  // namespace samara::test
