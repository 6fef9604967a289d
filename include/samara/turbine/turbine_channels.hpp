// Output channels of a turbine's state: motions and loads by the channel names of OpenFAST, in its
// units and frames (docs/channels.md). A load is the load of the outer body on the inner one: blade
// on hub, rotor on shaft, nacelle on tower, tower on ground. Root and tower loads are unknowns of
// the formulation, not differences.
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
  std::string unit;   ///< unit of OpenFAST: kN, kN-m, m, deg, rpm
  std::string frame;  ///< "blade root, pitched"
  std::string description;
};

/// Places of section loads and motions, fractions of the length; empty: all Gauss points.
struct ChannelStations {
  std::vector<double> blade;  ///< N1, N2, ... of B1N1MLx
  std::vector<double> tower;  ///< 1, 2, ... of TwHt1MLxt
};

/// Place of a channel's value among the quantities of a turbine, and its factor from SI.
struct ChannelPick {
  int slot = 0;
  double factor = 1.0;
  int unknown = -1;  ///< the unknown that is the value; -1: the value is the quantity in the slot
};

class ChannelCatalogue;

class TurbineChannels {
 public:
  /// `names` empty: all channels except those of the stations. `system` must outlive the object.
  /// @throws InputError for a name that this turbine does not have; the message has the nearest
  /// name
  TurbineChannels(const TurbineSystem& system, const ChannelStations& stations,
                  const std::vector<std::string>& names);

  const std::vector<Channel>& channels() const { return channels_; }

  /// All channels of this turbine, in the order of the documentation.
  static std::vector<Channel> available(const TurbineSystem& system,
                                        const ChannelStations& stations);

  /// Values in the units of the channels, at a state where the equations hold.
  void evaluate(double t, Vec z, Vec z_dot, std::span<double> values) const;

  /// The same for plain arrays, under inputs. T: double, or std::complex<double> to differentiate.
  template <class T>
  void evaluate(double t, const std::vector<T>& z, const std::vector<T>& z_dot, std::span<T> values,
                const TurbineInputs<T>& inputs = {}) const;

 private:
  /// A requested station.
  struct Section {
    int beam = 0;  ///< index in TurbineEquations::beams()
    int slot = 0;
    std::vector<std::pair<int, double>> place;  ///< Gauss points and their factors
  };

  void place_sections(const ChannelCatalogue& catalogue);

  const TurbineSystem& system_;
  ChannelStations stations_;
  std::vector<Channel> channels_;
  std::vector<ChannelPick> picks_;
  std::vector<Section> sections_;
  int size_ = 0;          ///< number of quantities
  bool has_air_ = false;  ///< quantities of the air are needed
};

}  // namespace samara::turbine
