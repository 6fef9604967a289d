// The ranks that share an analysis, and sums over them.
#pragma once

#include <algorithm>
#include <vector>

#include <Eigen/Core>
#include <mpi.h>

namespace samara::analysis {

struct Ranks {
  explicit Ranks(MPI_Comm communicator) : comm(communicator) {
    MPI_Comm_rank(comm, &rank);
    MPI_Comm_size(comm, &size);
  }
  MPI_Comm comm;
  int rank = 0;
  int size = 1;

  void sum(double* values, Eigen::Index count) const {
    if (size == 1) return;
    for (Eigen::Index i = 0; i < count; i += most_values)
      MPI_Allreduce(MPI_IN_PLACE, values + i, part(count - i), MPI_DOUBLE, MPI_SUM, comm);
  }
  void sum(Eigen::MatrixXd& values) const { sum(values.data(), values.size()); }
  void sum(Eigen::VectorXd& values) const { sum(values.data(), values.size()); }

  void sum_on(int target, Eigen::MatrixXd& values) const {
    if (size == 1) return;
    for (Eigen::Index i = 0; i < values.size(); i += most_values)
      MPI_Reduce(rank == target ? MPI_IN_PLACE : values.data() + i, values.data() + i,
                 part(values.size() - i), MPI_DOUBLE, MPI_SUM, target, comm);
  }

 private:
  /// Largest number of values in a message.
  static constexpr Eigen::Index most_values = 1 << 20;
  static int part(Eigen::Index rest) { return static_cast<int>(std::min(most_values, rest)); }
};

}  // namespace samara::analysis
