// Reads declared fields out of a YAML tree.
#pragma once

#include "samara/fields/visitor.hpp"

#include "yaml_reader.hpp"

namespace samara::io {

/// Adds errors to those of the mapping, each with its place.
class FieldReader : public fields::Visitor {
 public:
  explicit FieldReader(MapReader& top) : map_(&top) {}

  bool reads() const override { return true; }
  bool given(std::string_view key) const override;

  using Visitor::number;
  void number(const fields::Field& field, double& value,
              std::span<const fields::Word> words) override;
  void integer(const fields::Field& field, int& value,
               std::span<const fields::Word> words) override;
  void integers(const fields::Field& field, std::span<int> values) override;
  using Visitor::numbers;
  void numbers(const fields::Field& field, std::span<double> values, bool spread,
               std::span<const fields::Word> words) override;
  void number_list(const fields::Field& field, const char* items,
                   std::vector<double>& values) override;
  void name_list(const fields::Field& field, std::vector<std::string>& names) override;
  void pairs(const fields::Field& field, const std::array<const char*, 2>& names,
             std::vector<std::pair<double, double>>& pairs) override;
  using Visitor::table;
  void table(const fields::Field& field, std::span<const fields::Column> columns) override;
  bool text(const fields::Field& field, const char* expected, std::string& value) override;
  bool choice(const fields::Field& field, std::span<const char* const> words,
              std::size_t& place) override;
  void matrix(const fields::Field& field, Matrix6& matrix, std::array<bool, 6>* rigid) override;
  void points(const fields::Field& field, const Matrix3& to_a,
              std::vector<Vector3>& points) override;

  void block(const fields::Field& field, const fields::Presence& presence,
             const std::function<void()>& inside) override;
  void list(const fields::Field& field, const fields::Items& items) override;
  void numbered(const fields::Field& field, const fields::Numbered& entries) override;
  void named(const fields::Field& field, const fields::Named& entries) override;
  void two_ways(const fields::Field& field, const char* words, const std::function<void()>& plain,
                const std::function<void()>& mapping) override;

  void exclusive(std::initializer_list<Keys> groups) override;
  void at_least_one(Keys keys, const char* hint) override;
  void retired(std::string_view key, const char* where_it_went) override;
  void accept(Keys keys) override;
  void require(std::string_view key, const char* hint) override;
  void refuse(std::string_view key, const std::string& text) override;
  void expected(std::string_view key, const std::string& words) override;

 private:
  /// The entry of a field, or null if it is left out. A missing compulsory one becomes an error.
  const YamlNode* find(const fields::Field& field);
  void read_entries(const YamlNode& node, const std::string& where,
                    const std::function<void()>& inside);

  MapReader* map_;                         ///< mapping that is being read
  std::vector<std::string_view> refused_;  ///< its keys that another given key excludes
  const char* mapping_words_ = nullptr;    ///< names a mapping that may be given instead
};

}  // namespace samara::io
