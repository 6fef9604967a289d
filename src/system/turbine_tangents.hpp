// The tangents K = dr/dz and M = dr/dz_dot of a turbine as blocks, by automatic differentiation of
// the element functions.
#pragma once

#include <vector>

#include "samara/system/turbine_residual.hpp"

#include "block_matrix.hpp"

namespace samara::system {

class TurbineTangents {
 public:
  explicit TurbineTangents(const TurbineResidual& equations);
  ~TurbineTangents();
  TurbineTangents(const TurbineTangents&) = delete;
  TurbineTangents& operator=(const TurbineTangents&) = delete;

  /// Computes K and M at (t, z, z_dot).
  void evaluate(double t, const std::vector<double>& z, const std::vector<double>& z_dot);

  BlockMatrix& K() { return K_; }
  const BlockMatrix& K() const { return K_; }
  const BlockMatrix& M() const { return M_; }

 private:
  class Scatter;
  struct PointTangents;

  const TurbineResidual& equations_;
  std::vector<PointTangents> points_;  ///< beam after beam
  BlockMatrix K_;
  BlockMatrix M_;  ///< of the same pattern
};

}  // namespace samara::system
