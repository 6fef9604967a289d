// Where the unknowns of components stand in a system, and what they are.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "samara/system/metadata.hpp"

namespace samara::components {

/// A quantity that users ask for by name and that is an unknown.
struct Channel {
  std::string name;
  std::string unit;  ///< OpenFAST's
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
  /// Unknowns that nothing describes: they fill blocks, and stay zero.
  std::vector<int> padding;
};

/// Components ask for their places twice: a registry that counts, and one that knows from it where
/// each unknown stands. To that one they describe themselves when all have their places.
class Registry {
 public:
  /// One that counts.
  Registry() = default;
  /// One that places what `counted` has counted.
  static Registry placing(const Registry& counted);

  /// First unknown of a block of its own. Blocks of a lower rank are eliminated first, those of one
  /// rank in the order in which they are added.
  int add_block(int rank);
  /// First of `count` unknowns, at most a block, in one that others share.
  int add_shared(int rank, int count);
  /// Number of a port of so many values.
  int add_port(int values);

  void describe(int unknown, const system::Unknown& what, system::RowRole row);
  /// Changes what is described: a position that nothing holds, whose row is a balance of loads.
  void set_free(int unknown);
  /// A coordinate that only loads and inertia restore, and the row of the load that would hold it.
  void add_free(const system::UnconstrainedCoordinate& free);
  void set_row(int unknown, system::RowRole row);
  void add(const system::EnergyGroup& group);
  void add(const system::UnconstrainedCoordinate& unconstrained);
  void add(const system::MeshError& error);
  void add(const system::Motion& motion);
  void add(const Channel& channel);
  /// The unknown becomes its negative where the rotor turns from one blade to the next.
  void reverse(int unknown);

  /// All that has been declared to one that places.
  Declarations finish();
  /// Symmetry of a rotor whose blades are alike: the unknowns of each go to the next one's. Below
  /// two blades every unknown is its own image.
  system::RotorSymmetry symmetry(int blades) const;

 private:
  struct Rank {
    int start = 0;  ///< first unknown
    int blocks = 0;
    int free_slots = 0;  ///< of the last block, where it is shared
  };

  std::map<int, Rank> ranks_;
  Declarations declared_;
  std::vector<bool> is_described_;
  std::vector<int> reversed_;
  /// Unknowns of equal parts, by name and number, in the same order for each part.
  std::map<std::string, std::map<int, std::vector<int>>> instances_;
};

}  // namespace samara::components
