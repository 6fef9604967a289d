// The ranks that share an analysis, and sums over them.
#pragma once

#include <algorithm>
#include <exception>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <mpi.h>

#include "samara/base/error.hpp"

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

  /// Does work that differs from rank to rank. If it fails on one of them, it fails on all.
  template <class Work>
  void attempt(const Work& work) const {
    std::exception_ptr error;
    std::string message;
    try {
      work();
    } catch (const std::exception& failure) {
      error = std::current_exception();
      message = failure.what();
    }
    int failed = error ? rank : size;
    MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MIN, comm);
    if (failed == size) return;
    int length = static_cast<int>(message.size());
    MPI_Bcast(&length, 1, MPI_INT, failed, comm);
    message.resize(static_cast<std::size_t>(length));
    MPI_Bcast(message.data(), length, MPI_CHAR, failed, comm);
    if (error) std::rethrow_exception(error);
    throw ConvergenceError(message);
  }

 private:
  /// Largest number of values in a message.
  static constexpr Eigen::Index most_values = 1 << 20;
  static int part(Eigen::Index rest) { return static_cast<int>(std::min(most_values, rest)); }
};

}  // namespace samara::analysis
