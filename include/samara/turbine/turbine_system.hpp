// The turbine as a periodic system. It assembles beams and rigid bodies into Vec and Mat.
#pragma once

#include <memory>

#include "samara/model/turbine.hpp"
#include "samara/system/periodic_system.hpp"
#include "samara/turbine/turbine_equations.hpp"

namespace samara::turbine {

class TurbineSystem final : public system::PeriodicSystem {
 public:
  /// Assembles on any communicator. Each rank has a copy of the turbine and writes its own rows.
  /// `at_least`: the tangents include its blocks; null: no further blocks.
  TurbineSystem(const model::Turbine& turbine, MPI_Comm comm,
                const components::TangentPlan* at_least = nullptr);
  ~TurbineSystem() override;

  const model::Turbine& turbine() const;
  const turbine::TurbineLayout& layout() const;
  /// The equations behind residual(), also for complex states.
  const TurbineEquations& equations() const;

  MPI_Comm comm() const override;
  PetscInt size() const override;
  double period() const override;
  const std::vector<system::Unknown>& unknowns() const override;
  const std::vector<system::RowRole>& rows() const override;
  const std::vector<bool>& differential() const override;
  bool constraints_are_autonomous() const override;
  bool is_conservative() const override;
  const system::RotorSymmetry& symmetry() const override;
  const std::vector<system::EnergyGroup>& energy_groups() const override;
  const std::vector<system::UnconstrainedCoordinate>& unconstrained_coordinates() const override;
  std::vector<system::UnconstrainedCoordinate> free_coordinates() const override;
  std::vector<system::Motion> motions() const override;
  std::unique_ptr<system::MotionEnergies> motion_energies(double t, Vec steady) const override;
  std::vector<system::MeshError> mesh_errors() const override;
  void reference_state(double t, Vec z) const override;
  void settle(double t, Vec z) const override;
  void require_admissible(double t, Vec z) const override;
  petsc::Handle<Vec> make_state() const override;
  petsc::Handle<Mat> make_jacobian() const override;
  petsc::Handle<Mat> make_mass() const override;
  std::vector<std::vector<PetscInt>> pattern() const override;
  std::unique_ptr<system::PeriodicSystem> unloaded() const override;
  std::vector<PetscInt> common_unknowns() const override;
  std::unique_ptr<system::PeriodicSystem> part_of(int rank,
                                                  const std::vector<int>& owners) const override;
  /// Gives large rotations of the blades a new reference; the rotation of the tower top stays below
  /// 170 degrees.
  std::unique_ptr<system::PeriodicSystem> counted_from(Vec z) const override;
  void count_from_undeformed(Vec z) const override;
  void residual(double t, Vec z, Vec z_dot, Vec r) const override;
  void tangents(double t, Vec z, Vec z_dot, double shift, Mat jacobian, Mat mass) const override;

 private:
  class Assembly;
  explicit TurbineSystem(std::unique_ptr<Assembly> assembly);

  std::unique_ptr<Assembly> assembly_;
};

}  // namespace samara::turbine
