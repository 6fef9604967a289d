#include "samara/components/tangents.hpp"

#include <limits>

#include "samara/base/index.hpp"

namespace samara::components {
namespace {

constexpr int block = BlockMatrix::block;
/// Matrix of three rows, one column per value of a port.
using ByPort =
    Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, TangentPlan::most_port_values>;

}  // namespace

Tangents::Tangents(std::shared_ptr<const TangentPlan> plan)
    : plan_(std::move(plan)), K_(plan_->blocks), M_(plan_->blocks) {
  for (const TangentPlan::Call& call : plan_->calls) {
    Derivatives derivatives;
    if (call.is_idle) {  // never evaluated
      derivatives_.push_back(derivatives);
      continue;
    }
    derivatives.x.assign(at(call.arguments), std::numeric_limits<double>::quiet_NaN());
    derivatives.y.setZero(call.values);
    derivatives.J.setZero(call.values, call.arguments);
    derivatives_.push_back(derivatives);
  }
  for (std::size_t i = 0; i < plan_->port_sizes.size(); ++i) {
    const int size = plan_->port_sizes[i];
    const auto columns = static_cast<Eigen::Index>(plan_->port_columns[i].size());
    ports_.push_back({Eigen::VectorXd::Zero(size), Eigen::MatrixXd::Zero(size, columns)});
  }
}

void Tangents::start(double t, const std::vector<double>& z, const std::vector<double>& z_dot) {
  t_ = t;
  z_ = &z;
  z_dot_ = &z_dot;
  next_ = 0;
  for (Port& port : ports_) {
    port.values.setZero();
    port.J.setZero();
  }
  for (BlockMatrix* matrix : {&K_, &M_})
    std::fill(matrix->values().begin(), matrix->values().end(), 0.0);
  for (const TangentPlan::Constant& constant : plan_->constants)
    K_.values()[constant.offset] += constant.value;
}

void Tangents::gather(const Connections& connections, int n) {
  arguments_.resize(std::max(arguments_.size(), at(n)));
  double* x = arguments_.data();
  for (const Argument& argument : connections.arguments) {
    switch (argument.kind) {
      case Argument::Kind::unknowns:
        std::copy_n(z_->data() + argument.first, argument.count, x);
        break;
      case Argument::Kind::rates:
        std::copy_n(z_dot_->data() + argument.first, argument.count, x);
        break;
      case Argument::Kind::port:
        std::copy_n(ports_[at(argument.first)].values.data(), argument.count, x);
        break;
      case Argument::Kind::zeros:
        std::fill_n(x, argument.count, 0.0);
        break;
    }
    x += argument.count;
  }
}

void Tangents::scatter(const Connections& connections, const TangentPlan::Call& call,
                       const Derivatives& derivatives) {
  for (std::size_t i = 0; i < connections.shares.size(); ++i)
    add_share(connections.shares[i], call.shares[i], derivatives.J);
  for (std::size_t i = 0; i < connections.provisions.size(); ++i)
    add_provision(connections.provisions[i], call.provisions[i], derivatives);
}

void Tangents::add_share(const Share& share, const TangentPlan::SharePlan& plan,
                         const Eigen::MatrixXd& J) {
  const Eigen::Index stride = J.rows();
  const auto put = [&](const TangentPlan::Entries& entries, const double* own, const double* other,
                       Eigen::Index step, double weight, double other_weight) {
    double* target = (entries.is_rate ? M_ : K_).values().data() + entries.offset;
    for (int c = 0; c < entries.count; ++c, own += step, other += step, target += block)
      for (int i = 0; i < share.count; ++i) target[i] += weight * own[i] + other_weight * other[i];
  };
  const double* own = J.data() + share.value;
  const double* other = J.data() + share.other;
  for (const TangentPlan::Entries& entries : plan.entries)
    put(entries, own + entries.from * stride, other + entries.from * stride, stride, share.weight,
        share.other_weight);
  for (const TangentPlan::Carried& carried : plan.carried) {
    const Eigen::MatrixXd& port = ports_[at(carried.port)].J;
    ByPort by_port = ByPort::Zero(3, port.rows());
    by_port.topRows(share.count) =
        share.weight * J.block(share.value, carried.argument, share.count, port.rows()) +
        share.other_weight * J.block(share.other, carried.argument, share.count, port.rows());
    through_.noalias() = by_port.lazyProduct(port);
    for (const TangentPlan::Entries& entries : carried.entries) {
      const double* from = through_.data() + 3 * entries.from;
      put(entries, from, from, 3, 1.0, 0.0);
    }
  }
}

void Tangents::add_provision(const Provision& provision, const TangentPlan::ProvisionPlan& plan,
                             const Derivatives& derivatives) {
  Port& port = ports_[at(provision.port)];
  const Eigen::Index size = port.values.size();
  port.values += derivatives.y.segment(provision.value, size);
  for (const TangentPlan::ProvisionPlan::Direct& direct : plan.direct)
    port.J.col(direct.column) += derivatives.J.col(direct.argument).segment(provision.value, size);
  for (const TangentPlan::ProvisionPlan::Through& through : plan.through) {
    const Eigen::MatrixXd& source = ports_[at(through.port)].J;
    const Eigen::MatrixXd product =
        derivatives.J.block(provision.value, through.argument, size, source.rows()) * source;
    for (std::size_t c = 0; c < through.columns.size(); ++c)
      port.J.col(through.columns[c]) += product.col(static_cast<Eigen::Index>(c));
  }
}

}  // namespace samara::components
