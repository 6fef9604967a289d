// Places where the tangents of the components' functions have entries. They are found once,
// independent of the state, by the same functions with a scalar that records its dependences.
#pragma once

#include <cstdint>
#include <limits>
#include <set>
#include <vector>

#include <Eigen/Core>

#include "samara/components/function.hpp"
#include "samara/math/dependence.hpp"

namespace samara::components {

/// An unknown or a rate on which the values of a port depend.
struct PortColumn {
  int unknown = 0;
  bool is_rate = false;
  bool operator==(const PortColumn&) const = default;
};

/// Places of all entries of K and M, and the map from the derivatives of each function to them.
struct TangentPlan {
  static constexpr int most_port_values = 16;

  /// Consecutive entries of up to three rows: maps columns of the derivatives of a function or of a
  /// port to columns of a block.
  struct Entries {
    int from = 0;
    int count = 0;
    bool is_rate = false;
    int unknown = 0;         ///< unknown of the first column
    std::size_t offset = 0;  ///< offset of the first entry in the values of K or M
  };
  /// Part of a share that passes through a port.
  struct Carried {
    int argument = 0;  ///< first of the port's values
    int port = 0;
    std::vector<Entries> entries;
  };
  struct SharePlan {
    std::vector<Entries> entries;
    std::vector<Carried> carried;
  };
  /// Map from the arguments of a function to the columns of a port.
  struct ProvisionPlan {
    struct Direct {
      int argument = 0;
      int column = 0;
    };
    struct Through {
      int argument = 0;
      int port = 0;
      std::vector<int> columns;  ///< number in the target port of each column of the port that the
                                 ///< argument belongs to
    };
    std::vector<Direct> direct;
    std::vector<Through> through;
  };
  struct Call {
    int arguments = 0;
    int values = 0;
    std::vector<SharePlan> shares;
    std::vector<ProvisionPlan> provisions;
    bool is_idle = true;               ///< true without derivatives and without provisions
    std::vector<int> argument_blocks;  ///< without those of ports
    std::vector<int> row_blocks;       ///< of the shares
  };
  /// A constant entry of K.
  struct Constant {
    std::size_t offset = 0;
    double value = 0.0;
  };

  std::vector<int> port_sizes;
  std::vector<std::vector<PortColumn>> port_columns;
  std::vector<Call> calls;  ///< in the order in which the functions are stated
  std::vector<Constant> constants;
  std::vector<std::vector<int>> K;       ///< columns of each row, ascending
  std::vector<std::vector<int>> M;       ///< the same
  std::vector<std::vector<int>> blocks;  ///< block columns of each block row of both, ascending
};

class Portion;

class Pattern {
 public:
  /// `size`: number of unknowns of the system. `portion`: the terms that the plan has, with the
  /// blocks of its rows; null: all.
  Pattern(int size, const std::vector<int>& port_sizes, const Portion* portion = nullptr);

  static constexpr bool has_inputs = false;  ///< they are zero
  static double time() { return 0.0; }
  /// A NaN: a value that is 0 at time() must not remove the entries that it multiplies.
  static double varying(double) { return std::numeric_limits<double>::quiet_NaN(); }
  template <class Place>
  static void require_rotation(int, const Place&) {}

  void add(const std::vector<LinearShare>& shares);

  template <int n, int m, class Function>
  void add(const Connections& connections, const Function& function, Memory = Memory::none) {
    static_assert(n <= math::Dependence::most_quantities);
    Eigen::Matrix<math::Dependence, n, 1> x;
    begin(connections, n, x.data());
    const Eigen::Matrix<math::Dependence, m, 1> y = function(x);
    end(connections, m, y.data());
  }

  /// The plan of all functions that have been stated. `at_least`: the plan includes its blocks;
  /// null: no further blocks.
  TangentPlan finish(const TangentPlan* at_least = nullptr);

 private:
  struct Port {
    /// Constants. Dependences on unknowns are in `columns`.
    std::vector<math::Dependence> values;
    std::vector<std::set<int>> columns;  ///< numbers in the plan's columns, for each value
  };
  /// Meaning of an argument of the present function.
  struct Source {
    Argument::Kind kind = Argument::Kind::zeros;
    int first = 0;  ///< unknown, or port
    int index = 0;  ///< index of the value in the port
    int start = 0;  ///< first argument of the port's values
  };

  void begin(const Connections& connections, int n, math::Dependence* x);
  void end(const Connections& connections, int m, const math::Dependence* y);
  void add_share(const Share& share, const math::Dependence* y);
  void add_provision(const Provision& provision, const math::Dependence* y);
  int place_of(int port, const PortColumn& column);
  std::vector<int>& row(int row, bool is_rate);
  static void append(std::vector<TangentPlan::Entries>& entries, int from,
                     const PortColumn& column);

  const Portion* portion_;
  TangentPlan plan_;
  std::vector<Port> ports_;
  std::vector<Source> sources_;  ///< arguments of the present function
  std::vector<LinearShare> linear_;
  std::vector<std::vector<Share>> shares_;  ///< shares of each call
};

}  // namespace samara::components
