#include "samara/turbine/turbine_system.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>

#include "samara/components/portion.hpp"

#include "turbine_motions.hpp"

namespace samara::turbine {
namespace {

constexpr int block = TurbineLayout::block;

/// |theta| from which rotations get a new reference: 120 degrees. The result of a coarse mesh
/// depends slightly on the reference, therefore it changes only where necessary.
constexpr double large_rotation = 3.4641016151377544;

}  // namespace

class TurbineSystem::Assembly {
 public:
  /// `of_portion`: terms that count; null: all.
  Assembly(std::shared_ptr<const TurbineEquations> all, MPI_Comm communicator,
           std::shared_ptr<const components::Portion> of_portion)
      : shared_equations(std::move(all)),
        equations(*shared_equations),
        turbine(equations.turbine()),
        layout(equations.layout()),
        comm(communicator),
        portion(std::move(of_portion)),
        own_plan(portion ? equations.find_plan(*portion) : equations.plan()),
        plan(*own_plan) {
    find_range();
    find_differential();
  }

  struct Workspace {
    components::Tangents tangents;
    std::vector<std::size_t> mass_offsets;  ///< positions in M's blocks of its entries, row by row
  };

  std::shared_ptr<const TurbineEquations> shared_equations;
  const TurbineEquations& equations;
  const model::Turbine& turbine;
  const TurbineLayout& layout;
  MPI_Comm comm;
  std::shared_ptr<const components::Portion> portion;
  std::shared_ptr<const components::TangentPlan> own_plan;
  const components::TangentPlan& plan;
  std::vector<bool> differential;
  PetscInt first_row = 0;
  PetscInt last_row = 0;
  mutable std::optional<Workspace> made_workspace;
  mutable petsc::Handle<VecScatter> gather;
  mutable petsc::Handle<Vec> whole;
  /// State, rates and residual of an evaluation: kept, since new ones cost more than their values.
  mutable std::vector<double> state;
  mutable std::vector<double> rates;
  mutable std::vector<double> rows;

  /// Made at the first use: its memory is large.
  Workspace& workspace() const {
    if (made_workspace) return *made_workspace;
    made_workspace.emplace(Workspace{components::Tangents(own_plan), {}});
    for (int row = 0; row < layout.size(); ++row)
      for (const int column : plan.M[static_cast<std::size_t>(row)])
        made_workspace->mass_offsets.push_back(made_workspace->tangents.M().place(row, column));
    return *made_workspace;
  }

  bool parallel() const {
    int ranks = 1;
    MPI_Comm_size(comm, &ranks);
    return ranks > 1;
  }

  // ---- the state -----------------------------------------------------------------------------

  /// The whole vector, gathered from all ranks.
  std::vector<double> gathered(Vec z) const {
    std::vector<double> values;
    take(z, values);
    return values;
  }
  void take(Vec z, std::vector<double>& values) const {
    values.resize(static_cast<std::size_t>(layout.size()));
    if (!parallel()) {
      const petsc::ReadView view(z);
      std::copy(view.data(), view.data() + layout.size(), values.begin());
      return;
    }
    if (!gather) petsc::check(VecScatterCreateToAll(z, gather.fill(), whole.fill()));
    petsc::check(VecScatterBegin(gather.get(), z, whole.get(), INSERT_VALUES, SCATTER_FORWARD));
    petsc::check(VecScatterEnd(gather.get(), z, whole.get(), INSERT_VALUES, SCATTER_FORWARD));
    const petsc::ReadView view(whole.get());
    std::copy(view.data(), view.data() + layout.size(), values.begin());
  }

  /// Sets the rotations of the undeformed state.
  void undo_references(std::vector<double>& values) const {
    const auto put = [&values](int first, const Matrix3& reference) {
      Eigen::Map<Vector3>(values.data() + first + 3) = math::parameters_of(reference.transpose());
    };
    for (const components::PlacedBeam& placed : equations.beams()) {
      if (placed.find_changes().empty()) continue;
      const model::Beam& beam = *placed.beam;
      for (int p = 0; p < beam.point_count(); ++p)
        put(placed.points[static_cast<std::size_t>(p)], beam.reference(p / beam.order));
      for (std::size_t m = 0; m < placed.masses.size(); ++m)
        put(placed.masses[m], beam.reference_before(beam.mass_nodes[m].end));
      put(placed.tip, beam.reference(beam.elements - 1));
    }
  }

  /// Writes the own part of a state. Its rotations count as in `target`, or from the undeformed
  /// state if that is null.
  void recount(std::vector<double> values, const TurbineEquations* target, Vec z) const {
    const auto rewrite = [&values](int first, const Matrix3& from, const Matrix3& to) {
      if (from == to) return;
      const Eigen::Map<Vector3> theta(values.data() + first + 3);
      const Matrix3 attitude = math::direction_cosines<double>(theta).transpose() * from;
      Eigen::Map<Vector3>(values.data() + first + 3) =
          math::parameters_of(attitude * to.transpose());
    };
    for (std::size_t b = 0; b < equations.beams().size(); ++b) {
      const components::PlacedBeam& placed = equations.beams()[b];
      const model::Beam& beam = *placed.beam;
      const auto to = [&](int e) -> Matrix3 {
        return target == nullptr ? Matrix3(Matrix3::Identity())
                                 : target->beams()[b].beam->reference(e);
      };
      for (int p = 0; p < beam.point_count(); ++p) {
        const int e = p / beam.order;
        rewrite(placed.points[static_cast<std::size_t>(p)], beam.reference(e), to(e));
      }
      for (std::size_t m = 0; m < placed.masses.size(); ++m) {
        const int e = beam.mass_nodes[m].end - 1;
        if (e >= 0) rewrite(placed.masses[m], beam.reference(e), to(e));
      }
      rewrite(placed.tip, beam.reference(beam.elements - 1), to(beam.elements - 1));
    }
    write_own(values, z);
  }

  void write_own(const std::vector<double>& values, Vec z) const {
    const petsc::WriteView view(z);
    for (PetscInt i = first_row; i < last_row; ++i)
      view[i - first_row] = values[static_cast<std::size_t>(i)];
  }

 private:
  void find_range() {
    const petsc::Handle<Vec> z = vector();
    petsc::check(VecGetOwnershipRange(z.get(), &first_row, &last_row));
  }

  /// Also of a part, whose plan has its own rows only.
  void find_differential() {
    differential.assign(static_cast<std::size_t>(layout.size()), false);
    for (const std::vector<int>& columns : equations.plan()->M)
      for (const int column : columns) differential[static_cast<std::size_t>(column)] = true;
  }

 public:
  petsc::Handle<Vec> vector() const {
    int ranks = 1;
    int rank = 0;
    MPI_Comm_size(comm, &ranks);
    MPI_Comm_rank(comm, &rank);
    const int blocks = layout.blocks();
    const int own = blocks / ranks + (rank < blocks % ranks ? 1 : 0);
    return petsc::make_vector(comm, own * block, layout.size());
  }
};

TurbineSystem::TurbineSystem(const model::Turbine& turbine, MPI_Comm comm,
                             const components::TangentPlan* at_least)
    : assembly_(std::make_unique<Assembly>(
          std::make_shared<const TurbineEquations>(turbine, at_least), comm, nullptr)) {}

TurbineSystem::TurbineSystem(std::unique_ptr<Assembly> assembly) : assembly_(std::move(assembly)) {}

TurbineSystem::~TurbineSystem() = default;

const model::Turbine& TurbineSystem::turbine() const { return assembly_->turbine; }
const TurbineLayout& TurbineSystem::layout() const { return assembly_->layout; }
const TurbineEquations& TurbineSystem::equations() const { return assembly_->equations; }
MPI_Comm TurbineSystem::comm() const { return assembly_->comm; }
PetscInt TurbineSystem::size() const { return assembly_->layout.size(); }

double TurbineSystem::period() const {
  const double speed = assembly_->turbine.speed;
  return speed > 0.0 ? 2.0 * std::numbers::pi / speed : 0.0;
}

const std::vector<system::Unknown>& TurbineSystem::unknowns() const {
  return assembly_->equations.declarations().unknowns;
}
const std::vector<system::RowRole>& TurbineSystem::rows() const {
  return assembly_->equations.declarations().rows;
}
const std::vector<bool>& TurbineSystem::differential() const { return assembly_->differential; }
const system::RotorSymmetry& TurbineSystem::symmetry() const {
  return assembly_->equations.symmetry();
}
const std::vector<system::EnergyGroup>& TurbineSystem::energy_groups() const {
  return assembly_->equations.declarations().energies;
}
const std::vector<system::UnconstrainedCoordinate>& TurbineSystem::unconstrained_coordinates()
    const {
  return assembly_->equations.declarations().unconstrained;
}
std::vector<system::UnconstrainedCoordinate> TurbineSystem::free_coordinates() const {
  return assembly_->equations.declarations().free;
}

std::vector<system::Motion> TurbineSystem::motions() const {
  std::vector<system::Motion> motions = motions_of(turbine(), layout());
  const std::vector<system::Motion>& declared = assembly_->equations.declarations().motions;
  motions.insert(motions.end(), declared.begin(), declared.end());
  return motions;
}

std::unique_ptr<system::MotionEnergies> TurbineSystem::motion_energies(double t, Vec steady) const {
  const std::vector<double> values = assembly_->gathered(steady);
  return find_motion_energies(equations(), t,
                              Eigen::Map<const Eigen::VectorXd>(values.data(), layout().size()));
}

std::vector<system::MeshError> TurbineSystem::mesh_errors() const {
  return assembly_->equations.declarations().mesh_errors;
}

bool TurbineSystem::constraints_are_autonomous() const {
  return assembly_->equations.constraints_are_autonomous();
}

bool TurbineSystem::is_conservative() const { return assembly_->equations.is_conservative(); }

petsc::Handle<Vec> TurbineSystem::make_state() const { return assembly_->vector(); }

petsc::Handle<Mat> TurbineSystem::make_jacobian() const {
  const Assembly& assembly = *assembly_;
  const petsc::Handle<Vec> z = make_state();
  PetscInt local = 0;
  petsc::check(VecGetLocalSize(z.get(), &local));
  const auto& columns = assembly.plan.blocks;
  const int first = static_cast<int>(assembly.first_row) / block;
  const int last = static_cast<int>(assembly.last_row) / block;
  std::vector<PetscInt> inside;
  std::vector<PetscInt> outside;
  for (int i = first; i < last; ++i) {
    PetscInt own = 0;
    const auto& row = columns[static_cast<std::size_t>(i)];
    for (const int j : row)
      if (j >= first && j < last) ++own;
    inside.push_back(own);
    outside.push_back(static_cast<PetscInt>(row.size()) - own);
  }
  petsc::Handle<Mat> matrix;
  petsc::check(MatCreate(assembly.comm, matrix.fill()));
  petsc::check(MatSetSizes(matrix.get(), local, local, size(), size()));
  petsc::check(MatSetType(matrix.get(), MATBAIJ));
  petsc::check(MatSeqBAIJSetPreallocation(matrix.get(), block, 0, inside.data()));
  petsc::check(
      MatMPIBAIJSetPreallocation(matrix.get(), block, 0, inside.data(), 0, outside.data()));
  for (int i = first; i < last; ++i) {  // sets the pattern; the values come block by block
    const std::vector<double> zeros(static_cast<std::size_t>(block * block), 0.0);
    for (const PetscInt j : columns[static_cast<std::size_t>(i)]) {
      const PetscInt row = i;
      petsc::check(MatSetValuesBlocked(matrix.get(), 1, &row, 1, &j, zeros.data(), INSERT_VALUES));
    }
  }
  petsc::check(MatAssemblyBegin(matrix.get(), MAT_FINAL_ASSEMBLY));
  petsc::check(MatAssemblyEnd(matrix.get(), MAT_FINAL_ASSEMBLY));
  return matrix;
}

petsc::Handle<Mat> TurbineSystem::make_mass() const {
  const Assembly& assembly = *assembly_;
  const petsc::Handle<Vec> z = make_state();
  PetscInt local = 0;
  petsc::check(VecGetLocalSize(z.get(), &local));
  std::vector<PetscInt> inside;
  std::vector<PetscInt> outside;
  for (PetscInt i = assembly.first_row; i < assembly.last_row; ++i) {
    PetscInt own = 0;
    const auto& row = assembly.plan.M[static_cast<std::size_t>(i)];
    for (const PetscInt j : row)
      if (j >= assembly.first_row && j < assembly.last_row) ++own;
    inside.push_back(own);
    outside.push_back(static_cast<PetscInt>(row.size()) - own);
  }
  petsc::Handle<Mat> matrix;
  petsc::check(MatCreate(assembly.comm, matrix.fill()));
  petsc::check(MatSetSizes(matrix.get(), local, local, size(), size()));
  petsc::check(MatSetType(matrix.get(), MATAIJ));
  petsc::check(MatSeqAIJSetPreallocation(matrix.get(), 0, inside.data()));
  petsc::check(MatMPIAIJSetPreallocation(matrix.get(), 0, inside.data(), 0, outside.data()));
  for (PetscInt i = assembly.first_row; i < assembly.last_row; ++i) {  // sets the pattern
    const auto& row = assembly.plan.M[static_cast<std::size_t>(i)];
    const std::vector<double> zeros(row.size(), 0.0);
    petsc::check(MatSetValues(matrix.get(), 1, &i, static_cast<PetscInt>(row.size()), row.data(),
                              zeros.data(), INSERT_VALUES));
  }
  petsc::check(MatAssemblyBegin(matrix.get(), MAT_FINAL_ASSEMBLY));
  petsc::check(MatAssemblyEnd(matrix.get(), MAT_FINAL_ASSEMBLY));
  return matrix;
}

std::vector<std::vector<PetscInt>> TurbineSystem::pattern() const {
  const components::TangentPlan& pattern = assembly_->plan;
  std::vector<std::vector<PetscInt>> columns(pattern.K.size());
  for (std::size_t i = 0; i < columns.size(); ++i)
    std::set_union(pattern.K[i].begin(), pattern.K[i].end(), pattern.M[i].begin(),
                   pattern.M[i].end(), std::back_inserter(columns[i]));
  return columns;
}

/// With u = theta = 0 the kinematic rows are V - (v_a + omega_a x x): V is their negative. The row
/// of a joint that is not free is its angle minus the prescribed one. The kinematic rows of free
/// joints give their speeds in the same way, joint by joint from the tower outward.
void TurbineSystem::reference_state(double t, Vec z) const {
  const Assembly& assembly = *assembly_;
  const auto n = static_cast<std::size_t>(size());
  std::vector<double> values(n, 0.0);
  const std::vector<double> rates(n, 0.0);
  std::vector<double> r(n, 0.0);
  const components::Declarations& declared = assembly.equations.declarations();
  const auto is_joint = [&declared](std::size_t i) {
    const system::Unknown& unknown = declared.unknowns[i];
    return unknown.owner.kind == system::PartKind::joint &&
           unknown.role == system::UnknownRole::position;
  };
  assembly.undo_references(values);
  assembly.equations.evaluate(t, values, rates, r);
  for (std::size_t i = 0; i < n; ++i)
    if (is_joint(i) && declared.rows[i] == system::RowRole::constraint) values[i] -= r[i];
  constexpr int most_joints_in_a_row = 5;
  for (int pass = 0; pass < most_joints_in_a_row; ++pass) {
    assembly.equations.evaluate(t, values, rates, r);
    for (std::size_t i = 0; i < n; ++i) {
      if (declared.rows[i] != system::RowRole::kinematic) continue;
      if (declared.unknowns[i].role == system::UnknownRole::velocity) values[i] -= r[i];
      if (is_joint(i)) values[i + 1] += r[i];  // its speed
    }
  }
  assembly.equations.settle_air(t, values);
  assembly.write_own(values, z);
}

void TurbineSystem::settle(double t, Vec z) const {
  std::vector<double> values = assembly_->gathered(z);
  assembly_->equations.settle_air(t, values);
  assembly_->write_own(values, z);
}

void TurbineSystem::require_admissible(double t, Vec z) const {
  assembly_->equations.require_admissible(t, assembly_->gathered(z));
}

std::unique_ptr<system::PeriodicSystem> TurbineSystem::unloaded() const {
  model::Turbine bare = turbine();
  bare.chain.gravity = 0.0;
  bare.chain.generator_torque = {};
  bare.chain.rotor_torque = {};
  bare.tower.loads.clear();
  for (model::Beam& blade : bare.blades) blade.loads.clear();
  if (bare.air) bare.air->rotor.acting = 0.0;
  return std::make_unique<TurbineSystem>(bare, comm(), assembly_->equations.plan().get());
}

std::vector<PetscInt> TurbineSystem::common_unknowns() const {
  std::vector<PetscInt> unknowns;
  for (const int common : components::Portion::find_common_blocks(assembly_->plan))
    for (int i = 0; i < block; ++i) unknowns.push_back(common * block + i);
  return unknowns;
}

std::unique_ptr<system::PeriodicSystem> TurbineSystem::part_of(
    int rank, const std::vector<int>& owners) const {
  std::vector<int> of_blocks;
  for (std::size_t i = 0; i < owners.size(); i += block) of_blocks.push_back(owners[i]);
  auto portion = components::Portion::find(assembly_->plan, std::move(of_blocks), rank);
  if (!portion) return nullptr;
  return std::unique_ptr<TurbineSystem>(new TurbineSystem(std::make_unique<Assembly>(
      assembly_->shared_equations, PETSC_COMM_SELF, std::move(portion))));
}

std::unique_ptr<system::PeriodicSystem> TurbineSystem::counted_from(Vec z) const {
  const Assembly& assembly = *assembly_;
  const std::vector<double> values = assembly.gathered(z);
  const auto rotation = [&values](int first) {
    return Vector3(Eigen::Map<const Vector3>(values.data() + first + 3));
  };
  model::Turbine turned = turbine();
  bool any = false;
  for (std::size_t k = 0; k < turned.blades.size(); ++k) {
    const components::PlacedBeam& placed = assembly.equations.beams()[k];
    model::Beam& beam = turned.blades[k];
    double largest = rotation(placed.tip).norm();
    for (const int first : placed.points) largest = std::max(largest, rotation(first).norm());
    if (largest < large_rotation) continue;
    any = true;
    for (int e = 0; e < beam.elements; ++e) {
      const auto middle = static_cast<std::size_t>(e * beam.order + beam.order / 2);
      const Matrix3 reference =
          math::direction_cosines<double>(rotation(placed.points[middle])).transpose() *
          beam.reference(e);
      for (int j = 0; j < beam.order; ++j)
        beam.points[static_cast<std::size_t>(e * beam.order + j)].reference = reference;
    }
  }
  if (!any) return nullptr;
  auto system = std::make_unique<TurbineSystem>(turned, comm());
  assembly.recount(values, &system->equations(), z);
  return system;
}

void TurbineSystem::count_from_undeformed(Vec z) const {
  assembly_->recount(assembly_->gathered(z), nullptr, z);
}

void TurbineSystem::residual(double t, Vec z, Vec z_dot, Vec r) const {
  const Assembly& assembly = *assembly_;
  assembly.take(z, assembly.state);
  assembly.take(z_dot, assembly.rates);
  assembly.rows.assign(static_cast<std::size_t>(size()), 0.0);
  assembly.equations.evaluate(t, assembly.state, assembly.rates, {}, assembly.rows,
                              assembly.portion.get());
  assembly.write_own(assembly.rows, r);
}

void TurbineSystem::tangents(double t, Vec z, Vec z_dot, double shift, Mat jacobian,
                             Mat mass) const {
  const Assembly& assembly = *assembly_;
  Assembly::Workspace& workspace = assembly.workspace();
  components::Tangents& tangents = workspace.tangents;
  assembly.take(z, assembly.state);
  assembly.take(z_dot, assembly.rates);
  assembly.equations.evaluate(t, assembly.state, assembly.rates, tangents);
  std::vector<double>& K = tangents.K().values();
  const std::vector<double>& M = tangents.M().values();
  if (mass != nullptr && !assembly.parallel()) {
    PetscScalar* values = nullptr;  // row by row, in the order of the offsets
    petsc::check(MatSeqAIJGetArrayWrite(mass, &values));
    for (std::size_t entry = 0; entry < workspace.mass_offsets.size(); ++entry)
      values[entry] = M[workspace.mass_offsets[entry]];
    petsc::check(MatSeqAIJRestoreArrayWrite(mass, &values));
  } else if (mass != nullptr) {
    std::size_t entry = 0;
    std::vector<PetscScalar> row_values;
    for (PetscInt i = 0; i < size(); ++i) {
      const auto& columns = assembly.plan.M[static_cast<std::size_t>(i)];
      const bool own = i >= assembly.first_row && i < assembly.last_row;
      row_values.clear();
      for (std::size_t c = 0; c < columns.size(); ++c)
        row_values.push_back(M[workspace.mass_offsets[entry++]]);
      if (own && !columns.empty())
        petsc::check(MatSetValues(mass, 1, &i, static_cast<PetscInt>(columns.size()),
                                  columns.data(), row_values.data(), INSERT_VALUES));
    }
    petsc::check(MatAssemblyBegin(mass, MAT_FINAL_ASSEMBLY));
    petsc::check(MatAssemblyEnd(mass, MAT_FINAL_ASSEMBLY));
  }
  if (jacobian != nullptr) {
    if (shift != 0.0)
      for (std::size_t i = 0; i < K.size(); ++i) K[i] += shift * M[i];
    tangents.K().copy_to(jacobian);
  }
}

}  // namespace samara::turbine
