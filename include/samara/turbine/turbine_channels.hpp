// Output channels of a turbine's state: motions and loads by the channel names of OpenFAST, in its
// units and frames (docs/channels.md). Loads are those of the outer body on the inner one: of the
// blade on the hub, of the rotor on the shaft, of the nacelle on the tower, of the tower on the
// ground. Root and tower loads are unknowns of the formulation, not differences.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "samara/turbine/turbine_system.hpp"

namespace samara::turbine {

struct Channel {
  std::string name;
  std::string unit;   ///< OpenFAST's: kN, kN-m, m, deg, rpm
  std::string frame;  ///< "blade root, pitched"
  std::string description;
};

/// Places of section loads and motions, fractions of the length; empty: all Gauss points.
struct ChannelStations {
  std::vector<double> blade;  ///< N1, N2, ... of B1N1MLx
  std::vector<double> tower;  ///< 1, 2, ... of TwHt1MLxt
};

/// Where a channel's value stands among the quantities of a turbine, and its factor from SI.
struct ChannelPick {
  int slot = 0;
  double factor = 1.0;
  int unknown = -1;  ///< that it is; -1: it is the quantity in the slot
};

class ChannelCatalogue;

class TurbineChannels {
 public:
  /// `names` empty: all but those of the stations. `system` must live on.
  /// @throws InputError where a name is not one of this turbine's, with the nearest one
  TurbineChannels(const TurbineSystem& system, const ChannelStations& stations,
                  const std::vector<std::string>& names);

  const std::vector<Channel>& channels() const { return channels_; }

  /// All that this turbine has, in the order of the documentation.
  static std::vector<Channel> available(const TurbineSystem& system,
                                        const ChannelStations& stations);

  /// Values in the units of the channels, at a state where the equations hold.
  void evaluate(double t, Vec z, Vec z_dot, std::span<double> values) const;

  /// The same of plain arrays, under inputs; T: double, or std::complex<double> to differentiate.
  template <class T>
  void evaluate(double t, const std::vector<T>& z, const std::vector<T>& z_dot, std::span<T> values,
                const TurbineInputs<T>& inputs = {}) const;

 private:
  /// A station that is asked for.
  struct Section {
    int beam = 0;  ///< of TurbineEquations::beams()
    int slot = 0;
    std::vector<std::pair<int, double>> place;  ///< Gauss points and their factors
  };

  void place_sections(const ChannelCatalogue& catalogue);

  const TurbineSystem& system_;
  ChannelStations stations_;
  std::vector<Channel> channels_;
  std::vector<ChannelPick> picks_;
  std::vector<Section> sections_;
  int size_ = 0;  ///< number of quantities
};

}  // namespace samara::turbine
