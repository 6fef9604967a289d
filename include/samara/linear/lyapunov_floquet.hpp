// A periodic state-space form in Lyapunov-Floquet coordinates, in which A is constant
// (docs/theory.md, section 10.6; S. C. Sinha, R. Pandiyan and J. S. Bibb, ASME J. Vib. Acoust. 118
// (1996), 209-219):
//     x = P(psi) q,  q = Q(psi) x,  q_dot = Lambda q + Q B u,  y = C P q + D u.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "samara/linear/azimuth_series.hpp"

namespace samara::linear {

class LyapunovFloquet {
 public:
  /// Integrates over a revolution in at least `steps` steps, through `azimuths` equally spaced
  /// azimuths; at these the forms below need no further integration. Half as many steps give the
  /// error. The coordinates are those of the slowest resolved modes, at most `states`; 0: all.
  /// `series` must outlive this object. The last `first_order` of its states are xi, the others eta
  /// and its rate.
  /// @throws InputError where there are no such coordinates, or fewer than `states`
  LyapunovFloquet(const AzimuthSeries& series, double rotor_speed, int azimuths, int states,
                  int steps = default_steps, int first_order = 0);

  static constexpr int default_steps = 512;

  const std::vector<ModelState>& states() const { return states_; }
  /// Reason why states are missing; empty where none is, or where as many as requested are there.
  const std::string& remark() const { return remark_; }
  /// {Lambda, Q B, C P, D with the static response of the modes that are left out}.
  StateSpace form(double psi) const { return form(psi, transformation(psi)); }
  /// {Lambda, Q, P, none}: inputs and outputs are x.
  StateSpace transformation(double psi) const;
  /// The same where the transformation is known already.
  StateSpace form(double psi, const StateSpace& map) const;

 private:
  /// A mode, or several whose multipliers cannot be separated, with coordinates s:
  /// V(t) = Phi(t) V(0) exp(-exponent t), W V = 1.
  struct Block {
    enum class Kind {
      pair,      ///< with its conjugate: x = 2 Re(V s)
      positive,  ///< real: x = V s
      negative,  ///< of negative multipliers: x = Re(V s), s = exp(i psi/2) times real numbers
    };
    Kind kind = Kind::pair;
    Eigen::MatrixXcd exponent;
    std::vector<Eigen::MatrixXcd> V;  ///< at the ends of the intervals, columns
    std::vector<Eigen::MatrixXcd> W;  ///< at the ends of the intervals, rows
    double error = 0.0;               ///< relative, of the exponent, due to the step

    double modulus() const;
    int states() const;
  };
  struct Frame {
    Eigen::MatrixXd P, Q;
  };

  Eigen::MatrixXd propagate(double from, double to, int steps) const;
  Eigen::MatrixXd unscaled(const Eigen::MatrixXd& phi) const;
  void find_blocks(const Eigen::MatrixXd& monodromy, const Eigen::MatrixXd& coarse);
  void follow(Block& block) const;
  void choose_branch(Block& block) const;
  void choose_scale(Block& block) const;
  void select(int states);
  void name_states();
  Frame frame_at(double psi) const;
  void orthogonalize(const std::vector<Eigen::MatrixXcd>& V,
                     std::vector<Eigen::MatrixXcd>& W) const;

  const AzimuthSeries& series_;
  double speed_;
  int intervals_;
  int steps_;                                 ///< in an interval
  Eigen::Index positions_;                    ///< entries of eta
  Eigen::VectorXd scale_;                     ///< x over the integrated states
  std::vector<Eigen::MatrixXd> propagators_;  ///< over the intervals
  std::vector<Block> blocks_;
  Eigen::MatrixXd exponents_;  ///< Lambda
  std::vector<ModelState> states_;
  std::string remark_;
};

}  // namespace samara::linear
