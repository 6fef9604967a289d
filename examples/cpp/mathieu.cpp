// Mathieu's equation x'' + 2 zeta x' + (a - 2 q cos 2t) x = 0 as a user-defined periodic system:
// Floquet exponents without a turbine.
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include <samara/analysis/floquet.hpp>
#include <samara/analysis/trim.hpp>
#include <samara/petsc/session.hpp>

using namespace samara;

namespace {

class Mathieu final : public system::PeriodicSystem {
 public:
  Mathieu(double a, double q, double zeta) : a_(a), q_(q), zeta_(zeta) {
    using system::RowRole;
    using system::UnknownRole;
    const system::Owner owner(system::PartKind::body, "pendulum");
    unknowns_ = {{owner, "", "x", "m", UnknownRole::position},
                 {owner, "", "v", "m/s", UnknownRole::velocity}};
    rows_ = {RowRole::kinematic, RowRole::balance};
    symmetry_.source = {0, 1};
    symmetry_.sign = {1.0, 1.0};
    energies_ = {{system::EnergyGroup::Kind::kinetic, owner, "", system::Frame::fixed, {1}, {1.0}}};
  }

  MPI_Comm comm() const override { return PETSC_COMM_SELF; }
  PetscInt size() const override { return 2; }
  double period() const override { return std::numbers::pi; }
  const std::vector<system::Unknown>& unknowns() const override { return unknowns_; }
  const std::vector<system::RowRole>& rows() const override { return rows_; }
  const std::vector<bool>& differential() const override { return differential_; }
  bool constraints_are_autonomous() const override { return true; }
  const system::RotorSymmetry& symmetry() const override { return symmetry_; }
  const std::vector<system::EnergyGroup>& energy_groups() const override { return energies_; }
  const std::vector<system::UnconstrainedCoordinate>& unconstrained_coordinates() const override {
    return unconstrained_;
  }
  void reference_state(double, Vec z) const override { petsc::check(VecSet(z, 0.0)); }
  petsc::Handle<Vec> make_state() const override {
    return petsc::make_vector(PETSC_COMM_SELF, 2, 2);
  }
  petsc::Handle<Mat> make_jacobian() const override { return make_matrix(); }
  petsc::Handle<Mat> make_mass() const override { return make_matrix(); }

  void residual(double t, Vec z, Vec z_dot, Vec r) const override {
    const petsc::ReadView x(z);
    const petsc::ReadView x_dot(z_dot);
    const petsc::WriteView row(r);
    row[0] = x[1] - x_dot[0];
    row[1] = x_dot[1] + 2.0 * zeta_ * x[1] + stiffness(t) * x[0];
  }

  void tangents(double t, Vec, Vec, double shift, Mat jacobian, Mat mass) const override {
    const double K[2][2] = {{0.0, 1.0}, {stiffness(t), 2.0 * zeta_}};
    const double M[2][2] = {{-1.0, 0.0}, {0.0, 1.0}};
    const auto put = [](Mat matrix, const auto& value) {
      petsc::check(MatZeroEntries(matrix));
      for (PetscInt i = 0; i < 2; ++i)
        for (PetscInt j = 0; j < 2; ++j)
          petsc::check(MatSetValue(matrix, i, j, value(i, j), INSERT_VALUES));
      petsc::check(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
      petsc::check(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
    };
    put(jacobian, [&](PetscInt i, PetscInt j) { return K[i][j] + shift * M[i][j]; });
    if (mass != nullptr) put(mass, [&](PetscInt i, PetscInt j) { return M[i][j]; });
  }

 private:
  double stiffness(double t) const { return a_ - 2.0 * q_ * std::cos(2.0 * t); }
  static petsc::Handle<Mat> make_matrix() {
    petsc::Handle<Mat> matrix;
    petsc::check(MatCreateSeqAIJ(PETSC_COMM_SELF, 2, 2, 2, nullptr, matrix.fill()));
    return matrix;
  }

  double a_;
  double q_;
  double zeta_;
  std::vector<system::Unknown> unknowns_;
  std::vector<system::RowRole> rows_;
  std::vector<bool> differential_{true, true};
  system::RotorSymmetry symmetry_;
  std::vector<system::EnergyGroup> energies_;
  std::vector<system::UnconstrainedCoordinate> unconstrained_;
};

}  // namespace

int main() {
  const petsc::Session session({});
  analysis::Observer silent;
  for (const double q : {0.1, 0.5}) {
    const Mathieu system(1.0, q, 0.05);  // a = 1: the first region of instability
    const analysis::Trim trim = analysis::find_trim(system, {}, silent);
    analysis::FloquetOptions options;
    options.steps = 200;
    const analysis::Floquet floquet =
        analysis::find_floquet_modes(system, trim.solution, options, PETSC_COMM_SELF, silent);
    for (const analysis::Mode& mode : floquet.set.modes)
      std::printf("q = %.1f: multiplier %+.6f %+.6fi, growth %+.6f 1/s\n", q,
                  mode.multiplier.real(), mode.multiplier.imag(), mode.exponent.real());
  }
  return 0;
}
