#include "samara/components/pattern.hpp"

#include <algorithm>
#include <map>
#include <string>

#include "samara/base/error.hpp"
#include "samara/base/index.hpp"
#include "samara/components/block_matrix.hpp"
#include "samara/components/portion.hpp"

namespace samara::components {
namespace {

using math::Dependence;
constexpr int block = BlockMatrix::block;

/// Sorts a list in ascending order and removes duplicates.
void keep_unique(std::vector<int>& row) {
  std::ranges::sort(row);
  row.erase(std::unique(row.begin(), row.end()), row.end());
}

void sort(std::vector<std::vector<int>>& rows) {
  for (std::vector<int>& row : rows) keep_unique(row);
}

template <class Visit>
void for_each_quantity(std::uint64_t quantities, const Visit& visit) {
  for (int i = 0; quantities != 0; ++i, quantities >>= 1)
    if ((quantities & 1U) != 0) visit(i);
}

}  // namespace

Pattern::Pattern(int size, const std::vector<int>& port_sizes, const Portion* portion)
    : portion_(portion) {
  plan_.K.resize(at(size));
  plan_.M.resize(at(size));
  plan_.port_sizes = port_sizes;
  plan_.port_columns.resize(port_sizes.size());
  for (const int values : port_sizes) {
    if (values > TangentPlan::most_port_values) throw InternalError("a port has too many values");
    ports_.push_back({std::vector<Dependence>(at(values)), std::vector<std::set<int>>(at(values))});
  }
}

void Pattern::add(const std::vector<LinearShare>& shares) {
  for (const LinearShare& share : shares) {
    if (share.weight == 0.0) continue;
    if (portion_ != nullptr && !portion_->has_entry(share.row, share.column)) continue;
    linear_.push_back(share);
    for (int i = 0; i < share.count; ++i) plan_.K[at(share.row + i)].push_back(share.column + i);
  }
}

void Pattern::begin(const Connections& connections, int n, Dependence* x) {
  sources_.clear();
  for (const Argument& argument : connections.arguments) {
    const int start = static_cast<int>(sources_.size());
    for (int i = 0; i < argument.count; ++i) {
      const int place = start + i;
      const bool is_port = argument.kind == Argument::Kind::port;
      sources_.push_back({argument.kind, is_port ? argument.first : argument.first + i, i, start});
      if (place >= n) break;
      x[place] = Dependence::on(place);
      if (argument.kind == Argument::Kind::zeros) x[place] = Dependence();
      if (!is_port) continue;
      const Port& port = ports_[at(argument.first)];
      if (port.columns[at(i)].empty()) x[place] = port.values[at(i)];
    }
  }
  if (static_cast<int>(sources_.size()) != n)
    throw InternalError("a function of " + std::to_string(n) + " arguments is given " +
                        std::to_string(sources_.size()));
}

void Pattern::end(const Connections& connections, int m, const Dependence* y) {
  plan_.calls.emplace_back();
  plan_.calls.back().arguments = static_cast<int>(sources_.size());
  plan_.calls.back().values = m;
  TangentPlan::Call& call = plan_.calls.back();
  for (const Source& source : sources_)
    if (source.kind == Argument::Kind::unknowns || source.kind == Argument::Kind::rates)
      call.argument_blocks.push_back(source.first / block);
  for (const Share& share : connections.shares) call.row_blocks.push_back(share.row / block);
  keep_unique(call.argument_blocks);
  keep_unique(call.row_blocks);
  shares_.push_back(connections.shares);
  for (const Share& share : connections.shares) add_share(share, y);
  for (const Provision& provision : connections.provisions) add_provision(provision, y);
}

std::vector<int>& Pattern::row(int row, bool is_rate) {
  return (is_rate ? plan_.M : plan_.K)[at(row)];
}

/// Extends the last entries by a column. Begins new entries if the column is not the next one or is
/// in another block.
void Pattern::append(std::vector<TangentPlan::Entries>& entries, int from,
                     const PortColumn& column) {
  if (!entries.empty()) {
    TangentPlan::Entries& last = entries.back();
    if (last.from + last.count == from && last.unknown + last.count == column.unknown &&
        last.is_rate == column.is_rate && last.unknown / block == column.unknown / block) {
      ++last.count;
      return;
    }
  }
  entries.push_back({from, 1, column.is_rate, column.unknown, 0});
}

void Pattern::add_share(const Share& share, const Dependence* y) {
  if (share.count < 1 || share.count > 3 ||
      share.row / block != (share.row + share.count - 1) / block)
    throw InternalError("a share of a function must have one to three rows in one block");
  TangentPlan::SharePlan plan;
  if (portion_ != nullptr && !portion_->has_share(plan_.calls.size() - 1, share.row)) {
    plan_.calls.back().shares.push_back(plan);
    return;
  }
  std::uint64_t all = 0;
  for (int i = 0; i < share.count; ++i) {
    std::uint64_t own = 0;
    if (share.weight != 0.0) own |= y[share.value + i].quantities();
    if (share.other_weight != 0.0) own |= y[share.other + i].quantities();
    all |= own;
    for_each_quantity(own, [&](int argument) {
      const Source& source = sources_[at(argument)];
      if (source.kind != Argument::Kind::port) {
        row(share.row + i, source.kind == Argument::Kind::rates).push_back(source.first);
        return;
      }
      for (const int place : ports_[at(source.first)].columns[at(source.index)]) {
        const PortColumn& column = plan_.port_columns[at(source.first)][at(place)];
        row(share.row + i, column.is_rate).push_back(column.unknown);
      }
    });
  }
  std::map<int, std::set<int>> through;  // by first argument: columns of the port
  for_each_quantity(all, [&](int argument) {
    const Source& source = sources_[at(argument)];
    if (source.kind != Argument::Kind::port) {
      append(plan.entries, argument, {source.first, source.kind == Argument::Kind::rates});
      return;
    }
    through[source.start].insert(ports_[at(source.first)].columns[at(source.index)].begin(),
                                 ports_[at(source.first)].columns[at(source.index)].end());
  });
  for (const auto& [start, places] : through) {
    TangentPlan::Carried carried{start, sources_[at(start)].first, {}};
    for (const int place : places)
      append(carried.entries, place, plan_.port_columns[at(carried.port)][at(place)]);
    plan.carried.push_back(carried);
  }
  TangentPlan::Call& call = plan_.calls.back();
  if (all != 0) call.is_idle = false;
  call.shares.push_back(plan);
}

/// The number of a column of a port. A missing column is added.
int Pattern::place_of(int port, const PortColumn& column) {
  std::vector<PortColumn>& columns = plan_.port_columns[at(port)];
  const auto found = std::find(columns.begin(), columns.end(), column);
  if (found != columns.end()) return static_cast<int>(found - columns.begin());
  columns.push_back(column);
  return static_cast<int>(columns.size()) - 1;
}

void Pattern::add_provision(const Provision& provision, const Dependence* y) {
  Port& port = ports_[at(provision.port)];
  TangentPlan::ProvisionPlan plan;
  std::uint64_t all = 0;
  for (std::size_t i = 0; i < port.values.size(); ++i) {
    const Dependence& value = y[static_cast<std::size_t>(provision.value) + i];
    all |= value.quantities();
    if (value.quantities() == 0) port.values[i] += value;
    for_each_quantity(value.quantities(), [&](int argument) {
      const Source& source = sources_[at(argument)];
      if (source.kind != Argument::Kind::port) {
        port.columns[i].insert(
            place_of(provision.port, {source.first, source.kind == Argument::Kind::rates}));
        return;
      }
      for (const int place : ports_[at(source.first)].columns[at(source.index)])
        port.columns[i].insert(
            place_of(provision.port, plan_.port_columns[at(source.first)][at(place)]));
    });
  }
  for_each_quantity(all, [&](int argument) {
    const Source& source = sources_[at(argument)];
    if (source.kind != Argument::Kind::port) {
      plan.direct.push_back(
          {argument,
           place_of(provision.port, {source.first, source.kind == Argument::Kind::rates})});
      return;
    }
    if (!plan.through.empty() && plan.through.back().argument == source.start) return;
    TangentPlan::ProvisionPlan::Through through{source.start, source.first, {}};
    for (const PortColumn& column : plan_.port_columns[at(source.first)])
      through.columns.push_back(place_of(provision.port, column));
    plan.through.push_back(through);
  });
  plan_.calls.back().provisions.push_back(plan);
  plan_.calls.back().is_idle = false;
}

TangentPlan Pattern::finish(const TangentPlan* at_least) {
  sort(plan_.K);
  sort(plan_.M);
  plan_.blocks.resize(plan_.K.size() / block);
  for (std::size_t i = 0; i < plan_.K.size(); ++i) {
    std::vector<int>& own = plan_.blocks[i / block];
    if (portion_ == nullptr || portion_->has_unknown(static_cast<int>(i)))
      own.push_back(static_cast<int>(i) / block);
    for (const std::vector<int>* columns : {&plan_.K[i], &plan_.M[i]})
      for (const int column : *columns) own.push_back(column / block);
  }
  for (std::size_t i = 0; at_least != nullptr && i < plan_.blocks.size(); ++i)
    plan_.blocks[i].insert(plan_.blocks[i].end(), at_least->blocks[i].begin(),
                           at_least->blocks[i].end());
  sort(plan_.blocks);
  const BlockMatrix places(plan_.blocks);
  const auto offset = [&places](int row, int column) { return places.place(row, column); };
  for (std::size_t c = 0; c < plan_.calls.size(); ++c)
    for (std::size_t s = 0; s < plan_.calls[c].shares.size(); ++s) {
      const int row = shares_[c][s].row;
      TangentPlan::SharePlan& share = plan_.calls[c].shares[s];
      for (TangentPlan::Entries& entries : share.entries)
        entries.offset = offset(row, entries.unknown);
      for (TangentPlan::Carried& carried : share.carried)
        for (TangentPlan::Entries& entries : carried.entries)
          entries.offset = offset(row, entries.unknown);
    }
  for (const LinearShare& share : linear_)
    for (int i = 0; i < share.count; ++i)
      plan_.constants.push_back({offset(share.row + i, share.column + i), share.weight});
  return std::move(plan_);
}

}  // namespace samara::components
