#include "samara/turbine/torque_in_time.hpp"

#include <utility>

namespace samara::turbine {
namespace {

/// The torque in the row of the generator's joint. It has no unknowns.
class GivenTorque final : public components::Stated<GivenTorque> {
 public:
  GivenTorque(std::function<double(double)> torque, const model::Turbine& turbine,
              const TurbineLayout& layout)
      : torque_(std::move(torque)), turbine_(turbine), layout_(layout) {}

  void place(components::Registry&) override {}

  void describe(components::Registry&) override {
    connections_.arguments = {components::zeros(1)};
    connections_.shares = {{layout_.generator() + 1, 1, 0}};
  }

  bool is_conservative() const override { return false; }

  template <class System>
  void state(System& system) const {
    const auto row_of = [&]<class T>(const Eigen::Matrix<T, 1, 1>&) {
      const double now = turbine_.operation.generator_off ? 0.0 : torque_(system.time());
      Eigen::Matrix<T, values, 1> y = Eigen::Matrix<T, values, 1>::Zero();
      y(0) = T(system.varying(now) * -turbine_.chain.gear());
      return y;
    };
    system.template add<1, values>(connections_, row_of);
  }

 private:
  static constexpr int values = 2;  ///< the torque; g++ 12 warns of vectors with one entry

  std::function<double(double)> torque_;
  const model::Turbine& turbine_;
  const TurbineLayout& layout_;
  components::Connections connections_;
};

}  // namespace

TorqueInTime::TorqueInTime(std::function<double(double)> torque) : torque_(std::move(torque)) {}

std::unique_ptr<components::Component> TorqueInTime::make(const model::Turbine& turbine,
                                                          const TurbineLayout& layout) const {
  return std::make_unique<GivenTorque>(torque_, turbine, layout);
}

}  // namespace samara::turbine
