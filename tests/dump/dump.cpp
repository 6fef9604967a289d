// Equations of a turbine at random states, as text with the names of unknowns, rows and
// channels: scripts/compare_trees compares two trees of sources by it.
//
//     dump_system CASE.yaml > out.txt
//
// Values of a state follow from the names of its unknowns, so that the order of these may change.
// Lines: kind, names, value, with tabs between. Columns of K and M come times the size of their
// unknown in the random states.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <map>
#include <string>
#include <vector>

#include "samara/io/case.hpp"
#include "samara/model/turbine.hpp"
#include "samara/petsc/session.hpp"
#include "samara/turbine/turbine_input_output.hpp"
#include "samara/turbine/turbine_system.hpp"

namespace {

using namespace samara;

constexpr int states = 3;

/// From -1 to 1.
double random_value(const std::string& name, int seed) {
  std::uint64_t hash = 14695981039346656037ULL + static_cast<std::uint64_t>(seed);
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  hash ^= hash >> 30;
  hash *= 0xbf58476d1ce4e5b9ULL;
  hash ^= hash >> 27;
  hash *= 0x94d049bb133111ebULL;
  hash ^= hash >> 31;
  return std::ldexp(static_cast<double>(hash >> 11), -52) - 1.0;
}

double size_of(const system::Unknown& unknown) {
  if (unknown.role == system::UnknownRole::position) return unknown.unit == "rad" ? 0.3 : 1.0;
  if (unknown.role == system::UnknownRole::velocity) return unknown.unit == "rad/s" ? 0.5 : 3.0;
  return 1e5;
}

class Dump {
 public:
  explicit Dump(const std::string& path)
      : input_(io::read_case(path, {})),
        system_(model::build_turbine(input_.turbine), PETSC_COMM_SELF) {
    // Unknowns that stand for nothing have one name.
    std::map<std::string, int> found;
    for (const system::Unknown& unknown : system_.unknowns()) {
      const int number = ++found[unknown.name()];
      names_.push_back(unknown.name() + (number > 1 ? " " + std::to_string(number) : ""));
    }
  }

  void run() {
    const petsc::Handle<Vec> z = system_.make_state();
    system_.reference_state(0.3, z.get());
    put_vector("reference", z);
    for (const system::UnconstrainedCoordinate& one : system_.unconstrained_coordinates())
      put("neutral", one.name + "\t" + name(one.unknown) + "\t" + name(one.row), 1.0);
    put("sectors", system_.symmetry().broken_by, system_.symmetry().sectors);
    for (std::size_t i = 0; i < names_.size(); ++i)
      put("symmetry", names_[i] + "\t" + name(system_.symmetry().source[i]),
          system_.symmetry().sign[i]);
    put_mesh_errors();
    for (int seed = 0; seed < states; ++seed) put_state(seed);
  }

 private:
  const std::string& name(PetscInt i) const { return names_[static_cast<std::size_t>(i)]; }

  static void put(const std::string& kind, const std::string& names, double value) {
    std::printf("%s\t%s\t%.17g\n", kind.c_str(), names.c_str(), value);
  }

  void put_vector(const std::string& kind, const petsc::Handle<Vec>& vector) const {
    const petsc::ReadView view(vector.get());
    for (PetscInt i = 0; i < system_.size(); ++i) put(kind, name(i), view[i]);
  }

  /// Entries that are zero are left out.
  void put_matrix(const std::string& kind, const petsc::Handle<Mat>& matrix) const {
    for (PetscInt i = 0; i < system_.size(); ++i) {
      PetscInt count = 0;
      const PetscInt* columns = nullptr;
      const PetscScalar* values = nullptr;
      petsc::check(MatGetRow(matrix.get(), i, &count, &columns, &values));
      for (PetscInt k = 0; k < count; ++k) {
        const system::Unknown& unknown = system_.unknowns()[static_cast<std::size_t>(columns[k])];
        if (values[k] != 0.0)
          put(kind, name(i) + "\t" + name(columns[k]), values[k] * size_of(unknown));
      }
      petsc::check(MatRestoreRow(matrix.get(), i, &count, &columns, &values));
    }
  }

  void put_mesh_errors() const {
    std::map<std::string, int> numbers;
    for (const system::MeshError& error : system_.mesh_errors()) {
      const std::string& first = name(error.unknowns.front());
      const std::string place = first + "\t" + std::to_string(numbers[first]++);
      put("mesh constant", place, error.constant.norm());
      put("mesh rate", place, error.rate.norm());
      put("mesh remainder", place, error.remainder.norm());
    }
  }

  void put_state(int seed) const {
    const std::string before = "state " + std::to_string(seed) + " ";
    const double t = 0.7 * (seed + 1);
    const petsc::Handle<Vec> z = system_.make_state();
    const petsc::Handle<Vec> z_dot = system_.make_state();
    const petsc::Handle<Vec> r = system_.make_state();
    {
      const petsc::WriteView values(z.get());
      const petsc::WriteView rates(z_dot.get());
      for (PetscInt i = 0; i < system_.size(); ++i) {
        const double size = size_of(system_.unknowns()[static_cast<std::size_t>(i)]);
        values[i] = size * random_value(name(i), 2 * seed);
        rates[i] = size * random_value(name(i), 2 * seed + 1);
      }
    }
    system_.residual(t, z.get(), z_dot.get(), r.get());
    put_vector(before + "r", r);
    const petsc::Handle<Mat> K = system_.make_jacobian();
    const petsc::Handle<Mat> M = system_.make_mass();
    system_.tangents(t, z.get(), z_dot.get(), 0.0, K.get(), M.get());
    put_matrix(before + "K", K);
    put_matrix(before + "M", M);
    put_energies(before, z);
    put_signals(before, t, z, z_dot);
  }

  void put_energies(const std::string& before, const petsc::Handle<Vec>& z) const {
    const petsc::ReadView view(z.get());
    std::map<std::string, double> sums;
    for (const system::EnergyGroup& group : system_.energy_groups()) {
      const std::size_t n = group.unknowns.size();
      double energy = 0.0;
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j)
          energy +=
              view[group.unknowns[i]] * group.weight[i * n + j] * view[group.unknowns[j]] / 2.0;
      const std::string word = group.kind == system::EnergyGroup::Kind::kinetic ? "T" : "U";
      sums[word + "\t" + group.owner.part + "\t" + group.direction + "\t" +
           std::to_string(group.owner.instance) + "\t" + name(group.unknowns.front())] += energy;
    }
    for (const auto& [names, energy] : sums) put(before + "energy", names, energy);
  }

  void put_signals(const std::string& before, double t, const petsc::Handle<Vec>& z,
                   const petsc::Handle<Vec>& z_dot) const {
    turbine::ChannelStations stations;
    if (!system_.turbine().blades.empty()) stations.blade = {0.0, 0.37, 1.0};
    if (system_.turbine().has_tower) stations.tower = {0.0, 0.37, 1.0};
    std::vector<std::string> channels;
    for (const turbine::Channel& one : turbine::TurbineChannels::available(system_, stations))
      channels.push_back(one.name);
    const turbine::TurbineInputOutput signals(system_, {}, stations, channels);
    const Eigen::VectorXd values = signals.output_values(t, z.get(), z_dot.get());
    for (std::size_t i = 0; i < channels.size(); ++i)
      put(before + "channel", channels[i], values(static_cast<Eigen::Index>(i)));
    const system::InputTangents inputs = signals.input_tangents(t, z.get(), z_dot.get());
    const system::OutputTangents outputs = signals.output_tangents(t, z.get(), z_dot.get());
    for (std::size_t k = 0; k < signals.inputs().size(); ++k) {
      const auto column = static_cast<Eigen::Index>(k);
      const std::string& input = signals.inputs()[k].name;
      for (PetscInt i = 0; i < system_.size(); ++i) {
        put_nonzero(before + "by input", name(i) + "\t" + input, inputs.by_value(i, column));
        put_nonzero(before + "by input rate", name(i) + "\t" + input, inputs.by_rate(i, column));
      }
    }
    for (std::size_t k = 0; k < channels.size(); ++k) {
      const auto row = static_cast<Eigen::Index>(k);
      for (PetscInt i = 0; i < system_.size(); ++i) {
        const double size = size_of(system_.unknowns()[static_cast<std::size_t>(i)]);
        put_nonzero(before + "channel by state", channels[k] + "\t" + name(i),
                    size * outputs.by_state(row, i));
        put_nonzero(before + "channel by rate", channels[k] + "\t" + name(i),
                    size * outputs.by_rate(row, i));
      }
    }
  }

  static void put_nonzero(const std::string& kind, const std::string& names, double value) {
    if (value != 0.0) put(kind, names, value);
  }

  io::Case input_;
  turbine::TurbineSystem system_;
  std::vector<std::string> names_;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: dump_system CASE.yaml\n");
    return 2;
  }
  const petsc::Session session({});
  try {
    Dump(argv[1]).run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
