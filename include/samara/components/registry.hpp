// Places and descriptions of the unknowns of the components in a system.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "samara/system/metadata.hpp"

namespace samara::components {

/// An unknown of the system as a quantity that users request by name.
struct Channel {
  std::string name;
  std::string unit;  ///< unit of OpenFAST
  std::string frame;
  std::string description;
  int unknown = 0;
  double factor = 1.0;  ///< value per SI unit of the unknown
};

/// Declarations of the components.
struct Declarations {
  std::vector<system::Unknown> unknowns;
  std::vector<system::RowRole> rows;
  std::vector<system::EnergyGroup> energies;
  std::vector<system::UnconstrainedCoordinate> unconstrained;
  std::vector<system::UnconstrainedCoordinate> free;  ///< PeriodicSystem::free_coordinates
  std::vector<system::MeshError> mesh_errors;
  std::vector<system::Motion> motions;
  std::vector<Channel> channels;
  std::vector<int> port_sizes;
  /// Unknowns without a description. They fill blocks and stay zero.
  std::vector<int> padding;
};

/// Places of unknowns. Components request their places twice: from a registry that counts, and from
/// one that then knows the place of each unknown. When all places are known they describe
/// themselves to the second one.
class Registry {
 public:
  /// Creates a registry that counts.
  Registry() = default;
  /// Creates a registry that places the unknowns that `counted` has counted.
  static Registry placing(const Registry& counted);

  /// First unknown of a new block. Blocks of a lower rank are eliminated first; blocks of one rank
  /// are eliminated in the order in which they are added.
  int add_block(int rank);
  /// First of `count` unknowns (at most a block) in a block that several components share.
  int add_shared(int rank, int count);
  /// Number of a new port with this number of values.
  int add_port(int values);

  void describe(int unknown, const system::Unknown& what, system::RowRole row);
  /// Changes the description: a free position, whose row is a balance of loads.
  void set_free(int unknown);
  /// Adds a coordinate that only loads and inertia restore, and the row of the load that would hold
  /// it.
  void add_free(const system::UnconstrainedCoordinate& free);
  void set_row(int unknown, system::RowRole row);
  void add(const system::EnergyGroup& group);
  void add(const system::UnconstrainedCoordinate& unconstrained);
  void add(const system::MeshError& error);
  void add(const system::Motion& motion);
  void add(const Channel& channel);
  /// The unknown changes its sign when the rotor turns from one blade to the next.
  void reverse(int unknown);

  /// All declarations; for a registry that places.
  Declarations finish();
  /// Symmetry of a rotor with equal blades: the unknowns of each blade are mapped to those of the
  /// next one. With fewer than two blades every unknown is mapped to itself.
  system::RotorSymmetry symmetry(int blades) const;

 private:
  struct Rank {
    int start = 0;  ///< first unknown
    int blocks = 0;
    int free_slots = 0;  ///< free slots of the last block, if it is shared
  };

  std::map<int, Rank> ranks_;
  Declarations declared_;
  std::vector<bool> is_described_;
  std::vector<int> reversed_;
  /// Unknowns of equal parts, by name and number, in the same order for each part.
  std::map<std::string, std::map<int, std::vector<int>>> instances_;
};

}  // namespace samara::components
