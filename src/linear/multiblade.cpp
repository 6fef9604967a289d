#include "samara/linear/multiblade.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include <Eigen/LU>

#include "samara/base/error.hpp"

namespace samara::linear {
namespace {

int binomial(int p, int q) { return p == 2 && q == 1 ? 2 : 1; }

}  // namespace

std::vector<system::Signal> column_signals(const LinearModel& model) {
  const char* behind[] = {"", "_rate", "_acceleration"};
  const char* units[] = {"", "/s", "/s^2"};
  std::vector<system::Signal> signals;
  for (const InputColumn& column : model.input_columns()) {
    system::Signal signal = model.input_output().inputs()[column.input];
    signal.name += behind[column.derivative];
    signal.unit += units[column.derivative];
    if (!signal.family.empty()) signal.family += behind[column.derivative];
    signals.push_back(signal);
  }
  return signals;
}

std::vector<std::string> Multiblade::words(int blades) {
  std::vector<std::string> result{"mean"};
  for (int n = 1; 2 * n < blades; ++n) {
    result.push_back("cos " + std::to_string(n));
    result.push_back("sin " + std::to_string(n));
  }
  if (blades % 2 == 0) result.emplace_back("alternating");
  return result;
}

Multiblade::Multiblade(const LinearModel& model) : model_(model) {
  for (const system::Unknown& unknown : model.system().unknowns())
    blades_ = std::max(blades_, unknown.owner.instance);
  if (blades_ < 3)
    throw InputError(
        "linearize.forms: multiblade coordinates are for three and more blades; hint: "
        "lyapunov_floquet, hill");
  const double period = model.system().period();
  speed_ = period > 0.0 ? 2.0 * std::numbers::pi / period : 0.0;
  states_ = model.states();
  inputs_ = column_signals(model);
  outputs_ = model.input_output().outputs();
  find_state_families();
  std::vector<SignalKey> inputs;
  for (const InputColumn& column : model.input_columns())
    inputs.emplace_back(model.input_output().inputs()[column.input].family, column.derivative);
  find_signal_families(inputs, inputs_, input_families_);
  std::vector<SignalKey> outputs;
  for (const system::Signal& output : outputs_) outputs.emplace_back(output.family, 0);
  find_signal_families(outputs, outputs_, output_families_);
}

void Multiblade::find_state_families() {
  const analysis::ConsistentSubspace& subspace = model_.subspace();
  const int d = subspace.degrees_of_freedom();
  add_state_families(subspace.coordinates(), 0, d);
  add_state_families(subspace.states(), 2 * d, 0);
}

/// Families of the states from `first` on, and of their rates, which stand `rates` places behind
/// them (0: there are none).
void Multiblade::add_state_families(const std::vector<PetscInt>& unknowns, int first, int rates) {
  using Key = std::pair<std::string, std::string>;  // part and family
  std::vector<Key> families;                        // in the order of the states
  std::map<Key, std::map<int, int>> members;        // by blade
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    const system::Unknown& unknown =
        model_.system().unknowns()[static_cast<std::size_t>(unknowns[i])];
    if (unknown.owner.instance == 0) continue;
    const bool is_blade = unknown.owner.kind == system::PartKind::beam;
    const Key family(unknown.owner.part,
                     (is_blade ? "" : unknown.owner.part + " ") + unknown.family());
    if (!members.contains(family)) families.push_back(family);
    members[family][unknown.owner.instance] = first + static_cast<int>(i);
  }
  for (const Key& key : families) {
    const std::string& name = key.second;
    Family family;
    for (const auto& [blade, place] : members[key]) {
      family.members.push_back(place);
      family.scales.push_back(states_[static_cast<std::size_t>(place)].scale);
    }
    if (static_cast<int>(family.members.size()) != blades_)
      throw InputError(
          "linearize.forms: multiblade coordinates are for blades with the same "
          "states, not all blades have \"" +
          name + "\"");
    for (int derivative = 0; derivative < (rates > 0 ? 2 : 1); ++derivative) {
      family.derivative = derivative;
      family.first = static_cast<int>(state_families_.size()) - derivative;
      const std::vector<std::string> names = words(blades_);
      const ModelState of_first = states_[static_cast<std::size_t>(family.members.front())];
      for (std::size_t j = 0; j < names.size(); ++j) {
        ModelState& state = states_[static_cast<std::size_t>(family.members[j])];
        state = of_first;
        state.name = names[j] + " " + name + (derivative > 0 ? rate_word : "");
      }
      state_families_.push_back(family);
      for (int& place : family.members) place += rates;
    }
  }
}

/// Signals that are given for all blades; `keys`: family and order of the derivative of each.
void Multiblade::find_signal_families(const std::vector<SignalKey>& keys,
                                      std::vector<system::Signal>& signals,
                                      std::vector<Family>& families) const {
  std::map<SignalKey, std::vector<int>> found;
  for (std::size_t i = 0; i < keys.size(); ++i)
    if (!keys[i].first.empty()) found[keys[i]].push_back(static_cast<int>(i));
  const std::vector<std::string> names = words(blades_);
  const auto signal_of = [&signals](int i) -> system::Signal& {
    return signals[static_cast<std::size_t>(i)];
  };
  for (auto& [key, members] : found) {
    if (static_cast<int>(members.size()) != blades_) continue;
    std::ranges::sort(members, {}, [&](int i) { return signal_of(i).blade; });
    families.push_back({members, std::vector<double>(members.size(), 1.0), key.second,
                        static_cast<int>(families.size()) - key.second});
    for (std::size_t j = 0; j < names.size(); ++j) {
      system::Signal& signal = signal_of(members[j]);
      signal.name = signal.family + " " + names[j];
      signal.frame = "multiblade";
    }
  }
}

Eigen::MatrixXd Multiblade::functions(double psi, int derivative) const {
  Eigen::MatrixXd result(blades_, blades_);
  for (int k = 0; k < blades_; ++k) {
    const double azimuth = psi + 2.0 * std::numbers::pi * k / blades_;
    result(k, 0) = derivative == 0 ? 1.0 : 0.0;
    int column = 1;
    for (int n = 1; 2 * n < blades_; ++n) {
      const double quarter = 0.5 * std::numbers::pi * derivative;
      const double size = std::pow(n, derivative);
      result(k, column++) = size * std::cos(n * azimuth + quarter);
      result(k, column++) = size * std::sin(n * azimuth + quarter);
    }
    if (blades_ % 2 == 0) result(k, column) = derivative > 0 ? 0.0 : k % 2 == 0 ? 1.0 : -1.0;
  }
  return result;
}

/// The transformation, differentiated `extra` times by time. A derivative of a quantity contains
/// the quantity itself: (B q)^(p) = sum_r binomial(p, r) Omega^(p - r) B^(p - r) q^(r).
Eigen::MatrixXd Multiblade::matrix(const std::vector<Family>& families, Eigen::Index size,
                                   double psi, int extra) const {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(size, size);
  if (extra == 0) result.setIdentity();
  for (const Family& family : families) {
    for (int r = 0; r <= family.derivative; ++r) {
      const Family& lower = families[static_cast<std::size_t>(family.first + r)];
      const int order = family.derivative - r + extra;
      const Eigen::MatrixXd block =
          binomial(family.derivative, r) * std::pow(speed_, order) * functions(psi, order);
      for (std::size_t k = 0; k < family.members.size(); ++k)
        for (std::size_t j = 0; j < lower.members.size(); ++j)
          result(family.members[k], lower.members[j]) =
              block(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(j)) *
              family.scales.front() / family.scales[k];
    }
  }
  return result;
}

StateSpace Multiblade::transform(double psi, const StateSpace& form) const {
  const Eigen::MatrixXd T = matrix(state_families_, form.A.rows(), psi, 0);
  const Eigen::MatrixXd T_dot = matrix(state_families_, form.A.rows(), psi, 1);
  const Eigen::MatrixXd U = matrix(input_families_, form.B.cols(), psi, 0);
  const Eigen::MatrixXd Y = matrix(output_families_, form.C.rows(), psi, 0);
  const Eigen::PartialPivLU<Eigen::MatrixXd> states(T);
  StateSpace result;
  result.A = states.solve(form.A * T - T_dot);
  result.B = states.solve(form.B * U);
  if (form.C.rows() == 0) return {result.A, result.B, form.C, form.D};
  const Eigen::PartialPivLU<Eigen::MatrixXd> outputs(Y);
  result.C = outputs.solve(form.C * T);
  result.D = outputs.solve(form.D * U);
  return result;
}

}  // namespace samara::linear
