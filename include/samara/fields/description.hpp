// A visitor that walks through all fields that could be.
#pragma once

#include "samara/fields/visitor.hpp"

namespace samara::fields {

/// Goes into every mapping once; values are no concern of it.
class Description : public Visitor {
 public:
  bool describes() const override { return true; }

  using Visitor::number;
  void number(const Field&, double&, std::span<const Word>) override {}
  void integer(const Field&, int&, std::span<const Word>) override {}
  void integers(const Field&, std::span<int>) override {}
  using Visitor::numbers;
  void numbers(const Field&, std::span<double>, bool, std::span<const Word>) override {}
  void number_list(const Field&, const char*, std::vector<double>&) override {}
  void name_list(const Field&, std::vector<std::string>&) override {}
  void pairs(const Field&, const std::array<const char*, 2>&,
             std::vector<std::pair<double, double>>&) override {}
  using Visitor::table;
  void table(const Field&, std::span<const Column>) override {}
  bool text(const Field&, const char*, std::string&) override { return false; }
  bool choice(const Field&, std::span<const char* const>, std::size_t&) override { return false; }
  void matrix(const Field&, Matrix6&, std::array<bool, 6>*) override {}
  void points(const Field&, const Matrix3&, std::vector<Vector3>&) override {}

  void block(const Field&, const Presence&, const std::function<void()>& inside) override {
    inside();
  }
  void list(const Field&, const Items& items) override { items.declare(items.size()); }
  void numbered(const Field&, const Numbered& entries) override { entries.declare(1); }
  void named(const Field&, const Named& entries) override { entries.declare(""); }
  void two_ways(const Field&, const char*, const std::function<void()>& plain,
                const std::function<void()>& mapping) override {
    plain();
    mapping();
  }
};

}  // namespace samara::fields
