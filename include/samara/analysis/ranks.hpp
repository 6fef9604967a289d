// The ranks that share an analysis, and sums over them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <exception>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <mpi.h>

#include "samara/base/error.hpp"
#include "samara/petsc/session.hpp"

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

  void sum_on(int target, double* values, Eigen::Index count) const {
    if (size == 1) return;
    for (Eigen::Index i = 0; i < count; i += most_values)
      MPI_Reduce(rank == target ? MPI_IN_PLACE : values + i, values + i, part(count - i),
                 MPI_DOUBLE, MPI_SUM, target, comm);
  }
  void sum_on(int target, Eigen::MatrixXd& values) const {
    sum_on(target, values.data(), values.size());
  }

  void sum_on(int target, Eigen::MatrixXcd& values) const {
    sum_on(target, reinterpret_cast<double*>(values.data()), 2 * values.size());
  }

  /// Sums of the real and imaginary parts.
  void sum(Eigen::MatrixXcd& values) const {
    sum(reinterpret_cast<double*>(values.data()), 2 * values.size());
  }

  /// The 2-norm of a vector of which each rank has a part.
  template <class Values>
  double norm(const Values& part) const {
    double square = part.squaredNorm();
    sum(&square, 1);
    return std::sqrt(square);
  }

  /// Copies a value of one rank to all others; texts, vectors and matrices take its size.
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void share(int source, T& value) const { share(source, &value, 1); }
  void share(int source, std::string& text) const { share_sized(source, text); }
  template <class T>
  void share(int source, std::vector<T>& values) const {
    share_sized(source, values);
  }
  template <class T>
  void share(int source, Eigen::MatrixX<T>& values) const {
    std::array<Eigen::Index, 2> shape{values.rows(), values.cols()};
    share(source, shape);
    values.resize(shape[0], shape[1]);
    share(source, values.data(), values.size());
  }

  /// Puts the values of all ranks one after the other, on all of them.
  template <class T>
  void gather(std::vector<T>& values) const {
    std::vector<T> all;
    for (int source = 0; source < size; ++source) {
      std::vector<T> part = values;
      share(source, part);
      all.insert(all.end(), part.begin(), part.end());
    }
    values = std::move(all);
  }

  /// The largest value of all ranks, for each place.
  void find_largest(std::vector<double>& values) const {
    if (size == 1) return;
    const auto count = static_cast<Eigen::Index>(values.size());
    for (Eigen::Index i = 0; i < count; i += most_values)
      MPI_Allreduce(MPI_IN_PLACE, values.data() + i, part(count - i), MPI_DOUBLE, MPI_MAX, comm);
  }
  double largest(double value) const {
    if (size > 1) MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, MPI_MAX, comm);
    return value;
  }

  /// Whether it is true on all ranks.
  bool all(bool value) const {
    int result = value ? 1 : 0;
    if (size > 1) MPI_Allreduce(MPI_IN_PLACE, &result, 1, MPI_INT, MPI_MIN, comm);
    return result != 0;
  }

  /// Does work that differs from rank to rank. If it fails on one of them, it fails on all, with
  /// the same class of error.
  template <class Work>
  void attempt(const Work& work) const {
    if (size == 1) {
      work();
      return;
    }
    std::exception_ptr error;
    std::string message;
    ErrorClass kind = ErrorClass::convergence;
    const auto take = [&](const std::exception& failure, ErrorClass of) {
      error = std::current_exception();
      message = failure.what();
      kind = of;
    };
    try {
      work();
    } catch (const InputError& failure) {
      take(failure, ErrorClass::input);
    } catch (const DomainError& failure) {
      take(failure, ErrorClass::domain);
    } catch (const InternalError& failure) {
      take(failure, ErrorClass::internal);
    } catch (const std::exception& failure) {
      take(failure, ErrorClass::convergence);
    }
    const int failed = petsc::find_smallest(error ? rank : size, comm);
    if (failed == size) return;
    share(failed, message);
    share(failed, kind);
    if (failed == rank) std::rethrow_exception(error);
    switch (kind) {
      case ErrorClass::input:
        throw InputError(message);
      case ErrorClass::domain:
        throw DomainError(message);
      case ErrorClass::internal:
        throw InternalError(message);
      case ErrorClass::convergence:
        throw ConvergenceError(message);
    }
  }

 private:
  enum class ErrorClass : std::uint8_t { input, domain, internal, convergence };

  template <class Values>
  void share_sized(int source, Values& values) const {
    std::size_t count = values.size();
    share(source, count);
    values.resize(count);
    share(source, values.data(), static_cast<Eigen::Index>(count));
  }
  template <class T>
  void share(int source, T* values, Eigen::Index count) const {
    if (size == 1) return;
    for (Eigen::Index i = 0; i < count; i += most_values)
      MPI_Bcast(values + i, part(count - i) * static_cast<int>(sizeof(T)), MPI_BYTE, source, comm);
  }

  /// Largest number of values in a message.
  static constexpr Eigen::Index most_values = 1 << 20;
  static int part(Eigen::Index rest) { return static_cast<int>(std::min(most_values, rest)); }
};

}  // namespace samara::analysis
